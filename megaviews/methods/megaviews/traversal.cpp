#include "megaviews/methods/megaviews/traversal.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "shaders/shared/map_store.glsl"
#include "shaders/shared/splat.glsl"
#include "shaders/shared/types.glsl"

namespace mv {
namespace {

using CountsByLevel = std::array<PairCounts, kSceneLevels>;

}  // namespace

void countPair(PairCounts& counts, std::uint32_t decision, std::uint32_t viewCount) {
    ++counts.processed;
    switch (decision) {
        case kPairCulled:
            ++counts.culled;
            break;
        case kPairForced:
            ++counts.forced;
            [[fallthrough]];
        case kPairRendered:
            ++counts.rendered;
            counts.renderedViews += viewCount;
            break;
        case kPairSkipped:
            ++counts.skipped;
            break;
        default:
            ++counts.subdivided;
            break;
    }
}

TraversalResult traverse(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                         const MethodSettings& settings) {
    const uint res = static_cast<uint>(settings.maps.resolution);
    assert(settings.maps.resolution >= 8 && (res & (res - 1)) == 0);
    const MapStore store{res};
    const bool mipFill = mipFilled(settings.rules, settings.pairs.holeFill, res);
    const PairTest pairs(sceneNodes, views.nodes, settings);

    TraversalResult result;
    result.nodeTexels.assign(mapWords(store, views.nodes.size()), kNone);
    std::vector<std::uint32_t> mips(mipFill ? mipWords(store, views.leafCount) : 0, kNone);
    const std::vector<std::uint32_t> root(sceneNodes.empty() ? 0 : 1, 0);
    std::vector<std::vector<std::uint32_t>> handedOn(views.nodes.size());
    tbb::enumerable_thread_specific<CountsByLevel> threadCounts;

    for (std::size_t level = 0; level + 1 < views.levelBegin.size(); ++level) {
        tbb::parallel_for(
            views.levelBegin[level], views.levelBegin[level + 1], [&](std::uint32_t node) {
                const ViewNode& view = views.nodes[node];
                const uint parent = parentOf(view);
                SplatTarget map{result.nodeTexels.data() + mapWordOf(store, node, 0)};
                if (mipFill && isLeaf(view)) {
                    map.mips = mips.data() + mipWordOf(store, views.mapOfNode[node], 0);
                }
                CountsByLevel& counts = threadCounts.local();
                handedOn[node] = pairs.ofViewNode(
                    node, parent == kNone ? root : handedOn[parent], [&](const NodePair& pair) {
                        const SceneNode& scene = sceneNodes[pair.scene];
                        countPair(counts[scene.level], pair.decision, view.viewCount);
                        if (isRendered(pair)) {
                            splatPair(scene, boxCenter(view), settings.rules,
                                      pair.decision == kPairForced, settings.pairs.holeFill, res,
                                      map);
                        }
                    });
            });
        if (level > 0) {  // what the parents handed on has been read
            for (std::uint32_t n = views.levelBegin[level - 1]; n < views.levelBegin[level]; ++n) {
                std::vector<std::uint32_t>().swap(handedOn[n]);
            }
        }
    }

    result.leafMaps = fuseMaps(result.nodeTexels, views, settings.maps.resolution);
    if (mipFill) pushMips(mips, result.leafMaps);

    const std::uint32_t deepest = sceneNodes.empty() ? 0 : sceneNodes.back().level;
    result.countsPerLevel.resize(std::max(kTreeLevels, deepest + 1));
    for (const CountsByLevel& counts : threadCounts) {
        for (std::size_t level = 0; level < result.countsPerLevel.size(); ++level) {
            result.countsPerLevel[level] += counts[level];
            result.counts += counts[level];
        }
    }
    return result;
}

}  // namespace mv
