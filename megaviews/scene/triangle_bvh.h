#pragma once
// A four-wide SAH hierarchy over the scene's triangles, built once on the CPU, walked by VPL rays
// in GLSL and in C++ by the same lines (shaders/shared/bvh.glsl). VPL rays hit triangles, never the
// octree. Triangles that fill their boxes poorly stand in several leaves (triangle_pieces.h). What
// an animation moves is a tree of its own under the same root, refitted for each pose, its
// triangles whole.

#include <memory>
#include <optional>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/scene/scene.h"
#include "shaders/shared/bvh.glsl"

namespace mv {

struct RayHit {
    float t = 0;                 // root-cube units if the direction is unit
    std::uint32_t triangle = 0;  // index into Scene::triangles
    std::uint32_t slot = 0;      // index into TriangleBvh::triangles
    float u = 0, v = 0;          // barycentric weights of the 2nd and 3rd corner
};

// Textures small enough to be sampled anywhere: each image box-filtered down to at most
// kTraceTextureSize texels a side, all in one array. Approximate: what VPLs see of a texture.
inline constexpr int kTraceTextureSize = 256;
struct TraceTextures {
    std::vector<TraceTexture> textures;  // parallel to Scene::textures
    std::vector<std::uint32_t> texels;   // RGBA8, sRGB colour, r in the low byte
};
TraceTextures makeTraceTextures(const Scene& scene);
std::vector<TraceMaterial> makeTraceMaterials(const Scene& scene);

// Leaves hold at most kBvhLeafTriangles triangles; boxes are padded by kBvhPadding on every side. A
// walk never lets more than kBvhStack - 1 children wait. The same scene gives the same bytes for
// any number of threads.
inline constexpr std::uint32_t kBvhLeafTriangles = 4;
inline constexpr float kBvhPadding = 1.0f / (1 << 21);
inline constexpr float kPoorBvh = 2;
inline constexpr float kBvhPieces = 0.3f;  // share of the triangles that pieces may add

// bvhLift() of a hierarchy that is built of the scene as it stands.
float rayLift(const Scene& scene);

struct TriangleBvh {
    glm::vec3 center{0};         // of the ball around the box of all triangles, wherever they move
    float radius = 0;            // root-cube units
    std::vector<BvhNode> nodes;  // empty for an empty scene; root first
    std::vector<BvhTriangle> triangles;  // by slot, in leaf order
    TraceTextures textures;
    std::vector<TraceMaterial> materials;
    const Scene* scene = nullptr;     // outlives this
    std::uint32_t flags = kBvhEmpty;  // kBvh* of shaders/shared/bvh_data.glsl

    // What moves: the last nodes and triangles, as they were built. Null: nothing does.
    struct Moving {
        std::uint32_t node = 0, triangle = 0;  // the first that move
        std::vector<BvhNode> nodes;
        std::vector<std::uint32_t> order;  // of triangles: index into Scene::triangles
        float cost = 0;                    // of walking the nodes, see refit()
    };
    std::shared_ptr<const Moving> moving;

    static TriangleBvh build(const Scene& scene, const Progress& progress = {});
    // After poseScene(): boxes and corners of what moves. The tree keeps its shape while a walk
    // through it costs at most kPoorBvh times what it did where it was built, by the areas of its
    // boxes; for a pose in which it would cost more it is built anew. Depends on the pose alone.
    void refit();
    // Not of a triangle that an earlier slot holds, too. Hits name slots of which this is so.
    bool isFirst(std::size_t slot) const { return triangles[slot].slot == slot; }
    // What the functions of bvh.glsl take. gloss: albedos are those of surfaces with theirs
    // (kBvhGloss), and what is clear tints (kBvhTints).
    BvhData data(bool gloss = false) const;
    // Closest hit with tMin < t < tMax, alpha masks honoured; nothing if there is none.
    std::optional<RayHit> intersect(glm::vec3 origin, glm::vec3 direction, float tMin,
                                    float tMax) const;
    bool occluded(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) const;
    BvhSurface surface(const RayHit& hit) const;
    // What the ray hit is the back of a surface that has only a front: pictures do not show it.
    bool isBack(const RayHit& hit, glm::vec3 direction) const;
};

}  // namespace mv
