// The traversal of one view against the reference traversal of all: the same pairs, counts and
// maps; and what two views share.

#include "megaviews/inspect/view_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "inspect/inspect_scenes.h"
#include "megaviews/inspect/shared_pairs.h"
#include "shaders/shared/splat.glsl"

namespace mv {
namespace {

using testing::InspectCase;
using testing::PairKey;

PairCounts sumOf(const std::set<PairKey>& pairs, const ViewHierarchy& views) {
    PairCounts sum;
    for (const auto& [view, scene, decision] : pairs)
        countPair(sum, decision, views.nodes[view].viewCount);
    return sum;
}

TEST(ViewPairs, TogetherAreThePairsOfTheTraversal) {
    testing::forAllCases(
        [](const InspectCase& c, const MethodSettings& options, const ViewHierarchy& views) {
            const auto& nodes = testing::nodesOf(c, options.rules);
            std::set<PairKey> together;
            for (std::uint32_t v = 0; v < views.sortedViews.size(); ++v) {
                const ViewPairs pairs = pairsOfView(nodes, views, v, options);
                ASSERT_EQ(pairs.chainBegin.size(), pairs.chain.size() + 1);
                PairCounts counts;
                for (std::size_t n = 0; n < pairs.chain.size(); ++n) {
                    for (const NodePair& pair : pairs.pairsOf(n)) {
                        ASSERT_EQ(pair.view, pairs.chain[n]);
                        countPair(counts, pair.decision, views.nodes[pair.view].viewCount);
                        together.insert(testing::keyOf(pair));
                    }
                }
                EXPECT_EQ(counts, pairs.counts);
            }
            EXPECT_EQ(together, testing::allPairs(nodes, views, options));
            EXPECT_EQ(sumOf(together, views), traverse(nodes, views, options).counts);
        });
}

TEST(ViewPairs, TheirMapsAreThoseOfTheTraversal) {
    testing::forAllCases([](const InspectCase& c, const MethodSettings& options,
                            const ViewHierarchy& views) {
        const auto& nodes = testing::nodesOf(c, options.rules);
        const TraversalResult all = traverse(nodes, views, options);
        const std::size_t size = mapTexels(static_cast<uint>(options.maps.resolution));
        for (std::uint32_t v = 0; v < views.sortedViews.size(); ++v) {
            const ViewPairs pairs = pairsOfView(nodes, views, v, options);
            const ViewMapsOfView maps = mapsOfView(nodes, views, pairs, options);
            ASSERT_EQ(maps.own.size(), pairs.chain.size());
            for (std::size_t n = 0; n < pairs.chain.size(); ++n) {
                ASSERT_TRUE(std::equal(
                    maps.own[n].depth.begin(), maps.own[n].depth.end(),
                    all.nodeTexels.begin() + static_cast<std::ptrdiff_t>(pairs.chain[n] * size)))
                    << "view " << v << ", node " << n << " of the chain";
            }
            const std::uint32_t map = views.mapOfNode[views.leafOfView[v]];
            ASSERT_TRUE(
                std::equal(maps.fused.depth.begin(), maps.fused.depth.end(),
                           all.leafMaps.texels.begin() + static_cast<std::ptrdiff_t>(map * size)))
                << "view " << v;
        }
    });
}

// Of the pair that won a texel nothing remains to be said but that its splat alone leaves the same
// depth there, and that no earlier pair's does.
TEST(ViewPairs, TheWinnerOfATexelIsTheFirstPairThatLeavesItsDepth) {
    testing::forAllCases([](const InspectCase& c, const MethodSettings& options,
                            const ViewHierarchy& views) {
        const auto& nodes = testing::nodesOf(c, options.rules);
        const uint res = static_cast<uint>(options.maps.resolution);
        for (std::uint32_t v = 0; v < views.sortedViews.size(); v += 9) {
            const ViewPairs pairs = pairsOfView(nodes, views, v, options);
            const ViewMapsOfView maps = mapsOfView(nodes, views, pairs, options);
            for (std::size_t n = 0; n < pairs.chain.size(); ++n) {
                const InspectedMap& map = maps.own[n];
                std::vector<std::uint32_t> winner(map.depth.size(), kNone);
                for (std::size_t i = pairs.chainBegin[n]; i < pairs.chainBegin[n + 1]; ++i) {
                    const NodePair& pair = pairs.pairs[i];
                    if (!isRendered(pair)) continue;
                    std::vector<std::uint32_t> alone(map.depth.size(), kNone);
                    std::vector<std::uint32_t> mips(mipTexels(res), kNone);
                    splatPair(nodes[pair.scene], boxCenter(views.nodes[pair.view]), options.rules,
                              pair.decision == kPairForced, options.pairs.holeFill, res,
                              {alone.data(), mips.data()});
                    for (std::size_t t = 0; t < alone.size(); ++t) {
                        if (winner[t] == kNone && alone[t] != kNone && alone[t] == map.depth[t])
                            winner[t] = static_cast<std::uint32_t>(i);
                    }
                }
                ASSERT_EQ(map.pair, winner) << "view " << v << ", node " << n << " of the chain";
            }
            for (std::size_t t = 0; t < maps.fused.depth.size(); ++t) {
                ASSERT_EQ(maps.fused.depth[t] == kNone, maps.fused.pair[t] == kNone);
                if (maps.fused.pair[t] == kNone) continue;
                ASSERT_LT(maps.fused.pair[t], pairs.pairs.size());
                ASSERT_TRUE(isRendered(pairs.pairs[maps.fused.pair[t]]));
            }
        }
    });
}

TEST(ViewPairs, SlotsLeadToTheirSortedViews) {
    const InspectCase room = testing::inspectCases()[0];
    const ViewHierarchy views = ViewHierarchy::build(room.slots, {});
    std::size_t found = 0;
    for (std::size_t slot = 0; slot < room.slots.size(); ++slot) {
        const auto sorted = sortedViewOf(views, static_cast<std::int64_t>(slot));
        EXPECT_EQ(sorted.has_value(), room.slots[slot].flags != kViewDead) << slot;
        if (!sorted) continue;
        ++found;
        EXPECT_EQ(views.sortedViews[*sorted].slot, slot);
    }
    EXPECT_EQ(found, views.sortedViews.size());
    EXPECT_FALSE(sortedViewOf(views, -1));
    EXPECT_FALSE(sortedViewOf(views, 1'000'000));
    EXPECT_FALSE(sortedViewOf(views, std::int64_t{1} << 40));
    EXPECT_FALSE(sortedViewOf({}, 0));
}

TEST(SharedPairs, ArePairsWhoseViewNodeHoldsBoth) {
    const InspectCase room = testing::inspectCases()[0];
    const MethodSettings options;
    for (const bool flat : {false, true}) {
        const ViewHierarchy views = ViewHierarchy::build(room.slots, {11, kCorrectedRules, flat});
        const auto n = static_cast<std::uint32_t>(views.sortedViews.size());
        std::uint64_t sharedByNeighbours = 0;
        for (std::uint32_t i = 0; i + 1 < n; i += 3) {
            for (const std::uint32_t j : {i, i + 1, n - 1}) {
                const ViewPairs a = pairsOfView(room.scene.nodes, views, i, options);
                const ViewPairs b = pairsOfView(room.scene.nodes, views, j, options);
                const SharedPairs shared = sharedPairs(a, b);
                const auto holds = [&](const NodePair& p, std::uint32_t view) {
                    const ViewNode& node = views.nodes[p.view];
                    return view >= node.firstView && view < node.firstView + node.viewCount;
                };
                for (const auto& p : shared.both) EXPECT_TRUE(holds(p, i) && holds(p, j));
                for (const auto& p : shared.aAlone) EXPECT_TRUE(holds(p, i) && !holds(p, j));
                for (const auto& p : shared.bAlone) EXPECT_TRUE(!holds(p, i) && holds(p, j));
                EXPECT_EQ(shared.both.size() + shared.aAlone.size(), a.counts.rendered);
                EXPECT_EQ(shared.both.size() + shared.bAlone.size(), b.counts.rendered);
                if (i == j) {
                    EXPECT_TRUE(shared.aAlone.empty() && shared.bAlone.empty());
                }
                EXPECT_TRUE(!flat || i == j || shared.both.empty());
                if (j == i + 1) sharedByNeighbours += shared.both.size();

                std::vector<Line> lines;
                const DrawnCount drawn = appendSharedPairs(shared, room.scene.nodes, lines, 10);
                EXPECT_EQ(drawn.exist,
                          shared.both.size() + shared.aAlone.size() + shared.bAlone.size());
                EXPECT_LE(drawn.drawn, 30u);
                EXPECT_LE(lines.size(), 12 * drawn.drawn);
                EXPECT_FALSE(lines.empty());
            }
        }
        EXPECT_EQ(sharedByNeighbours > 100, !flat);
    }
}

}  // namespace
}  // namespace mv
