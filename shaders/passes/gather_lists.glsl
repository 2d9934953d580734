// The lists of views that receivers keep (gather_cull.comp), and the view that owns one of a list's
// units.
#ifndef MV_GATHER_LISTS_GLSL
#define MV_GATHER_LISTS_GLSL
#include "shaders/passes/last_at_most.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_data.glsl"
#include "shaders/shared/gather_sampling.glsl"

layout(binding = kUnitPowerPrefix) uniform usamplerBuffer prefix;   // power units before each view
layout(binding = kUnitReceiverLists) uniform usamplerBuffer lists;  // GatherList
layout(binding = kUnitRuns) uniform usamplerBuffer runs;            // GatherRun
layout(binding = kUnitRunWords) uniform usamplerBuffer runUnits;    // the same, word by word
layout(binding = kUnitRunSearch) uniform usamplerBuffer runSearch;  // see run_search_table.comp
layout(binding = kUnitViewSearch) uniform usamplerBuffer viewSearch;  // see view_search_table.comp

uniform uint capacity;  // runs a receiver
uniform uint viewSlotShift;
// Tiles have 2^tileShift pixels each way and kTileParts receivers; 0: receiver 0 serves all.
uniform uint tilesAcross;
uniform uint tileShift;

uint receiverOf(uvec2 pixel, uint part) {
    if (tilesAcross == 0u) return 0u;
    uint tile = (pixel.y >> tileShift) * tilesAcross + (pixel.x >> tileShift);
    return 1u + kTileParts * tile + part;
}

// The view that owns the fraction `within` / 2^32 of list unit `unit`, or kNone past the list's
// end; `power`: power units per list unit there.
uint viewOfUnit(uint receiver, uint units, uint unit, uint within, out float power) {
    uint firstRun = receiver * capacity;
    uint range =
        texelFetch(runSearch, int(receiver * kRunSearchSlots + (unit >> runSearchShift(units)))).x;
    uint run =
        lastAtMost(runUnits, firstRun + (range & 0xFFFFu), firstRun + (range >> 16u), 4u, unit);
    uvec4 r = texelFetch(runs, int(run));
    uint end = runEnd(r.z);
    uint scale = runScale(r.z);
    power = powerOfListUnit(scale);
    uint place = r.w + powerAtUnit(unit - r.x, within, scale);
    if (place >= texelFetch(prefix, int(end)).x) return kNone;
    int slot = int(place >> viewSlotShift);
    uint begins = max(r.y, texelFetch(viewSearch, slot).x);
    uint ends = min(end, texelFetch(viewSearch, slot + 1).x + 1u);
    return lastAtMost(prefix, begins, ends, 1u, place);
}

// One of a list's strata of equal power.
struct Stratum {
    uint begin, width;  // units of the list
};
Stratum stratumOf(uint units, uint count, uint stratum) {
    uint begin = stratumBegin(units, count, stratum);
    return Stratum(begin, stratumBegin(units, count, stratum + 1u) - begin);
}

// The view at `offset`, in 1 / 2^32, of a stratum of a receiver's list; kNone: there is none.
// weight: of the whole stratum, in the power units of that view.
uint viewOfStratum(uint receiver, uint units, Stratum stratum, uint offset, out float weight) {
    weight = 0.0;
    if (stratum.width == 0u) return kNone;
    uint unit, within;
    umulExtended(offset, stratum.width, unit, within);
    uint view = viewOfUnit(receiver, units, stratum.begin + unit, within, weight);
    weight *= float(stratum.width);
    return view;
}
#endif
