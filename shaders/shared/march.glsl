// Is the way between two points free? The scene octree answers, its leaves standing for the surface
// inside them: no maps. A leaf that is flat enough is its surface element, the plane through the
// surface's centroid limited to the tight box; any other leaf is its box.
//
// The nodes lie in depth-first order, one uvec4 each (megaviews/methods/rays/march_tree.h): a walk
// is one loop over one fetch, on to the next node where the box is met and past the subtree where
// it is not, without a stack. Any leaf that blocks ends it, so its order does not matter.
//
// What is decided at an end of the way: a leaf knows its surface to a fraction of its own size, so
// the ends are lifted off their surfaces by kMarchLift leaf edges and nothing counts within
// kMarchGap leaf edges of either. Occluders nearer to a surface than that do not shadow it.
//
// Like bvh_data.glsl: functions take MV_MARCH_PARAMS first and are called with MV_MARCH_ARGS. In
// C++ that is `const MarchNodes& march,`; in GLSL it is nothing, and nodes come from a buffer
// texture.
#ifndef MV_MARCH_GLSL
#define MV_MARCH_GLSL
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/octahedral.glsl"

MV_BEGIN_NAMESPACE

MV_CONST float kMarchLift = 0.1f;
MV_CONST float kMarchGap = 0.25f;
// Boxes are rounded outwards to this grid over the root cube, 16 bits a coordinate.
MV_CONST float kMarchGrid = 65535.0f;
// Share of a box's half diagonal by which an element reaches beyond its box, as in maps.
MV_CONST float kMarchMargin = 0.05f;

// x, y, z: low | high << 16 of the box. w: of an inner node the index behind its subtree; of a leaf
// kMarchLeaf, and if its plane is usable kMarchPlane | v << 19 | u << 8 | height.
MV_CONST uint kMarchLeaf = 0x80000000u;
MV_CONST uint kMarchPlane = 0x40000000u;
MV_CONST float kMarchNormalScale = 1023.0f;  // octahedral coordinates, 11 bits
MV_CONST float kMarchHeightScale = 127.0f;   // of the plane over the box's centre, 8 bits

#ifdef __cplusplus
struct MarchNodes {
    const uvec4* nodes = nullptr;
    uint count = 0;      // 0: nothing is in the way
    float leafEdge = 0;  // root-cube units
};
#define MV_MARCH_PARAMS const MarchNodes &march,
#define MV_MARCH_ARGS march,
#define MV_MARCH_SELF march
inline uvec4 marchNode(const MarchNodes& march, uint i) { return march.nodes[i]; }
inline uint marchCountOf(const MarchNodes& march) { return march.count; }
inline float marchLeafEdgeOf(const MarchNodes& march) { return march.leafEdge; }
#else
#define MV_MARCH_PARAMS
#define MV_MARCH_ARGS
#define MV_MARCH_SELF
layout(binding = kUnitMarchNodes) uniform usamplerBuffer marchTexels;
uniform uint marchCount;
uniform float marchLeafEdge;
uvec4 marchNode(uint i) { return texelFetch(marchTexels, int(i)); }
uint marchCountOf() { return marchCount; }
float marchLeafEdgeOf() { return marchLeafEdge; }
#endif

// The direction of a leaf's plane, not normalised; axis-aligned planes are exact.
MV_FN vec3 marchPlaneNormal(uint leaf) {
    float u = float(int((leaf >> 8u) & 0x7FFu)) - kMarchNormalScale;
    float v = float(int((leaf >> 19u) & 0x7FFu)) - kMarchNormalScale;
    return octahedralDirection(vec2(u, v), kMarchNormalScale);
}

