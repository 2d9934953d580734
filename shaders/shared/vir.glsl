// View-independent rasterisation [Marrs17]: a frame's points are made of its triangles for many
// views at once, and each view splats those that it is near enough to need. One triangle, point and
// texel at a time, for both processors.
//
// Points come in levels of detail [Marrs17 fig. 6]. Level k serves the views at a distance of
// kVirNearest 2^k to kVirNearest 2^(k+1), the first one also what is nearer and the last what is
// farther, and lies as dense as the nearest of them asks. So a point of one triangle is splatted
// into a view at the density that suits its own distance, however large the triangle is.
#ifndef MV_VIR_GLSL
#define MV_VIR_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/parametrisation.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/rasterise.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

MV_CONST uint kVirLevels = 5u;
MV_CONST float kVirNearest = 1.0f / 32.0f;  // root-cube units
// Triangles, in the order of the BVH, whose levels are decided together.
MV_CONST uint kVirGroup = 32u;
// Points of neighbouring triangles that views are tested against together.
MV_CONST uint kVirCluster = 32u;
// Texels from the middle of a splat to its edge, at most.
MV_CONST float kVirReach = 6.0f;

// Distances of the views that a level serves: x <= distance < y, root-cube units.
MV_FN vec2 virRange(uint level) {
    float from = kVirNearest * float(1u << level);
    return vec2(level == 0u ? 0.0f : from, level + 1u == kVirLevels ? kInfinity : 2.0f * from);
}

// A point of a triangle, 16 bytes.
struct VirPoint {
    float x, y, z;  // root-cube units
    uint triangle;  // of the BVH; kNone: the alpha mask cuts the point out
};

// ---------------------------------------------------------------- triangles to points

// The points of a triangle: a lattice of columns along its longest edge and 2 x `rows` rows, those
// beyond the opposite edge folded back into the triangle.
struct VirLattice {
    uint columns, rows;  // 0 columns: no point
    uint first;          // corner that the longest edge begins at
};

// The longest edge and the height over it, in spacings; none for a triangle that is a line.
MV_FN vec2 virExtent(vec3 a, vec3 b, vec3 c, float spacing) {
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    MV_PRECISE float longest = sqrt(max(dot3(ab, ab), max(dot3(bc, bc), dot3(ca, ca))));
    float area2 = length3(cross3(ab, ca));  // twice the triangle's
    if (!(area2 > 0.0f)) return vec2(0.0f);
    MV_PRECISE vec2 extent = vec2(longest / spacing, area2 / longest / spacing);
    return extent;
}
MV_FN bool virIsLattice(vec3 a, vec3 b, vec3 c, float spacing) {
    return virExtent(a, b, c, spacing).y > 1.0f;
}

// Rows and columns are no further apart than `spacing`. A triangle narrower than that has as many
// points in one row as its area asks for, the fraction by chance: where it is less than one, a
// point in the middle with the probability that is the area's share of spacing^2. The chance is a
// multiplicative hash of the triangle's number [Knuth, TAOCP 3, 6.4], so that of like neighbours
// every n-th has a point.
MV_FN VirLattice virLattice(vec3 a, vec3 b, vec3 c, float spacing, uint triangle) {
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    VirLattice lattice;
    lattice.first = 0u;
    if (dot3(bc, bc) > dot3(ab, ab)) lattice.first = 1u;
    if (dot3(ca, ca) > max(dot3(ab, ab), dot3(bc, bc))) lattice.first = 2u;
    vec2 extent = virExtent(a, b, c, spacing);
    if (virIsLattice(a, b, c, spacing)) {
        lattice.rows = uint(-floor(-0.5f * extent.y));
        lattice.columns = uint(-floor(-extent.x));
    } else {
        MV_PRECISE float points = 0.5f * extent.x * extent.y + unitFloat(triangle * 2654435769u);
        lattice.rows = 1u;
        lattice.columns = uint(floor(points));
    }
    return lattice;
}

// Weights of the corners a, b, c at the k-th of columns x rows points.
MV_FN vec3 virWeights(VirLattice lattice, uint k) {
    MV_PRECISE float u = 1.0f / 3.0f;
    MV_PRECISE float v = 1.0f / 3.0f;
    if (lattice.columns * lattice.rows > 1u) {
        u = (float(k % lattice.columns) + 0.5f) / float(lattice.columns);
        v = (float(k / lattice.columns) + 0.5f) / (2.0f * float(lattice.rows));
        if (u + v > 1.0f) {
            u = 1.0f - u;
            v = 1.0f - v;
        }
    }
    MV_PRECISE float w = 1.0f - u - v;
    if (lattice.first == 0u) return vec3(w, u, v);
    if (lattice.first == 1u) return vec3(v, w, u);
    return vec3(u, v, w);
}

