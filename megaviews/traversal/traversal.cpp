#include "megaviews/traversal/traversal.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cassert>

#include "shaders/shared/pair.glsl"
#include "shaders/shared/splat.glsl"

namespace mv {
namespace {

using CountsByLevel = std::array<PairCounts, kMaxLevels>;

// All pairs of one view node. `arriving`: scene nodes that its parent's pairs handed on by
// splitting the view. Returns those that this node hands on to each of its children.
std::vector<std::uint32_t> traverseViewNode(const std::vector<SceneNode>& sceneNodes,
                                            const ViewNode& view,
                                            const std::vector<std::uint32_t>& arriving,
                                            const TraversalOptions& options, SplatTarget map,
                                            CountsByLevel& counts) {
    const bool published = options.rules == Rules::published;
    const uint res = static_cast<uint>(options.viewRes);
    const float pairRes = pairResolution(options);
    std::vector<std::uint32_t> handedOn;
    std::vector<std::uint32_t> open = arriving;
    while (!open.empty()) {
        const SceneNode& scene = sceneNodes[open.back()];
        const std::uint32_t sceneIndex = open.back();
        open.pop_back();
        const uint decision = decidePair(scene, view, published, pairRes);
        countPair(counts[scene.level], decision, view.viewCount);
        if (decision == kPairRendered || decision == kPairForced) {
            splatPair(scene, boxCenter(view), published, decision == kPairForced, options.holeFill,
                      res, map);
        } else if (decision == kPairSplitScene) {
            for (uint k = 0; k < childCountOf(scene.children); ++k) {
                open.push_back(firstChildOf(scene.children) + k);
            }
        } else if (decision == kPairSplitView) {
            handedOn.push_back(sceneIndex);
        }
    }
    return handedOn;
}

}  // namespace

float pairResolution(const TraversalOptions& options) {
    return pairResolution(static_cast<float>(options.viewRes), options.rules == Rules::published,
                          options.pairSize);
}

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

TraversalResult traverse(const std::vector<SceneNode>& sceneNodes, const ViewHierarchy& views,
                         const TraversalOptions& options) {
    const uint res = static_cast<uint>(options.viewRes);
    assert(options.viewRes >= 8 && (res & (res - 1)) == 0);
    const std::size_t size = mapTexels(res);
    const bool mipFill = mipFilled(options.rules == Rules::published, options.holeFill, res);

    TraversalResult result;
    result.nodeTexels.assign(views.nodes.size() * size, kNone);
    std::vector<std::uint32_t> mips(mipFill ? views.leafCount * std::size_t{mipTexels(res)} : 0,
                                    kNone);
    const std::vector<std::uint32_t> root(sceneNodes.empty() ? 0 : 1, 0);
    std::vector<std::vector<std::uint32_t>> handedOn(views.nodes.size());
    tbb::enumerable_thread_specific<CountsByLevel> threadCounts;

    for (std::size_t level = 0; level + 1 < views.levelBegin.size(); ++level) {
        tbb::parallel_for(
            views.levelBegin[level], views.levelBegin[level + 1], [&](std::uint32_t node) {
                const ViewNode& view = views.nodes[node];
                const uint parent = parentOf(view);
                SplatTarget map{result.nodeTexels.data() + node * size};
                if (mipFill && isLeaf(view)) {
                    map.mips = mips.data() + views.mapOfNode[node] * std::size_t{mipTexels(res)};
                }
                handedOn[node] =
                    traverseViewNode(sceneNodes, view, parent == kNone ? root : handedOn[parent],
                                     options, map, threadCounts.local());
            });
        if (level > 0) {  // what the parents handed on has been read
            for (std::uint32_t n = views.levelBegin[level - 1]; n < views.levelBegin[level]; ++n) {
                std::vector<std::uint32_t>().swap(handedOn[n]);
            }
        }
    }

    result.leafMaps = fuseMaps(result.nodeTexels, views, options.viewRes);
    if (mipFill) pushMips(mips, result.leafMaps);

    result.countsPerLevel.resize(kMaxLevels);
    for (const CountsByLevel& counts : threadCounts) {
        for (std::size_t level = 0; level < counts.size(); ++level) {
            result.countsPerLevel[level] += counts[level];
            result.counts += counts[level];
        }
    }
    return result;
}

}  // namespace mv
