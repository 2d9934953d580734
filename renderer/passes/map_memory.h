#pragma once
// What final maps may take of the GPU's memory: every method that makes maps asks here first.

#include <cstdint>
#include <string>

namespace mv {

std::string mebibytes(std::uint64_t bytes);  // "12 MiB", rounded up

// Throws Error(ExitCode::impossible), naming the limit and what would fit, if `maps` maps of
// 2 x viewRes^2 texels and `workBytes` more for each (none of which lie in a buffer larger than the
// maps) exceed the budget, or one of their buffers the largest that this device has: a storage
// block, or, inRanges, where passes bind only a range of it, the largest buffer texture.
void checkFinalMaps(std::uint64_t maps, int viewRes, std::uint64_t workBytes,
                    std::uint64_t gpuMemoryBytes, bool inRanges = false);

}  // namespace mv
