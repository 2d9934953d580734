// Writing a rendered pair into the map of its view node. Maps keep minima: GLSL includers define
//   MV_SPLAT(texel, bits)      the atomic minimum of a texel of the map,
//   MV_SPLAT_MIP(texel, bits)  (optional) the same of a texel of the map's coarser levels,
//   MV_MAP, MV_MAP_ARG         (optional) a further parameter that says which map.
//
// As published: one texel, that of the node's centroid; with filling, leaf pairs larger than a
// texel go to the coarser level where they are not [Kol19 §3.2], to be pushed down after fusion.
// With kRuleSurfaces: every texel whose centre ray meets the node's surface element (the plane
// through the centroid, limited to the box) at the depth where it does; a ball at the seam of the
// faces touches both. Surfaces far from any plane fill their box, at the centroid's depth; in leaf
// pairs larger than a texel, which cover many when filling is on, at the depth where the ray enters
// the box.
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

// Where the ray, known to meet the box, enters it, as a fraction: (numerator, denominator > 0), a
// multiple of `ray`.
MV_FN vec2 boxEntry(vec3 ray, vec3 offset, vec3 h) {
    vec3 along = abs(ray);
    vec3 gap = abs(offset) - h;
    vec2 entry = vec2(0.0f, 1.0f);
    if (gap.x * entry.y > entry.x * along.x) entry = vec2(gap.x, along.x);
    if (gap.y * entry.y > entry.x * along.y) entry = vec2(gap.y, along.y);
    if (gap.z * entry.y > entry.x * along.z) entry = vec2(gap.z, along.z);
    return entry.y > 0.0f ? entry : vec2(0.0f, 1.0f);
}

// A node as one view sees it, and the texels it may cover: all of them from inside its ball.
struct SplatArea {
    vec3 offset;       // of the box's centre
    vec3 h;            // half extents
    vec3 normal;       // of the surface element, if it is one
    float height;      // of its plane over the view, along the normal
    float margin;      // by which it reaches beyond the box
    float pointDepth;  // of the centroid
    bool usable;       // see packSurface
    bool forced;       // the pair is kPairForced
    uvec4 front;       // ballTexels of face 0
    uvec4 back;        // and of face 1
    uint count;        // texels of both
};
// Does the ball cover more texels than one lane should fill? False promises at most 16 a face:
// beyond the seam balls grow by up to 2 before they leave the other face.
MV_FN bool isLargeSplat(SceneNode s, vec3 viewCenter, uint mapRes) {
    vec3 offset = minus3(boxCenter(s), viewCenter);
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float l = length3(offset);
    MV_PRECISE float size = float(mapRes) * rs * l;
    MV_PRECISE float limit =
        (abs(offset.x) < 0.35f * l ? 1.5f : 3.0f) * sizeDivisorExact(offset, rs);
    return size > limit || !(l > rs);
}

MV_FN SplatArea splatAreaOf(SceneNode s, vec3 viewCenter, bool forced, uint mapRes) {
    SplatArea a;
    a.offset = minus3(boxCenter(s), viewCenter);
    a.h = boxHalf(s);
    vec3 point = minus3(centroidOf(s), viewCenter);
    a.usable = surfaceUsable(s.surface);
    a.forced = forced;
    a.normal = surfaceNormal(s.surface);
    a.height = dot3(a.normal, point);
    a.pointDepth = length3(point);
    MV_PRECISE float rs = length3(a.h);
    MV_PRECISE float margin = (forced ? kLeafMargin : kNodeMargin) * rs;
    a.margin = margin;
    MV_PRECISE float l = length3(a.offset);
    MV_PRECISE float tangent = sqrt(max((l - rs) * (l + rs), 0.0f));
    a.front = ballTexels(0u, a.offset, rs, tangent, mapRes);
    a.back = ballTexels(1u, a.offset, rs, tangent, mapRes);
    if (!(l > rs)) a.front = a.back = uvec4(0u, 0u, mapRes, mapRes);
    a.count = a.front.z * a.front.w + a.back.z * a.back.w;
    return a;
}

// One of the area's texels.
struct SplatTexel {
    uint face, column, row;
};
MV_FN SplatTexel splatTexelOf(SplatArea a, uint k) {
    uint inFront = a.front.z * a.front.w;
    bool first = k < inFront;
    uvec4 rect = first ? a.front : a.back;
    uint index = first ? k : k - inFront;
    // Exact for the few texels of a map, and a vector operation where integer division is not.
    uint row = uint((float(index) + 0.5f) / float(rect.z));
    SplatTexel t;
    t.face = first ? 0u : 1u;
    t.column = rect.x + index - row * rect.z;
    t.row = rect.y + row;
    return t;
}
// The one after it, which does without a division.
MV_FN SplatTexel nextSplatTexel(SplatArea a, SplatTexel t) {
    uvec4 rect = t.face == 0u ? a.front : a.back;
    t.column += 1u;
    bool rowEnds = t.column == rect.x + rect.z;
    t.row += rowEnds ? 1u : 0u;
    t.column = rowEnds ? rect.x : t.column;
    bool faceEnds = t.row == rect.y + rect.w;
    t.face = faceEnds ? 1u : t.face;
    t.column = faceEnds ? a.back.x : t.column;
    t.row = faceEnds ? a.back.y : t.row;
    return t;
}

