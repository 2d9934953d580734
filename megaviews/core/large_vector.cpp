#include "megaviews/core/large_vector.h"

#include <sys/mman.h>

#include <cstdint>

namespace mv {

void adviseLargePages(void* data, std::size_t bytes) noexcept {
    if (bytes < kLeastLargeBytes) return;
    constexpr std::uintptr_t kPage = 4096;
    const std::uintptr_t begin =
        (reinterpret_cast<std::uintptr_t>(data) + kPage - 1) / kPage * kPage;
    const std::uintptr_t end = (reinterpret_cast<std::uintptr_t>(data) + bytes) / kPage * kPage;
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace mv
