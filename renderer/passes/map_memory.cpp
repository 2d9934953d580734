#include "renderer/passes/map_memory.h"

#include <algorithm>
#include <cassert>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "shaders/shared/map_store.glsl"

namespace mv {

std::string mebibytes(std::uint64_t bytes) {
    return std::to_string((bytes + (1u << 20) - 1) >> 20) + " MiB";
}

namespace {

// Of one map, at another resolution.
std::uint64_t mapBytes(const FinalMaps& maps, int mapRes) {
    const MapStore store{static_cast<uint>(mapRes)};
    return 4 * (maps.packed ? packedWords(store, 1) : mapWords(store, 1));
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
    const std::uint64_t bytes = maps.count * mapBytes(maps, maps.mapRes);
    const std::uint64_t work = maps.count * maps.workBytes;
    return bytes <= mostBytes(maps, gpuMemoryBytes) && work <= largestBlock() &&
           bytes + work <= gpuMemoryBytes;
}

void checkFinalMaps(const FinalMaps& maps, std::uint64_t gpuMemoryBytes) {
    if (fit(maps, gpuMemoryBytes)) return;
    const std::uint64_t limit = mostBytes(maps, gpuMemoryBytes);
    const std::uint64_t each = mapBytes(maps, maps.mapRes) + maps.workBytes;
    std::string what = std::to_string(maps.count) + " maps of 2 x " + std::to_string(maps.mapRes) +
                       "^2 texels need " + mebibytes(maps.count * each) + ", and ";
    if (limit < gpuMemoryBytes) {
        what += maps.inRanges ? "the largest buffer texture" : "the largest storage block";
        what += " of this device holds " + mebibytes(limit);
    } else {
        what += "--gpu-memory allows " + mebibytes(limit);
    }
    int res = maps.mapRes;
    while (res > 8 && maps.count * mapBytes(maps, res) > limit) res /= 2;
    what += ": about " + std::to_string(limit / each) + " views would fit";
    if (res < maps.mapRes && maps.count * mapBytes(maps, res) <= limit) {
        what += ", or --view-res " + std::to_string(res);
    }
    throw Error(ExitCode::impossible, what);
}

std::vector<std::uint32_t> GpuViewMaps::readTexels(std::uint32_t first, std::uint32_t count) const {
    const auto read = [&](std::uint32_t from, std::uint32_t maps) {
        if (!packed) return texels.read(mapWordOf(store(), from, 0), mapWords(store(), maps));
        const auto words = texels.read(packedWordOf(store(), from, 0), packedWords(store(), maps));
        std::vector<std::uint32_t> out(mapWords(store(), maps));
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = unpackTexel(words[i / 2], static_cast<uint>(i));
        }
        return out;
    };
    if (slices.empty()) return read(first, count);
    std::vector<std::uint32_t> out;
    for (std::size_t slice = 0; slice < slices.size(); ++slice) {
        // Slices may share a map.
        const std::uint32_t begin = std::max(first, slices[slice].x);
        const std::uint32_t end = std::min(first + count, slices[slice].y);
        if (begin >= end) continue;
        makeSlice(slice);
        const auto part = read(begin - firstMap, end - begin);
        out.insert(out.end(), part.begin(), part.end());
        count -= end - first;
        first = end;
    }
    return out;
}

bool areTooLong(const gl::TexelBuffer<std::uint32_t>& texels) {
    return texels.size() > static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
}

std::uint64_t makeFlatMaps(const GpuViewHierarchy& views, int mapRes, std::uint64_t workBytes,
                           std::uint64_t gpuMemoryBytes, GpuViewMaps& out,
                           MethodStatistics& statistics) {
    assert(views.flat && views.leafCount == views.aliveCount);
    checkFinalMaps({views.aliveCount, mapRes, workBytes}, gpuMemoryBytes);
    const std::uint64_t words = mapWords(MapStore{static_cast<uint>(mapRes)}, views.aliveCount);
    out.present = out.fused = true;
    out.mapRes = mapRes;
    out.mapCount = views.aliveCount;
    out.texels.ensure("view maps", std::max<std::uint64_t>(words, 4));
    out.inQuads = areTooLong(out.texels);
    statistics = {};
    statistics.passes.made = 1;
    statistics.maps = out.mapCount;
    statistics.mapBytes = out.texels.bytes();
    statistics.predictedMapBytes = 4 * words;
    return words;
}

}  // namespace mv
