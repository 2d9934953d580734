// How a view node is written.
#include "shaders/passes/view_hierarchy_views.glsl"
#include "shaders/shared/bindings.glsl"

layout(std430, binding = kBlockViewNodes) writeonly buffer Nodes { uvec4 nodes[]; };  // ViewNode
layout(std430, binding = kBlockMapOfNode) writeonly buffer Maps { uint mapOfNode[]; };

// psi = theta + pi/2.
void writeNode(uint slot, vec3 center, uint children, vec3 halfExtent, uint level, Cone cone,
               uint firstView, uint viewCount, uint parent) {
    nodes[4u * slot] = uvec4(floatBitsToUint(center), children);
    nodes[4u * slot + 1u] = uvec4(floatBitsToUint(halfExtent), level);
    nodes[4u * slot + 2u] =
        uvec4(floatBitsToUint(cone.axis), floatBitsToUint(cone.culls ? -cone.sinTheta : -1.0));
    nodes[4u * slot + 3u] = uvec4(floatBitsToUint(cone.culls ? cone.cosTheta : 0.0), firstView,
                                  viewCount, (parent << 1u) | (cone.culls ? 0u : kViewNodeNoCull));
}
