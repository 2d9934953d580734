// Writing a rendered pair into the map of its view node. Maps keep minima: GLSL includers define
//   MV_SPLAT(texel, bits)  the atomic minimum,
//   MV_MAP, MV_MAP_ARG     (optional) a further parameter that says which map, and its argument;
// in C++ the map is a pointer to its 2 R^2 texels.
//
// published: one texel, that of the voxel's centre. corrected: every texel whose centre ray meets
// the node's box, at the depth of the surface's centroid; a ball at the seam of the faces touches
// both. Leaf pairs larger than a texel are filled texel by texel with the surface element: the
// plane through the centroid, limited to the box.
#ifndef MV_SPLAT_GLSL
#define MV_SPLAT_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/paraboloid.glsl"
#include "shaders/shared/surface.glsl"

#ifdef __cplusplus
#define MV_MAP , mv::uint* map
#define MV_MAP_ARG , map
#define MV_SPLAT(texel, bits) map[texel] = min(map[texel], bits)
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
// neighbouring elements leave no crack between them.
MV_CONST float kElementMargin = 0.05f;

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

// Depth of the surface inside the box along a texel's ray, in units of the ray; negative: missed.
// offset, point: the box's centre and a point of the surface as seen from the view.
MV_FN float elementDepth(vec3 ray, vec3 offset, vec3 h, vec3 point, uint surface) {
    if (!surfaceUsable(surface)) {
        float entry = boxEntry(ray, offset, h);
        return rayMeetsBox(ray, offset, h) ? entry : -1.0f;
    }
    vec3 n = surfaceNormal(surface);
    MV_PRECISE float slope = dot3(n, ray);
    MV_PRECISE float height = dot3(n, point);
    if (!(abs(slope) > 1e-6f)) return -1.0f;  // edge on
    MV_PRECISE float t = height / slope;
    MV_PRECISE float margin = kElementMargin * length3(h);
    MV_PRECISE float x = abs(ray.x * t - offset.x) - h.x;
    MV_PRECISE float y = abs(ray.y * t - offset.y) - h.y;
    MV_PRECISE float z = abs(ray.z * t - offset.z) - h.z;
    return t > 0.0f && max(x, max(y, z)) <= margin ? t : -1.0f;
}

// Texels of one face whose centres a ball can cover: first column, first row, columns, rows.
// tangent = sqrt(l^2 - rs^2); x is positive towards the face. The ball's disc on the face has
// centre (y, z) / (x + tangent) and radius rs / (x + tangent); where the ball covers the pole that
// projects to infinity, the disc turns inside out and the whole face is taken.
MV_FN uvec4 ballTexels(float x, float y, float z, float rs, float tangent, uint viewRes) {
    MV_PRECISE float w = x + tangent;
    float res = float(viewRes);
    if (!(w > 1e-4f * tangent)) return uvec4(0u, 0u, viewRes, viewRes);
    MV_PRECISE float perTexel = 0.5f * res;
    MV_PRECISE float reach = rs / w * perTexel + 1e-3f;
    MV_PRECISE float column = (y / w + 1.0f) * perTexel - 0.5f;  // of the disc's centre
    MV_PRECISE float row = (z / w + 1.0f) * perTexel - 0.5f;
    float c0 = clamp(-floor(reach - column), 0.0f, res);
    float c1 = clamp(floor(column + reach), -1.0f, res - 1.0f);
    float r0 = clamp(-floor(reach - row), 0.0f, res);
    float r1 = clamp(floor(row + reach), -1.0f, res - 1.0f);
    if (!(c1 >= c0) || !(r1 >= r0)) return uvec4(0u);
    return uvec4(uint(c0), uint(r0), uint(c1 - c0) + 1u, uint(r1 - r0) + 1u);
}

// One texel at a point of the surface: published rules, and leaf pairs when filling is off.
MV_FN void splatPoint(vec3 offset, uint viewRes MV_MAP) {
    uint texel = texelOfDirection(offset, viewRes);
    uint bits = floatBitsToUint(length3(offset));
    MV_SPLAT(texel, bits);
}

// Every texel whose centre ray meets the node: `element` says whether at its surface element or at
// its box with the centroid's depth. The view must lie outside the node's ball.
MV_FN void splatArea(SceneNode s, vec3 viewCenter, bool element, uint viewRes MV_MAP) {
    vec3 offset = minus3(boxCenter(s), viewCenter);
    vec3 point = minus3(centroidOf(s), viewCenter);
    vec3 h = boxHalf(s);
    MV_PRECISE float rs = length3(h);
    MV_PRECISE float l = length3(offset);
    MV_PRECISE float tangent = sqrt(max((l - rs) * (l + rs), 0.0f));
    float centroidDepth = length3(point);
    uvec4 front = ballTexels(offset.x, offset.y, offset.z, rs, tangent, viewRes);
    uvec4 back = ballTexels(-offset.x, offset.y, offset.z, rs, tangent, viewRes);
    uint inFront = front.z * front.w;
    uint count = inFront + back.z * back.w;
    for (uint k = 0u; k < count; ++k) {
        bool first = k < inFront;
        uint index = first ? k : k - inFront;
        uint columns = first ? front.z : back.z;
        uint row = index / columns;
        uint column = index - row * columns;
        uint texel = first ? (front.y + row) * viewRes + front.x + column
                           : (viewRes + back.y + row) * viewRes + back.x + column;
        vec3 ray = texelRay(texel, viewRes);
        float depth = centroidDepth;
        bool hit = false;
        if (element) {
            float t = elementDepth(ray, offset, h, point, s.surface);
            MV_PRECISE float z = t * texelRayLength(texel, viewRes);
            depth = z;
            hit = t >= 0.0f;
        } else {
            hit = rayMeetsBox(ray, offset, h);
        }
        if (hit) {
            uint bits = floatBitsToUint(depth);
            MV_SPLAT(texel, bits);
        }
    }
}

// `forced`: the pair is kPairForced; holeFill: multi-pixel filling is on.
MV_FN void splatPair(SceneNode s, vec3 viewCenter, bool published, bool forced, bool holeFill,
                     uint viewRes MV_MAP) {
    if (published || (forced && !holeFill)) {
        splatPoint(minus3(centroidOf(s), viewCenter), viewRes MV_MAP_ARG);
    } else {
        splatArea(s, viewCenter, forced, viewRes MV_MAP_ARG);
    }
}

MV_END_NAMESPACE
#endif
