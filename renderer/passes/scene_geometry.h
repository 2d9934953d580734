#pragma once
// The scene's triangles on the GPU, cut into compact chunks of one material: what lies outside a
// frustum is not drawn, and what is nearer is drawn first, so that hidden fragments cost a depth
// test only.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "megaviews/scene/scene.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/vertex_array.h"

namespace mv {

// Vertex attribute locations, as the shaders declare them.
inline constexpr GLuint kPositionAttribute = 0, kNormalAttribute = 1, kColorAttribute = 2,
                        kUvAttribute = 3, kEmissiveUvAttribute = 4, kPositionBeforeAttribute = 5;

// Six inward planes of a clip space with depth in [0, w]; an infinite far plane is none.
class Frustum {
  public:
    explicit Frustum(const glm::mat4& clipFromWorld);
    bool touches(glm::vec3 min, glm::vec3 max) const;  // conservative: never a false no

  private:
    std::array<glm::vec4, 6> planes_;
};

// Consecutive triangles of one material with their tight box.
struct GeometryChunk {
    glm::vec3 min{kInfinity}, max{-kInfinity};
    std::uint32_t material = 0;
    std::uint32_t firstTriangle = 0, triangles = 0;  // in the order of the index buffer
};

// Draws of one material, ready for glMultiDrawElements.
struct MaterialDraw {
    std::uint32_t material = 0;
    std::vector<GLsizei> counts;
    std::vector<const void*> offsets;
};

class SceneGeometry {
  public:
    SceneGeometry() = default;
    explicit SceneGeometry(const Scene& scene);
    // After poseScene(): uploads what moves, with the boxes of its chunks.
    void setPose(const Scene& scene);
    void rest() { largestStep_ = 0; }
    // How far any vertex moved along an axis by the last pose. Where it stood is the attribute
    // kPositionBeforeAttribute, which only scenes that move have.
    float largestStep() const { return largestStep_; }

    // The chunks that touch the frustum, grouped by material within shells around the eye, the
    // nearest shell first. The order depends on nothing else.
    std::vector<MaterialDraw> visible(const Frustum& frustum, glm::vec3 eye) const;
    void draw(const MaterialDraw& draw) const;  // with vertices() bound

    const gl::VertexArray& vertices() const { return vertices_; }
    const std::vector<GeometryChunk>& chunks() const { return chunks_; }
    std::uint64_t bytes() const;

  private:
    gl::Buffer positions_, positionsBefore_, normals_, colors_, uvs_, emissiveUvs_, indices_;
    gl::VertexArray vertices_;
    std::vector<GeometryChunk> chunks_;
    // Chunks of what moves come last.
    std::size_t firstMovingChunk_ = 0;
    std::vector<std::uint32_t> movingOrder_;  // of the scene's triangles in the index buffer
    std::vector<glm::vec3> movingPositions_;  // of the last pose
    float largestStep_ = 0;
};

}  // namespace mv
