// Which candidates become views: those that light what the camera sees [Georgiev and Slusallek
// 2010, Simple and Robust Iterative Importance Sampling of Virtual Point Lights]. A candidate is
// kept with a probability proportional to what it would give the surfaces in sight, by the share of
// it that a pilot saw get there from places around, and its flux divided by it: the expected light
// stays the full sum over the candidates. The same lines run in renderer/passes/thin_views_pass.cpp
// and in megaviews/views.
#ifndef MV_IMPORTANCE_GLSL
#define MV_IMPORTANCE_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// A surface that the camera sees, root-cube units.
struct ImportancePoint {
    float positionX, positionY, positionZ;
    uint pad0;
    float normalX, normalY, normalZ;
    uint pad1;
};

// A place of the pilot's, on a surface: what share of the light that it would give the points is
// seen to get there. Sorted by Morton key.
struct ImportancePlace {
    float positionX, positionY, positionZ;
    uint key;
    float normalX, normalY, normalZ;
    float visible;
};

// A few points stand for all surfaces in sight: nearer than the distance between them, root-cube
// units, the geometry term says nothing more.
MV_CONST float kImportanceDistance = 0.05f;      // at most
MV_CONST float kImportanceOfSpread = 0.2f;       // of the points' mean distance from their middle
MV_CONST uint kImportanceWindow = 8u;            // places before and after a candidate on the curve
MV_CONST float kImportanceLeastVisible = 0.02f;  // of what the pilot saw nothing of
// The share of the views that is spread by flux alone: whatever can be seen can be chosen.
MV_CONST float kImportanceGuard = 0.1f;
MV_CONST uint kImportanceDraw = 16u;   // `dimension` of random4, beside those of vpl.glsl
MV_CONST uint kImportanceBlock = 64u;  // candidates that one invocation sums
MV_CONST uint kImportanceLanes = 256u;
MV_CONST uint kImportanceRounds = 4u;  // of solving for the scale

// What a view of one watt gives a point, but for constants: cos cos / max(r^2, d^2), 1/root-cube
// unit^2.
MV_FN float importanceTerm(View view, ImportancePoint point, float distance) {
    MV_PRECISE float x = view.positionX - point.positionX;
    MV_PRECISE float y = view.positionY - point.positionY;
    MV_PRECISE float z = view.positionZ - point.positionZ;
    vec3 way = vec3(x, y, z);
    float r2 = dot3(way, way);
    if (!(r2 > 1e-12f)) return 0.0f;
    MV_PRECISE float cosX = max(0.0f, dot3(vec3(point.normalX, point.normalY, point.normalZ), way));
    MV_PRECISE float cosV = max(0.0f, -dot3(viewNormal(view), way));
    MV_PRECISE float term = cosX * cosV / (r2 * max(r2, distance * distance));
    return term;
}

// The visible share around a candidate, from the pilot's places of which the surface faces alike,
// the nearer the more; all of it where there is none.
struct ImportanceVisible {
    float sum, weight;
};
MV_FN ImportanceVisible withPlace(ImportanceVisible around, View view, ImportancePlace place,
                                  float distance) {
    MV_PRECISE float x = view.positionX - place.positionX;
    MV_PRECISE float y = view.positionY - place.positionY;
    MV_PRECISE float z = view.positionZ - place.positionZ;
    vec3 way = vec3(x, y, z);
    MV_PRECISE float alike =
        max(0.0f, dot3(viewNormal(view), vec3(place.normalX, place.normalY, place.normalZ)));
    MV_PRECISE float apart2 = dot3(way, way) + distance * distance;
    MV_PRECISE float weight = alike * alike / max(apart2, 1e-12f);
    MV_PRECISE float weights = around.weight + weight;
    MV_PRECISE float product = weight * place.visible;
    MV_PRECISE float sum = around.sum + product;
    ImportanceVisible more;
    more.sum = sum;
    more.weight = weights;
    return more;
}
MV_FN float visibleShare(ImportanceVisible around) {
    MV_PRECISE float share = around.weight > 0.0f ? around.sum / around.weight : 1.0f;
    return max(share, kImportanceLeastVisible);
}

MV_FN float viewLuminance(View view) { return max(0.0f, luminance(viewFlux(view))); }

// The probabilities follow from these sums.
struct ImportanceTotals {
    float importance;  // sums over the candidates
    float flux;
    float alive;
    float scale;  // probability per weight
};

// A candidate's part of what all of them weigh together, which is 1.
MV_FN float candidateWeight(float importance, float flux, ImportanceTotals totals) {
    float guard = totals.importance > 0.0f ? kImportanceGuard : 1.0f;
    MV_PRECISE float weight = flux > 0.0f ? guard * (flux / totals.flux) : 0.0f;
    if (importance > 0.0f) {
        MV_PRECISE float guided = weight + (1.0f - guard) * (importance / totals.importance);
        weight = guided;
    }
    return weight;
}

// The scale so far lets `certain` candidates be kept for sure; the others, which weigh `rest`
// together, share what is left of the wanted number.
MV_FN float nextScale(float wanted, float certain, float rest, float scale) {
    MV_PRECISE float next = (wanted - certain) / rest;
    return rest > 0.0f && certain < wanted ? max(next, scale) : scale;
}

// The probability with which a candidate becomes a view. One fixed random number a candidate
// decides, so the views change little by little while camera and light move.
MV_FN float keepProbability(float weight, ImportanceTotals totals) {
    MV_PRECISE float p = totals.scale * weight;
    return p < 1.0f ? p : 1.0f;
}
// bounce: of the candidate. On lamps it is one of lampNumbers(), so that what is kept is spread as
// evenly over them as all candidates are.
MV_FN bool keepsCandidate(uint seed, uint slot, uint bounce, float probability) {
    float number = random4(seed, slot, 0u, kImportanceDraw).x;
    if (bounce == 0u) number = lampNumbers(seed, slot).w;
    return number < probability;
}

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::ImportancePoint) == 32);
static_assert(sizeof(mv::ImportancePlace) == 32);
static_assert(sizeof(mv::ImportanceTotals) == 16);
#endif
#endif
