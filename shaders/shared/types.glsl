// Every struct that crosses from C++ to the GPU, declared once. Geometry is in root-cube units
// ([0,1]^3, see RootCube in megaviews/scene/scene.h); std430, scalars only.
#ifndef MV_TYPES_GLSL
#define MV_TYPES_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// A view: a virtual point light or a glowing particle. Dead slots have flags == kViewDead and
// are absent from the view hierarchy. 48 bytes.
MV_CONST uint kViewDead = 0u;             // path left the scene, or slot unused
MV_CONST uint kViewHemisphere = 1u;       // VPL: lights and sees the half space around its normal
MV_CONST uint kViewOmnidirectional = 2u;  // particle: lights and sees everything
struct View {
    float positionX, positionY, positionZ;  // root-cube units
    uint flags;                             // kView*
    float normalX, normalY, normalZ;        // unit; zero for omnidirectional views
    uint bounce;                            // 0 = on an emitter, 1.. = VPL after that many segments
    float fluxR, fluxG, fluxB;              // W, reflected (VPL) or emitted (particle, emitter)
    uint slot;                              // identity from frame to frame (vpl.glsl)
};
MV_FN vec3 viewPosition(View v) { return vec3(v.positionX, v.positionY, v.positionZ); }
MV_FN vec3 viewNormal(View v) { return vec3(v.normalX, v.normalY, v.normalZ); }
MV_FN vec3 viewFlux(View v) { return vec3(v.fluxR, v.fluxG, v.fluxB); }

// Levels of either octree at most: the length of arrays over them.
MV_CONST uint kTreeLevels = 11u;
// Levels at most of whatever tree stands for the scene: a binary one has more.
MV_CONST uint kSceneLevels = 24u;

// Packed children of an octree node: index of the first child << 4 | number of children (0..8).
// Children are contiguous. A leaf has no children.
MV_FN uint packChildren(uint first, uint count) { return (first << 4u) | count; }
MV_FN uint firstChildOf(uint children) { return children >> 4u; }
MV_FN uint childCountOf(uint children) { return children & 15u; }

// Scene octree node as the traversal reads it, 48 bytes = 3 texels of a uvec4 buffer texture.
// By the rules the box is the tight box of the surface inside the voxel or the voxel, the centroid
// the surface's, weighted by area, or the box's centre (rules.glsl): same layout, other table.
struct SceneNode {
    float centerX, centerY, centerZ;        // of the box
    uint children;                          // packChildren
    float halfX, halfY, halfZ;              // half extents of the box, rounded up
    uint surface;                           // packSurface: plane normal and whether it is usable
    float centroidX, centroidY, centroidZ;  // a point of the surface, inside the box
    uint level;                             // root = 0
};

// View octree node, 64 bytes = 4 texels.
MV_CONST uint kViewNodeNoCull = 1u;  // its views together see every direction
struct ViewNode {
    float centerX, centerY, centerZ;  // where its map is rendered from
    uint children;                    // packChildren
    float halfX, halfY, halfZ;        // half extents of the box of its views, rounded up
    uint level;                       // root = 0
    float axisX, axisY, axisZ;        // unit axis of the cone of its views' directions
    float cosPsi;                     // psi = cone half angle + half field of view, < pi
    float sinPsi;
    uint firstView;  // range in the Morton-sorted views
    uint viewCount;
    uint flags;  // kViewNodeNoCull | parent << 1 (root: parent = kNone >> 1)
};

// A sample that one pixel gathered, 48 bytes.
struct GatheredRecord {
    uint slot;
    uint visible;                           // 1 if its light passes, as far as is known
    float positionX, positionY, positionZ;  // of the view, root-cube units
    float openR, openG, openB;              // irradiance that it gives if visible, W/m^2
    float r, g, b;                          // that it does give; what corrects beliefs may be < 0
    uint pad;
};

// One triangle as VPL rays read it, 48 bytes = 3 texels. Vertex attributes are fetched through
// the scene's index buffer only after the closest hit is known.
// In leaf order: a triangle that is cut into pieces stands in several leaves.
struct BvhTriangle {
    float ax, ay, az;  // first corner
    uint triangle;     // index into Scene::triangles
    float bx, by, bz;  // second; all three exactly as in Scene::positions, so that no ray
    uint material;     // index | kMaterialMask if a hit must consult the alpha mask
    float cx, cy, cz;  // third; slips between neighbours
    uint slot;         // first of those that hold the triangle: the one that counts
};
MV_CONST uint kMaterialMask = 0x80000000u;

