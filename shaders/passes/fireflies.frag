// Fireflies: pixels that a sample made far brighter than what lies around them, and that the filter
// left so where no neighbour is like enough to share. One that exceeds the third brightest of the
// surfaces in the 24 pixels around it by more than `factor` is given as much as that. Dims the
// picture by what it takes; alpha is the variance of the luminance, as in filter.frag.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
uniform float factor;

layout(location = 0) out vec4 irradiance;

const int kReach = 2;
const uint kLeastSurfaces = 8u;  // what has fewer around it is small and far

// The third largest luminance of the surfaces around a pixel: a firefly may have spread to two
// beside it. Without bound where there are few.
float thirdAround(ivec2 pixel) {
    ivec2 limit = textureSize(source, 0) - 1;
    uint count = 0u;
    vec3 largest = vec3(0.0);  // descending
    for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (at == pixel || at != clamp(at, ivec2(0), limit)) continue;
            if (texelFetch(surfaces, at, 0).w == kNoSurface) continue;
            ++count;
            float light = luminance(texelFetch(source, at, 0).rgb);
            vec2 lower = min(largest.xy, light);
            largest = max(largest, vec3(light, lower));
        }
    }
    return count < kLeastSurfaces ? kInfinity : largest.z;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = texelFetch(source, pixel, 0);
    float light = luminance(irradiance.rgb);
    float most = factor * thirdAround(pixel);
    if (light > most && light < kInfinity) {  // what is wrong stays to be seen
        float left = most / light;
        irradiance *= vec4(vec3(left), left * left);
    }
}
