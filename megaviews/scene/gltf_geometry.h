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

// What is wanted of a file's geometry.
struct GeometryRequest {
    PoseTime time;
    double durationS = 0;                    // of the animation
    std::span<const std::uint32_t> without;  // materials that are left out
    std::optional<RootCube> stated;          // by the file
};

// Fills the geometry arrays and the root cube of `scene` (assembleGeometry).
void addGeometry(const tinygltf::Model& model, Rig rig, const GeometryRequest& request,
                 std::span<const MaterialUvs> uvs, Scene& scene, GltfReport& report,
                 const Progress& progress);

}  // namespace mv
