#include "renderer/passes/map_memory.h"

#include <algorithm>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "shaders/shared/map_store.glsl"

namespace mv {

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

void checkFinalMaps(std::uint64_t maps, int viewRes, std::uint64_t workBytes,
                    std::uint64_t gpuMemoryBytes, bool inRanges) {
    const auto block = static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes);
    const auto quads = 16 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
    const std::uint64_t limit = std::min(gpuMemoryBytes, inRanges ? std::max(block, quads) : block);
    const auto mapBytes = [](int res) { return 4 * mapWords(MapStore{static_cast<uint>(res)}, 1); };
    const std::uint64_t each = mapBytes(viewRes);
    const std::uint64_t bytes = maps * each, work = maps * workBytes;
    if (bytes <= limit && work <= block && bytes + work <= gpuMemoryBytes) return;
    std::string what = std::to_string(maps) + " maps of 2 x " + std::to_string(viewRes) +
                       "^2 texels need " + mebibytes(bytes + work) + ", and ";
    if (limit < gpuMemoryBytes) {
        what += inRanges ? "the largest buffer texture" : "the largest storage block";
        what += " of this device holds " + mebibytes(limit);
    } else {
        what += "--gpu-memory allows " + mebibytes(limit);
    }
    int res = viewRes;
    while (res > 8 && maps * mapBytes(res) > limit) res /= 2;
    what += ": about " + std::to_string(limit / (each + workBytes)) + " views would fit";
    if (res < viewRes && maps * mapBytes(res) <= limit) {
        what += ", or --view-res " + std::to_string(res);
    }
    throw Error(ExitCode::impossible, what);
}

}  // namespace mv
