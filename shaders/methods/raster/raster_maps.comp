// Rasterises one triangle an invocation into the maps of a block of views: depths along the rays
// through the texels' centres, from where each view stands. No hierarchy, nothing shared.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/bvh.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/rasterise.glsl"

layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint triangleCount;
uniform uint groupsAcross;  // work groups that hold a triangle each for every invocation
uniform uint firstView;
uniform uint endView;
uniform uint viewsEach;
uniform uint mapRes;
// Rows of both faces, one below the other, are drawn in parts: loops must end in time.
uniform uint firstRow;
uniform uint endRow;

#define MV_MAP_RES mapRes
#include "shaders/passes/map_texels.glsl"
#include "shaders/passes/splat_texels.glsl"

uvec4 rowsOf(uvec4 area, uint face) {
    uint first = clamp(firstRow, face * mapRes, (face + 1u) * mapRes) - face * mapRes;
    uint end = clamp(endRow, face * mapRes, (face + 1u) * mapRes) - face * mapRes;
    area.y = max(area.y, first);
    area.w = min(area.w, end);
    return area.y < area.w ? area : uvec4(0u);
}

void main() {
    uint triangle =
        (groupIndex() % groupsAcross) * uint(MV_WORKGROUP_SIZE) + gl_LocalInvocationID.x;
    uint view = firstView + groupIndex() / groupsAcross * viewsEach;
    if (triangle >= triangleCount) return;
    uint end = min(view + viewsEach, endView);
    uvec4 ta = bvhTriangleTexel(3u * triangle);
    uvec4 tb = bvhTriangleTexel(3u * triangle + 1u);
    uvec4 tc = bvhTriangleTexel(3u * triangle + 2u);
    if (tc.w != triangle) return;  // an earlier slot holds it
    vec3 cornerA = bvhVec3(ta);
    vec3 cornerB = bvhVec3(tb);
    vec3 cornerC = bvhVec3(tc);
    // Views stand so near to surfaces that their height above one has no digits left in float.
    dvec3 normal = cross(dvec3(cornerB) - dvec3(cornerA), dvec3(cornerC) - dvec3(cornerA));
    vec3 middle = (cornerA + cornerB + cornerC) * (1.0 / 3.0);
    vec3 toA = cornerA - middle;
    vec3 toB = cornerB - middle;
    vec3 toC = cornerC - middle;
    float radius = sqrt(max(dot3(toA, toA), max(dot3(toB, toB), dot3(toC, toC)))) * 1.00001 + 2e-7;

    while (view < end) {
        vec3 origin = viewPosition(view);
        vec3 a = cornerA - origin;
        vec3 b = cornerB - origin;
        vec3 c = cornerC - origin;
        vec3 offset = middle - origin;
        float l2 = dot3(offset, offset);
        uvec4 front = ballConeTexels(0u, offset, l2, radius, mapRes);
        uvec4 back = ballConeTexels(1u, offset, l2, radius, mapRes);
        // Loops alone skip work where branches are masked.
        for (bool near = (front.z | back.z) != 0u; near; near = false) {
            triangleTexels(a, b, c, mapRes, front, back);
        }
        SplatTexels t = firstTexel(rowsOf(front, 0u), rowsOf(back, 1u));
        TriangleEdges edges;
        double height = 0.0;
        if (t.left.z != 0u) {
            edges = triangleEdges(a, b, c);
            height = dot(normal, dvec3(cornerA) - dvec3(origin));
        }
        while (t.left.z != 0u) {
            uint texel = texelAt(t.face, t.at.x, t.at.y, mapRes);
            float u;
            float v;
            vec3 ray = texelRay(texel, mapRes);
            bool hit = meetsTriangle(edges, ray, u, v) && texelReachable(texel, mapRes);
            double slope = dot(normal, dvec3(ray));
            float depth = float(height / (slope != 0.0 ? slope : 1.0));
            hit = hit && slope != 0.0 && depth > 0.0;
#if MV_BVH_MASKS
            if (hit && (tb.w & kMaterialMask) != 0u) {
                hit = !bvhMaskedOut(ta.w, tb.w & ~kMaterialMask, u, v);
            }
#endif
            if (hit) {
                lowerMapTexel(view, texel, floatBitsToUint(depth * texelRayLength(texel, mapRes)));
            }
            toNextTexel(t);
        }
        view += 1u;
    }
}
