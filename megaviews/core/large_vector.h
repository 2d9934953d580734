#pragma once
// A vector of what a scene can have millions of, in pages of 2 MiB where the system gives them on
// request: a small page costs a fault, and half of the time to read an octree went into these.

#include <cstddef>
#include <memory>
#include <vector>

namespace mv {

// Asks for large pages under [data, data + bytes), untouched so far. A hint: nothing happens where
// the block is below kLeastLargeBytes or the system has none.
void adviseLargePages(void* data, std::size_t bytes) noexcept;
inline constexpr std::size_t kLeastLargeBytes = 4u << 20;

template <typename T>
struct LargeAllocator {
    using value_type = T;
    LargeAllocator() = default;
    template <typename U>
    LargeAllocator(const LargeAllocator<U>& /*other*/) noexcept {}

    T* allocate(std::size_t count) {
        T* const data = std::allocator<T>().allocate(count);
        adviseLargePages(data, count * sizeof(T));
        return data;
    }
    void deallocate(T* data, std::size_t count) noexcept {
        std::allocator<T>().deallocate(data, count);
    }
    bool operator==(const LargeAllocator&) const = default;
};

template <typename T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace mv
