#pragma once
// What the fuzz targets share. Each feeds arbitrary bytes to one reader of files: it must return or
// throw the errors it documents, and nothing else; AddressSanitizer and UBSan watch.
//   build-asan/tests/fuzz_gltf tests/fuzz/seeds/gltf -max_total_time=600
// looks for longer than the tests do.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "megaviews/core/error.h"

namespace mv::fuzz {

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

// A file in memory that is opened by name.
class MemoryFile {
  public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("fuzz", 0)) {
        if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
    }
    ~MemoryFile() { close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(file_); }

  private:
    int file_;
};

// A reader either takes its input or refuses it in words.
template <typename Read>
int tryTo(const Read& read) {
    try {
        read();
    } catch (const Error& error) {
        if (std::string_view(error.what()).empty()) std::abort();
    }
    return 0;
}

}  // namespace mv::fuzz
