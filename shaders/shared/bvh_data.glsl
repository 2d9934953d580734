// The data behind bvh.glsl: the hierarchy, the triangles' attributes, materials and textures as
// rays read them, from arrays in C++ and from buffer textures in GLSL.
//
// How to include it. Every function takes MV_BVH_PARAMS first and is called with MV_BVH_ARGS;
// headers built on this one do the same and then work in both languages:
//
//     MV_FN bool blocked(MV_BVH_PARAMS vec3 a, vec3 b) { ... bvhOccluded(MV_BVH_ARGS a, b, ...) }
//
// C++: the parameter is `const BvhData& bvh`, from TriangleBvh::data(); it points into the
// TriangleBvh and its Scene. No globals, so any number of threads may trace at once.
// GLSL: the parameter is nothing; data come from ten buffer textures on consecutive units from
// kUnitBvh, plus `uniform uint bvhFlags` (kBvh*, TriangleBvh::flags).
// Arrays whose flag is not set need no texture. `#define MV_BVH_MASKS 0` leaves out alpha masks
// for scenes without kBvhMasks: faster where `if` does not branch. `#define MV_BVH_TINTS 1` is what
// bvhPassed() needs in scenes with kBvhTints.
//
//     unit  uniform              format     content
//      +0   bvhNodeTexels        RGBA32UI   BvhNode, 4 texels each
//      +1   bvhTriangleTexels    RGBA32UI   BvhTriangle, 3 texels each, leaf order
//      +2   bvhIndexTexels       RGB32UI    Scene::triangles
//      +3   bvhNormalTexels      RGB32F     Scene::normals
//      +4   bvhColorTexels       RGBA32F    Scene::colors         (kBvhColors)
//      +5   bvhUvTexels          RG32F      Scene::uvs            (kBvhUvs)
//      +6   bvhEmissiveUvTexels  RG32F      Scene::emissiveUvs    (kBvhEmissiveUvs)
//      +7   bvhMaterialTexels    RGBA32UI   TraceMaterial, 4 texels each
//      +8   bvhTextureTexels     RGBA32UI   TraceTexture          (kBvhUvs or kBvhEmissiveUvs)
//      +9   bvhColourTexels      R32UI      texels of the trace textures (as above)
#ifndef MV_BVH_DATA_GLSL
#define MV_BVH_DATA_GLSL
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/types.glsl"

#ifndef MV_BVH_MASKS
#define MV_BVH_MASKS 1
#endif
#ifndef MV_BVH_TINTS
#ifdef __cplusplus
#define MV_BVH_TINTS 1
#else
#define MV_BVH_TINTS 0
#endif
#endif

MV_BEGIN_NAMESPACE

MV_CONST uint kBvhColors = 1u;
MV_CONST uint kBvhUvs = 2u;
MV_CONST uint kBvhEmissiveUvs = 4u;
MV_CONST uint kBvhMasks = 8u;
MV_CONST uint kBvhGloss = 32u;     // surfaces reflect with their gloss, as matt ones all the same
MV_CONST uint kBvhTints = 64u;     // what is clear keeps some of the light that rays pass it by
MV_CONST uint kBvhMirrors = 128u;  // some material mirrors (kMaterialMirrors)
MV_CONST uint kBvhOfGloss = kBvhGloss | kBvhTints;  // what `lambert` materials do without
MV_CONST uint kBvhEmpty = 16u;    // no triangle at all: nothing is fetched, nothing is hit
MV_CONST uint kBvhLiftBits = 8u;  // from this bit on: what bvhLift() doubles by
MV_CONST uint kMostBvhLift = 9u;
MV_CONST int kBvhStack = 64;  // nodes whose children may wait in a walk; the builder keeps to it

#ifdef __cplusplus
struct BvhData {
    const BvhNode* nodes = nullptr;
    const BvhTriangle* triangles = nullptr;
    const uvec3* indices = nullptr;
    const vec3* normals = nullptr;
    const vec4* colors = nullptr;
    const vec2* uvs = nullptr;
    const vec2* emissiveUvs = nullptr;
    const TraceMaterial* materials = nullptr;
    const TraceTexture* textures = nullptr;
    const uint* texels = nullptr;
    uint flags = kBvhEmpty;
};
#define MV_BVH_PARAMS const BvhData &bvh,
#define MV_BVH_ARGS bvh,

