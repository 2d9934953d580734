#pragma once
// What final maps may take of the GPU's memory: every method that makes maps asks here first.

#include <cstdint>
#include <string>

#include "megaviews/settings/statistics.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

std::string mebibytes(std::uint64_t bytes);  // "12 MiB", rounded up

struct FinalMaps {
    std::uint64_t count;
    int mapRes;                   // of 2 x mapRes^2 texels
    std::uint64_t workBytes = 0;  // more for each, in a buffer of their own
    bool inRanges = false;        // passes bind only a range of them
    bool packed = false;          // 16 bits a texel instead of 32
};
// Within the budget, and each buffer within the largest that this device has: a storage block, or,
// inRanges, a buffer texture.
bool fit(const FinalMaps& maps, std::uint64_t gpuMemoryBytes);
// Throws Error(ExitCode::impossible), naming the limit and what would fit, if they do not.
void checkFinalMaps(const FinalMaps& maps, std::uint64_t gpuMemoryBytes);

// More of them than a buffer texture of words holds: read four a texel (GpuViewMaps::inQuads).
bool areTooLong(const gl::TexelBuffer<std::uint32_t>& texels);

// One map for each view of a flat hierarchy, not cleared yet, and what they take, in statistics
// that begin anew; `workBytes` more of each map are the caller's to allocate. Returns the words of
// all. Throws as checkFinalMaps().
std::uint64_t makeFlatMaps(const GpuViewHierarchy& views, int mapRes, std::uint64_t workBytes,
                           std::uint64_t gpuMemoryBytes, GpuViewMaps& out,
                           MethodStatistics& statistics);

}  // namespace mv