// Four boxes of a BVH, 64 bytes = 4 texels [YKL17]. Their planes lie at origin + byte * scale,
// child k's in bits 8 k to 8 k + 7. A child is first << 3 | count: `count` triangles from `first`,
// or with count 0 the node `first`; kNone where there are fewer than four.
struct BvhNode {
    float originX, originY, originZ;
    float scaleX;
    uint child0, child1, child2, child3;
    uint lowX, lowY, lowZ;
    float scaleY;
    uint highX, highY, highZ;
    float scaleZ;
};

// Material as VPL tracing reads it, 64 bytes.
struct TraceMaterial {
    float baseR, baseG, baseB;              // linear base colour factor
    float alphaCutoff;                      // 0 = opaque
    float emissionR, emissionG, emissionB;  // W/(m^2 sr), strength included
    uint flags;                             // kMaterial*
    uint baseTexture, emissiveTexture;      // index into the trace textures or kNone
    float baseAlpha;
    float layer;        // what gloss adds, kBvhGloss: albedo = base + layer (1 - base)
    float filledIndex;  // Material::filledIndex(), for sight: rays of light go straight
    float passR, passG,
        passB;  // of light that rays pass it by, times the base colour: what is left
};
MV_CONST uint kMaterialDoubleSided = 1u;
MV_CONST uint kMaterialUnlit = 2u;     // emits, reflects nothing
MV_CONST uint kMaterialBlends = 4u;    // what it leaves of light is a share, its alpha
MV_CONST uint kMaterialClosed = 8u;    // light that it lets in gets out by it
MV_CONST uint kMaterialMirrors = 16u;  // metal so smooth that sight goes on from it

// A texture as VPL tracing reads it: RGBA8 texels (sRGB colour) from `offset` in one texel buffer.
struct TraceTexture {
    uint offset, width, height;
    uint wrap;  // bits 0-1: s, bits 2-3: t; 0 repeat, 1 clamp, 2 mirrored repeat; bit 4: nearest
};
MV_CONST uint kTraceTextureNearest = 16u;

// A light as shooting and direct lighting read it, 64 bytes.
MV_CONST uint kLightPoint = 0u;
MV_CONST uint kLightSpot = 1u;
MV_CONST uint kLightDirectional = 2u;
MV_CONST uint kLightSky = 3u;  // the last of a list, if there is one; of it only flux and share
struct LightRecord {
    float positionX, positionY, positionZ;     // root-cube units
    uint type;                                 // kLight*
    float directionX, directionY, directionZ;  // unit, along the light's rays
    float cosOuter;                            // spot
    float intensityR, intensityG, intensityB;  // W/sr (point, spot), W/m^2 (directional)
    float cosInner;                            // spot
    float fluxR, fluxG, fluxB;                 // W that it sends into the scene
    float cumulative;                          // running share of VPL paths; see vpl.glsl
};

// A cell of the sky, in the order of skyIndex() (sky.glsl). 16 bytes.
struct SkyTexel {
    float r, g, b;     // radiance, W/(m^2 sr)
    float cumulative;  // running share of the power of all cells
};

// The sky as one of a few parallel views sees it: a direction, and the irradiance that a surface
// across it has from all of its part of the sky (megaviews/views/sky_views.h). 32 bytes.
struct SkyView {
    float x, y, z;    // unit, towards the sky
    float luminance;  // of the irradiance
    float r, g, b;    // W/m^2
    float unused;
};

// One emissive triangle for bounce-0 VPLs and the paths that start on it; `cumulative` is the
// running share of power, last = 1.
struct EmissiveTriangle {
    uint bvhSlot;  // index into TriangleBvh::triangles
    float cumulative;
    float probability;  // share of this triangle alone
    float areaM2;       // world units squared
};

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::View) == 48);
static_assert(sizeof(mv::SceneNode) == 48);
static_assert(sizeof(mv::ViewNode) == 64);
static_assert(sizeof(mv::GatheredRecord) == 48);
static_assert(sizeof(mv::BvhTriangle) == 48);
static_assert(sizeof(mv::BvhNode) == 64);
static_assert(sizeof(mv::TraceMaterial) == 64);
static_assert(sizeof(mv::TraceTexture) == 16);
static_assert(sizeof(mv::LightRecord) == 64);
static_assert(sizeof(mv::EmissiveTriangle) == 16);
static_assert(sizeof(mv::SkyTexel) == 16);
static_assert(sizeof(mv::SkyView) == 32);
#endif
#endif
