// Fireflies: pixels that a sample made far brighter than what lies around them, and that the filter
// left so where no neighbour is like enough to share. One that exceeds the third brightest of the
// surfaces in the 24 pixels around it by more than `factor` is given as much as that. With `dark`,
// so is one that falls as short of the third darkest: that all of its few directions missed a sky
// tells nothing. A colour of which samples took more than there was is given as that of the pixels
// around. Dims the picture by what it takes; alpha is the variance of the luminance, as in
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

// Of the surfaces around a pixel.
struct Around {
    vec2 thirds;  // the third smallest and third largest luminance: what is off may have spread to
                  // two beside it; without bounds where surfaces are few
    vec3 light;   // the sum
};
Around lookAround(ivec2 pixel) {
    ivec2 limit = textureSize(source, 0) - 1;
    uint count = 0u;
    vec3 sum = vec3(0.0);
    vec3 largest = vec3(0.0);         // descending
    vec3 smallest = vec3(kInfinity);  // ascending
    for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) {
            ivec2 at = pixel + ivec2(x, y);
            if (at == pixel || at != clamp(at, ivec2(0), limit)) continue;
            if (texelFetch(surfaces, at, 0).w == kNoSurface) continue;
            ++count;
            vec3 colour = texelFetch(source, at, 0).rgb;
            float light = luminance(colour);
            sum += max(colour, 0.0);
            vec2 lower = min(largest.xy, light);
            vec2 higher = max(smallest.xy, light);
            largest = max(largest, vec3(light, lower));
            smallest = min(smallest, vec3(light, higher));
        }
    }
    vec2 thirds = vec2(smallest.z, largest.z);
    return Around(count < kLeastSurfaces ? vec2(0.0, kInfinity) : thirds, sum);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    irradiance = texelFetch(source, pixel, 0);
    float light = luminance(irradiance.rgb);
    if (!(abs(light) < kInfinity)) return;  // wrong stays to be seen
    Around around = lookAround(pixel);
    // Samples that take too much leave less than nothing, as others leave too much.
    float least = dark ? around.thirds.x / factor : min(light, 0.0);
    float wanted = clamp(light, least, around.thirds.y * factor);
    bool lacksColour = min(irradiance.r, min(irradiance.g, irradiance.b)) < 0.0 || light == 0.0;
    float lightAround = luminance(around.light);
    if (wanted > 0.0 && lacksColour && lightAround > 0.0) {
        irradiance.rgb = around.light * (wanted / lightAround);
    } else if (light > 0.0) {
        irradiance.rgb *= wanted / light;
    }
    if (light > 0.0) irradiance.a *= (wanted / light) * (wanted / light);
}
