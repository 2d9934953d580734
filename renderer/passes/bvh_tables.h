#pragma once
// The scene's triangles, their hierarchy, materials and reduced textures on the GPU, as
// shaders/shared/bvh_data.glsl names them: for passes that shoot rays or test triangles themselves.

#include <cstdint>

#include "megaviews/scene/triangle_bvh.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texel_buffer.h"

namespace mv {

class BvhTables {
  public:
    void setScene(const Scene& scene, const TriangleBvh& bvh);  // uploads
    void setPose(const Scene& scene, const TriangleBvh& bvh);   // what moves, after refit()
    // Units from kUnitBvh on, and the program's bvhFlags. gloss: as of TriangleBvh::data().
    void bind(gl::Program& program, bool gloss = false) const;
    // What a shader that includes passes/bounded_rays.glsl is compiled with.
    gl::Defines rayDefines() const;
    bool masks() const { return (flags_ & kBvhMasks) != 0; }  // what MV_BVH_MASKS must be
    bool tints() const { return (flags_ & kBvhTints) != 0; }  // what MV_BVH_TINTS must be
    bool mirrors() const { return (flags_ & kBvhMirrors) != 0; }
    // How passing is compiled: nothing passes, alpha masks alone, or what is clear tints, too.
    enum { kPassings = 3 };
    int passing() const { return tints() ? 2 : masks() ? 1 : 0; }
    std::uint32_t triangleCount() const { return triangleCount_; }
    std::uint64_t bytes() const;

  private:
    // In the order of units; those that the scene does without stay empty.
    struct Tables {
        gl::TexelBuffer<BvhNode> nodes;
        gl::TexelBuffer<BvhTriangle> triangles;
        gl::TexelBuffer<glm::uvec3> indices;
        gl::TexelBuffer<glm::vec3> normals;
        gl::TexelBuffer<glm::vec4> colors;
        gl::TexelBuffer<glm::vec2> uvs, emissiveUvs;
        gl::TexelBuffer<TraceMaterial> materials;
        gl::TexelBuffer<TraceTexture> textures;
        gl::TexelBuffer<std::uint32_t> texels;
    };
    template <typename Visit>
    void forEach(const Visit& visit) const;  // visit(unit, table), of all tables
    Tables tables_;
    std::uint32_t flags_ = kBvhEmpty, triangleCount_ = 0;
};

}  // namespace mv
