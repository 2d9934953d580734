// Splats some of a view's points into its map, one stretch of points an invocation.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/ism.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

layout(binding = kUnitSurfacePoints) uniform usamplerBuffer surface;  // SurfacePoint

uniform uint viewCount;
uniform uint pointsPerView;
uniform uint pointsEach;  // of an invocation
uniform uint stratum;
uniform uint seed;
uniform uint viewRes;
uniform float radius;

#define MV_MAP_RES viewRes
#include "shaders/passes/map_texels.glsl"

void main() {
    uint stretches = (pointsPerView + pointsEach - 1u) / pointsEach;
    uint view = globalIndex() / stretches;
    if (view >= viewCount) return;
    uint k = globalIndex() % stretches * pointsEach;
    uint end = min(k + pointsEach, pointsPerView);
    vec3 origin = viewPosition(view);
    vec3 normal = viewNormal(view);
    uint flags = viewFlags(view);
    uint slot = viewSlot(view);
    while (k < end) {
        uvec4 p = texelFetch(surface, int(ismPoint(slot, k, stratum, seed)));
        vec3 offset = uintBitsToFloat(p.xyz) - origin;
        float l = length3(offset);
        uvec4 area = uvec4(0u);
        uvec4 other = uvec4(0u);
        if (ismSees(p.w, flags, normal, offset, l)) {
            area = pointTexels(0u, offset, l, radius, kIsmReach, viewRes);
            other = pointTexels(1u, offset, l, radius, kIsmReach, viewRes);
        }
        uint face = 0u;
        if (area.z == 0u) {
            area = other;
            other = uvec4(0u);
            face = 1u;
        }
        uvec2 at = area.xy;
        while (area.z != 0u) {
            uint texel = texelAt(face, at.x, at.y, viewRes);
            if (texelReachable(texel, viewRes)) {
                lowerMapTexel(view, texel, floatBitsToUint(l));
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
