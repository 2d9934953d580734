// Decisions on a pair (scene node s, view node v) [Kol19 §3.2]: cull [fig. 4], projected size and
// equivalence [fig. 6], subdivision [fig. 8]. Without trigonometry and without divisions: what is
// compared is cross-multiplied. vs = s.centre - v.centre, l = |vs|; rs, rv bounding radii.
//
// Two sets of rules, and any between them (rules.glsl):
//   published: balls around voxels, fig. 6 literally, threshold 1 texel, subdivision by level;
//   corrected: tight boxes, a size that bounds every view of the node, threshold 2 texels,
//              subdivision by radius.
// None loses a pair where one of the trees ends before the other. Leaf pairs whose view lies
// inside the ball of the scene leaf have no size and, at its centre, no direction: they are
// skipped, unless surface elements are drawn and the view looks at the leaf's from off it.
#ifndef MV_PAIR_GLSL
#define MV_PAIR_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/rules.glsl"
#include "shaders/shared/surface.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

MV_CONST uint kPairNone = 0u;        // no pair
MV_CONST uint kPairCulled = 1u;      // no view of v can see s
MV_CONST uint kPairRendered = 2u;    // s fills the same texel in all views of v
MV_CONST uint kPairForced = 3u;      // rendered although larger: both are leaves
MV_CONST uint kPairSplitScene = 4u;  // continue with the children of s
MV_CONST uint kPairSplitView = 5u;   // continue with the children of v
MV_CONST uint kPairSkipped = 6u;     // leaves, the view inside the ball of s and not facing it
MV_CONST uint kPairInside = 7u;      // kPairForced or kPairSkipped: facesSurface() says which

// Rounding in root-cube units: single precision computes n.vs in the unit cube to within 5e-7.
// A 50th of a leaf of the finest octree, so that views 2 % of a leaf above a wall still cull it.
MV_CONST float kCullMargin = 1e-6f;
// Diameter in texels below which a pair is rendered, times the setting `pair-size`.
MV_CONST float kPairSizePublished = 1.0f;
// Below two texels pairs double with every step of 1.41 and pictures gain nothing where a ray
// answers what a map does not know; above, depths get worse (docs/results-earlier.md).
MV_CONST float kPairSizeCorrected = 2.0f;
// Resolution of maps whose texels are that large: what sizes are compared in.
MV_FN float pairResolution(float mapRes, uint rules, float pairSize) {
    float texels = hasRule(rules, kRuleTwoTexels) ? kPairSizeCorrected : kPairSizePublished;
    return mapRes / (texels * pairSize);
}

MV_FN vec3 boxCenter(SceneNode s) { return vec3(s.centerX, s.centerY, s.centerZ); }
MV_FN vec3 boxHalf(SceneNode s) { return vec3(s.halfX, s.halfY, s.halfZ); }
MV_FN vec3 centroidOf(SceneNode s) { return vec3(s.centroidX, s.centroidY, s.centroidZ); }
MV_FN vec3 boxCenter(ViewNode v) { return vec3(v.centerX, v.centerY, v.centerZ); }
MV_FN vec3 boxHalf(ViewNode v) { return vec3(v.halfX, v.halfY, v.halfZ); }
MV_FN vec3 axisOf(ViewNode v) { return vec3(v.axisX, v.axisY, v.axisZ); }
MV_FN bool isLeaf(SceneNode s) { return childCountOf(s.children) == 0u; }
MV_FN bool isLeaf(ViewNode v) { return childCountOf(v.children) == 0u; }
MV_FN uint parentOf(ViewNode v) { return (v.flags >> 1u) == (kNone >> 1u) ? kNone : v.flags >> 1u; }

// Both sides of the comparisons that decide a pair, for whoever shows them; what was not asked is
// 0. Kernels read none of it, so that compilers leave it out.
struct PairTerms {
    float hidden, hiddenLeast;  // culled if hidden > hiddenLeast, root-cube units: how far s lies
                                // outside of what v sees
    float size, sizeMost;       // rendered if size < sizeMost and sizeMost > 0: equivalentViews()
    float distance;             // |vs|
    float radius, viewRadius;   // rs and rv
    float off, offLeast;        // seen from inside if off > offLeast, or facing: facesSurface()
};
MV_FN PairTerms noTerms() {
    PairTerms t;
    t.hidden = t.hiddenLeast = t.size = t.sizeMost = 0.0f;
    t.distance = t.radius = t.viewRadius = t.off = t.offLeast = 0.0f;
    return t;
}