inline uvec4 bvhTexelAt(const void* array, uint i) {
    uvec4 texel;
    std::memcpy(&texel, static_cast<const char*>(array) + std::size_t{i} * 16, 16);
    return texel;
}
inline uvec4 bvhNodeTexel(const BvhData& bvh, uint i) { return bvhTexelAt(bvh.nodes, i); }
inline uvec4 bvhTriangleTexel(const BvhData& bvh, uint i) { return bvhTexelAt(bvh.triangles, i); }
inline uvec4 bvhMaterialTexel(const BvhData& bvh, uint i) { return bvhTexelAt(bvh.materials, i); }
inline uvec4 bvhTextureTexel(const BvhData& bvh, uint i) { return bvhTexelAt(bvh.textures, i); }
inline uint bvhColourTexel(const BvhData& bvh, uint i) { return bvh.texels[i]; }
inline uvec3 bvhCorners(const BvhData& bvh, uint triangle) { return bvh.indices[triangle]; }
inline vec3 bvhNormalAt(const BvhData& bvh, uint vertex) { return bvh.normals[vertex]; }
inline vec4 bvhColorAt(const BvhData& bvh, uint vertex) { return bvh.colors[vertex]; }
inline vec2 bvhUvAt(const BvhData& bvh, uint vertex) { return bvh.uvs[vertex]; }
inline vec2 bvhEmissiveUvAt(const BvhData& bvh, uint vertex) { return bvh.emissiveUvs[vertex]; }
inline uint bvhFlagsOf(const BvhData& bvh) { return bvh.flags; }
#define MV_BVH_ONLY const BvhData& bvh
#define MV_BVH_SELF bvh
#else
#define MV_BVH_PARAMS
#define MV_BVH_ARGS
#define MV_BVH_ONLY
#define MV_BVH_SELF
layout(binding = kUnitBvh + 0) uniform usamplerBuffer bvhNodeTexels;
layout(binding = kUnitBvh + 1) uniform usamplerBuffer bvhTriangleTexels;
layout(binding = kUnitBvh + 2) uniform usamplerBuffer bvhIndexTexels;
layout(binding = kUnitBvh + 3) uniform samplerBuffer bvhNormalTexels;
layout(binding = kUnitBvh + 4) uniform samplerBuffer bvhColorTexels;
layout(binding = kUnitBvh + 5) uniform samplerBuffer bvhUvTexels;
layout(binding = kUnitBvh + 6) uniform samplerBuffer bvhEmissiveUvTexels;
layout(binding = kUnitBvh + 7) uniform usamplerBuffer bvhMaterialTexels;
layout(binding = kUnitBvh + 8) uniform usamplerBuffer bvhTextureTexels;
layout(binding = kUnitBvh + 9) uniform usamplerBuffer bvhColourTexels;
uniform uint bvhFlags;

uvec4 bvhNodeTexel(uint i) { return texelFetch(bvhNodeTexels, int(i)); }
uvec4 bvhTriangleTexel(uint i) { return texelFetch(bvhTriangleTexels, int(i)); }
uvec4 bvhMaterialTexel(uint i) { return texelFetch(bvhMaterialTexels, int(i)); }
uvec4 bvhTextureTexel(uint i) { return texelFetch(bvhTextureTexels, int(i)); }
uint bvhColourTexel(uint i) { return texelFetch(bvhColourTexels, int(i)).x; }
uvec3 bvhCorners(uint triangle) { return texelFetch(bvhIndexTexels, int(triangle)).xyz; }
vec3 bvhNormalAt(uint vertex) { return texelFetch(bvhNormalTexels, int(vertex)).xyz; }
vec4 bvhColorAt(uint vertex) { return texelFetch(bvhColorTexels, int(vertex)); }
vec2 bvhUvAt(uint vertex) { return texelFetch(bvhUvTexels, int(vertex)).xy; }
vec2 bvhEmissiveUvAt(uint vertex) { return texelFetch(bvhEmissiveUvTexels, int(vertex)).xy; }
uint bvhFlagsOf() { return bvhFlags; }
#endif

MV_FN vec3 bvhVec3(uvec4 texel) {
    return vec3(uintBitsToFloat(texel.x), uintBitsToFloat(texel.y), uintBitsToFloat(texel.z));
}

MV_END_NAMESPACE
#endif
