#include "megaviews/io/save_maps.h"

#include <algorithm>

#include "megaviews/io/npy.h"
#include "shaders/shared/map_store.glsl"

namespace mv {

std::filesystem::path besideNpy(const std::filesystem::path& file, const std::string& name) {
    std::filesystem::path result = file;
    if (result.extension() == ".npy") result.replace_extension();
    result += "." + name + ".npy";
    return result;
}

void saveMaps(const std::filesystem::path& file, const MapsToSave& maps) {
    const std::uint64_t mapCount = maps.centers.size();
    const auto res = static_cast<std::uint64_t>(maps.mapRes);
    const std::uint64_t texelsPerMap = mapTexels(static_cast<uint>(res));

    // Depth, some MiB at a time.
    NpyWriter<float> depth(file, {mapCount, 2, res, res});
    const std::uint64_t mapsAtOnce =
        std::max<std::uint64_t>(1, (8u << 20) / std::max<std::uint64_t>(1, texelsPerMap * 4));
    std::vector<std::uint32_t> bits;
    std::vector<float> distances;
    for (std::uint64_t first = 0; first < mapCount; first += mapsAtOnce) {
        const std::uint64_t count = std::min(mapsAtOnce, mapCount - first);
        bits.resize(count * texelsPerMap);
        distances.resize(bits.size());
        maps.read(first, bits);
        std::transform(bits.begin(), bits.end(), distances.begin(), [&](std::uint32_t b) {
            return static_cast<float>(double{mapDepth(b)} * maps.root.edge);
        });
        depth.write(distances);
    }

    std::vector<double> centres;
    centres.reserve(3 * mapCount);
    for (const glm::vec3& center : maps.centers) {
        const glm::dvec3 world = maps.root.worldFromRoot(center);
        centres.insert(centres.end(), {world.x, world.y, world.z});
    }

    NpyWriter<double> centresFile(besideNpy(file, "centres"), {mapCount, 3});
    centresFile.write(centres);
    NpyWriter<std::uint32_t> viewsFile(besideNpy(file, "views"), {maps.mapOfSlot.size()});
    viewsFile.write(maps.mapOfSlot);
    // All three are whole before the first takes its place.
    depth.close();
    centresFile.close();
    viewsFile.close();
    depth.commit();
    centresFile.commit();
    viewsFile.commit();
}

}  // namespace mv
