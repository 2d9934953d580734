// Splats some of a view's points into its map, one stretch of points an invocation.
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/ism.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = 0) uniform usamplerBuffer sortedViews;  // View, 3 texels
layout(binding = 1) uniform usamplerBuffer surface;      // SurfacePoint
layout(std430, binding = 0) buffer Maps { uint mapTexels_[]; };

uniform uint viewCount;
uniform uint pointsPerView;
uniform uint pointsEach;  // of an invocation
uniform uint stratum;
uniform uint seed;
uniform uint viewRes;
uniform float radius;

void main() {
    uint stretches = (pointsPerView + pointsEach - 1u) / pointsEach;
    uint view = globalIndex() / stretches;
    if (view >= viewCount) return;
    uint k = globalIndex() % stretches * pointsEach;
    uint end = min(k + pointsEach, pointsPerView);
    uvec4 v0 = texelFetch(sortedViews, int(view * 3u));
    vec3 normal = uintBitsToFloat(texelFetch(sortedViews, int(view * 3u + 1u)).xyz);
    uint slot = texelFetch(sortedViews, int(view * 3u + 2u)).w;
    vec3 origin = uintBitsToFloat(v0.xyz);
    uint map = view * mapTexels(viewRes);
    while (k < end) {
        uvec4 p = texelFetch(surface, int(ismPoint(slot, k, stratum, seed)));
        vec3 offset = uintBitsToFloat(p.xyz) - origin;
        float l = length3(offset);
        uvec4 area = uvec4(0u);
        uvec4 other = uvec4(0u);
        if (ismSees(p.w, v0.w, normal, offset, l)) {
            area = ismTexels(offset.x, offset.y, offset.z, l, radius, viewRes);
            other = ismTexels(-offset.x, offset.y, offset.z, l, radius, viewRes);
        }
        uint face = 0u;
        if (area.z == 0u) {
            area = other;
            other = uvec4(0u);
            face = 1u;
        }
        uvec2 at = area.xy;
        while (area.z != 0u) {
            uint texel = (face * viewRes + at.y) * viewRes + at.x;
            if (texelReachable(texel, viewRes)) {
                atomicMin(mapTexels_[map + texel], floatBitsToUint(l));
            }
            at.x += 1u;
            if (at.x == area.z) at = uvec2(area.x, at.y + 1u);
            if (at.y == area.w) {
                area = other;
                at = area.xy;
                other = uvec4(0u);
                face = 1u;
            }
        }
        k += 1u;
    }
}
