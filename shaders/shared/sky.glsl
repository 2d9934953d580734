// The sky: radiance from every direction, as a table of cells in latitude and longitude that light
// paths and shadow rays draw directions from in proportion to their power. Rows count from the
// zenith down; there are twice as many columns, and both are powers of two. Cells are stored along
// the Morton curve of the left half, then of the right one, so that near shares are near directions
// and the guide's cells (vpl.glsl) patches of the sky.
//
// C++ functions take the table before all else, MV_SKY_PARAMS; GLSL: a buffer texture of RGBA32F
// at kUnitSky. Choices use only + - * / sqrt, so that C++ and GPU draw the same bits.
#ifndef MV_SKY_GLSL
#define MV_SKY_GLSL
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"
#include "shaders/shared/sampling.glsl"
#include "shaders/shared/types.glsl"

#ifdef __cplusplus
#define MV_SKY_PARAMS const SkyTexel *sky,
#define MV_SKY_ARGS sky,
#else
#define MV_SKY_PARAMS
#define MV_SKY_ARGS
layout(binding = kUnitSky) uniform samplerBuffer skyTexels;
#endif

MV_BEGIN_NAMESPACE

MV_CONST uint kSkyDraw = 20u;  // `dimension` of random4
MV_CONST uint kSkyPickDraw = 21u;

#ifdef __cplusplus
inline vec4 skyTexel(const SkyTexel* sky, uint i) {
    return {sky[i].r, sky[i].g, sky[i].b, sky[i].cumulative};
}
#else
vec4 skyTexel(uint i) { return texelFetch(skyTexels, int(i)); }
#endif

// Every other bit of 32, and back.
MV_FN uint skySpread(uint x) {
    x = (x | x << 8u) & 0x00FF00FFu;
    x = (x | x << 4u) & 0x0F0F0F0Fu;
    x = (x | x << 2u) & 0x33333333u;
    return (x | x << 1u) & 0x55555555u;
}
MV_FN uint skyCompact(uint x) {
    x &= 0x55555555u;
    x = (x | x >> 1u) & 0x33333333u;
    x = (x | x >> 2u) & 0x0F0F0F0Fu;
    x = (x | x >> 4u) & 0x00FF00FFu;
    return (x | x >> 8u) & 0x0000FFFFu;
}

MV_FN uint skyIndex(uint rows, uint column, uint row) {
    uint before = column >= rows ? rows * rows : 0u;
    return before + (skySpread(column & (rows - 1u)) | skySpread(row) << 1u);
}

// Cosine of the angle from the zenith where a row begins.
MV_FN float skyCosine(uint rows, uint row) { return cosSin2Pi(float(row) / float(2u * rows)).x; }

// Share of the power of a cell over its solid angle: density of skySample there, 1/sr.
MV_FN float skyDensity(MV_SKY_PARAMS uint rows, uint i, uint row, float cumulative) {
    float before = i > 0u ? skyTexel(MV_SKY_ARGS i - 1u).w : 0.0f;
    MV_PRECISE float solidAngle =
        (skyCosine(rows, row) - skyCosine(rows, row + 1u)) * (kPi / float(rows));
    MV_PRECISE float density = (cumulative - before) / solidAngle;
    return density;
}

// A direction towards the sky, its radiance and the density over solid angle that it was drawn
// with: the cell by u, the place in it by v and w.
MV_FN float skySample(MV_SKY_PARAMS uint rows, float u, float v, float w, MV_OUT(vec3) direction,
                      MV_OUT(vec3) radiance) {
    // The first cell whose running share exceeds u.
    uint low = 0u;
    uint high = 2u * rows * rows - 1u;
    MV_FIND_FIRST(low, high, middle, u < skyTexel(MV_SKY_ARGS middle).w);
    uint inHalf = low & (rows * rows - 1u);
    uint column = (low >= rows * rows ? rows : 0u) + skyCompact(inHalf);
    uint row = skyCompact(inHalf >> 1u);
    float top = skyCosine(rows, row);
    float bottom = skyCosine(rows, row + 1u);
    MV_PRECISE float y = top + (bottom - top) * v;
    MV_PRECISE float sine = sqrt(max((1.0f - y) * (1.0f + y), 0.0f));
    vec2 cs = cosSin2Pi((float(column) + w) / float(2u * rows));
    // The image's middle lies towards +x.
    MV_PRECISE float x = -sine * cs.x;
    MV_PRECISE float z = -sine * cs.y;
    direction = vec3(x, y, z);
    vec4 cell = skyTexel(MV_SKY_ARGS low);
    radiance = vec3(cell);
    return skyDensity(MV_SKY_ARGS rows, low, row, cell.w);
}

// Column and row of a unit direction, with their fractions.
MV_FN vec2 skyPlace(uint rows, vec3 direction) {
    float azimuth = atan2(direction.z, direction.x) / (2.0f * kPi) + 0.5f;
    float polar = acos(clamp(direction.y, -1.0f, 1.0f)) / kPi;
    return vec2(azimuth * float(2u * rows), polar * float(rows));
}

// Radiance of the cell in a direction, and the density with which skySample draws it.
MV_FN float skyRadiance(MV_SKY_PARAMS uint rows, vec3 direction, MV_OUT(vec3) radiance) {
    vec2 place = skyPlace(rows, direction);
    uint column = min(uint(max(place.x, 0.0f)), 2u * rows - 1u);
    uint row = min(uint(max(place.y, 0.0f)), rows - 1u);
    uint i = skyIndex(rows, column, row);
    vec4 cell = skyTexel(MV_SKY_ARGS i);
    radiance = vec3(cell);
    return skyDensity(MV_SKY_ARGS rows, i, row, cell.w);
}

// The irradiance that one ray from a surface stands for if it reaches the sky, W/m^2, and its
// direction. `tableShare` of the rays (those with pick below it) are drawn by the sky's power, the
// others by the cosine; both are weighed as one mixture [Veach and Guibas 1995, balance heuristic].
MV_FN vec3 skyIrradiance(MV_SKY_PARAMS uint rows, float tableShare, vec3 normal, vec3 r, float pick,
                         MV_OUT(vec3) direction) {
    vec3 radiance = vec3(0.0f);
    float density = 0.0f;
    if (pick < tableShare) {
        density = skySample(MV_SKY_ARGS rows, r.x, r.y, r.z, direction, radiance);
    } else {
        direction = cosineDirection(normal, r.x, r.y);
        density = skyRadiance(MV_SKY_ARGS rows, direction, radiance);
    }
    float cosine = dot3(normal, direction);
    if (!(cosine > 0.0f)) return vec3(0.0f);
    return radiance * (cosine / (tableShare * density + (1.0f - tableShare) * cosine / kPi));
}

MV_END_NAMESPACE
#endif
