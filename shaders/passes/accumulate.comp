// Irradiance of one more set of samples -> the running mean: m_n = m_(n-1) + (x_n - m_(n-1)) / n.
#include "shaders/shared/bindings.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSampleSet) uniform sampler2D setOfSamples;
layout(binding = kImageMean, rgba32f) uniform image2D mean;
uniform ivec2 size;
uniform float sets;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= size.x || pixel.y >= size.y) return;
    vec4 before = imageLoad(mean, pixel);
    vec4 one = texelFetch(setOfSamples, pixel, 0);
    imageStore(mean, pixel, vec4(before.rgb + (one.rgb - before.rgb) / sets, one.a));
}
