#pragma once
// A binary SAH hierarchy over the scene's triangles, built once on the CPU, walked by VPL rays in
// GLSL and in C++ by the same lines (shaders/shared/bvh.glsl). VPL rays hit triangles, never the
// octree.

#include <optional>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/settings/progress.h"

namespace mv {

struct RayHit {
    float t = 0;               // root-cube units if the direction is unit
    std::uint32_t triangle = 0;
    float u = 0, v = 0;        // barycentric weights of the 2nd and 3rd corner
};

// Textures small enough to be sampled anywhere: each image box-filtered down to at most
// kTraceTextureSize texels a side, all in one array. Approximate: what VPLs see of a texture.
inline constexpr int kTraceTextureSize = 256;
struct TraceTextures {
    std::vector<TraceTexture> textures;   // parallel to Scene::textures
    std::vector<std::uint32_t> texels;    // RGBA8, sRGB colour, r in the low byte
};
TraceTextures makeTraceTextures(const Scene& scene);
std::vector<TraceMaterial> makeTraceMaterials(const Scene& scene);

struct TriangleBvh {
    std::vector<BvhNode> nodes;           // empty for an empty scene
    std::vector<BvhTriangle> triangles;   // in leaf order
    TraceTextures textures;
    std::vector<TraceMaterial> materials;
    const Scene* scene = nullptr;         // outlives this

    static TriangleBvh build(const Scene& scene, const Progress& progress = {});
    // Closest hit with tMin < t < tMax, alpha masks honoured; nothing if there is none.
    std::optional<RayHit> intersect(glm::vec3 origin, glm::vec3 direction, float tMin,
                                    float tMax) const;
    bool occluded(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) const;
};

}  // namespace mv
