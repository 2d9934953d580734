// Sums over blocks of 64 sorted views that all lie in one leaf, so that a leaf of very many views
// adds blocks. (A million iterations of one invocation are slow anywhere, and software renderers
// end any shader's loops after 65535 in all.)
#include "shaders/passes/view_hierarchy_views.glsl"
#include "shaders/shared/bindings.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint count;  // full blocks
uniform uint leafLevel;
layout(binding = kUnitViewLevels) uniform usamplerBuffer levels;  // view_hierarchy_levels.comp
layout(std430, binding = kBlockViewBlocks) writeonly buffer Blocks { vec4 blocksOut[]; };

void main() {
    uint block = globalIndex();
    if (block >= count) return;
    uint begin = block * kViewBlock;
    uint end = begin + kViewBlock;
    uint i = begin + 1u;
    while (i < end && (texelFetch(levels, int(i)).x & 15u) > leafLevel) ++i;
    if (i < end) {
        blocksOut[4u * block] = vec4(0.0);
        return;
    }
    vec3 lo = viewPosition(begin);
    vec3 hi = lo;
    precise vec3 sum = vec3(0.0);
    bool culls = true;
    for (i = begin; i < end; ++i) {
        vec3 p = viewPosition(i);
        lo = min(lo, p);
        hi = max(hi, p);
        sum += viewNormal(i);
        culls = culls && viewIsHemisphere(i);
    }
    Cone cone = Cone(vec3(0.0), 1.0, 0.0, false);
    culls = coneAxis(sum, float(kViewBlock), cone.axis) && culls;
    for (i = begin; i < end && culls; ++i)
        culls = coneInclude(cone.axis, viewNormal(i), 1.0, 0.0, cone.cosTheta, cone.sinTheta);
    culls = culls && coneFinish(cone.cosTheta, cone.sinTheta);
    blocksOut[4u * block] = vec4(lo, 1.0);
    blocksOut[4u * block + 1u] = vec4(hi, culls ? 1.0 : 0.0);
    blocksOut[4u * block + 2u] = vec4(sum, cone.cosTheta);
    blocksOut[4u * block + 3u] = vec4(cone.axis, cone.sinTheta);
}
