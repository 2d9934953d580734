// Visibility of a sample of the gather (gather_sum.glsl): the shadow test against the view's map.
// MV_MAP_KIND 1: fused maps; 2: maps of all nodes, walked from leaf to root.
#include "shaders/passes/gather_maps.glsl"
#include "shaders/shared/fetch_nodes.glsl"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/shadow_test.glsl"

uniform bool footprint;

bool isVisible(VisibilitySample s) {
    uint texel = texelOfDirection(s.fromMap, mapRes);
    uint bits = loadMapTexel(s.map - firstMap, texel);
#if MV_MAP_KIND == 2
    // The last texel that is not empty on the way down is the first on the way up [Kol19 §3.2].
    vec3 leafCenter = fetchViewNodeCenter(s.map);
    uint node = s.map;
    while (bits == kNone && node != kNone) {
        node = fetchViewParent(node);
        if (node != kNone) {
            vec3 center = fetchViewNodeCenter(node);
            bits = recenterDepth(loadMapTexel(node, texel), texel, mapRes, center - leafCenter);
        }
    }
#endif
    return isLit(bits, s.fromMap, s.normal, mapRes, footprint, bias);
}
