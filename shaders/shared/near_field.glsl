// What the clamp takes away, given back: the light of surfaces nearer than the views on them are to
// each other. The path goes on [Kollig and Keller 2004, bias compensation]: a ray of the cosine
// distribution meets such a surface at distance r. A view there that is clamped at c would have
// given all but 1 - r^4 / c^4 of its light; that share of what the surface emits and reflects is
// added. What it reflects comes from lights, sky and views, of which a few are weighed by what
// they would give and one is asked by another ray. So a corner is as bright, and a crack beside a
// patch of sun as dark, as what lights it, whether views stand in it or not.
// Approximate: c is what a view of the brightness of those around it would have; nothing is given
// beyond a multiple of what was gathered, or of what is given around, since one bright path would
// be a dot in the dark; and only rays up to a reach count.
#ifndef MV_NEAR_FIELD_GLSL
#define MV_NEAR_FIELD_GLSL
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/language.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/sky.glsl"
#include "shaders/shared/types.glsl"
#include "shaders/shared/view_spacing.glsl"

MV_BEGIN_NAMESPACE

MV_CONST float kNearFieldReach = kMaxClampDistance;
MV_CONST uint kNearFieldRays = 2u;  // of a pixel and set of samples
// Views looked at before and after a place on the Morton curve; as far as their own neighbours.
MV_CONST uint kNearFieldWindow = kSpacingWindow;
// How many are weighed for a ray: views, evenly spread in their order, and directions of the sky.
MV_CONST uint kNearFieldViews = 16u;
MV_CONST uint kNearFieldSky = 2u;
MV_CONST float kNearFieldMost = 4.0f;  // times what was gathered, or what is given around
MV_CONST uint kNearFieldTile = 8u;     // pixels each way: around
MV_CONST uint kNearFieldDraw = 19u;    // `dimension` of random4
MV_CONST uint kNearFieldSkyDraw = 24u;

// ---------------------------------------------------------------- the ray

// The random numbers of a pixel's n-th ray: x, y its direction, z what lights the place, w the
// views that are weighed.
MV_FN vec4 nearFieldNumbers(uint seed, uint x, uint y, uint n) {
    return random4(seed, y << 16u | x, n, kNearFieldDraw);
}

// The ray's direction. The 16 pixels of a block share out the heights, and so do 16 rays of a
// pixel, those of any power of two evenly.
MV_FN vec3 nearFieldDirection(vec3 normal, vec4 numbers, uint x, uint y, uint n) {
    uint turn = (n & 1u) << 3u | (n & 2u) << 1u | (n & 4u) >> 1u | (n & 8u) >> 3u;
    float height = (float((blockRank(x & 3u, y & 3u) + turn) & 15u) + numbers.x) / 16.0f;
    return cosineDirection(normal, min(height, 0.99999994f), numbers.y);
}

// ---------------------------------------------------------------- what the clamp has taken

// The nearest views around a place that face as it does; distance2: from there, squared.
MV_FN NearestViews withNearView(NearestViews n, float distance2, vec3 viewNormal,
                                vec3 placeNormal) {
    return dot3(viewNormal, placeNormal) > 0.5f ? withView(n, distance2, 1.0f) : n;
}

// Where a view at the place would be clamped.
MV_FN float nearFieldClampDistance(NearestViews n, Crowd crowd) {
    return hasNearest(n) ? clampDistanceAmong(n, 1.0f, crowd) : kMaxClampDistance;
}

// The share of its light that a receiver at distance r would not get from it (gatherTerm()).
MV_FN float nearFieldTaken(float clampDistance, float r) {
    float x = r / max(clampDistance, 1e-20f);
    return max(0.0f, 1.0f - x * x * x * x);
}

// ---------------------------------------------------------------- what lights the place

// One of what was weighed, and what it gives the place if nothing stands between.
struct NearFieldLight {
    Choice choice;
    float givenR, givenG, givenB;  // W/m^2
    float wayX, wayY, wayZ;        // from the place
};

MV_FN NearFieldLight noNearFieldLight(float number) {
    NearFieldLight l;
    l.choice = noChoice(number);
    l.givenR = 0.0f;
    l.givenG = 0.0f;
    l.givenB = 0.0f;
    l.wayX = 0.0f;
    l.wayY = 0.0f;
    l.wayZ = 0.0f;
    return l;
}

MV_FN NearFieldLight withLight(NearFieldLight l, uint candidate, vec3 given, vec3 way) {
    l.choice = withCandidate(l.choice, candidate, luminance(given));
    if (l.choice.chosen != candidate) return l;
    l.givenR = given.x;
    l.givenG = given.y;
    l.givenB = given.z;
    l.wayX = way.x;
    l.wayY = way.y;
    l.wayZ = way.z;
    return l;
}

// The k-th view that is weighed, of `count`; number: in [0, 1), one for all of them.
MV_FN uint nearFieldView(uint k, float number, uint count) {
    return min(uint((float(k) + number) / float(kNearFieldViews) * float(count)), count - 1u);
}

// What it gives, for itself and those that are not weighed.
MV_FN vec3 nearFieldOfView(vec3 flux, float term, uint count, float edgeM) {
    return flux * (term * float(count) / (float(kNearFieldViews) * edgeM * edgeM));
}

// The k-th direction of the sky that is weighed, and the irradiance that it stands for; r: numbers
// in [0, 1), the same for all of them.
MV_FN vec3 nearFieldSky(MV_SKY_PARAMS uint rows, float tableShare, vec3 normal, vec4 r, uint k,
                        MV_OUT(vec3) way) {
    vec3 numbers = fract(vec3(r) + float(k) / float(kNearFieldSky));
    float pick = (float(k) + r.w) / float(kNearFieldSky);
    vec3 given = skyIrradiance(MV_SKY_ARGS rows, tableShare, normal, numbers, pick, way);
    way *= kBeyondScene;
    return given / float(kNearFieldSky);
}

// What the chosen one stands for, W/m^2.
MV_FN vec3 nearFieldGiven(NearFieldLight l) {
    if (l.choice.chosen == kNone) return vec3(0.0f);
    return vec3(l.givenR, l.givenG, l.givenB) * (l.choice.total / l.choice.weight);
}

// How much of what near places give is added to a receiver that has gathered so much. around: the
// mean power of what they give to the receivers around it, before any of it is bounded.
MV_FN vec3 nearFieldAdded(vec3 given, vec3 gathered, float around) {
    float power = gatherPower(given);
    float most = kNearFieldMost * max(gatherPower(gathered), around);
    return power > most ? given * (most / power) : given;
}

MV_END_NAMESPACE
#endif
