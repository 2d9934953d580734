#include "renderer/passes/map_memory.h"

#include <algorithm>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/passes/gpu_data.h"
#include "shaders/shared/map_store.glsl"

namespace mv {

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

namespace {

std::uint64_t mapBytes(int viewRes) {
    return 4 * mapWords(MapStore{static_cast<uint>(viewRes)}, 1);
}
std::uint64_t largestBlock() {
    return static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes);
}
// Of all maps in one buffer.
std::uint64_t mostBytes(const FinalMaps& maps, std::uint64_t gpuMemoryBytes) {
    const auto quads = 16 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
    const std::uint64_t largest = maps.inRanges ? std::max(largestBlock(), quads) : largestBlock();
    return std::min(gpuMemoryBytes, largest);
}

}  // namespace

bool fit(const FinalMaps& maps, std::uint64_t gpuMemoryBytes) {
    const std::uint64_t bytes = maps.count * mapBytes(maps.viewRes);
    const std::uint64_t work = maps.count * maps.workBytes;
    return bytes <= mostBytes(maps, gpuMemoryBytes) && work <= largestBlock() &&
           bytes + work <= gpuMemoryBytes;
}

void checkFinalMaps(const FinalMaps& maps, std::uint64_t gpuMemoryBytes) {
    if (fit(maps, gpuMemoryBytes)) return;
    const std::uint64_t limit = mostBytes(maps, gpuMemoryBytes);
    const std::uint64_t each = mapBytes(maps.viewRes) + maps.workBytes;
    std::string what = std::to_string(maps.count) + " maps of 2 x " + std::to_string(maps.viewRes) +
                       "^2 texels need " + mebibytes(maps.count * each) + ", and ";
    if (limit < gpuMemoryBytes) {
        what += maps.inRanges ? "the largest buffer texture" : "the largest storage block";
        what += " of this device holds " + mebibytes(limit);
    } else {
        what += "--gpu-memory allows " + mebibytes(limit);
    }
    int res = maps.viewRes;
    while (res > 8 && maps.count * mapBytes(res) > limit) res /= 2;
    what += ": about " + std::to_string(limit / each) + " views would fit";
    if (res < maps.viewRes && maps.count * mapBytes(res) <= limit) {
        what += ", or --view-res " + std::to_string(res);
    }
    throw Error(ExitCode::impossible, what);
}

std::vector<std::uint32_t> GpuViewMaps::readTexels(std::uint32_t first, std::uint32_t count) const {
    if (slices.empty()) return texels.read(mapWordOf(store(), first, 0), mapWords(store(), count));
    std::vector<std::uint32_t> out;
    for (std::size_t slice = 0; slice < slices.size(); ++slice) {
        // Slices may share a map.
        const std::uint32_t begin = std::max(first, slices[slice].x);
        const std::uint32_t end = std::min(first + count, slices[slice].y);
        if (begin >= end) continue;
        makeSlice(slice);
        const auto part =
            texels.read(mapWordOf(store(), begin - firstMap, 0), mapWords(store(), end - begin));
        out.insert(out.end(), part.begin(), part.end());
        count -= end - first;
        first = end;
    }
    return out;
}

}  // namespace mv
