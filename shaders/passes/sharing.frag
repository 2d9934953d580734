// What the pairs of the traversal mean for the surface that a pixel shows.
// MV_VIEW_SHARING: x = how many views share the pair that renders it, the mean over views drawn at
// random; y = the share of them for which it is rendered. MV_VIEW_SHARED: two views' classes
// (mv::SharedClass) as colours over a shaded picture.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/pair_path.glsl"

layout(binding = kUnitPosition) uniform sampler2D positions;  // G-buffer
layout(binding = kUnitNormal) uniform sampler2D normals;
layout(binding = kUnitAlbedo) uniform sampler2D albedos;
layout(binding = kUnitLeafOfView) uniform usamplerBuffer leafOfView;

uniform uint viewCount;  // 0: no view, or no method that renders pairs
uniform uint rules;
uniform float pairRes;  // see pair.glsl
uniform uint seed;

out vec4 result;

#if MV_VIEW == MV_VIEW_SHARING
const uint kDraws = 16u;
uniform int grid;  // G-buffer pixels a fragment, each way

void main() {
    uvec2 pixel = uvec2(ivec2(gl_FragCoord.xy) * grid);
    vec4 position = texelFetch(positions, ivec2(pixel), 0);
    // One view from each of as many strata of sorted views, so that near and far are both there.
    uint draws = position.w != 0.0 ? min(kDraws, viewCount) : 0u;
    uint shared_ = 0u;
    uint rendered = 0u;
    uint i = 0u;
    NodePath scene;
    if (draws > 0u) scene = scenePathTo(position.xyz);
    while (i < draws) {
        uint begin = stratumBegin(viewCount, draws, i);
        uint width = stratumBegin(viewCount, draws, i + 1u) - begin;
        uint random = pcg4d(uvec4(seed, pixel.y << 16u | pixel.x, i, 0u)).x;
        uint leaf = texelFetch(leafOfView, int(begin + mulHigh(random, width))).x;
        PairEnd end = pairEnd(scene, viewPathFrom(leaf), rules, pairRes);
        if (isRendered(end)) {
            shared_ += end.viewCount;
            rendered += 1u;
        }
        i += 1u;
    }
    float mean = rendered > 0u ? float(shared_) / float(rendered) : 0.0;
    result = vec4(mean, draws > 0u ? float(rendered) / float(draws) : 0.0, 0.0, 1.0);
}
#else
uniform uint viewA;  // sorted views, or kNone
uniform uint viewB;
uniform vec3 eye;
uniform vec3 towardsEye;       // of an orthographic camera; zero: perspective
uniform vec3 classColours[5];  // linear
uniform float sceneLevels;

PairEnd endFor(NodePath scene, uint view) {
    PairEnd end = PairEnd(kNone, kNone, kPairNone, 0u, 0u);
    uint steps = view < viewCount ? 1u : 0u;
    while (steps > 0u) {
        end = pairEnd(scene, viewPathFrom(texelFetch(leafOfView, int(view)).x), rules, pairRes);
        steps -= 1u;
    }
    return end;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(positions, pixel, 0);
    vec3 albedo = texelFetch(albedos, pixel, 0).rgb;
    vec3 normal = normalizeOr(texelFetch(normals, pixel, 0).xyz, vec3(0.0, 1.0, 0.0));
    vec3 toEye = dot3(towardsEye, towardsEye) > 0.0
                     ? towardsEye
                     : normalizeOr(eye - position.xyz, vec3(0.0, 1.0, 0.0));
    float grey = luminance(albedo) * abs(dot3(normal, toEye));

    uint found = 0u;
    float level = 0.0;
    if (position.w != 0.0 && (viewA < viewCount || viewB < viewCount)) {
        NodePath scene = scenePathTo(position.xyz);
        PairEnd a = endFor(scene, viewA);
        PairEnd b = endFor(scene, viewB);
        bool together = isRendered(a) && a.sceneNode == b.sceneNode && a.viewNode == b.viewNode;
        found = (isRendered(a) ? 1u : 0u) + (isRendered(b) ? 2u : 0u) + (together ? 1u : 0u);
        level = float(a.sceneLevel) / max(sceneLevels - 1.0, 1.0);
    }
    // Classes tint the picture; only sharing is full colour, brighter for larger scene nodes.
    vec3 colour = classColours[found] * (0.25 + 0.75 * grey);
    if (found == 4u) colour = classColours[found] * (1.9 - 1.3 * level) * (0.55 + 0.45 * grey);
    if (found == 0u) colour = vec3(grey);
    result = vec4(position.w != 0.0 ? colour : vec3(0.0), 1.0);
}
#endif
