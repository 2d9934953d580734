#include "renderer/passes/bvh_tables.h"

namespace mv {

void BvhTables::setScene(const Scene& scene, const TriangleBvh& bvh) {
    tables_ = {};
    flags_ = bvh.flags;
    triangleCount_ = static_cast<std::uint32_t>(bvh.triangles.size());
    if (!(bvh.flags & kBvhEmpty)) {
        tables_[0] = TexelTable("BVH nodes", GL_RGBA32UI, bvh.nodes);
        tables_[1] = TexelTable("BVH triangles", GL_RGBA32UI, bvh.triangles);
        tables_[2] = TexelTable("BVH indices", GL_RGB32UI, scene.triangles);
        tables_[3] = TexelTable("BVH normals", GL_RGB32F, scene.normals);
        tables_[7] = TexelTable("BVH materials", GL_RGBA32UI, bvh.materials);
    }
    if (bvh.flags & kBvhColors) tables_[4] = TexelTable("BVH colours", GL_RGBA32F, scene.colors);
    if (bvh.flags & kBvhUvs) tables_[5] = TexelTable("BVH uvs", GL_RG32F, scene.uvs);
    if (bvh.flags & kBvhEmissiveUvs) {
        tables_[6] = TexelTable("BVH emissive uvs", GL_RG32F, scene.emissiveUvs);
    }
    if (bvh.flags & (kBvhUvs | kBvhEmissiveUvs)) {
        tables_[8] = TexelTable("BVH textures", GL_RGBA32UI, bvh.textures.textures);
        tables_[9] = TexelTable("BVH texels", GL_R32UI, bvh.textures.texels);
    }
}

void BvhTables::bind(gl::Program& program) const {
    for (GLuint unit = 0; unit < tables_.size(); ++unit) {
        if (tables_[unit].texels) tables_[unit].texels.bind(unit);
    }
    program.set("bvhFlags", flags_);
}

std::uint64_t BvhTables::bytes() const {
    std::uint64_t sum = 0;
    for (const TexelTable& table : tables_) sum += table.buffer.bytes();
    return sum;
}

}  // namespace mv
