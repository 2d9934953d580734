#pragma once
// A file written aside and renamed into place, so that nobody ever finds half of one and a disk
// that is full costs no older result: what everything that writes a file goes through. What exists
// already and is no regular file (a device, a pipe) is written directly. A link stays a link: what
// it leads to is replaced.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

namespace mv {

class OutputFile {
  public:
    // Opens a new file in the folder of `path`, or of what it links to. Throws
    // Error(ExitCode::output) naming path and reason, as every member does.
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();  // removes what was not committed
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    // Throws what opening and putting in place would throw now; leaves nothing behind.
    static void check(const std::filesystem::path& path);

    // Whether a file of this name is one that was not committed, of this or another process.
    static bool isAside(std::string_view fileName);

    void writeBytes(const void* data, std::uint64_t bytes);
    void write(std::string_view text) { writeBytes(text.data(), text.size()); }
    template <typename T>
    void write(std::span<const T> elements) {
        writeBytes(elements.data(), elements.size_bytes());
    }
    // Closes: what finds no room has failed then. Nothing may be written afterwards.
    void close();
    // Closes, if that was not done, and renames over `path`.
    void commit();

  private:
    // What keeps a file from being put in place, found before the first byte.
    void checkTarget() const;
    void openAside();
    [[noreturn]] void fail(const char* what) const;  // with the reason that errno gives
    std::filesystem::path path_, target_, aside_;
    std::FILE* file_ = nullptr;
};

// The file that a path leads to through links, whether it exists or not.
std::filesystem::path throughLinks(std::filesystem::path path);

}  // namespace mv