// Writes the texel if its centre ray meets the surface element or, of a surface that is none, the
// box.
MV_FN void splatAreaTexel(SplatArea a, SplatTexel at, uint mapRes MV_MAP) {
    vec2 middle = texelCenter(at.column, at.row, mapRes);
    vec3 ray = centerRay(at.face, middle);
    bool meetsBox = rayMeetsBox(ray, a.offset, a.h);
    MV_PRECISE float slope = dot3(a.normal, ray);
    bool edgeOn = !(abs(slope) > 1e-6f);
    // One division serves the plane and the box.
    vec2 entry = boxEntry(ray, a.offset, a.h);
    if (a.usable) entry = vec2(a.height, edgeOn ? 1.0f : slope);
    MV_PRECISE float t = entry.x / entry.y;
    MV_PRECISE float x = abs(ray.x * t - a.offset.x) - a.h.x;
    MV_PRECISE float y = abs(ray.y * t - a.offset.y) - a.h.y;
    MV_PRECISE float z = abs(ray.z * t - a.offset.z) - a.h.z;
    bool meetsElement = !edgeOn && t > 0.0f && max(x, max(y, z)) <= a.margin;
    MV_PRECISE float along = t * centerRayLength(middle);
    float depth = a.usable || a.forced ? along : a.pointDepth;
    if ((meetsBox || (a.usable && a.forced)) && (meetsElement || !a.usable)) {
        uint texel = texelAt(at.face, at.column, at.row, mapRes);
        uint bits = floatBitsToUint(depth);
        MV_SPLAT(texel, bits);
    }
}

// One texel at a point of the surface: without surface elements, and leaf pairs when filling is
// off.
MV_FN void splatPoint(vec3 offset, uint mapRes MV_MAP) {
    uint texel = texelOfDirection(offset, mapRes);
    uint bits = floatBitsToUint(length3(offset));
    MV_SPLAT(texel, bits);
}

#ifdef MV_SPLAT_MIP
// One texel of the finest level on which the node's ball is not larger than a texel.
MV_FN void splatMip(SceneNode s, vec3 viewCenter, uint mapRes MV_MAP) {
    vec3 offset = minus3(boxCenter(s), viewCenter);
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float divisor = sizeDivisorExact(offset, rs);
    MV_PRECISE float size = float(mapRes) * rs * length3(offset);
    uint level = 0u;
    while ((mapRes >> level) > 1u && size > divisor) {
        ++level;
        size = 0.5f * size;
    }
    uint texel = texelOfDirection(minus3(centroidOf(s), viewCenter), mapRes >> level);
    uint bits = floatBitsToUint(length3(minus3(centroidOf(s), viewCenter)));
    if (level == 0u) {
        MV_SPLAT(texel, bits);
    } else {
        uint mipTexel = mipOffset(level, mapRes) + texel;
        MV_SPLAT_MIP(mipTexel, bits);
    }
}
#endif

// Every texel whose centre ray meets the node.
MV_FN void splatArea(SceneNode s, vec3 viewCenter, bool forced, uint mapRes MV_MAP) {
    SplatArea a = splatAreaOf(s, viewCenter, forced, mapRes);
    if (a.count == 0u) return;
    SplatTexel at = splatTexelOf(a, 0u);
    uint left = a.count;
    do {
        splatAreaTexel(a, at, mapRes MV_MAP_ARG);
        at = nextSplatTexel(a, at);
    } while (--left > 0u);
}

// forced: the pair is kPairForced. holeFill: multi-pixel filling is on (see mipFilled).
MV_FN void splatPair(SceneNode s, vec3 viewCenter, uint rules, bool forced, bool holeFill,
                     uint mapRes MV_MAP) {
#ifdef MV_SPLAT_MIP
    if (forced && mipFilled(rules, holeFill, mapRes)) {
        splatMip(s, viewCenter, mapRes MV_MAP_ARG);
        return;
    }
#endif
    if (!hasRule(rules, kRuleSurfaces) || (forced && !holeFill)) {
        splatPoint(minus3(centroidOf(s), viewCenter), mapRes MV_MAP_ARG);
    } else {
        splatArea(s, viewCenter, forced, mapRes MV_MAP_ARG);
    }
}

MV_END_NAMESPACE
#endif
