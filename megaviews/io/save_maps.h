#pragma once
// The three arrays of --save-maps: every fused map with its centre, and which map each view reads
// (ViewMaps -> files). F.npy float32 [maps, 2, R, R]: face 0 looks along +x, face 1 along -x;
// column i and row j stand for (u, v) = ((i + 1/2) 2/R - 1, (j + 1/2) 2/R - 1) = (y, z)/(1 + |x|)
// of the unit direction; the value is the distance from the map's centre in the file's world
// units, infinity where nothing was seen. F.centres.npy float64 [maps, 3], world units.
// F.views.npy uint32 [views]: the map of each view by slot, 0xFFFFFFFF for dead slots.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "megaviews/scene/scene.h"
#include "shaders/shared/types.glsl"

namespace mv {

struct MapsToSave {
    int mapRes = 0;                            // R
    std::span<const glm::vec3> centers;        // one a map, root-cube units
    std::span<const std::uint32_t> mapOfSlot;  // kNone for dead slots
    RootCube root;
    // Copies the texels of whole maps from number firstMap on: bits of float distances in
    // root-cube units, kNone = empty. Called in order, some MiB at a time, so that maps on a GPU
    // need not fit in memory twice.
    std::function<void(std::uint64_t firstMap, std::span<std::uint32_t> texels)> read;
};

// Throws Error(ExitCode::output) if a file cannot be written.
void saveMaps(const std::filesystem::path& file, const MapsToSave& maps);

// "F.npy" with name "centres" is "F.centres.npy".
std::filesystem::path besideNpy(const std::filesystem::path& file, const std::string& name);

}  // namespace mv
