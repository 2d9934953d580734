#pragma once
// A file written aside and renamed into place, so that nobody ever finds half of one: what every
// writer of megaviews/io uses. What exists already and is no regular file (a device, a pipe) is
// written directly.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

namespace mv {

class OutputFile {
  public:
    // Opens a new file beside `path` (or beside what it links to). Throws
    // Error(ExitCode::output) naming path and reason, as every member does.
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();  // removes what was not committed
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void writeBytes(const void* data, std::uint64_t bytes);
    void write(std::string_view text) { writeBytes(text.data(), text.size()); }
    template <typename T>
    void write(std::span<const T> elements) {
        writeBytes(elements.data(), elements.size_bytes());
    }
    // Flushes, closes and renames over `path`. Nothing may be written afterwards.
    void commit();

  private:
    [[noreturn]] void fail(const char* what) const;
    std::filesystem::path path_, target_, aside_;
    std::FILE* file_ = nullptr;
};

}  // namespace mv
