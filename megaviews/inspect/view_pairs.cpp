#include "megaviews/inspect/view_pairs.h"

#include <algorithm>
#include <cassert>

#include "shaders/shared/fuse.glsl"
#include "shaders/shared/splat.glsl"

namespace mv {
namespace {

// Where one pair's splat may have written: the texels of its two rectangles, or, for a point, the
// texel of the map and of each of its coarser levels.
template <typename Visit, typename VisitMip>
void visitTouched(const SceneNode& scene, vec3 viewCenter, bool forced,
                  const MethodSettings& settings, Visit&& visit, VisitMip&& visitMip) {
    const uint res = static_cast<uint>(settings.maps.resolution);
    if (!hasRule(settings.rules, kRuleSurfaces) || (forced && !settings.pairs.holeFill)) {
        const vec3 offset = minus3(centroidOf(scene), viewCenter);
        visit(texelOfDirection(offset, res));
        if (!forced || !mipFilled(settings.rules, settings.pairs.holeFill, res)) return;
        for (uint level = 1; (res >> level) > 0; ++level) {
            visitMip(mipOffset(level, res) + texelOfDirection(offset, res >> level));
        }
        return;
    }
    const SplatArea area = splatAreaOf(scene, viewCenter, forced, res);
    for (uint face = 0; face < kMapFaces; ++face) {
        const uvec4 rect = face == 0 ? area.front : area.back;
        for (uint j = rect.y; j < rect.y + rect.w; ++j) {
            for (uint i = rect.x; i < rect.x + rect.z; ++i) visit(texelAt(face, i, j, res));
        }
    }
}

// Maps of a view in the making; scratch is empty between pairs.
struct MapOfPairs {
    InspectedMap map, mips;
    std::vector<std::uint32_t> scratch, scratchMips;

    MapOfPairs(std::size_t texels, std::size_t mipCount) {
        map = empty(texels);
        mips = empty(mipCount);
        scratch.assign(texels, kNone);
        scratchMips.assign(mipCount, kNone);
    }
    static InspectedMap empty(std::size_t texels) {
        return {std::vector<std::uint32_t>(texels, kNone),
                std::vector<std::uint32_t>(texels, kNone)};
    }
    static void take(std::uint32_t& written, std::uint32_t pair, std::uint32_t texel,
                     InspectedMap& to) {
        if (written < to.depth[texel]) {
            to.depth[texel] = written;
            to.pair[texel] = pair;
        }
        written = kNone;
    }
    void add(const SceneNode& scene, vec3 viewCenter, std::uint32_t pair, bool forced,
             const MethodSettings& settings) {
        SplatTarget target{scratch.data()};
        if (!scratchMips.empty()) target.mips = scratchMips.data();
        splatPair(scene, viewCenter, settings.rules, forced, settings.pairs.holeFill,
                  static_cast<uint>(settings.maps.resolution), target);
        visitTouched(
            scene, viewCenter, forced, settings,
            [&](uint texel) { take(scratch[texel], pair, texel, map); },
            [&](uint texel) { take(scratchMips[texel], pair, texel, mips); });
    }
};

}  // namespace

std::optional<std::uint32_t> sortedViewOf(const ViewHierarchy& views, std::int64_t slot) {
    if (slot < 0) return std::nullopt;
    for (std::size_t i = 0; i < views.sortedViews.size(); ++i) {
        if (std::int64_t{views.sortedViews[i].slot} == slot) return static_cast<std::uint32_t>(i);
    }
    return std::nullopt;
}

ViewPairs pairsOfView(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                      std::uint32_t sortedView, const MethodSettings& settings) {
    assert(sortedView < views.leafOfView.size());
    ViewPairs out;
    out.sortedView = sortedView;
    for (std::uint32_t n = views.leafOfView[sortedView]; n != kNone; n = parentOf(views.nodes[n])) {
        out.chain.push_back(n);
    }
    std::reverse(out.chain.begin(), out.chain.end());

    const PairTest test(sceneNodes, views.nodes, settings);
    std::vector<std::uint32_t> open(sceneNodes.empty() ? 0 : 1, 0);
    for (const std::uint32_t view : out.chain) {
        out.chainBegin.push_back(out.pairs.size());
        open = test.ofViewNode(view, std::move(open), [&](const NodePair& pair) {
            out.pairs.push_back(pair);
            countPair(out.counts, pair.decision, views.nodes[view].viewCount);
        });
    }
    out.chainBegin.push_back(out.pairs.size());
    return out;
}

ViewMapsOfView mapsOfView(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                          const ViewPairs& pairs, const MethodSettings& settings) {
    const uint res = static_cast<uint>(settings.maps.resolution);
    const std::size_t texels = mapTexels(res);
    const bool mips = mipFilled(settings.rules, settings.pairs.holeFill, res);
    ViewMapsOfView out;
    out.mapRes = settings.maps.resolution;
    out.fused = MapOfPairs::empty(texels);
    for (std::size_t c = 0; c < pairs.chain.size(); ++c) {
        const ViewNode& node = views.nodes[pairs.chain[c]];
        const bool leaf = isLeaf(node);
        MapOfPairs made(texels, mips && leaf ? mipTexels(res) : 0);
        for (std::size_t i = pairs.chainBegin[c]; i < pairs.chainBegin[c + 1]; ++i) {
            const NodePair& pair = pairs.pairs[i];
            if (!isRendered(pair)) continue;
            made.add(sceneNodes[pair.scene], boxCenter(node), static_cast<std::uint32_t>(i),
                     pair.decision == kPairForced, settings);
        }
        // What the nodes above saw, from here.
        InspectedMap fused = made.map;
        if (c > 0) {
            const vec3 offset = minus3(boxCenter(views.nodes[pairs.chain[c - 1]]), boxCenter(node));
            for (uint texel = 0; texel < texels; ++texel) {
                const uint seen = recenterDepth(out.fused.depth[texel], texel, res, offset);
                if (seen < fused.depth[texel]) {
                    fused.depth[texel] = seen;
                    fused.pair[texel] = out.fused.pair[texel];
                }
            }
        }
        // Multi-pixel filling without surface elements: the finest coarser level that is not empty.
        for (uint texel = 0; mips && leaf && texel < texels; ++texel) {
            for (uint level = 1; fused.depth[texel] == kNone && (res >> level) > 0; ++level) {
                const uint from = mipTexelOf(texel, level, res);
                fused.depth[texel] = made.mips.depth[from];
                fused.pair[texel] = made.mips.pair[from];
            }
        }
        out.fused = std::move(fused);
        out.own.push_back(std::move(made.map));
    }
    return out;
}

}  // namespace mv
