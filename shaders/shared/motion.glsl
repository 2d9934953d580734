// How far a surface has moved since the frame before, beside its mark in the G-buffer.
#ifndef MV_MOTION_GLSL
#define MV_MOTION_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// The way to where it was, as a byte an axis in 127ths of the largest step of any surface, above a
// mark of 1: a float holds 24 bits exactly. largest: 0 where nothing moves.
MV_FN float markOfStep(vec3 step, float largest) {
    if (!(largest > 0.0f)) return 1.0f;
    vec3 bytes = floor(clamp(step / largest, vec3(-1.0f), vec3(1.0f)) * 127.0f + 128.5f);
    return 1.0f + bytes.x + 256.0f * bytes.y + 65536.0f * bytes.z;
}

MV_FN vec3 stepOfMark(float mark, float largest) {
    uint code = mark > 1.0f ? uint(mark) - 1u : 0x808080u;
    vec3 bytes = vec3(float(code & 255u), float((code >> 8u) & 255u), float(code >> 16u));
    return (bytes - 128.0f) * (largest / 127.0f);
}

MV_END_NAMESPACE
#endif
