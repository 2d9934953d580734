// GBuffer x ViewHierarchy -> irradiance: what one view gives one receiver, and which views can give
// it anything at all [Kol19 §5.1]. E leaves out the receiver's albedo / pi.
#ifndef MV_GATHER_GLSL
#define MV_GATHER_GLSL
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/octahedral.glsl"
#include "shaders/shared/pair.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// ---------------------------------------------------------------- one view, one receiver

// E per watt of the view's flux, without visibility and without 1 / edge^2, so in 1 / root-cube
// unit^2: cos_v / pi * cos_x * r^2 / max(r^2, c^2)^2 for a VPL, cos_x / (4 pi) / max(r^2, c^2) for
// a particle. A VPL stands for a patch of surface of about radius c. Below that distance 1 / r^2 is
// bounded, but beside an edge the cosines still peak within r of it, so it fades too. Zero behind
// either surface, beyond `cutoff` (0 = none), and at the view's own point, where no direction
// exists.
MV_FN float gatherTerm(vec3 toView, vec3 normal, vec3 viewNormal, bool omnidirectional,
                       float clampDistance, float cutoff) {
    float r2 = dot3(toView, toView);
    if (!(r2 > 1e-30f)) return 0.0f;
    if (cutoff > 0.0f && r2 > cutoff * cutoff) return 0.0f;
    float inverseR = 1.0f / sqrt(r2);
    float cosX = max(0.0f, dot3(normal, toView) * inverseR);
    float cosV = max(0.0f, -dot3(viewNormal, toView) * inverseR);
    float m2 = max(r2, clampDistance * clampDistance);
    float emitted = omnidirectional ? 0.25f / kPi : cosV * (r2 / m2) / kPi;
    return emitted * cosX / m2;
}

// ---------------------------------------------------------------- receivers

// A receiver is a part of a tile of the picture: the surface points that its pixels show, in a box,
// and their shading normals, in a cone. Tiles are this many pixels wide and high, or as many times
// more as keep their number below kMaxTiles, and have up to three parts, so that a wall, the edge
// of a doorway in it and the room behind are three receivers. The views that a part's pixels weigh
// are drawn for each of the smallest tiles.
MV_CONST uint kTileParts = 3u;
MV_CONST uint kTileShift = 3u;
MV_CONST uint kTileEdge = 1u << kTileShift;
MV_CONST uint kMaxTiles = 16384u;

// Boxes and cones are widened by what arithmetic rounds: root-cube units, and the angle that a
// rounded cosine near 1 stands for.
MV_CONST float kReceiverMargin = 4e-6f;
MV_CONST float kReceiverConeMarginRad = 1.5e-3f;

// (cos, sin) of a cone's half angle, below 90 degrees, widened by the margin.
MV_FN float widenedCos(float cosCone, float sinCone) {
    return cosCone - kReceiverConeMarginRad * sinCone;
}
MV_FN float widenedSin(float cosCone, float sinCone) {
    return min(1.0f, sinCone + kReceiverConeMarginRad * cosCone);
}

// ---------------------------------------------------------------- culling

// The squared distance between two boxes.
MV_FN float boxDistance2(vec3 vs, vec3 h) {
    vec3 gap = max(abs(vs) - h, vec3(0.0f));
    return dot3(gap, gap);
}

// False only if no view of the node can light any point and normal of the receiver, or all of them
// lie beyond `cutoff` (0 = none). The receiver's box is already widened by the margin. A receiver
// sees what lies in front of one of its tangent planes: directions up to 90 degrees more than its
// cone from the axis, so the test of the views' cone serves it too. cosCone <= 0 sees everything.
MV_FN bool viewsReachReceiver(ViewNode node, vec3 receiverCenter, vec3 receiverHalf,
                              vec3 receiverAxis, float cosCone, float sinCone, float cutoff) {
    vec3 vs = minus3(receiverCenter, boxCenter(node));
    vec3 h = receiverHalf + boxHalf(node);
    if (cutoff > 0.0f && boxDistance2(vs, h) > cutoff * cutoff) return false;
    if ((node.flags & kViewNodeNoCull) == 0u && cullBox(vs, h, axisOf(node), node.cosPsi)) {
        return false;
    }
    return !(cosCone > 0.0f) || !cullBox(-vs, h, receiverAxis, -sinCone);
}