MV_FN vec3 minus3(vec3 a, vec3 b) {
    MV_PRECISE float x = a.x - b.x;
    MV_PRECISE float y = a.y - b.y;
    MV_PRECISE float z = a.z - b.z;
    return vec3(x, y, z);
}

// Is the ball outside the cone of half angle psi < pi around the unit axis for every view within
// a ball around the cone's apex? sin(alpha - psi) * l > rs + rv [Kol19 fig. 4]; no false culls.
MV_FN bool cullBall(vec3 vs, float radii, vec3 axis, float cosPsi, float sinPsi,
                    MV_INOUT(PairTerms) terms) {
    MV_PRECISE float p = dot3(axis, vs);
    MV_PRECISE float q = length3(cross3(axis, vs));
    MV_PRECISE float distance = q * cosPsi - p * sinPsi;
    terms.hidden = distance;
    terms.hiddenLeast = radii + kCullMargin;
    return distance > radii + kCullMargin;
}

// The same for boxes and psi >= 90 degrees, half a space or more (views see no less): h = half
// extents of scene box + view box, so that d in vs +- h are all the vectors from a view to a point
// of the scene node. What is invisible is the convex cone of half angle pi - psi around -axis: the
// box lies in it iff its corners do. The terms are those of the corner that is nearest to being
// seen: how deep it lies below the plane across the axis, and how deep the cone is there.
MV_FN bool cullBox(vec3 vs, vec3 h, vec3 axis, float cosPsi, MV_INOUT(PairTerms) terms) {
    // Terms of n.d and |d|^2 by axis and sign first.
    MV_PRECISE float ax = axis.x * (vs.x - h.x);
    MV_PRECISE float bx = axis.x * (vs.x + h.x);
    MV_PRECISE float ay = axis.y * (vs.y - h.y);
    MV_PRECISE float by = axis.y * (vs.y + h.y);
    MV_PRECISE float az = axis.z * (vs.z - h.z);
    MV_PRECISE float bz = axis.z * (vs.z + h.z);
    MV_PRECISE float highest = max(ax, bx) + max(ay, by) + max(az, bz);
    terms.hidden = -highest;
    terms.hiddenLeast = kCullMargin;
    if (!(highest < -kCullMargin)) return false;
    MV_PRECISE float axx = (vs.x - h.x) * (vs.x - h.x);
    MV_PRECISE float bxx = (vs.x + h.x) * (vs.x + h.x);
    MV_PRECISE float ayy = (vs.y - h.y) * (vs.y - h.y);
    MV_PRECISE float byy = (vs.y + h.y) * (vs.y + h.y);
    MV_PRECISE float azz = (vs.z - h.z) * (vs.z - h.z);
    MV_PRECISE float bzz = (vs.z + h.z) * (vs.z + h.z);
    MV_PRECISE float cos2 = cosPsi * cosPsi;
    bool inside = true;
    float least = kInfinity;
    for (uint corner = 0u; corner < 8u; ++corner) {
        MV_PRECISE float across = ((corner & 1u) != 0u ? bx : ax) +
                                  ((corner & 2u) != 0u ? by : ay) + ((corner & 4u) != 0u ? bz : az);
        MV_PRECISE float squared = ((corner & 1u) != 0u ? bxx : axx) +
                                   ((corner & 2u) != 0u ? byy : ayy) +
                                   ((corner & 4u) != 0u ? bzz : azz);
        MV_PRECISE float depth = -across - kCullMargin;
        MV_PRECISE float depth2 = depth * depth;
        MV_PRECISE float bound = cos2 * squared;
        inside = inside && depth > 0.0f && depth2 > bound;
        if (depth2 - bound < least) {
            least = depth2 - bound;
            terms.hidden = depth;
            terms.hiddenLeast = sqrt(bound);
        }
    }
    return inside;
}
MV_FN bool cullBox(vec3 vs, vec3 h, vec3 axis, float cosPsi) {
    PairTerms terms = noTerms();
    return cullBox(vs, h, axis, cosPsi, terms);
}

