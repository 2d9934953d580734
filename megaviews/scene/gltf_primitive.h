#pragma once
// One primitive of a glTF mesh, read once whatever number of nodes draws it: triangles wound
// alike whatever the mode, positions in double, attributes as a Scene has them. Serves the first
// stage, file -> Scene.

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "megaviews/scene/gltf_accessor.h"
#include "megaviews/scene/gltf_materials.h"

namespace mv {

struct Primitive {
    std::string place;  // meshes[0].primitives[1] ("name")
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;          // empty: flat
    std::vector<glm::vec4> colors;            // optional
    std::vector<glm::vec2> uvs, emissiveUvs;  // transformed; empty: no such texture
    std::vector<glm::uvec3> triangles;
    std::uint32_t material = 0;

    struct Influences {  // JOINTS_n and WEIGHTS_n
        std::vector<glm::uvec4> joints;
        std::vector<glm::dvec4> weights;
    };
    std::vector<Influences> influences;
    struct MorphTarget {  // displacements; empty: none
        std::vector<glm::dvec3> positions, normals;
    };
    std::vector<MorphTarget> targets;

    std::size_t repeatedIndices = 0;  // triangles that a list drops for two equal indices
    std::size_t leftOverIndices = 0;  // that make no whole triangle
};

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

// Renumbers the triangles' vertices without gaps; returns which of them are left, ascending.
std::vector<std::uint32_t> dropUnusedVertices(std::vector<glm::uvec3>& triangles,
                                              std::size_t vertices);

// Vertices that no triangle uses are left out. Throws through the report if an index is out of
// range. Safe to call from several threads.
Primitive readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& in,
                        const std::string& place, std::span<const MaterialUvs> uvs,
                        const GltfReport& report);

}  // namespace mv