// The walk down the view tree goes on below a kept node while the node's box is larger than a share
// of its distance: far views are told apart no better than they need to be, so that lists stay
// short whatever the number of views.
MV_CONST float kRefineShare = 0.7f;
// Lists that do not fit are made again with a larger share, so that what is far is joined first,
// and where that is above this, of coarser nodes everywhere.
MV_CONST float kMostRefineShare = 8.0f;
MV_FN bool refineViewNode(ViewNode node, vec3 receiverCenter, vec3 receiverHalf, float share) {
    vec3 vs = minus3(receiverCenter, boxCenter(node));
    float gap2 = boxDistance2(vs, receiverHalf + boxHalf(node));
    return 4.0f * dot3(boxHalf(node), boxHalf(node)) > share * share * gap2;
}

// How often views of the node are sampled beyond their power: 2^shift, up to kMaxImportanceShift,
// from the geometry term at the farthest that the two boxes may be apart, since what is near is
// weighed again pixel by pixel (a bound by the nearest drew worse ones). Any value is unbiased.
MV_FN uint importanceShift(ViewNode node, vec3 receiverCenter, vec3 receiverHalf, vec3 receiverAxis,
                           float cosCone, float sinCone) {
    vec3 way = minus3(boxCenter(node), receiverCenter);
    vec3 sizes = receiverHalf + boxHalf(node);
    float slack = length3(sizes);
    float r = length3(way) + slack + 1e-6f;
    float cosX = 1.0f;
    if (cosCone > 0.0f) cosX = clamp((dot3(receiverAxis, way) + slack) / r + sinCone, 0.1f, 1.0f);
    float cosV = 0.5f;  // particles, or views of all directions
    if ((node.flags & kViewNodeNoCull) == 0u) {
        cosV = clamp((slack - dot3(axisOf(node), way)) / r - node.cosPsi, 0.1f, 1.0f);
    }
    // The exponent of the term's bits, relative to a view one root edge away at 60 degrees twice.
    float term = max(4.0f * cosX * cosV / (r * r), 1.0f);
    return min((floatBitsToUint(term) >> 23u) - 127u, kMaxImportanceShift);
}

// One of so many samples is taken where that share of a pixel's light is seen: noise goes with the
// share, and half is about what a matt surface reflects.
MV_FN uint samplesForOne(float share) {
    return share >= 0.5f ? 1u : share >= 0.25f ? 2u : share >= 0.125f ? 4u : 8u;
}

// ---------------------------------------------------------------- packed normals

// A pixel's plane with its part of the tile in the last two bits, which no direction misses.
MV_FN uint planeOfPart(uint packedNormal, uint part) { return (packedNormal & ~3u) | part; }
MV_FN uint partOfPlane(uint plane) { return plane & 3u; }

MV_CONST uint kNoSurface = 0x80008000u;  // packNormal never gives it

// A unit vector as two 16-bit octahedral coordinates, -32767 .. 32767.
MV_FN uint packNormal(vec3 n) {
    vec2 p = octahedralPoint(n);
    int x = int(floor(clamp(p.x, -1.0f, 1.0f) * 32767.0f + 0.5f));
    int y = int(floor(clamp(p.y, -1.0f, 1.0f) * 32767.0f + 0.5f));
    return (uint(x) & 0xFFFFu) | (uint(y) << 16u);
}
MV_FN vec3 unpackNormal(uint code) {
    float x = float(int(code << 16u) >> 16) / 32767.0f;
    float y = float(int(code) >> 16) / 32767.0f;
    return normalizeOr(octahedralDirection(vec2(x, y), 1.0f), vec3(0.0f, 0.0f, 1.0f));
}

MV_END_NAMESPACE
#endif