// Does the leaf block the way origin + t * direction (grid units) for t between from and to? The
// box is met from enter to leave. The box of a leaf that holds an end of the way is not in it.
MV_FN bool marchLeafBlocks(uvec4 leaf, vec3 low, vec3 high, vec3 origin, vec3 direction, float from,
                           float to, float enter, float leave) {
    vec3 center = (low + high) * 0.5f;
    vec3 h = (high - low) * 0.5f;
    vec3 n = marchPlaneNormal(leaf.w);
    vec3 way = center - origin;
    MV_PRECISE float reach = abs(n.x) * h.x + abs(n.y) * h.y + abs(n.z) * h.z;
    MV_PRECISE float height =
        dot3(n, way) + (float(int(leaf.w & 0xFFu)) - 128.0f) / kMarchHeightScale * reach;
    MV_PRECISE float slope = dot3(n, direction);
    MV_PRECISE float t = height / (slope != 0.0f ? slope : 1e-20f);
    MV_PRECISE float margin = kMarchMargin * length3(h);
    MV_PRECISE float x = abs(direction.x * t - way.x) - h.x;
    MV_PRECISE float y = abs(direction.y * t - way.y) - h.y;
    MV_PRECISE float z = abs(direction.z * t - way.z) - h.z;
    bool element = t > from && t < to && max(x, max(y, z)) <= margin;
    bool box = enter > from && leave < to;
    return (leaf.w & kMarchPlane) != 0u ? element : box;
}

// Whether a leaf blocks the way from a receiver to a view, both with the normals of their surfaces
// (a view without one: zero). Root-cube units. Looks at no more than `limit` nodes; `steps` says at
// how many. If the limit ended the walk, steps > limit.
MV_FN bool marchBlocked(MV_MARCH_PARAMS vec3 receiver, vec3 normal, vec3 view, vec3 viewNormal,
                        uint limit, MV_OUT(uint) steps) {
    float leafEdge = marchLeafEdgeOf(MV_MARCH_SELF);
    float lift = kMarchLift * leafEdge;
    vec3 origin = (receiver + normal * lift) * kMarchGrid;
    vec3 direction = (view + viewNormal * lift) * kMarchGrid - origin;
    float inverseLength = 1.0f / max(length3(direction), 1e-20f);
    MV_PRECISE float from = kMarchGap * leafEdge * kMarchGrid * inverseLength;
    MV_PRECISE float to = 1.0f - from;
    // Zero components: a huge finite inverse keeps 0 * inverse at 0 where infinity gives NaN.
    vec3 inverse = vec3(1.0f / (abs(direction.x) > 1e-15f ? direction.x : 1e-15f),
                        1.0f / (abs(direction.y) > 1e-15f ? direction.y : 1e-15f),
                        1.0f / (abs(direction.z) > 1e-15f ? direction.z : 1e-15f));
    uint count = from < to ? marchCountOf(MV_MARCH_SELF) : 0u;
    uint node = 0u;
    uint looked = 0u;
    bool blocked = false;
    while (node < count && looked <= limit) {
        uvec4 texel = marchNode(MV_MARCH_ARGS node);
        vec3 low = vec3(float(int(texel.x & 0xFFFFu)), float(int(texel.y & 0xFFFFu)),
                        float(int(texel.z & 0xFFFFu)));
        vec3 high = vec3(float(int(texel.x >> 16u)), float(int(texel.y >> 16u)),
                         float(int(texel.z >> 16u)));
        vec3 a = (low - origin) * inverse;
        vec3 b = (high - origin) * inverse;
        vec3 first = min(a, b);
        vec3 last = max(a, b);
        float enter = max(first.x, max(first.y, first.z));
        float leave = min(last.x, min(last.y, last.z));
        bool met = max(enter, from) <= min(leave, to);
        bool leaf = (texel.w & kMarchLeaf) != 0u;
        uint behind = leaf ? node + 1u : texel.w;
        if (leaf && met) {
            blocked = marchLeafBlocks(texel, low, high, origin, direction, from, to, enter, leave);
            if (blocked) behind = count;
        }
        node = met && !leaf ? node + 1u : behind;
        ++looked;
    }
    steps = looked;
    return blocked;
}

MV_END_NAMESPACE
#endif
