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
uniform uint mapRes;
uniform float radius;

#define MV_MAP_RES mapRes
#include "shaders/passes/map_texels.glsl"
#include "shaders/passes/splat_texels.glsl"

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
        uvec4 front = uvec4(0u);
        uvec4 back = uvec4(0u);
        if (ismSees(p.w, flags, normal, offset, l)) {
            front = pointTexels(0u, offset, l, radius, kIsmReach, mapRes);
            back = pointTexels(1u, offset, l, radius, kIsmReach, mapRes);
        }
        SplatTexels t = firstTexel(front, back);
        while (t.left.z != 0u) {
            uint texel = texelAt(t.face, t.at.x, t.at.y, mapRes);
            if (texelReachable(texel, mapRes)) {
                lowerMapTexel(view, texel, floatBitsToUint(l));
            }
            toNextTexel(t);
        }
        k += 1u;
    }
}
