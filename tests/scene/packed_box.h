#pragma once
// A box as glTF files hold it: plain, as a Draco stream, and as buffer views that meshoptimizer
// packs, made by the encoders of both libraries; and images as WebP. For the tests of the loader.

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf_builder.h"

namespace mv::testing {

// The cube [-1,1]^3, each side with vertices of its own: 24 vertices, 12 triangles.
struct Box {
    std::vector<glm::vec3> positions, normals;
    std::vector<glm::vec2> uvs;
    std::vector<glm::u8vec4> colors;
    std::vector<std::uint16_t> indices;
};
Box makeBox();

// With POSITION, NORMAL, TEXCOORD_0 and COLOR_0 (normalised bytes).
GltfBuilder plainBox();

// Draco's unique ids of the attributes in a stream of dracoStream.
inline constexpr int kDracoPosition = 0, kDracoNormal = 1, kDracoUv = 2, kDracoColor = 3;

enum class DracoMethod { sequential, edgebreaker };
// Quantised to 14 bits (normals 12), or with all bits of the floats.
Bytes dracoStream(const Box& box, DracoMethod method, bool quantised = true);
// Of a stream, as Draco's own decoder gives them.
std::vector<glm::vec3> dracoPositions(std::span<const std::uint8_t> stream);
// A box whose primitive is a stream; nothing else holds its data.
GltfBuilder dracoBox(std::span<const std::uint8_t> stream);

// Adds a view of a fallback buffer that `packed` unpacks to; returns its number. `buffer` 1 of the
// document is the fallback buffer, so the builder has to be written as GLB.
int addMeshoptView(GltfBuilder& b, const Bytes& packed, std::size_t count, std::size_t byteStride,
                   const std::string& mode, const std::string& filter = "NONE");
// Packed by meshoptimizer's codecs of vertices and of triangles.
Bytes meshoptVertices(const void* data, std::size_t count, std::size_t byteStride);
Bytes meshoptTriangles(const std::vector<std::uint16_t>& indices);
// Positions with the exponential filter, normals with the octahedral, the rest without.
GltfBuilder meshoptBox();

// Lossless.
Bytes webp(int width, int height, std::span<const std::uint8_t> rgba);

// Triangles as text, one a line, corners rotated so that the least comes first, sorted: equal for
// scenes that are drawn alike, whatever the order of their vertices. Numbers have two decimals.
std::string describeTriangles(const Scene& scene);

}  // namespace mv::testing
