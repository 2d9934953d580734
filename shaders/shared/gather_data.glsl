// What the passes of the gather hand each other [Kol19 §5.1]; how it is made say the shaders.
#ifndef MV_GATHER_DATA_GLSL
#define MV_GATHER_DATA_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// The views that one receiver keeps, as runs of neighbours in the sorted views: one texel each.
struct GatherList {
    uint runs, units, views;
    uint level;  // of the view tree that was reached
};
struct GatherRun {
    uint unitsBefore;  // of the receiver's earlier runs
    uint firstView;
    uint endAndScale;  // packRunEnd
    uint powerBefore;  // power units before the first view in all views
};
MV_FN uint packRunEnd(uint endView, uint scale) { return endView | scale << 27u; }
MV_FN uint runEnd(uint endAndScale) { return endAndScale & 0x07FFFFFFu; }
MV_FN uint runScale(uint endAndScale) { return endAndScale >> 27u; }

// A list numbers the power units of its views (gather_sampling.glsl) times their importance, a
// power of two. Where the sum would not fit, it is of fewer and larger units, 2^30 and more: one is
// 2^(kMaxImportanceShift - scale) units of power, which is less than one unit, or many. scale: of a
// run, 0 .. 2 * kMaxImportanceShift.
MV_CONST uint kMaxImportanceShift = 13u;
// sum: of power times importance of the whole list, below 2^44. shift: of the run's importance.
MV_FN uint listScale(uint shift, float sum) {
    uint exponent = floatBitsToUint(max(sum, 1.0f)) >> 23u;
    return kMaxImportanceShift + shift - (max(exponent, 157u) - 157u);
}
MV_FN float powerOfListUnit(uint scale) {
    return uintBitsToFloat((127u + kMaxImportanceShift - scale) << 23u);
}
// The units that a run with so much power has in the list. Of the last one a part may be nobody's.
MV_FN uint listUnits(uint power, uint scale) {
    if (scale >= kMaxImportanceShift) return power << (scale - kMaxImportanceShift);
    return power > 0u ? ((power - 1u) >> (kMaxImportanceShift - scale)) + 1u : 0u;
}
// The unit of a run's power where the list has a unit of the run, and a place within that, in
// 1 / 2^32.
MV_FN uint powerAtUnit(uint unit, uint within, uint scale) {
    if (scale >= kMaxImportanceShift) return unit >> (scale - kMaxImportanceShift);
    uint finer = kMaxImportanceShift - scale;
    return unit << finer | within >> (32u - finer);
}

// A tile of the picture as a receiver: the box of the points that its pixels show and the cone of
// their normals, both widened; 48 bytes = 3 texels.
struct GatherTile {
    float centerX, centerY, centerZ;
    float cosCone;  // <= 0: normals of every direction
    float halfX, halfY, halfZ;
    float sinCone;
    float axisX, axisY, axisZ;
    uint pixels;  // that show a surface
};

// A view that a tile has drawn for one rank of one stratum.
struct GatherDraw {
    uint view;     // sorted; kNone: what was drawn is nobody's
    float weight;  // power units of the stratum, as the view counts them
};

// What the gather reads of each sorted view, 64 bytes = 4 texels, of which two are enough to weigh
// it. A sample of w units weighs w / kPowerUnits.
struct GatherRecord {
    float positionX, positionY, positionZ;
    float clampDistance;              // below which it lights no brighter
    float normalX, normalY, normalZ;  // zero: omnidirectional
    float luminance;                  // of the flux below
    float fluxR, fluxG, fluxB;        // kPowerUnits * flux / units, W
    uint map;                         // kNone: none
    float centerX, centerY, centerZ;  // of the map
    uint unitsAndLamp;                // packUnits
};
// lamp: the view lies on an emissive surface, for its direct light.
MV_FN uint packUnits(uint units, bool lamp) { return units | (lamp ? 0x80000000u : 0u); }
MV_FN uint unitsOf(uint unitsAndLamp) { return unitsAndLamp & 0x7FFFFFFFu; }
MV_FN bool isOnLamp(uint unitsAndLamp) { return (unitsAndLamp & 0x80000000u) != 0u; }

// What record_samples.glsl writes down before the GatheredRecords themselves.
MV_CONST uint kMaxTaps = 16u;
struct GatherTap {
    uint x, y;  // pixel of the gather
    float weight;
    uint pad;
};
struct GatherHead {
    uint sampleCount;  // all of them, also those beyond the capacity
    uint tapCount;
    float weight;  // of all taps
    uint pad;
    GatherTap taps[kMaxTaps];
};

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::GatherList) == 16);
static_assert(sizeof(mv::GatherRun) == 16);
static_assert(sizeof(mv::GatherTile) == 48);
static_assert(sizeof(mv::GatherDraw) == 8);
static_assert(sizeof(mv::GatherRecord) == 64);
static_assert(sizeof(mv::GatherHead) == 16 + 16 * mv::kMaxTaps);
#endif
#endif
