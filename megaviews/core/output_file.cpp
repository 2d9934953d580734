#include "megaviews/core/output_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include "megaviews/core/error.h"

namespace mv {

namespace {
namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as many as Linux follows
const std::string kAsidePrefix = ".megaviews-", kAsideSuffix = ".part";

// Short, and its own: the target's name with something added could be too long.
std::string asideName() {
    static std::atomic<unsigned> counter{0};
    return kAsidePrefix + std::to_string(getpid()) + "-" + std::to_string(counter++) + kAsideSuffix;
}

Error refused(const fs::path& path, const std::string& reason) {
    return {ExitCode::output, "'" + path.string() + "' cannot be written: " + reason};
}

fs::path folderOf(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

fs::path throughLinks(fs::path path) {
    std::error_code error;
    // A link to an open pipe leads to no name (/dev/stdout).
    const fs::file_status there = fs::status(path, error);
    if (fs::exists(there) && !fs::is_regular_file(there) && !fs::is_directory(there)) return path;
    for (int i = 0; i < kMostLinks && fs::is_symlink(path, error); ++i) {
        const fs::path next = fs::read_symlink(path, error);
        if (error) return path;
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    return path;
}

OutputFile::OutputFile(const fs::path& path) : path_(path), target_(throughLinks(path)) {
    checkTarget();
    struct stat existing {};
    const bool exists = ::stat(target_.c_str(), &existing) == 0;
    if (exists && !S_ISREG(existing.st_mode)) {
        file_ = std::fopen(target_.c_str(), "wb");
        if (!file_) fail("it cannot be opened");
        return;
    }
    openAside();
    // Who may read a result does not change with it; where that cannot be had, it is no reason.
    if (exists) static_cast<void>(::fchmod(::fileno(file_), existing.st_mode & 07777));
}

OutputFile::~OutputFile() {
    if (file_) std::fclose(file_);
    std::error_code ignored;
    if (!aside_.empty()) fs::remove(aside_, ignored);
}

void OutputFile::check(const fs::path& path) {
    const fs::path target = throughLinks(path);
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
        // Opening a pipe waits for its reader.
        if (::access(target.c_str(), W_OK) != 0) throw refused(path, "it is read-only");
        return;
    }
    OutputFile written(path);
}

bool OutputFile::isAside(std::string_view fileName) {
    return fileName.starts_with(kAsidePrefix) && fileName.ends_with(kAsideSuffix);
}

void OutputFile::checkTarget() const {
    std::error_code error;
    const fs::path folder = folderOf(target_);
    if (!fs::is_directory(folder, error)) {
        throw refused(path_, "no folder '" + folder.string() + "'");
    }
    struct stat existing {};
    if (::lstat(target_.c_str(), &existing) != 0) {
        if (errno != ENOENT) fail("its name");
        return;
    }
    if (S_ISDIR(existing.st_mode)) throw refused(path_, "it is a folder");
    if (S_ISLNK(existing.st_mode) && ::stat(target_.c_str(), &existing) != 0) {
        throw refused(path_, "its links lead in a circle");
    }
    if (::access(target_.c_str(), W_OK) != 0) throw refused(path_, "it is read-only");
}

void OutputFile::openAside() {
    const fs::path folder = folderOf(target_);
    const fs::path aside = folder / asideName();
    file_ = std::fopen(aside.c_str(), "wbx");
    if (file_) {
        aside_ = aside;
        return;
    }
    if (errno == EACCES || errno == EROFS) throw refused(path_, "its folder is read-only");
    fail("no file can be made in its folder");
}

void OutputFile::writeBytes(const void* data, std::uint64_t bytes) {
    if (bytes != 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail("writing");
}

void OutputFile::close() {
    if (!file_) return;
    if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("closing");
}

void OutputFile::commit() {
    close();
    if (aside_.empty()) return;
    if (std::rename(aside_.c_str(), target_.c_str()) != 0) fail("putting it in place");
    aside_.clear();
}

void OutputFile::fail(const char* what) const {
    throw refused(path_, std::string(what) + ": " + std::strerror(errno));
}

}  // namespace mv
