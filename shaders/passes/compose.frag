// The linear radiance of the chosen view: L = direct + albedo / pi * E + L_e.
#include "shaders/shared/debug_view.glsl"
layout(binding = 0) uniform sampler2D positionTexture;
layout(binding = 1) uniform sampler2D normalTexture;
layout(binding = 2) uniform sampler2D albedoTexture;
layout(binding = 3) uniform sampler2D emissionTexture;
layout(binding = 4) uniform sampler2D directTexture;
layout(binding = 5) uniform sampler2D irradianceTexture;  // one black texel where there is none
layout(binding = 6) uniform sampler2D candidatesTexture;
uniform int view;
out vec4 color;

vec4 texelOr(sampler2D t, ivec2 p) { return texelFetch(t, min(p, textureSize(t, 0) - 1), 0); }

void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    float surface = texelFetch(positionTexture, p, 0).w;
    vec3 albedo = texelFetch(albedoTexture, p, 0).rgb;
    vec3 emission = texelFetch(emissionTexture, p, 0).rgb;
    vec3 direct = texelOr(directTexture, p).rgb;
    vec3 indirect = albedo * (1.0 / kPi) * texelOr(irradianceTexture, p).rgb;
    // Nothing is lit where there is no surface, whatever the textures hold there.
    if (surface == 0.0) {
        direct = vec3(0.0);
        indirect = vec3(0.0);
        albedo = vec3(0.0);
    }
    vec3 result = direct + indirect + emission;
    if (view == kViewDirect) result = direct + emission;
    if (view == kViewIndirect) result = indirect;
    if (view == kViewAlbedo) result = albedo;
    if (view == kViewNormals || view == kViewDepth) {
        vec4 normalDepth = texelFetch(normalTexture, p, 0);
        result = view == kViewNormals ? normalDepth.xyz : vec3(normalDepth.w);
        if (surface == 0.0) result = vec3(0.0);
    }
    if (view == kViewCandidates) {
        result = surface == 0.0 ? vec3(0.0) : vec3(texelOr(candidatesTexture, p).r);
    }
    color = vec4(result, 1.0);
}
