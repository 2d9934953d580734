// Fireflies: pixels that a sample made far brighter than what lies around them, and that the filter
// left so where no neighbour is like enough to share. One that exceeds the third brightest of the
// surfaces in the 24 pixels around it by more than `factor` is given as much as that. With `dark`,
// so is one that falls as short of the third darkest: that all of its few directions missed a sky
// tells nothing. Dims the picture by what it takes; alpha is the variance of the luminance, as in
// filter.frag.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/light.glsl"

layout(binding = kUnitFilterSource) uniform sampler2D source;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;
uniform float factor;
uniform bool dark;

layout(location = 0) out vec4 irradiance;

const int kReach = 2;
const uint kLeastSurfaces = 8u;  // what has fewer around it is small and far

// The third smallest and the third largest luminance of the surfaces around a pixel: what is off
// may have spread to two beside it. Without bounds where there are few.
vec2 thirdsAround(ivec2 pixel) {
    ivec2 limit = textureSize(source, 0) - 1;
    uint count = 0u;
    vec3 largest = vec3(0.0);         // descending
    vec3 smallest = vec3(kInfinity);  // ascending
    for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (at == pixel || at != clamp(at, ivec2(0), limit)) continue;
            if (texelFetch(surfaces, at, 0).w == kNoSurface) continue;
            ++count;
            float light = luminance(texelFetch(source, at, 0).rgb);
            vec2 lower = min(largest.xy, light);
            vec2 higher = max(smallest.xy, light);
            largest = max(largest, vec3(light, lower));
            smallest = min(smallest, vec3(light, higher));
        }
    }
    return count < kLeastSurfaces ? vec2(0.0, kInfinity) : vec2(smallest.z, largest.z);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = texelFetch(source, pixel, 0);
    float light = luminance(irradiance.rgb);
    vec2 thirds = thirdsAround(pixel);
    float least = dark ? thirds.x / factor : 0.0;
    float wanted = clamp(light, least, thirds.y * factor);
    if (wanted == light || !(light >= 0.0 && light < kInfinity)) return;  // wrong stays to be seen
    float change = wanted / max(light, 1e-30);
    irradiance = light > 0.0 ? irradiance * vec4(vec3(change), change * change)
                             : vec4(vec3(wanted), irradiance.a);
}
