#pragma once
// Reads one primitive of a glTF mesh: triangles wound alike whatever the mode. Serves the first
// stage, file -> Scene.

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "megaviews/scene/gltf_accessor.h"
#include "megaviews/scene/gltf_materials.h"
#include "megaviews/scene/posed_draw.h"

namespace mv {

// What a primitive will take, before it is read.
struct PrimitiveSize {
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;      // at most: those that no triangle uses are not kept
    std::uint64_t elementsKept = 0;  // of all attributes and morph targets
    std::uint64_t elementsRead = 0;
};
PrimitiveSize primitiveSize(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

// Whether it consists of triangles and has positions.
bool drawsTriangles(const tinygltf::Primitive& primitive);

// Triangles out of `indices` (or 0, 1, 2, ... for `vertices` of them), wound as the standard says:
// every second triangle of a strip turned, fans around their first vertex.
struct TriangleList {
    std::vector<glm::uvec3> triangles;
    std::size_t repeated = 0, leftOver = 0;
};
TriangleList assembleTriangles(int mode, std::span<const std::uint32_t> indices);

// Vertices that no triangle uses are left out. Throws through the report if an index is out of
// range. Safe to call from several threads.
Primitive readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& in,
                        const std::string& place, std::span<const MaterialUvs> uvs,
                        const GltfReport& report);

}  // namespace mv
