// Trees and views read through buffer textures, whose fetches are fast on every renderer. GLSL
// only.
#ifndef MV_FETCH_NODES_GLSL
#define MV_FETCH_NODES_GLSL
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/types.glsl"

layout(binding = kUnitSceneNodes) uniform usamplerBuffer sceneNodes;
layout(binding = kUnitViewNodes) uniform usamplerBuffer viewNodes;
layout(binding = kUnitSortedViews) uniform usamplerBuffer sortedViews;

SceneNode fetchSceneNode(uint index) {
    uvec4 a = texelFetch(sceneNodes, int(index * 3u));
    uvec4 b = texelFetch(sceneNodes, int(index * 3u + 1u));
    uvec4 c = texelFetch(sceneNodes, int(index * 3u + 2u));
    vec4 center = uintBitsToFloat(a);
    vec4 extent = uintBitsToFloat(b);
    vec4 point = uintBitsToFloat(c);
    return SceneNode(center.x, center.y, center.z, a.w, extent.x, extent.y, extent.z, b.w, point.x,
                     point.y, point.z, c.w);
}

uint fetchSceneChildren(uint index) { return texelFetch(sceneNodes, int(index * 3u)).w; }
uint fetchSceneLevel(uint index) { return texelFetch(sceneNodes, int(index * 3u + 2u)).w; }

ViewNode fetchViewNode(uint index) {
    uvec4 a = texelFetch(viewNodes, int(index * 4u));
    uvec4 b = texelFetch(viewNodes, int(index * 4u + 1u));
    uvec4 c = texelFetch(viewNodes, int(index * 4u + 2u));
    uvec4 d = texelFetch(viewNodes, int(index * 4u + 3u));
    vec4 center = uintBitsToFloat(a);
    vec4 extent = uintBitsToFloat(b);
    vec4 axis = uintBitsToFloat(c);
    return ViewNode(center.x, center.y, center.z, a.w, extent.x, extent.y, extent.z, b.w, axis.x,
                    axis.y, axis.z, axis.w, uintBitsToFloat(d.x), d.y, d.z, d.w);
}

vec3 fetchViewNodeCenter(uint index) {
    return uintBitsToFloat(texelFetch(viewNodes, int(index * 4u)).xyz);
}
uint fetchViewChildren(uint index) { return texelFetch(viewNodes, int(index * 4u)).w; }
uint fetchViewParent(uint index) {
    uint parent = texelFetch(viewNodes, int(index * 4u + 3u)).w >> 1u;
    return parent == (kNone >> 1u) ? kNone : parent;
}

// Parts of the i-th of the sorted views.
vec3 viewPosition(uint i) { return uintBitsToFloat(texelFetch(sortedViews, int(3u * i)).xyz); }
uint viewFlags(uint i) { return texelFetch(sortedViews, int(3u * i)).w; }
vec3 viewNormal(uint i) { return uintBitsToFloat(texelFetch(sortedViews, int(3u * i + 1u)).xyz); }
uint viewBounce(uint i) { return texelFetch(sortedViews, int(3u * i + 1u)).w; }
vec3 viewFlux(uint i) { return uintBitsToFloat(texelFetch(sortedViews, int(3u * i + 2u)).xyz); }
uint viewSlot(uint i) { return texelFetch(sortedViews, int(3u * i + 2u)).w; }
#endif
