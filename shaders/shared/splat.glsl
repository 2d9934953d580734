// Writing a rendered pair into the map of its view node. Maps keep minima: GLSL includers define
//   MV_SPLAT(texel, bits)      the atomic minimum of a texel of the map,
//   MV_SPLAT_MIP(texel, bits)  (optional) the same of a texel of the map's coarser levels,
//   MV_MAP, MV_MAP_ARG         (optional) a further parameter that says which map.
//
// published: one texel, that of the voxel's centre; with filling, leaf pairs larger than a texel
// go to the coarser level where they are not [Kol19 §3.2], to be pushed down after fusion.
// corrected: every texel whose centre ray meets the node's surface element (the plane through the
// centroid, limited to the box) at the depth where it does; a ball at the seam of the faces touches
// both. Surfaces far from any plane fill their box, at the centroid's depth; in leaf pairs larger
// than a texel, which cover many when filling is on, at the depth where the ray enters the box.
#ifndef MV_SPLAT_GLSL
#define MV_SPLAT_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/parametrisation.glsl"
#include "shaders/shared/surface.glsl"

#ifdef __cplusplus
namespace mv {
struct SplatTarget {
    uint* texels;          // mapTexels(R)
    uint* mips = nullptr;  // mipTexels(R), or none: leaf pairs are written as points
};
}  // namespace mv
#define MV_MAP , mv::SplatTarget map
#define MV_MAP_ARG , map
#define MV_SPLAT(texel, bits) map.texels[texel] = min(map.texels[texel], bits)
#define MV_SPLAT_MIP(texel, bits) map.mips[texel] = min(map.mips[texel], bits)
#else
#ifndef MV_SPLAT
#error "define MV_SPLAT(texel, bits): the atomic minimum of a texel of the map"
#endif
#ifndef MV_MAP
#define MV_MAP
#define MV_MAP_ARG
#endif
#endif

MV_BEGIN_NAMESPACE

// Share of a box's half diagonal by which a surface element reaches beyond its box, so that
// neighbouring elements leave no crack between them. Planes of nodes within a texel are means over
// more surface than those of leaves larger than one: there only rays that graze the plane miss it.
MV_CONST float kNodeMargin = 1.0f;
MV_CONST float kLeafMargin = 0.05f;

// Does the line along `ray` through the view meet the box at `offset`? Separating axes ray x e:
// exact for flat boxes, no division. Views outside the node's ball need offset.ray > 0 as well.
MV_FN bool rayMeetsBox(vec3 ray, vec3 offset, vec3 h) {
    MV_PRECISE float x = offset.y * ray.z - offset.z * ray.y;
    MV_PRECISE float y = offset.z * ray.x - offset.x * ray.z;
    MV_PRECISE float z = offset.x * ray.y - offset.y * ray.x;
    MV_PRECISE float reachX = h.y * abs(ray.z) + h.z * abs(ray.y);
    MV_PRECISE float reachY = h.z * abs(ray.x) + h.x * abs(ray.z);
    MV_PRECISE float reachZ = h.x * abs(ray.y) + h.y * abs(ray.x);
    MV_PRECISE float along = dot3(offset, ray);
    return abs(x) <= reachX && abs(y) <= reachY && abs(z) <= reachZ && along > 0.0f;
}

// Where the ray, known to meet the box, enters it: a multiple of `ray`.
MV_FN float boxEntry(vec3 ray, vec3 offset, vec3 h) {
    MV_PRECISE float tx = ray.x != 0.0f ? (abs(offset.x) - h.x) / abs(ray.x) : 0.0f;
    MV_PRECISE float ty = ray.y != 0.0f ? (abs(offset.y) - h.y) / abs(ray.y) : 0.0f;
    MV_PRECISE float tz = ray.z != 0.0f ? (abs(offset.z) - h.z) / abs(ray.z) : 0.0f;
    return max(max(tx, ty), max(tz, 0.0f));
}

// Depth of a usable surface along a texel's ray, in units of the ray; negative: missed. offset,
// point: the box's centre and a point of the surface as seen from the view; margin: beyond the box.
MV_FN float elementDepth(vec3 ray, vec3 offset, vec3 h, vec3 point, uint surface, float margin) {
    vec3 n = surfaceNormal(surface);
    MV_PRECISE float slope = dot3(n, ray);
    MV_PRECISE float height = dot3(n, point);
    if (!(abs(slope) > 1e-6f)) return -1.0f;  // edge on
    MV_PRECISE float t = height / slope;
    MV_PRECISE float x = abs(ray.x * t - offset.x) - h.x;
    MV_PRECISE float y = abs(ray.y * t - offset.y) - h.y;
    MV_PRECISE float z = abs(ray.z * t - offset.z) - h.z;
    return t > 0.0f && max(x, max(y, z)) <= margin ? t : -1.0f;
}

// A node as one view sees it, and the texels it may cover: all of them from inside its ball.
struct SplatArea {
    vec3 offset;        // of the box's centre
    vec3 surfacePoint;  // the centroid
    vec3 h;             // half extents
    float pointDepth;   // of the centroid
    uvec4 front;        // ballTexels of face 0
    uvec4 back;         // and of face 1
    uint count;         // texels of both
};
// Does the ball cover more texels than one lane should fill? False promises at most 16 a face:
// beyond the seam balls grow by up to 2 before they leave the other face.
MV_FN bool isLargeSplat(SceneNode s, vec3 viewCenter, uint viewRes) {
    vec3 offset = minus3(boxCenter(s), viewCenter);
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float l = length3(offset);
    MV_PRECISE float size = float(viewRes) * rs * l;
    MV_PRECISE float limit =
        (abs(offset.x) < 0.35f * l ? 1.5f : 3.0f) * sizeDivisorExact(offset, rs);
    return size > limit || !(l > rs);
}

