#pragma once
// The scene's triangles, their hierarchy, materials and reduced textures on the GPU, as
// shaders/shared/bvh_data.glsl names them: for passes that shoot rays or test triangles themselves.

#include <array>
#include <cstdint>
#include <vector>

#include "megaviews/scene/triangle_bvh.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"

namespace mv {

// A read-only array as shaders fetch it.
struct TexelTable {
    gl::Buffer buffer;
    gl::TextureBuffer texels;
    template <typename T>
    TexelTable(const char* label, GLenum format, const std::vector<T>& elements)
        : buffer(gl::Buffer::of(label, elements)), texels(label, format, buffer) {}
    TexelTable() = default;
};

inline constexpr GLuint kBvhUnits = 10;

class BvhTables {
  public:
    void setScene(const Scene& scene, const TriangleBvh& bvh);  // uploads
    // Units 0 to kBvhUnits - 1, and the program's bvhFlags.
    void bind(gl::Program& program) const;
    bool masks() const { return (flags_ & kBvhMasks) != 0; }  // what MV_BVH_MASKS must be
    std::uint32_t triangleCount() const { return triangleCount_; }
    std::uint64_t bytes() const;

  private:
    std::array<TexelTable, kBvhUnits> tables_;  // in the order of units
    std::uint32_t flags_ = kBvhEmpty, triangleCount_ = 0;
};

}  // namespace mv
