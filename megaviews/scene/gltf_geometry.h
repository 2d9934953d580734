#pragma once
// Turns the primitives that a glTF scene draws into the triangle soup of a Scene: poses, morphs,
// skins and instances them in double, finds the root cube, and writes root-cube floats. Serves the
// first stage, file -> Scene.

#include <tiny_gltf.h>

#include <span>
#include <vector>

#include "megaviews/scene/gltf_nodes.h"
#include "megaviews/scene/gltf_primitive.h"
#include "megaviews/settings/progress.h"

namespace mv {

// Limits of what a file may expand to (instances included); beyond them it is refused.
inline constexpr std::uint64_t kMostTriangles = std::uint64_t{64} << 20;
inline constexpr std::uint64_t kMostVertices = std::uint64_t{192} << 20;
inline constexpr std::size_t kMostDraws = std::size_t{1} << 20;

// The pose that geometry stands in.
struct PoseTime {
    int animation = -1;
    double timeS = 0;  // inside the animation's duration
};

// Whether another time of this animation gives another geometry.
bool geometryMoves(const tinygltf::Model& model, const Rig& rig, int animation);

// Fills the geometry arrays and the root cube of `scene`.
void addGeometry(const tinygltf::Model& model, const Rig& rig, PoseTime time,
                 std::span<const MaterialUvs> uvs, Scene& scene, GltfReport& report,
                 const Progress& progress);

}  // namespace mv