MV_FN SplatArea splatAreaOf(SceneNode s, vec3 viewCenter, uint viewRes) {
    SplatArea a;
    a.offset = minus3(boxCenter(s), viewCenter);
    a.surfacePoint = minus3(centroidOf(s), viewCenter);
    a.h = boxHalf(s);
    a.pointDepth = length3(a.surfacePoint);
    MV_PRECISE float rs = length3(a.h);
    MV_PRECISE float l = length3(a.offset);
    MV_PRECISE float tangent = sqrt(max((l - rs) * (l + rs), 0.0f));
    a.front = ballTexels(0u, a.offset, rs, tangent, viewRes);
    a.back = ballTexels(1u, a.offset, rs, tangent, viewRes);
    if (!(l > rs)) a.front = a.back = uvec4(0u, 0u, viewRes, viewRes);
    a.count = a.front.z * a.front.w + a.back.z * a.back.w;
    return a;
}

// The k-th of the area's texels, if its centre ray meets the surface element or, of a surface that
// is none, the box.
MV_FN void splatAreaTexel(SplatArea a, bool forced, uint surface, uint k, uint viewRes MV_MAP) {
    uint inFront = a.front.z * a.front.w;
    bool first = k < inFront;
    uvec4 rect = first ? a.front : a.back;
    uint index = first ? k : k - inFront;
    // Exact for the few texels of a map, and a vector operation where integer division is not.
    uint row = uint((float(index) + 0.5f) / float(rect.z));
    uint column = index - row * rect.z;
    uint texel = texelAt(first ? 0u : 1u, rect.x + column, rect.y + row, viewRes);
    vec3 ray = texelRay(texel, viewRes);
    float depth = a.pointDepth;
    bool hit = rayMeetsBox(ray, a.offset, a.h);
    if (surfaceUsable(surface)) {
        MV_PRECISE float margin = (forced ? kLeafMargin : kNodeMargin) * length3(a.h);
        float t = elementDepth(ray, a.offset, a.h, a.surfacePoint, surface, margin);
        MV_PRECISE float z = t * texelRayLength(texel, viewRes);
        depth = z;
        hit = (forced || hit) && t >= 0.0f;
    } else if (forced) {
        MV_PRECISE float z = boxEntry(ray, a.offset, a.h) * texelRayLength(texel, viewRes);
        depth = z;
    }
    if (hit) {
        uint bits = floatBitsToUint(depth);
        MV_SPLAT(texel, bits);
    }
}

// One texel at a point of the surface: published rules, and leaf pairs when filling is off.
MV_FN void splatPoint(vec3 offset, uint viewRes MV_MAP) {
    uint texel = texelOfDirection(offset, viewRes);
    uint bits = floatBitsToUint(length3(offset));
    MV_SPLAT(texel, bits);
}

#ifdef MV_SPLAT_MIP
// One texel of the finest level on which the node's ball is not larger than a texel.
MV_FN void splatMip(SceneNode s, vec3 viewCenter, uint viewRes MV_MAP) {
    vec3 offset = minus3(boxCenter(s), viewCenter);
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float divisor = sizeDivisorExact(offset, rs);
    MV_PRECISE float size = float(viewRes) * rs * length3(offset);
    uint level = 0u;
    while ((viewRes >> level) > 1u && size > divisor) {
        ++level;
        size = 0.5f * size;
    }
    uint texel = texelOfDirection(minus3(centroidOf(s), viewCenter), viewRes >> level);
    uint bits = floatBitsToUint(length3(minus3(centroidOf(s), viewCenter)));
    if (level == 0u) {
        MV_SPLAT(texel, bits);
    } else {
        uint mipTexel = mipOffset(level, viewRes) + texel;
        MV_SPLAT_MIP(mipTexel, bits);
    }
}
#endif

// Every texel whose centre ray meets the node.
MV_FN void splatArea(SceneNode s, vec3 viewCenter, bool forced, uint viewRes MV_MAP) {
    SplatArea a = splatAreaOf(s, viewCenter, viewRes);
    if (a.count == 0u) return;
    uint k = 0u;
    do {
        splatAreaTexel(a, forced, s.surface, k, viewRes MV_MAP_ARG);
    } while (++k < a.count);
}

// forced: the pair is kPairForced. holeFill: multi-pixel filling is on (see mipFilled).
MV_FN void splatPair(SceneNode s, vec3 viewCenter, bool published, bool forced, bool holeFill,
                     uint viewRes MV_MAP) {
#ifdef MV_SPLAT_MIP
    if (published && forced && mipFilled(published, holeFill, viewRes)) {
        splatMip(s, viewCenter, viewRes MV_MAP_ARG);
        return;
    }
#endif
    if (published || (forced && !holeFill)) {
        splatPoint(minus3(centroidOf(s), viewCenter), viewRes MV_MAP_ARG);
    } else {
        splatArea(s, viewCenter, forced, viewRes MV_MAP_ARG);
    }
}

MV_END_NAMESPACE
#endif
