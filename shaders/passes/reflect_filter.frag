// One pass of the filter of reflected light, or of light that came through clear surfaces: 3 x 3
// taps (1 2 1) `spacing` pixels apart. Two points of a surface share what they reflect as far as
// one lobe of its gloss reaches: the rougher, and the farther what is reflected, the wider; a
// mirror keeps all as it is. Biased: what the lobe meets is taken to lie as far away as what the
// pixel's own ray met.
#include "shaders/passes/edges.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/microfacet.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;            // w = depth
layout(binding = kUnitGloss) uniform sampler2D glosses;             // or GBuffer::clear
layout(binding = kUnitReflectionWeight) uniform sampler2D weights;  // w = the ray's length
#ifdef MV_COAT
layout(binding = kUnitCoat) uniform sampler2D coats;
#endif
uniform int spacing;
uniform bool last;  // the light that comes back, not that which arrives

layout(location = 0) out vec4 radiance;

const float kLeastCos = 0.5;
const float kMostSlope = 0.6;

float roughnessAt(ivec2 pixel) {
#ifdef MV_COAT
    vec4 coat = texelFetch(coats, pixel, 0);
    if (coat.xyz != vec3(0.0)) return coat.a;
#endif
    return texelFetch(glosses, pixel, 0).a;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 weight = texelFetch(weights, pixel, 0);
    radiance = vec4(0.0);
    if (!(max(weight.r, max(weight.g, weight.b)) > 0.0)) return;
    vec3 position = texelFetch(positions, pixel, 0).xyz;
    vec4 normalDepth = texelFetch(normals, pixel, 0);
    float footprint = pixelFootprint(normalDepth.w);
    vec4 sum = vec4(texelFetch(source, pixel, 0).rgb, 1.0) * 4.0;
    float reach = ggxAlpha(roughnessAt(pixel)) * weight.w;
    // Narrower than a tap's way: nothing to share.
    if (spacing > 0 && reach > 0.5 * float(spacing) * footprint) {
        ivec2 limit = textureSize(source, 0) - 1;
        for (int tap = 0; tap < 9; ++tap) {
            ivec2 way = ivec2(tap % 3, tap / 3) - 1;
            ivec2 at = pixel + way * spacing;
            if (tap == 4 || at != clamp(at, ivec2(0), limit)) continue;
            vec4 other = texelFetch(weights, at, 0);
            float otherReach = min(ggxAlpha(roughnessAt(at)) * other.w, reach);
            if (!(max(other.r, max(other.g, other.b)) > 0.0) || !(otherReach > 0.0)) continue;
            vec3 place = texelFetch(positions, at, 0).xyz;
            bool corner = way.x != 0 && way.y != 0;
            float edge = edgeWeight(position, normalDepth.xyz, place,
                                    texelFetch(normals, at, 0).xyz, kLeastCos, kMostSlope,
                                    tapTolerance(corner) * float(spacing) * footprint);
            float steps = distance(position, place) / otherReach;
            float share = (corner ? 1.0 : 2.0) * edge * exp(-steps * steps);
            vec3 light = texelFetch(source, at, 0).rgb;
            if (share > 0.0) sum += vec4(light, 1.0) * share;
        }
    }
    radiance = vec4(sum.rgb / sum.w, 1.0);
    if (last) radiance.rgb *= weight.rgb;
}
