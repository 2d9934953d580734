#include "megaviews/io/save_maps.h"

#include <algorithm>

#include "megaviews/io/npy.h"

namespace mv {

std::filesystem::path besideNpy(const std::filesystem::path& file, const std::string& name) {
    std::filesystem::path result = file;
    if (result.extension() == ".npy") result.replace_extension();
    result += "." + name + ".npy";
    return result;
}

void saveMaps(const std::filesystem::path& file, const ReadMaps& read, const RootCube& root) {
    const ViewMaps& maps = read.maps;
    const std::uint64_t mapCount = maps.centers.size();
    const auto res = static_cast<std::uint64_t>(maps.mapRes);
    NpyWriter<float> depth(file, {mapCount, 2, res, res});
    constexpr std::size_t kAtOnce = 2u << 20;
    std::vector<float> distances;
    for (std::size_t first = 0; first < maps.texels.size(); first += kAtOnce) {
        distances.clear();
        for (std::size_t i = first; i < std::min(first + kAtOnce, maps.texels.size()); ++i) {
            distances.push_back(static_cast<float>(double{mapDepth(maps.texels[i])} * root.edge));
        }
        depth.write(distances);
    }

    std::vector<double> centres;
    centres.reserve(3 * mapCount);
    for (const glm::vec3& center : maps.centers) {
        const glm::dvec3 world = root.worldFromRoot(center);
        centres.insert(centres.end(), {world.x, world.y, world.z});
    }

    NpyWriter<double> centresFile(besideNpy(file, "centres"), {mapCount, 3});
    centresFile.write(centres);
    NpyWriter<std::uint32_t> viewsFile(besideNpy(file, "views"), {read.mapOfSlot.size()});
    viewsFile.write(read.mapOfSlot);
    // All three are whole before the first takes its place.
    depth.close();
    centresFile.close();
    viewsFile.close();
    depth.commit();
    centresFile.commit();
    viewsFile.commit();
}

}  // namespace mv
