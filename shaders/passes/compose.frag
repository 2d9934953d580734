// The linear radiance of the view MV_VIEW: L = direct + albedo / pi * E + reflected + L_e.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/light.glsl"
layout(binding = kUnitNormal) uniform sampler2D normalTexture;
layout(binding = kUnitAlbedo) uniform sampler2D albedoTexture;  // w: the share seen of a surface
layout(binding = kUnitEmission) uniform sampler2D emissionTexture;
layout(binding = kUnitDirect) uniform sampler2D directTexture;
layout(binding = kUnitIrradiance) uniform sampler2D
    irradianceTexture;  // one black texel where there is none
layout(binding = kUnitReflected) uniform sampler2D reflectedTexture;
layout(binding = kUnitCandidates) uniform sampler2D candidatesTexture;
uniform float emissionScale;  // of surfaces; skies and particles have theirs
out vec4 color;

vec4 texelOr(sampler2D t, ivec2 p) { return texelFetch(t, min(p, textureSize(t, 0) - 1), 0); }

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    vec4 albedo = texelFetch(albedoTexture, p, 0);
    // Nothing is lit where there is no surface, whatever the textures hold there.
    bool surface = albedo.w != 0.0;
#if MV_VIEW == MV_VIEW_NORMALS
    vec3 result = surface ? texelFetch(normalTexture, p, 0).xyz : vec3(0.0);
#elif MV_VIEW == MV_VIEW_DEPTH
    vec3 result = surface ? texelFetch(normalTexture, p, 0).www : vec3(0.0);
#elif MV_VIEW == MV_VIEW_ALBEDO
    vec3 result = surface ? albedo.rgb : vec3(0.0);
#elif MV_VIEW == MV_VIEW_CANDIDATES
    vec3 result = surface ? texelOr(candidatesTexture, p).rrr : vec3(0.0);
#elif MV_VIEW == MV_VIEW_UNDECIDED
    vec3 result = surface ? texelOr(candidatesTexture, p).ggg : vec3(0.0);
#else
    vec3 result = vec3(0.0);
#if MV_VIEW != MV_VIEW_INDIRECT
    if (surface) result = texelOr(directTexture, p).rgb;
    result += texelFetch(emissionTexture, p, 0).rgb * (surface ? emissionScale : 1.0);
#endif
#if MV_VIEW != MV_VIEW_DIRECT
    if (surface) {
        result += indirectRadiance(albedo.rgb, texelOr(irradianceTexture, p).rgb,
                                   texelOr(reflectedTexture, p).rgb);
    }
#endif
#endif
    color = vec4(result, 1.0);
}
