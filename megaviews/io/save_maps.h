#pragma once
// The three arrays of --save-maps: every fused map with its centre, and which map each view reads
// (ReadMaps -> files). F.npy float32 [maps, 2, R, R]: face 0 looks along +x, face 1 along -x;
// column i and row j stand for (u, v) = ((i + 1/2) 2/R - 1, (j + 1/2) 2/R - 1) = (y, z)/(1 + |x|)
// of the unit direction; the value is the distance from the map's centre in the file's world
// units, infinity where nothing was seen. F.centres.npy float64 [maps, 3], world units.
// F.views.npy uint32 [views]: the map of each view by slot, 0xFFFFFFFF for dead slots.

#include <filesystem>

#include "megaviews/maps/view_maps.h"
#include "megaviews/scene/scene.h"

namespace mv {

// Throws Error(ExitCode::output) if a file cannot be written.
void saveMaps(const std::filesystem::path& file, const ReadMaps& read, const RootCube& root);

// "F.npy" with name "centres" is "F.centres.npy".
std::filesystem::path besideNpy(const std::filesystem::path& file, const std::string& name);

}  // namespace mv
