// How many texels of each run of MV_TEXELS are NaN or infinite.
#include "shaders/shared/dispatch.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;
layout(binding = 0) uniform sampler2D radianceTexture;
layout(std430, binding = 0) writeonly buffer Counts { uint counts[]; };
uniform ivec2 size;

bool isBad(float x) { return (floatBitsToUint(x) & 0x7F800000u) == 0x7F800000u; }

void main() {
    uint texels = uint(size.x * size.y);
    uint begin = globalIndex() * MV_TEXELS;
    if (begin >= texels) return;
    uint end = min(begin + MV_TEXELS, texels);
    uint bad = 0u;
    for (uint i = begin; i < end; ++i) {
        vec4 c = texelFetch(radianceTexture, ivec2(int(i) % size.x, int(i) / size.x), 0);
        if (isBad(c.r) || isBad(c.g) || isBad(c.b)) ++bad;
    }
    counts[globalIndex()] = bad;
}
