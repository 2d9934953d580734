// How punctual lights shine (KHR_lights_punctual): shared by VPL shooting and direct lighting.
#ifndef MV_LIGHT_GLSL
#define MV_LIGHT_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// Share of a spot's intensity towards a direction at the angle with cosine cosAngle from its axis:
// 1 inside the inner cone, 0 outside the outer one, glTF's squared linear ramp in the cosine
// between. Where both cones coincide the edge is hard.
MV_FN float spotFalloff(float cosAngle, float cosInner, float cosOuter) {
    MV_PRECISE float width = max(cosInner - cosOuter, 1e-7f);
    MV_PRECISE float ramp = clamp((cosAngle - cosOuter) / width, 0.0f, 1.0f);
    MV_PRECISE float falloff = ramp * ramp;
    return falloff;
}

// Solid angle of a spot weighted with its falloff, sr: its flux is this times its intensity.
MV_FN float spotSolidAngle(float cosInner, float cosOuter) {
    MV_PRECISE float width = max(cosInner - cosOuter, 0.0f);
    MV_PRECISE float solidAngle = 2.0f * kPi * ((1.0f - cosInner) + width / 3.0f);
    return solidAngle;
}

MV_FN float luminance(vec3 c) { return dot3(c, vec3(0.2126f, 0.7152f, 0.0722f)); }

MV_END_NAMESPACE
#endif