// Unit; zero for a triangle that is a line.
MV_FN vec3 virNormal(vec3 a, vec3 b, vec3 c) {
    return normalizeOr(cross3(b - a, c - a), vec3(0.0f));
}

MV_FN vec3 virPosition(vec3 a, vec3 b, vec3 c, vec3 weights) {
    MV_PRECISE vec3 p = a * weights.x + b * weights.y + c * weights.z;
    return p;
}

// ---------------------------------------------------------------- points to texels

// Is a point of a level splatted into a view's map? range: of the level. l: length of offset. What
// stands where the view stands has no direction; a view that lights half a space sees nothing
// behind it.
MV_FN bool virServes(vec2 range, uint viewFlags, vec3 viewNormal, vec3 offset, float l) {
    return l >= range.x && l < range.y && l > 1e-6f &&
           (viewFlags == kViewOmnidirectional || dot3(viewNormal, offset) > 0.0f);
}

// A point as a view sees it: a disc in the plane of its triangle.
struct VirSplat {
    vec3 offset;          // from the view
    vec3 normal;          // unit; zero for a triangle that is a line
    float radius;         // of the disc
    bool alone;           // stands for its neighbours too: the disc is not cut by its triangle
    TriangleEdges edges;  // as the view sees them
};

// Discs of a lattice cover their triangle, all but the tips of slivers. Where a triangle has a
// point by chance, its disc has twice the area that it stands for, so that few rays slip through.
MV_CONST float kVirLatticeRadius = 1.2f;  // times the spacing
MV_CONST float kVirAloneRadius = 0.8f;

MV_FN VirSplat virSplat(vec3 a, vec3 b, vec3 c, vec3 position, float spacing, vec3 view) {
    VirSplat s;
    s.offset = position - view;
    s.normal = virNormal(a, b, c);
    s.alone = !virIsLattice(a, b, c, spacing);
    s.radius = spacing * (s.alone ? kVirAloneRadius : kVirLatticeRadius);
    s.edges = triangleEdges(a - view, b - view, c - view);
    return s;
}

// What a point writes into a texel, as bits of a depth: where the ray through the texel's centre
// meets the disc; kNone if it does not.
MV_FN uint virDepth(VirSplat s, uint texel, uint mapRes) {
    vec3 ray = texelRay(texel, mapRes);
    float slope = dot3(s.normal, ray);
    float height = dot3(s.normal, s.offset);
    MV_PRECISE float t = slope != 0.0f ? height / slope : 0.0f;
    MV_PRECISE vec3 beside = ray * t - s.offset;
    MV_PRECISE float depth = t * texelRayLength(texel, mapRes);
    float u;
    float v;
    bool meets = t > 0.0f && dot3(beside, beside) <= s.radius * s.radius &&
                 (s.alone || meetsTriangle(s.edges, ray, u, v));
    return meets ? floatBitsToUint(depth) : kNone;
}

// ---------------------------------------------------------------- what may be left out

MV_CONST float kVirSlack = 1e-5f;  // by which bounds are wider than rounding

// Does a view see any part of a box? Its corners are low and high, as offsets from the view.
MV_FN bool virMaySee(uint viewFlags, vec3 viewNormal, vec3 low, vec3 high) {
    vec3 farthest = vec3(viewNormal.x > 0.0f ? high.x : low.x, viewNormal.y > 0.0f ? high.y : low.y,
                         viewNormal.z > 0.0f ? high.z : low.z);
    return viewFlags == kViewOmnidirectional || dot3(viewNormal, farthest) > -kVirSlack;
}
// Least and greatest distance of the box from the view.
MV_FN vec2 virDistances(vec3 low, vec3 high) {
    vec3 gap = max(max(low, -high), vec3(0.0f));
    vec3 span = max(abs(low), abs(high));
    return vec2(length3(gap), length3(span));
}
// May a level serve views at these least and greatest distances?
MV_FN bool virMayServe(vec2 range, vec2 distances) {
    return distances.x < range.y + kVirSlack && distances.y >= range.x - kVirSlack;
}

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::VirPoint) == 16);
#endif
#endif
