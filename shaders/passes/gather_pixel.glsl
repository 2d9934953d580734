// One pixel of the gather: the surface it stands for, its receiver's list, the sum over it.
#include "shaders/passes/gather_sum.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // see gather_receivers.comp
layout(binding = kUnitPlanes) uniform usampler2D planes;
layout(binding = kUnitReceivers) uniform usampler2D receivers;
layout(binding = kUnitConesInUse) uniform usamplerBuffer used;  // cones in use, 2 words a node
layout(binding = kUnitFirstReceiver) uniform usamplerBuffer firstReceiver;  // of each node

uniform uint receiverCount;  // that there is room for

// The number of a receiver in the lists: 0 is the one that holds everything.
uint receiverIndex(uint key) {
    if (key == kNone) return 0u;
    uint node = key / kReceiverCones;
    uvec2 bits = texelFetch(used, int(node)).xy;
    uint cone = key % kReceiverCones;
    uint below = (1u << (cone & 31u)) - 1u;
    uint rank = cone < 32u ? uint(bitCount(bits.x & below))
                           : uint(bitCount(bits.x) + bitCount(bits.y & below));
    uint number = texelFetch(firstReceiver, int(node)).x + rank;
    return number < receiverCount ? number : 0u;
}

// present: whether the pixel shows a surface. list: the receiver's texel of `lists`.
Gathered gatherPixel(ivec2 pixel, out bool present, out uvec4 list) {
    uvec4 surface = texelFetch(surfaces, pixel, 0);
    present = surface.w != kNoSurface;
    receiverPlane = unpackNormal(texelFetch(planes, pixel, 0).x);
    uint receiver = receiverIndex(texelFetch(receivers, pixel, 0).x);
    list = texelFetch(lists, int(receiver));
    return gatherSum(receiver, list, uintBitsToFloat(surface.xyz), unpackNormal(surface.w),
                     uvec2(pixel), present, samples);
}
