// G-buffer -> the surface that each pixel of the gather stands for, and the receiver it belongs to:
// the deepest scene node, at most at receiverLevel, whose box holds its position.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/morton.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitPosition) uniform sampler2D positions;
layout(binding = kUnitNormal) uniform sampler2D normals;
layout(binding = kUnitPlane) uniform sampler2D planeNormals;
layout(binding = kUnitSceneKeys) uniform usamplerBuffer sceneKeys;

layout(binding = kImageSurfaces, rgba32ui) uniform writeonly restrict uimage2D surfaces;
layout(binding = kImageReceivers, r32ui) uniform writeonly restrict uimage2D receivers;
layout(binding = kImagePlanes, r32ui) uniform writeonly restrict uimage2D planes;
layout(std430, binding = kBlockConesInUse) buffer Used {
    uint used[];
};  // 2 words a node: a bit a cone

uniform ivec2 size;         // of the gather
uniform int scale;          // G-buffer pixels a gather pixel, each way
uniform int receiverLevel;  // -1: no receivers
uniform uint levelBegin[kTreeLevels + 1u];

// The node of a level whose cell has the key, or kNone.
uint findNode(uint key, uint begin, uint end) {
    uint lo = begin;
    uint hi = end;
    while (hi - lo > 1u) {
        uint middle = (lo + hi) >> 1u;
        if (texelFetch(sceneKeys, int(middle)).x <= key)
            lo = middle;
        else
            hi = middle;
    }
    return texelFetch(sceneKeys, int(lo)).x == key ? lo : kNone;
}

uint coneOf(uint node, vec3 n) {
    vec3 axis;
    float cosCone, sinCone;
    fetchSceneCone(node, axis, cosCone, sinCone);
    float c = widenedCos(cosCone, sinCone);
    float s = widenedSin(cosCone, sinCone);
    if (cosCone >= kReceiverConeCos) {
        if (coneHolds(axis, c, s, n)) return kReceiverFront;
        if (coneHolds(axis, c, s, -n)) return kReceiverBack;
    }
    return receiverCell(n);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, size))) return;

    // The first of the pixel's scale x scale that has a surface, in a fixed order.
    ivec2 limit = textureSize(positions, 0) - 1;
    ivec2 origin = pixel * scale;
    vec4 position = vec4(0.0);
    ivec2 chosen = origin;
    for (int i = 0; i < scale * scale && position.w == 0.0; ++i) {
        chosen = min(origin + ivec2(i % scale, i / scale), limit);
        position = texelFetch(positions, chosen, 0);
    }
    if (position.w == 0.0) {
        imageStore(surfaces, pixel, uvec4(0u, 0u, 0u, kNoSurface));
        imageStore(receivers, pixel, uvec4(kNone));
        return;
    }
    uint code = packNormal(normalizeOr(texelFetch(normals, chosen, 0).xyz, vec3(0.0, 1.0, 0.0)));
    vec3 normal = unpackNormal(code);
    vec3 plane = normalizeOr(texelFetch(planeNormals, chosen, 0).xyz, normal);
    imageStore(planes, pixel, uvec4(packNormal(plane)));
    imageStore(surfaces, pixel, uvec4(floatBitsToUint(position.xyz), code));

    uint leafKey = mortonKeyOf(position.xyz);
    uint receiver = kNone;
    for (int level = receiverLevel; level >= 0 && receiver == kNone; --level) {
        uint node = findNode(leafKey >> (3u * (kMortonLevels - uint(level))), levelBegin[level],
                             levelBegin[level + 1]);
        if (node != kNone) {
            SceneNode box = fetchSceneNode(node);
            if (receiverHolds(boxCenter(box), boxHalf(box), position.xyz)) {
                receiver = node * kReceiverCones + coneOf(node, normal);
            }
        }
    }
    imageStore(receivers, pixel, uvec4(receiver));
    if (receiver != kNone) atomicOr(used[receiver >> 5u], 1u << (receiver & 31u));
}
