// GBuffer x kept views x maps -> noisy irradiance [Kol19 §5.1], one fragment a gather pixel.
// MEASURE: instead, what the clamp takes away, on a sparse grid of the gather's pixels.
#include "shaders/passes/gather_sum.glsl"

layout(binding = 8) uniform usampler2D surfaces;  // see gather_receivers.comp
layout(binding = 9) uniform usampler2D receivers;
layout(binding = 10) uniform usamplerBuffer used;           // cones in use, 2 words a node
layout(binding = 11) uniform usamplerBuffer firstReceiver;  // of each node

uniform uint viewCount;
uniform int stride;  // of the grid; 1 unless measuring

layout(location = 0) out vec4 irradiance;
layout(location = 1) out float candidates;

// The number of a receiver in the lists: 0 is the one that holds everything.
uint receiverIndex(uint key) {
    if (key == kNone) return 0u;
    uint node = key / kReceiverCones;
    uvec2 bits = texelFetch(used, int(node)).xy;
    uint cone = key % kReceiverCones;
    uint below = (1u << (cone & 31u)) - 1u;
    uint rank = cone < 32u ? uint(bitCount(bits.x & below))
                           : uint(bitCount(bits.x) + bitCount(bits.y & below));
    return texelFetch(firstReceiver, int(node)).x + rank;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) * stride;
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    bool present = surface.w != kNoSurface;
    uint receiver = receiverIndex(texelFetch(receivers, pixel, 0).x);
    uvec4 list = texelFetch(lists, int(receiver));
    Gathered sum = gatherSum(receiver, list, uintBitsToFloat(surface.xyz), unpackNormal(surface.w),
                             uvec2(pixel), present, samples);
#ifdef MEASURE
    vec3 luminance = vec3(0.2126, 0.7152, 0.0722);
    irradiance = vec4(dot(sum.clamped, luminance), dot(sum.unclamped, luminance), 0.0, 1.0);
#else
    irradiance = vec4(sum.clamped, present ? 1.0 : 0.0);
#endif
    candidates = present ? float(list.z) / float(viewCount) : 0.0;
}
