// Random numbers as a hash: the same (seed, path, bounce, dimension) gives the same numbers on
// every machine, in C++ and GLSL, whatever the frame, so a VPL keeps its identity. pcg4d of
// [Jarzynski and Olano 2020, Hash Functions for GPU Rendering, JCGT 9(3)].
#ifndef MV_RANDOM_GLSL
#define MV_RANDOM_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

MV_FN uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v = v ^ (v >> 16u);
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

// The float in [0, 1) of the upper 24 bits: every value k / 2^24 is exact and equally likely.
MV_FN float unitFloat(uint bits) { return float(bits >> 8u) * (1.0f / 16777216.0f); }

// Four independent numbers in [0, 1). `dimension` tells apart draws of one bounce.
MV_FN vec4 random4(uint seed, uint path, uint bounce, uint dimension) {
    uvec4 h = pcg4d(uvec4(seed, path, bounce, dimension));
    return vec4(unitFloat(h.x), unitFloat(h.y), unitFloat(h.z), unitFloat(h.w));
}

// Numbers of the bounce-0 VPL of a slot on an emissive surface: x, y, z say where it lies, w
// whether it is kept (importance.glsl). Those of neighbouring slots fill the cube evenly, and those
// that are kept a part of it: the additive recurrence of [Roberts 2018, The Unreasonable
// Effectiveness of Quasirandom Sequences], by powers of the root of x^5 = x + 1, each number
// shifted by the seed.
MV_CONST uint kLampDraw = 4u;  // `dimension`, beside those of vpl.glsl
MV_FN vec4 lampNumbers(uint seed, uint slot) {
    uvec4 shift = pcg4d(uvec4(seed, 0xFFFFFFFFu, 0u, kLampDraw));
    uint n = slot + 1u;
    return vec4(unitFloat(shift.x + n * 3679390609u), unitFloat(shift.y + n * 3152041523u),
                unitFloat(shift.z + n * 2700274806u), unitFloat(shift.w + n * 2313257605u));
}

MV_END_NAMESPACE
#endif
