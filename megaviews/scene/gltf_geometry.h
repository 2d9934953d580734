#pragma once
// What a glTF scene draws where: instances and skins, and the primitives, each read once. Serves
// the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <optional>
#include <span>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/scene/gltf_nodes.h"
#include "megaviews/scene/gltf_primitive.h"

namespace mv {

// Limits of what a file may expand to; beyond them it is refused. Instances count, and what many
// primitives share counts for each. Elements are attribute values: a few for each four bytes of
// the file's buffers are more than any honest file has.
inline constexpr std::uint64_t kMostTriangles = std::uint64_t{32} << 20;
inline constexpr std::size_t kMostDraws = std::size_t{1} << 20;
inline constexpr std::uint64_t kElementsForFree = std::uint64_t{16} << 20;
inline constexpr std::uint64_t kElementsPerByte = 2;
inline constexpr std::uint64_t kMostElementsRead = std::uint64_t{1} << 30;

// Fills the geometry arrays and the root cube of `scene` (assembleGeometry).
void addGeometry(const tinygltf::Model& model, Rig rig, PoseTime time, double durationS,
                 std::span<const MaterialUvs> uvs, const std::optional<RootCube>& stated,
                 Scene& scene, GltfReport& report, const Progress& progress);

}  // namespace mv
