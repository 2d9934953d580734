// Loaded before the C library (LD_PRELOAD): makes one call on a file of one folder fail, as a full
// disk or a lost mount would. The environment says which:
//
// MEGAVIEWS_FAULT_FOLDER  files that are opened for writing below it, or by a relative name, are
//                         watched
// MEGAVIEWS_FAULT         open | write | close | rename: which kind of call
// MEGAVIEWS_FAULT_AT      its number, from 1: of writes, the file's they go to
// MEGAVIEWS_FAULT_MARK    a file that is made when the call has failed
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>

namespace {

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

struct Faults {
    std::string folder = variable("MEGAVIEWS_FAULT_FOLDER");
    std::string kind = variable("MEGAVIEWS_FAULT");
    int at = std::atoi(variable("MEGAVIEWS_FAULT_AT").c_str());
    std::string mark = variable("MEGAVIEWS_FAULT_MARK");
    std::mutex mutex;
    std::map<std::FILE*, int> files;  // open ones, with their numbers
    std::map<std::string, int> calls;

    bool watches(const char* path) const {
        if (folder.empty() || !path) return false;
        // Relative names are of the folder that the program was started in.
        return path[0] != '/' || std::string(path).starts_with(folder);
    }
    bool fails(const char* call, int number) {
        if (kind != call || number != at) return false;
        const int file = ::open(mark.c_str(), O_CREAT | O_WRONLY, 0600);
        if (file >= 0) ::close(file);
        errno = ENOSPC;
        return true;
    }
    bool failsNext(const char* call) { return fails(call, ++calls[call]); }
};

// Never destroyed: files are closed until the very end.
Faults& faults() {
    static Faults* const shared = new Faults;
    return *shared;
}

std::FILE* openedFor(std::FILE* (*original)(const char*, const char*), const char* path,
                     const char* mode) {
    Faults& f = faults();
    if (!std::strpbrk(mode, "wa+") || !f.watches(path)) return original(path, mode);
    const std::lock_guard lock(f.mutex);
    if (f.failsNext("open")) return nullptr;
    std::FILE* file = original(path, mode);
    if (file) f.files[file] = ++f.calls["file"];
    return file;
}

}  // namespace

extern "C" {

std::FILE* fopen(const char* path, const char* mode) {
    return openedFor(next<std::FILE*(const char*, const char*)>("fopen"), path, mode);
}
std::FILE* fopen64(const char* path, const char* mode) {
    return openedFor(next<std::FILE*(const char*, const char*)>("fopen64"), path, mode);
}

std::size_t fwrite(const void* data, std::size_t size, std::size_t count, std::FILE* file) {
    static auto* const original =
        next<std::size_t(const void*, std::size_t, std::size_t, std::FILE*)>("fwrite");
    Faults& f = faults();
    {
        const std::lock_guard lock(f.mutex);
        const auto found = f.files.find(file);
        if (found != f.files.end() && f.fails("write", found->second)) {
            return original(data, size, count / 2, file);  // some of it still fitted
        }
    }
    return original(data, size, count, file);
}

int fclose(std::FILE* file) {
    static auto* const original = next<int(std::FILE*)>("fclose");
    Faults& f = faults();
    bool failed = false;
    {
        const std::lock_guard lock(f.mutex);
        failed = f.files.erase(file) > 0 && f.failsNext("close");
    }
    const int result = original(file);
    if (!failed) return result;
    errno = ENOSPC;  // as if the last bytes had found no room
    return EOF;
}

int rename(const char* from, const char* to) {
    static auto* const original = next<int(const char*, const char*)>("rename");
    Faults& f = faults();
    {
        const std::lock_guard lock(f.mutex);
        if (f.watches(to) && f.failsNext("rename")) return -1;
    }
    return original(from, to);
}

}  // extern "C"
