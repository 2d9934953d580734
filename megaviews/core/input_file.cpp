#include "megaviews/core/input_file.h"

#include <algorithm>
#include <fstream>
#include <system_error>

namespace mv {
namespace fs = std::filesystem;

// How Git LFS 1 begins what a clone without it has in place of a large file.
constexpr std::string_view kLfsPointer = "version https://git-lfs.github.com/spec/v1";

std::string whyUnreadable(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) return "there is no such file";
    if (error) return error.message();
    if (fs::is_directory(status)) return "it is a folder, not a file";
    if (!fs::is_regular_file(status)) return "it is not a regular file";
    std::ifstream stream(path, std::ios::binary);
    if (!stream) return "it cannot be opened for reading";
    std::string start(kLfsPointer.size(), '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (start == kLfsPointer) {
        return "it is a Git LFS pointer to a file that was not fetched (git lfs pull)";
    }
    return {};
}

Resource readRegularFile(const fs::path& path, std::uint64_t most) {
    Resource result;
    result.error = whyUnreadable(path);
    if (!result.ok()) return result;
    std::error_code error;
    const std::uint64_t size = fs::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (!error) result.bytes.resize(std::min(size, most));
    stream.read(reinterpret_cast<char*>(result.bytes.data()),
                static_cast<std::streamsize>(result.bytes.size()));
    if (error || static_cast<std::uint64_t>(stream.gcount()) != result.bytes.size()) {
        return {{}, "it cannot be read to its end"};
    }
    result.file = path;
    return result;
}

std::string readTextFile(const fs::path& path, ExitCode code, std::uint64_t most) {
    Resource read = readRegularFile(path, most + 1);
    if (read.ok() && read.bytes.size() > most) {
        read.error = "it is larger than " + std::to_string(most >> 10) + " KiB";
    }
    if (!read.ok()) throw Error(code, "'" + path.string() + "' cannot be read: " + read.error);
    return {read.bytes.begin(), read.bytes.end()};
}

}  // namespace mv
