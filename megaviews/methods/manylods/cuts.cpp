#include "megaviews/methods/manylods/cuts.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

#include "shaders/shared/map_store.glsl"
#include "shaders/shared/splat.glsl"

namespace mv {
namespace {

bool splits(std::uint32_t decision) { return decision == kPairSplitScene; }

CutNode cutNode(std::uint32_t node, std::uint32_t decision, float own, float above) {
    return {node | decision << kCutDecisionShift, own, above};
}

// The parent of each node; kNone for the root.
std::vector<std::uint32_t> parentsOf(std::span<const SceneNode> nodes) {
    std::vector<std::uint32_t> parents(nodes.size(), kNone);
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        const uint first = firstChildOf(nodes[i].children);
        for (uint k = 0; k < childCountOf(nodes[i].children); ++k) parents[first + k] = i;
    }
    return parents;
}

}  // namespace

// One view's cut on its way to the next.
class ViewCuts::Update {
  public:
    Update(const ViewCuts& cuts, std::span<const SceneNode> sceneNodes, const ViewNode& view,
           const CutOptions& options)
        : cuts_(cuts),
          sceneNodes_(sceneNodes),
          view_(view),
          rules_(options.method.rules),
          pairRes_(pairResolution(options.method)),
          iterations_(options.iterations) {}

    Cut run(const Cut& old) {
        Cut cut;
        counts.iterations = 1;
        const Tested root = test(0);
        if (!splits(root.decision)) {
            counts.merged += old.view.state == kCutBelow;
            cut.view = cutViewOf(view_, kCutRoot);
            keep(cutNode(0, root.decision, root.clearance, kInfinity), cut);
            return cut;
        }
        cut.view = cutViewOf(view_, kCutBelow);
        if (old.view.state == kCutBelow) {
            advance(old, displacementOf(view_, old.view), cut);
        } else {
            split(0, kInfinity, {1, old.view.state == kCutNone});
        }
        while (!active_.empty()) {
            const Active a = active_.back();
            active_.pop_back();
            place(a.node, test(a.node), a.above, a.round, cut);
        }
        return cut;
    }

    PairCounts pairs;
    CutCounts counts;

  private:
    struct Tested {
        std::uint32_t decision;
        float clearance;
    };
    // The round in which a node is tested; descents of new views have no limit of them.
    struct Round {
        std::uint32_t number = 0;
        bool unlimited = false;
    };
    struct Active {
        std::uint32_t node;
        float above;
        Round round;
    };

    Tested test(std::uint32_t node) {
        PairTerms terms;
        const SceneNode& scene = sceneNodes_[node];
        const uint decision = decidePair(scene, view_, rules_, pairRes_, terms);
        countPair(pairs, decision, 1);
        // Where the node itself moves nothing is known of the next frame.
        const bool moves =
            scene.level < cuts_.movingBegin_.size() && node >= cuts_.movingBegin_[scene.level];
        return {decision, moves ? -1.0f : pairClearance(scene, view_, decision, pairRes_, terms)};
    }

    // Every node of the old cut: as it is, or what takes its place.
    void advance(const Cut& old, float displacement, Cut& cut) {
        std::vector<CutNode> nodes = old.nodes;
        for (CutNode& node : nodes) {
            node.own = clearanceLeft(node.own, displacement);
            node.above = clearanceLeft(node.above, displacement);
            if (node.above < 0) testChain(node);
        }
        for (const CutNode& node : merged_) {
            if (belowMerged(cutSceneNode(node))) continue;
            ++counts.merged;
            keep(node, cut);
        }
        for (const CutNode& node : nodes) {
            const std::uint32_t scene = cutSceneNode(node);
            if (belowMerged(scene)) continue;
            if (node.own < 0) {
                place(scene, test(scene), node.above, {}, cut);
            } else {
                ++counts.kept;
                keep(node, cut);
            }
        }
    }

    // Tests the chain of a node. If a node of it does not split, the topmost such is merged_.
    void testChain(CutNode& node) {
        node.above = kInfinity;
        std::optional<CutNode> merged;
        forChain(cutSceneNode(node), [&](std::uint32_t parent) {
            const Tested tested = test(parent);
            if (splits(tested.decision)) {
                float& above = merged ? merged->above : node.above;
                above = std::min(above, tested.clearance);
            } else {
                merged = cutNode(parent, tested.decision, tested.clearance, kInfinity);
            }
        });
        if (merged) merged_.push_back(*merged);
    }

    // The ancestors, the root left out, of which a node is the first in the cut: up from the node,
    // while that is a first child. So each ancestor of a cut belongs to one of its nodes.
    template <typename Visit>
    void forChain(std::uint32_t node, Visit&& visit) const {
        for (;;) {
            const std::uint32_t parent = cuts_.parents_[node];
            if (parent == 0 || firstChildOf(sceneNodes_[parent].children) != node) return;
            visit(parent);
            node = parent;
        }
    }