MV_FN bool cullPair(SceneNode s, ViewNode v, uint rules, MV_INOUT(PairTerms) terms) {
    if ((v.flags & kViewNodeNoCull) != 0u) return false;
    vec3 vs = minus3(boxCenter(s), boxCenter(v));
    if (!hasRule(rules, kRuleBoxes)) {
        MV_PRECISE float radii = length3(boxHalf(s)) + length3(boxHalf(v));
        return cullBall(vs, radii, axisOf(v), v.cosPsi, v.sinPsi, terms);
    }
    MV_PRECISE float hx = s.halfX + v.halfX;
    MV_PRECISE float hy = s.halfY + v.halfY;
    MV_PRECISE float hz = s.halfZ + v.halfZ;
    return cullBox(vs, vec3(hx, hy, hz), axisOf(v), v.cosPsi, terms);
}

// Projected diameters are R * rs * l / D texels, with D from one of these three (<= 0: infinite).
// The dual paraboloid map is the stereographic projection, so a ball becomes a disc.

// Exactly, from the view node's centre: D / l = |x| + sqrt(l^2 - rs^2).
MV_FN float sizeDivisorExact(vec3 vs, float rs) {
    MV_PRECISE float l = length3(vs);
    if (!(l > rs)) return 0.0f;
    MV_PRECISE float t = sqrt((l - rs) * (l + rs));
    MV_PRECISE float r = l * (abs(vs.x) + t);
    return r;
}
// [Kol19 fig. 6]: l shortened by rv, its angle to the x axis kept. Not a bound: views displaced
// sideways see the node up to 28 % larger.
MV_FN float sizeDivisorPublished(vec3 vs, float rs, float rv) {
    MV_PRECISE float l = length3(vs);
    MV_PRECISE float lc = l - rv;
    if (!(lc > rs)) return 0.0f;
    MV_PRECISE float t = sqrt((lc - rs) * (lc + rs));
    MV_PRECISE float r = lc * abs(vs.x) + l * t;
    return r;
}
// An upper bound of the diameter over all views within rv of the centre. f = l + |x| is convex
// with slope 2 cos(alpha/2) = sqrt(2 (l + |x|) / l), so a view displaced by up to rv has
// f' >= f - rv * slope, and f' >= l' >= lc = l - rv; and D' / l' = f' - l' + sqrt(l'^2 - rs^2)
// falls with l'. What is returned is D times l / l', to compare with R * rs * l.
MV_FN float sizeDivisorBound(vec3 vs, float rs, float rv) {
    MV_PRECISE float l = length3(vs);
    MV_PRECISE float lc = l - rv;
    if (!(lc > rs)) return 0.0f;
    MV_PRECISE float t = sqrt((lc - rs) * (lc + rs));
    MV_PRECISE float sum = l + abs(vs.x);
    MV_PRECISE float turned = l * sum - rv * sqrt(2.0f * sum * l);
    MV_PRECISE float nearest = l * lc;
    MV_PRECISE float r = max(turned, nearest) - nearest + l * t;
    return r;
}

// Does s fill the same texel in all views of v? The rule of [Kol19 §3.2] is valid while the view
// node is not larger than the scene node; tight boxes do not promise that, so the larger of the
// two radii is what must stay small.
MV_FN bool equivalentViews(vec3 vs, float rs, float rv, uint rules, float pairRes,
                           MV_INOUT(PairTerms) terms) {
    MV_PRECISE float l = length3(vs);
    if (!hasRule(rules, kRuleBound)) {
        MV_PRECISE float divisor = sizeDivisorPublished(vs, rs, rv);
        MV_PRECISE float size = pairRes * rs * l;
        terms.size = size;
        terms.sizeMost = divisor;
        return divisor > 0.0f && size < divisor;
    }
    float radius = max(rs, rv);
    MV_PRECISE float divisor = sizeDivisorBound(vs, radius, rv);
    MV_PRECISE float size = pairRes * radius * l;
    terms.size = size;
    terms.sizeMost = divisor;
    return divisor > 0.0f && size < divisor;
}

