// Makes boxes and cones of the nodes of one level, whose children are finished. MV_LEAF_LEVEL: the
// last level, whose nodes are all leaves, of any number of views; above it a leaf has one view.
#include "shaders/passes/view_hierarchy_node.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/rules.glsl"
layout(local_size_x = MV_WORKGROUP_SIZE) in;

uniform uint level;
uniform uint leafLevel;
uniform uint levelBegin;
uniform uint count;        // nodes of the level
uniform uint childrenEnd;  // end of the next level
uniform uint outputBegin;  // node that the bound ranges start with
uniform uint viewCount;    // all views
uniform uint rules;
layout(std430, binding = kBlockNodeBounds) writeonly buffer NodeBounds { vec4 boundsOut[]; };
layout(std430, binding = kBlockLeafOfView) writeonly buffer Leaves { uint leafOfView[]; };
layout(binding = kUnitNodeStarts) uniform usamplerBuffer starts;  // view_hierarchy_starts.comp
layout(binding = kUnitViewLevels) uniform usamplerBuffer levels;  // view_hierarchy_levels.comp
layout(binding = kUnitViewKeys) uniform usamplerBuffer keys;
layout(binding = kUnitNodeBounds) uniform samplerBuffer bounds;  // exact: lo, hi of each node
layout(binding = kUnitViewBlocks) uniform samplerBuffer blocks;  // view_hierarchy_blocks.comp

// Whether a block of views starts at i and lies in one leaf.
bool blockAt(uint i) {
    return i % kViewBlock == 0u && i + kViewBlock <= viewCount &&
           texelFetch(blocks, int(i / kViewBlock * 4u)).w > 0.0;
}

// The node, while it is made.
precise vec3 sum = vec3(0.0);  // of axes, each as often as it has views
vec3 lo, hi;                   // of its views
uint views = 1u;
uint children = 0u;
Cone cone;

#ifdef MV_LEAF_LEVEL
// Views up to the next that starts a node, a block at once where one lies inside. Whether none sees
// more than half of space.
bool boundViews(uint first) {
    uint i = first;
    bool culls = true;
    views = 0u;
    do {
        uint step = blockAt(i) ? kViewBlock : 1u;
        if (step > 1u) {
            uint b = i / kViewBlock * 4u;
            lo = min(lo, texelFetch(blocks, int(b)).xyz);
            hi = max(hi, texelFetch(blocks, int(b + 1u)).xyz);
            sum += texelFetch(blocks, int(b + 2u)).xyz;
            culls = culls && texelFetch(blocks, int(b + 1u)).w > 0.0;
        } else {
            vec3 p = viewPosition(i);
            lo = min(lo, p);
            hi = max(hi, p);
            sum += viewNormal(i);
            culls = culls && viewIsHemisphere(i);
        }
        i += step;
        views += step;
    } while (i < viewCount && (texelFetch(levels, int(i)).x & 15u) > leafLevel);
    return culls;
}

// The cone of more than one.
void includeViews(uint first, bool culls) {
    culls = coneAxis(sum, float(views), cone.axis) && culls;
    cone.cosTheta = 1.0;
    cone.sinTheta = 0.0;
    uint i = first;
    while (i < first + views && culls) {
        bool whole = blockAt(i);
        uint b = i / kViewBlock * 4u;
        vec4 axis = vec4(viewNormal(i), 0.0);
        float c = 1.0;
        if (whole) {
            axis = texelFetch(blocks, int(b + 3u));
            c = texelFetch(blocks, int(b + 2u)).w;
        }
        culls = coneInclude(cone.axis, axis.xyz, c, axis.w, cone.cosTheta, cone.sinTheta);
        i += whole ? kViewBlock : 1u;
    }
    cone.culls = culls && coneFinish(cone.cosTheta, cone.sinTheta);
}
#else
// Boxes, axes and views of its children.
void boundChildren(uint first, uint childCount) {
    children = packChildren(first, childCount);
    views = 0u;
    bool culls = true;
    for (uint c = first; c < first + childCount; ++c) {
        uvec4 direction = texelFetch(viewNodes, int(4u * c + 2u));
        uvec4 rest = texelFetch(viewNodes, int(4u * c + 3u));
        vec3 childLo = texelFetch(bounds, int(2u * c)).xyz;
        vec3 childHi = texelFetch(bounds, int(2u * c + 1u)).xyz;
        lo = min(lo, childLo);
        hi = max(hi, childHi);
        precise vec3 weighted = uintBitsToFloat(direction.xyz) * float(rest.z);
        sum += weighted;
        views += rest.z;
        culls = culls && (rest.w & kViewNodeNoCull) == 0u;
    }
    uvec4 direction = texelFetch(viewNodes, int(4u * first + 2u));
    uvec4 rest = texelFetch(viewNodes, int(4u * first + 3u));
    cone = Cone(uintBitsToFloat(direction.xyz), uintBitsToFloat(rest.x),
                -uintBitsToFloat(direction.w), culls);
}

// The cone of more than one.
void includeChildren(uint first, uint childCount) {
    bool culls = coneAxis(sum, float(views), cone.axis) && cone.culls;
    cone.cosTheta = 1.0;
    cone.sinTheta = 0.0;
    for (uint c = first; c < first + childCount && culls; ++c) {
        uvec4 d = texelFetch(viewNodes, int(4u * c + 2u));
        float s = uintBitsToFloat(texelFetch(viewNodes, int(4u * c + 3u)).x);
        culls = coneInclude(cone.axis, uintBitsToFloat(d.xyz), s, -uintBitsToFloat(d.w),
                            cone.cosTheta, cone.sinTheta);
    }
    cone.culls = culls && coneFinish(cone.cosTheta, cone.sinTheta);
}
#endif

void main() {
    uint local = globalIndex();
    if (local >= count) return;
    uint index = levelBegin + local;
    uvec4 start = texelFetch(starts, int(index));
    lo = viewPosition(start.x);
    hi = lo;
    cone = coneOfView(start.x);
#ifdef MV_LEAF_LEVEL
    bool hemispheres = boundViews(start.x);
    leafOfView[start.x] = index;
    if (views > 1u) includeViews(start.x, hemispheres);
#else
    bool isLeaf = start.w != kNone;
    uint end = local + 1u < count ? texelFetch(starts, int(index + 1u)).y : childrenEnd;
    uint childCount = isLeaf ? 0u : end - start.y;
    if (isLeaf) leafOfView[start.x] = index;
    if (childCount > 0u) boundChildren(start.y, childCount);
    if (childCount > 1u) includeChildren(start.y, childCount);
#endif

    vec3 center =
        vec3(intervalCenter(lo.x, hi.x), intervalCenter(lo.y, hi.y), intervalCenter(lo.z, hi.z));
    vec3 halfExtent = vec3(intervalHalf(lo.x, hi.x, center.x), intervalHalf(lo.y, hi.y, center.y),
                           intervalHalf(lo.z, hi.z, center.z));
    if (!hasRule(rules, kRuleBoxes)) {
        uint key = texelFetch(keys, int(start.x)).x >> (3u * (kMortonLevels - level));
        center = cellCenter(key, level);
        halfExtent = vec3(cellHalf(level));
    }
    uint slot = index - outputBegin;
    boundsOut[2u * slot] = vec4(lo, 0.0);
    boundsOut[2u * slot + 1u] = vec4(hi, 0.0);
    mapOfNode[index] = start.w;
    writeNode(slot, center, children, halfExtent, level, cone, start.x, views,
              level > 0u ? start.z : kNone >> 1u);
}