    bool belowMerged(std::uint32_t node) const {
        if (merged_.empty()) return false;
        for (node = cuts_.parents_[node]; node != 0; node = cuts_.parents_[node]) {
            for (const CutNode& merged : merged_) {
                if (cutSceneNode(merged) == node) return true;
            }
        }
        return false;
    }

    void split(std::uint32_t node, float above, Round round) {
        ++counts.split;
        counts.iterations = std::max(counts.iterations, round.number + 1);
        const uint children = sceneNodes_[node].children;
        for (uint k = 0; k < childCountOf(children); ++k) {
            active_.push_back({firstChildOf(children) + k, k == 0 ? above : kInfinity, round});
        }
    }

    // A node that was tested in this round and whose ancestors split.
    void place(std::uint32_t node, Tested tested, float above, Round round, Cut& cut) {
        if (!splits(tested.decision)) {
            keep(cutNode(node, tested.decision, tested.clearance, above), cut);
        } else if (round.unlimited || round.number < iterations_) {
            split(node, std::min(above, tested.clearance), {round.number + 1, round.unlimited});
        } else {
            // Too large, but an update goes no further: it stands for what is below it, like a
            // leaf, until the next.
            SceneNode leaf = sceneNodes_[node];
            leaf.children = 0;
            const uint decision = decidePair(leaf, view_, rules_, pairRes_);
            ++counts.coarse;
            keep(cutNode(node, decision, -1.0f, above), cut);
        }
    }

    void keep(const CutNode& node, Cut& cut) {
        cut.nodes.push_back(node);
        ++counts.nodes;
        counts.culled += cutDecision(node) == kPairCulled;
    }

    const ViewCuts& cuts_;
    std::span<const SceneNode> sceneNodes_;
    const ViewNode& view_;
    uint rules_;
    float pairRes_;
    std::uint32_t iterations_;
    std::vector<CutNode> merged_;  // ancestors that take the place of their subtrees
    std::vector<Active> active_;
};

ViewCuts::ViewCuts(std::span<const SceneNode> sceneNodes, std::vector<std::uint32_t> movingBegin)
    : parents_(parentsOf(sceneNodes)), movingBegin_(std::move(movingBegin)) {}

CutUpdate ViewCuts::update(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                           const CutOptions& options) {
    assert(options.iterations >= 1);
    assert(sceneNodes.size() == parents_.size());
    const MethodSettings& method = options.method;
    if (made_ != method) cuts_.clear();
    made_ = method;

    const auto count = static_cast<std::uint32_t>(views.nodes.size());
    std::uint32_t slots = 0;
    for (const View& view : views.sortedViews) slots = std::max(slots, view.slot + 1);
    cuts_.resize(std::max<std::size_t>(cuts_.size(), slots));
    std::vector<Cut> next(slots);

    const uint res = static_cast<uint>(method.maps.resolution);
    const MapStore store{res};
    const bool mipFill = mipFilled(method.rules, method.pairs.holeFill, res);
    std::vector<std::uint32_t> texels(mapWords(store, count), kNone);
    std::vector<std::uint32_t> mips(mipFill ? mipWords(store, count) : 0, kNone);
    tbb::enumerable_thread_specific<CutUpdate> sums;

    tbb::parallel_for(0u, sceneNodes.empty() ? 0u : count, [&](std::uint32_t node) {
        const ViewNode& view = views.nodes[node];
        const std::uint32_t slot = views.sortedViews[node].slot;
        Update update(*this, sceneNodes, view, options);
        next[slot] = update.run(cuts_[slot]);
        SplatTarget map{texels.data() + mapWordOf(store, node, 0)};
        if (mipFill) map.mips = mips.data() + mipWordOf(store, node, 0);
        for (const CutNode& drawn : next[slot].nodes) {
            if (!pairRendered(cutDecision(drawn))) continue;
            splatPair(sceneNodes[cutSceneNode(drawn)], boxCenter(view), method.rules,
                      cutDecision(drawn) == kPairForced, method.pairs.holeFill, res, map);
        }
        sums.local().counts += update.pairs;
        sums.local().cuts += update.counts;
    });
    cuts_ = std::move(next);

    CutUpdate result;
    for (const CutUpdate& sum : sums) {
        result.counts += sum.counts;
        result.cuts += sum.cuts;
    }
    result.leafMaps = fuseMaps(texels, views, method.maps.resolution);
    if (mipFill) pushMips(mips, result.leafMaps);
    return result;
}

}  // namespace mv