// Where a leaf pair's view lies inside the ball of the scene leaf: does the leaf's surface stand
// before the view? The view's own surface must not, or it would hide everything. It is told by the
// distance from the surface's plane: views are lifted by 2e-5 off their own, and a curved surface
// lies on both sides of its mean plane. Nearer than that, the side on which a plane lies still says
// whether the view looks at it.
MV_CONST float kFacedRounding = 2e-7f;  // of n.vs, root-cube units
MV_CONST float kFacedOwn = 6e-5f;       // planes: about three times the lift of views
MV_CONST float kFacedCurved = 0.25f;    // other surfaces: share of the ball's radius
MV_FN bool facesSurface(SceneNode s, ViewNode v, MV_INOUT(PairTerms) terms) {
    if (!surfaceUsable(s.surface)) return false;
    vec3 n = surfaceNormal(s.surface);
    vec3 toSurface = minus3(centroidOf(s), boxCenter(v));
    MV_PRECISE float height = dot3(n, toSurface);
    MV_PRECISE float views = abs(n.x) * v.halfX + abs(n.y) * v.halfY + abs(n.z) * v.halfZ;
    MV_PRECISE float off = abs(height) - views;
    terms.off = off;
    if (!surfacePlanar(s.surface)) {
        MV_PRECISE float curved = kFacedCurved * length3(boxHalf(s));
        terms.offLeast = curved;
        return off > curved;
    }
    MV_PRECISE float least = kFacedRounding + kSurfaceErrorRad * length3(toSurface);
    MV_PRECISE float own = kFacedOwn + least;
    terms.offLeast = own;
    MV_PRECISE float toward = dot3(axisOf(v), n) * height;
    MV_PRECISE float clear = 0.5f * abs(height);
    return off > own || (off > least && toward > clear);
}
MV_FN bool facesSurface(SceneNode s, ViewNode v) {
    PairTerms terms = noTerms();
    return facesSurface(s, v, terms);
}

MV_FN bool pairRendered(uint decision) {
    return decision == kPairRendered || decision == kPairForced;
}

// Everything but what only facesSurface() knows. pairRes: pairResolution().
MV_FN uint decidePairOutside(SceneNode s, ViewNode v, uint rules, float pairRes,
                             MV_OUT(PairTerms) terms) {
    terms = noTerms();
    if (cullPair(s, v, rules, terms)) return kPairCulled;
    vec3 vs = minus3(boxCenter(s), boxCenter(v));
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float rv = length3(boxHalf(v));
    terms.radius = rs;
    terms.viewRadius = rv;
    if (equivalentViews(vs, rs, rv, rules, pairRes, terms)) return kPairRendered;
    if (isLeaf(s) && isLeaf(v)) {
        MV_PRECISE float l = length3(vs);
        terms.distance = l;
        return l > rs ? kPairForced : hasRule(rules, kRuleSurfaces) ? kPairInside : kPairSkipped;
    }
    MV_PRECISE float twice = 2.0f * rv;
    bool larger = hasRule(rules, kRuleRadius) ? rs >= twice : s.level < v.level;
    return isLeaf(v) || (!isLeaf(s) && larger) ? kPairSplitScene : kPairSplitView;
}
MV_FN uint decidePairOutside(SceneNode s, ViewNode v, uint rules, float pairRes) {
    PairTerms terms;
    return decidePairOutside(s, v, rules, pairRes, terms);
}
MV_FN uint decidePair(SceneNode s, ViewNode v, uint rules, float pairRes, MV_OUT(PairTerms) terms) {
    uint decision = decidePairOutside(s, v, rules, pairRes, terms);
    if (decision != kPairInside) return decision;
    return facesSurface(s, v, terms) ? kPairForced : kPairSkipped;
}
MV_FN uint decidePair(SceneNode s, ViewNode v, uint rules, float pairRes) {
    PairTerms terms;
    return decidePair(s, v, rules, pairRes, terms);
}

MV_END_NAMESPACE
#endif
