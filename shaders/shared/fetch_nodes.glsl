// Nodes read through buffer textures, whose fetches are fast on every renderer. GLSL only.
#ifndef MV_FETCH_NODES_GLSL
#define MV_FETCH_NODES_GLSL
#include "shaders/shared/types.glsl"

SceneNode fetchSceneNode(usamplerBuffer nodes, uint index) {
    uvec4 a = texelFetch(nodes, int(index * 3u));
    uvec4 b = texelFetch(nodes, int(index * 3u + 1u));
    uvec4 c = texelFetch(nodes, int(index * 3u + 2u));
    vec4 center = uintBitsToFloat(a);
    vec4 extent = uintBitsToFloat(b);
    vec4 point = uintBitsToFloat(c);
    return SceneNode(center.x, center.y, center.z, a.w, extent.x, extent.y, extent.z, b.w, point.x,
                     point.y, point.z, c.w);
}

uint fetchSceneChildren(usamplerBuffer nodes, uint index) {
    return texelFetch(nodes, int(index * 3u)).w;
}

ViewNode fetchViewNode(usamplerBuffer nodes, uint index) {
    uvec4 a = texelFetch(nodes, int(index * 4u));
    uvec4 b = texelFetch(nodes, int(index * 4u + 1u));
    uvec4 c = texelFetch(nodes, int(index * 4u + 2u));
    uvec4 d = texelFetch(nodes, int(index * 4u + 3u));
    vec4 center = uintBitsToFloat(a);
    vec4 extent = uintBitsToFloat(b);
    vec4 axis = uintBitsToFloat(c);
    return ViewNode(center.x, center.y, center.z, a.w, extent.x, extent.y, extent.z, b.w, axis.x,
                    axis.y, axis.z, axis.w, uintBitsToFloat(d.x), d.y, d.z, d.w);
}
#endif
