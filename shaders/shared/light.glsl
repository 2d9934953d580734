// How punctual lights shine (KHR_lights_punctual): shared by VPL shooting, direct lighting and the
// near field.
#ifndef MV_LIGHT_GLSL
#define MV_LIGHT_GLSL
#include "shaders/shared/language.glsl"
#include "shaders/shared/types.glsl"

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

// A light that is nearer, or on the very surface, counts as this far away: root-cube units.
MV_CONST float kLeastLightDistance = 1e-4f;
// How far a ray goes that leaves the scene: the root cube's diagonal is 1.73.
MV_CONST float kBeyondScene = 4.0f;

// W/m^2 that a light gives a surface if nothing stands between, and the way there from the surface:
// root-cube units. edgeM: of the root cube.
MV_FN vec3 lightIrradiance(LightRecord l, float edgeM, vec3 position, vec3 normal,
                           MV_OUT(vec3) way) {
    vec3 axis = vec3(l.directionX, l.directionY, l.directionZ);
    bool sun = l.type == kLightDirectional;
    way = sun ? -axis * kBeyondScene : vec3(l.positionX, l.positionY, l.positionZ) - position;
    float distance = length3(way);
    float cosine = max(dot3(normal, way) / max(distance, 1e-20f), 0.0f);
    vec3 light = vec3(l.intensityR, l.intensityG, l.intensityB) * cosine;
    if (sun) return light;
    float metres = max(distance, kLeastLightDistance) * edgeM;
    light /= metres * metres;
    if (l.type != kLightSpot) return light;
    float cosAxis = -dot3(way, axis) / max(distance, 1e-20f);
    return light * spotFalloff(cosAxis, l.cosInner, l.cosOuter);
}

MV_FN float luminance(vec3 c) { return dot3(c, vec3(0.2126f, 0.7152f, 0.0722f)); }

// Takes an estimate that may fall below zero in some channels as near to grey as it needs, so that
// luminance stays and no colour comes that is not there; black where all of it is below. What is no
// number stays.
MV_FN vec3 nonNegative(vec3 light) {
    float least = min(light.x, min(light.y, light.z));
    float grey = luminance(light);
    if (!(least < 0.0f) || grey != grey) return light;
    float share = grey > 0.0f ? grey / (grey - least) : 0.0f;
    float rest = max(grey, 0.0f) * (1.0f - share);
    return vec3(max(rest + share * light.x, 0.0f), max(rest + share * light.y, 0.0f),
                max(rest + share * light.z, 0.0f));
}

// What a surface sends of gathered irradiance: its albedo's part, and what its gloss shows.
MV_FN vec3 indirectRadiance(vec3 albedo, vec3 irradiance, vec3 reflected) {
    return albedo * (1.0f / kPi) * nonNegative(irradiance) + reflected;
}

MV_END_NAMESPACE
#endif
