#pragma once
// Replaces what a glTF document holds in packed form (EXT_meshopt_compression of buffer views,
// KHR_draco_mesh_compression of primitives) by what it unpacks to, so that whoever comes after
// meets buffers, buffer views and accessors alone. Serves the first stage, file -> Scene.

#include <nlohmann/json.hpp>

#include "megaviews/core/progress.h"
#include "megaviews/scene/gltf_file.h"

namespace mv {

// Limits of what packed data may unpack to, beyond which a file is refused: all of them together,
// against the bytes of the file's buffers.
inline constexpr std::uint64_t kUnpackedForFree = std::uint64_t{32} << 20;
inline constexpr std::uint64_t kUnpackedPerByte = 256;
inline constexpr std::uint64_t kMostUnpacked = std::uint64_t{4} << 30;

// `json` is a copy whose values have their types and whose buffer views lie inside their buffers
// (gltf_check.h); unpacked data are appended to file.buffers. Throws through `report`, naming the
// buffer view or primitive.
void unpackCompressed(nlohmann::json& json, GltfFile& file, GltfReport& report,
                      const Progress& progress);

}  // namespace mv
