// Persistent cuts of ManyLoDs [HREB11 §3.2]: each view keeps the scene nodes at which its descent
// ended, and the next frame starts from these instead of the root. A node of the cut knows how far
// its view may move before a decision changes, its own or that of its chain: until then neither is
// tested again. Its chain are the ancestors below the root of which it is the first in the cut: up
// from the node, while that is a first child. So each ancestor of a cut belongs to one node. For
// flat view hierarchies, whose view nodes are points that see half a space or all of it, and scene
// nodes inside the root cube.
#ifndef MV_CUT_GLSL
#define MV_CUT_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// A scene node in the cut of a view, 12 bytes. Clearances are distances in root-cube units that the
// view may still move; negative: to be tested.
struct CutNode {
    uint node;    // scene node, which packChildren() gives 28 bits, | its decision << 28
    float own;    // clearance of its decision
    float above;  // least clearance of its chain's decisions
};
MV_CONST uint kCutDecisionShift = 28u;
MV_FN uint cutSceneNode(CutNode c) { return c.node & ((1u << kCutDecisionShift) - 1u); }
MV_FN uint cutDecision(CutNode c) { return c.node >> kCutDecisionShift; }

// What clearances are measured from: where a view stood when its cut was made, 32 bytes.
struct CutView {
    float positionX, positionY, positionZ;  // root-cube units
    uint flags;                             // of its ViewNode
    float axisX, axisY, axisZ;
    uint state;  // kCut*
};
MV_CONST uint kCutNone = 0u;   // no cut
MV_CONST uint kCutRoot = 1u;   // the root alone
MV_CONST uint kCutBelow = 2u;  // nodes below the root

MV_FN CutView cutViewOf(ViewNode v, uint state) {
    CutView c;
    c.positionX = v.centerX;
    c.positionY = v.centerY;
    c.positionZ = v.centerZ;
    c.flags = v.flags & kViewNodeNoCull;
    c.axisX = v.axisX;
    c.axisY = v.axisY;
    c.axisZ = v.axisZ;
    c.state = state;
    return c;
}

// Distances and sizes in single precision are right to within this share of them: several times
// what the sums of pair.glsl round by.
MV_CONST float kClearanceRounding = 4e-6f;

// How far the view may move before decidePair() says something else of the pair. Every quantity
// that it compares is Lipschitz in vs:
//   culled:   the distance of a box or ball from a plane, by 1;
//   rendered: pairRes rs < |x| + t, t = sqrt(l^2 - rs^2). Over a way d, |x| falls by d at most, and
//             t, concave in l and 0 at l = rs, by no more than d t / (l - rs);
//   larger:   |x| + t grows to at most |x| + l + 2 d;
//   forced:   stays outside the ball for l - rs.
// What stands inside a leaf's ball depends on more than that: no clearance.
MV_FN float pairClearance(SceneNode s, ViewNode v, uint decision, float pairRes, PairTerms terms) {
    MV_PRECISE float seen = abs(terms.hidden - terms.hiddenLeast);
    if ((v.flags & kViewNodeNoCull) != 0u) seen = kInfinity;
    vec3 vs = minus3(boxCenter(s), boxCenter(v));
    MV_PRECISE float l = length3(vs);
    MV_PRECISE float rs = length3(boxHalf(s));
    MV_PRECISE float least = pairRes * rs;
    MV_PRECISE float rounding = kClearanceRounding * (1.0f + l + least);
    MV_PRECISE float size = kInfinity;
    if (decision == kPairRendered) {
        MV_PRECISE float t = sqrt((l - rs) * (l + rs));
        MV_PRECISE float slope = 1.0f + t / (l - rs);
        size = (abs(vs.x) + t - least) / slope;
    } else if (decision != kPairCulled) {
        size = 0.5f * (least - abs(vs.x) - l);
        if (decision == kPairForced) size = min(size, l - rs);
    }
    if (decision == kPairSkipped || decision == kPairInside) size = 0.0f;
    MV_PRECISE float clearance = min(seen, size) - rounding;
    return clearance;
}

// By how much a view has used up clearances since `before`: the way of its position, and what its
// turned axis moves the plane across it by where the root cube is farthest.
MV_FN float displacementOf(ViewNode v, CutView before) {
    if (before.flags != (v.flags & kViewNodeNoCull)) return kInfinity;
    MV_PRECISE float way =
        length3(minus3(boxCenter(v), vec3(before.positionX, before.positionY, before.positionZ)));
    if (before.flags != 0u) return way;
    MV_PRECISE float turn =
        length3(minus3(axisOf(v), vec3(before.axisX, before.axisY, before.axisZ)));
    MV_PRECISE float reach = length3(minus3(boxCenter(v), vec3(0.5f))) + 0.87f;
    MV_PRECISE float sum = way + turn * reach;
    return sum;
}
// What is left of a clearance. Rounding never adds up: a little more is taken away.
MV_FN float clearanceLeft(float clearance, float displacement) {
    if (!(displacement > 0.0f)) return clearance;
    MV_PRECISE float left =
        clearance - displacement - kClearanceRounding * (clearance + displacement);
    return left;
}

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::CutNode) == 12);
static_assert(sizeof(mv::CutView) == 32);
#endif
#endif
