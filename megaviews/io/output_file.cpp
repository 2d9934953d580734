#include "megaviews/io/output_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

#include "megaviews/core/error.h"

namespace mv {

namespace {
namespace fs = std::filesystem;

std::string asideSuffix() {
    static std::atomic<unsigned> counter{0};
    return ".part-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
}
}  // namespace

OutputFile::OutputFile(const fs::path& path) : path_(path), target_(path) {
    std::error_code error;
    // A link stays a link: what it leads to is replaced.
    if (fs::is_symlink(path, error)) {
        const fs::path resolved = fs::canonical(path, error);
        if (!error) target_ = resolved;
    }
    const fs::file_status status = fs::status(target_, error);
    if (fs::is_directory(status)) {
        throw Error(ExitCode::output, path.string() + ": cannot be written: it is a folder");
    }
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        file_ = std::fopen(target_.c_str(), "wb");
    } else {
        aside_ = target_;
        aside_ += asideSuffix();
        file_ = std::fopen(aside_.c_str(), "wbx");
    }
    if (!file_) {
        aside_.clear();  // never remove what is not ours
        fail("cannot be written");
    }
}

OutputFile::~OutputFile() {
    if (file_) std::fclose(file_);
    std::error_code ignored;
    if (!aside_.empty()) fs::remove(aside_, ignored);
}

void OutputFile::writeBytes(const void* data, std::uint64_t bytes) {
    if (bytes != 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail("cannot be written");
}

void OutputFile::commit() {
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail("cannot be written");
    if (aside_.empty()) return;
    if (std::rename(aside_.c_str(), target_.c_str()) != 0) fail("cannot be put in place");
    aside_.clear();
}

void OutputFile::fail(const char* what) const {
    throw Error(ExitCode::output, path_.string() + ": " + what + ": " + std::strerror(errno));
}

}  // namespace mv
