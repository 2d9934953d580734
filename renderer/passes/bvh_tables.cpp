#include "renderer/passes/bvh_tables.h"

#include <span>
#include <string>

#include "megaviews/scene/rigged_scene.h"
#include "renderer/gl/workarounds.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

void BvhTables::setScene(const Scene& scene, const TriangleBvh& bvh) {
    tables_ = {};
    flags_ = bvh.flags;
    triangleCount_ = static_cast<std::uint32_t>(bvh.triangles.size());
    if (!(bvh.flags & kBvhEmpty)) {
        tables_.nodes = {"BVH nodes", bvh.nodes};
        tables_.triangles = {"BVH triangles", bvh.triangles};
        tables_.indices = {"BVH indices", scene.triangles};
        tables_.normals = {"BVH normals", scene.normals};
        tables_.materials = {"BVH materials", bvh.materials};
    }
    if (bvh.flags & kBvhColors) tables_.colors = {"BVH colours", scene.colors};
    if (bvh.flags & kBvhUvs) tables_.uvs = {"BVH uvs", scene.uvs};
    if (bvh.flags & kBvhEmissiveUvs) tables_.emissiveUvs = {"BVH emissive uvs", scene.emissiveUvs};
    if (bvh.flags & (kBvhUvs | kBvhEmissiveUvs)) {
        tables_.textures = {"BVH textures", bvh.textures.textures};
        tables_.texels = {"BVH texels", bvh.textures.texels};
    }
}

void BvhTables::setPose(const Scene& scene, const TriangleBvh& bvh) {
    const auto tail = [](const auto& all, std::uint32_t first) {
        return std::span(all).subspan(first);
    };
    const TriangleBvh::Moving& moving = *bvh.moving;
    if (tables_.nodes.size() < bvh.nodes.size()) {  // a tree built anew may have more
        tables_.nodes = {"BVH nodes", bvh.nodes};
    } else {
        tables_.nodes.write(0, std::span(bvh.nodes).first(1));
        tables_.nodes.write(moving.node, tail(bvh.nodes, moving.node));
    }
    tables_.triangles.write(moving.triangle, tail(bvh.triangles, moving.triangle));
    tables_.indices.write(scene.moving->triangle, tail(scene.triangles, scene.moving->triangle));
    tables_.normals.write(scene.moving->vertex, tail(scene.normals, scene.moving->vertex));
}

template <typename Visit>
void BvhTables::forEach(const Visit& visit) const {
    GLuint unit = kUnitBvh;
    const auto each = [&](const auto&... table) { (visit(unit++, table), ...); };
    const Tables& t = tables_;
    each(t.nodes, t.triangles, t.indices, t.normals, t.colors, t.uvs, t.emissiveUvs, t.materials,
         t.textures, t.texels);
}

void BvhTables::bind(gl::Program& program, bool gloss) const {
    forEach([](GLuint unit, const auto& table) {
        if (table) table.bindTexels(unit);
    });
    program.set("bvhFlags", gloss ? flags_ : flags_ & ~kBvhOfGloss);
}

gl::Defines BvhTables::rayDefines() const {
    gl::Defines defines = {{"MV_BVH_MASKS", masks() ? "1" : "0"},
                           {"MV_BVH_TINTS", tints() ? "1" : "0"}};
    constexpr int kLimitedRounds = 6875;  // an eighth of what all lanes may take
    if (gl::isOn(gl::Workaround::loopLimit)) {
        defines.emplace_back("MV_RAY_ROUNDS", std::to_string(kLimitedRounds) + "u");
    }
    return defines;
}

std::uint64_t BvhTables::bytes() const {
    std::uint64_t sum = 0;
    forEach([&](GLuint, const auto& table) { sum += table.bytes(); });
    return sum;
}

}  // namespace mv
