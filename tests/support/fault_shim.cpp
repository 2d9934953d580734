// Loaded before the C library (LD_PRELOAD): makes one call fail, on a file of one folder as a full
// disk or a lost mount would, or one allocation. The environment says which:
//
// MEGAVIEWS_FAULT_FOLDER  files that are opened for writing below it, or by a relative name, are
//                         watched
// MEGAVIEWS_FAULT         open | write | close | rename | allocation: which kind of call
// MEGAVIEWS_FAULT_AT      its number, from 1: of writes, the file's they go to
// MEGAVIEWS_FAULT_BYTES   smaller allocations are not counted
// MEGAVIEWS_FAULT_MARK    a file that is made when the call has failed
//
// Allocations are those that the program's own code makes by `new` (so all of its containers), not
// those of the libraries it uses, nor those of the driver, which is C: none of it can be unwound.
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <unistd.h>

#include <atomic>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
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

// Nothing here may allocate.
struct AllocationFault {
    std::atomic<bool> on = false;  // from main(): what libraries make before is not the program's
    std::size_t bytes = 0;
    long at = 0;
    std::atomic<long> count = 0;
    ElfW(Addr) begin = ~ElfW(Addr){}, end = 0;  // of the program's code

    AllocationFault() {
        const char* kind = std::getenv("MEGAVIEWS_FAULT");
        if (!kind || std::strcmp(kind, "allocation") != 0) return;  // none is the 0th
        const auto number = [](const char* name) {
            const char* value = std::getenv(name);
            return value ? std::atol(value) : 0l;
        };
        bytes = static_cast<std::size_t>(number("MEGAVIEWS_FAULT_BYTES"));
        at = number("MEGAVIEWS_FAULT_AT");
        // The first that is listed is the program itself.
        dl_iterate_phdr(
            [](dl_phdr_info* info, std::size_t, void* data) {
                auto* self = static_cast<AllocationFault*>(data);
                for (int i = 0; i < info->dlpi_phnum; ++i) {
                    const auto& segment = info->dlpi_phdr[i];
                    if (segment.p_type != PT_LOAD || !(segment.p_flags & PF_X)) continue;
                    self->begin = info->dlpi_addr + segment.p_vaddr;
                    self->end = self->begin + segment.p_memsz;
                }
                return 1;
            },
            this);
    }
    static bool calledByDriver() {
        void* frames[128];
        const int depth = backtrace(frames, 128);
        for (int i = 0; i < depth; ++i) {
            Dl_info of{};
            if (!dladdr(frames[i], &of) || !of.dli_fname) continue;
            for (const char* driver : {"_dri.so", "libLLVM", "libgallium"}) {
                if (std::strstr(of.dli_fname, driver)) return true;
            }
        }
        return false;
    }
    bool fails(std::size_t size, const void* caller) {
        const auto from = reinterpret_cast<ElfW(Addr)>(caller);
        if (!on || size < bytes || from < begin || from >= end || ++count != at) return false;
        if (calledByDriver()) {  // the driver's C++ uses the program's copy of a template
            --count;
            return false;
        }
        const char* mark = std::getenv("MEGAVIEWS_FAULT_MARK");
        const int file = mark ? ::open(mark, O_CREAT | O_WRONLY, 0600) : -1;
        if (file >= 0) ::close(file);
        return true;
    }
};

AllocationFault& allocationFault() {
    static AllocationFault fault;
    return fault;
}

void* allocate(std::size_t size, std::size_t alignment, const void* caller) {
    AllocationFault& fault = allocationFault();
    void* memory = nullptr;
    if (!fault.fails(size, caller)) {
        memory = alignment
                     ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                     : std::malloc(size ? size : 1);
    }
    if (!memory) throw std::bad_alloc();
    return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 0, __builtin_return_address(0)); }
void* operator new[](std::size_t size) { return allocate(size, 0, __builtin_return_address(0)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
    return allocate(size, static_cast<std::size_t>(alignment), __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

extern "C" {

static int (*programsMain)(int, char**, char**);

static int countedMain(int argc, char** argv, char** environment) {
    allocationFault().on = true;
    return programsMain(argc, argv, environment);
}

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(),
                      void (*fini)(), void (*loaderFini)(), void* stackEnd) {
    programsMain = main;
    return next<int(decltype(main), int, char**, void (*)(), void (*)(), void (*)(), void*)>(
        "__libc_start_main")(countedMain, argc, argv, init, fini, loaderFini, stackEnd);
}

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
