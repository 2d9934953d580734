// The reference traversal against its definition: every pair by naive recursion, every leaf
// accounted for by brute force over leaves and views, and exact rays against the maps.

#include "megaviews/methods/megaviews/traversal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "shaders/shared/pair.glsl"
#include "shaders/shared/splat.glsl"
#include "support/map_queries.h"
#include "support/sanitized.h"
#include "support/synthetic.h"

namespace mv {
namespace {

using glm::dvec3;
using testing::kBothRules;
using testing::nodesOf;
using testing::rayBox;
using testing::SyntheticScene;

// The definition: recursion on pairs, one tree at a time, into a map a view node.
struct Naive {
    const SceneNodes& scene;
    const ViewHierarchy& views;
    MethodSettings options;
    std::vector<uint> texels, mips;
    PairCounts counts;

    void visit(uint s, uint v) {
        const SceneNode& scenes = scene[s];
        const ViewNode& view = views.nodes[v];
        const uint res = static_cast<uint>(options.maps.resolution);
        ++counts.processed;
        const uint decision = decidePair(scenes, view, options.rules, pairResolution(options));
        switch (decision) {
            case kPairCulled:
                ++counts.culled;
                return;
            case kPairSkipped:
                ++counts.skipped;
                return;
            case kPairForced:
                ++counts.forced;
                [[fallthrough]];
            case kPairRendered: {
                ++counts.rendered;
                counts.renderedViews += view.viewCount;
                SplatTarget target{texels.data() + v * mapTexels(res)};
                if (!mips.empty() && isLeaf(view))
                    target.mips = mips.data() + views.mapOfNode[v] * mipTexels(res);
                splatPair(scenes, boxCenter(view), options.rules, decision == kPairForced,
                          options.pairs.holeFill, res, target);
                return;
            }
            case kPairSplitScene:
                ++counts.subdivided;
                for (uint k = 0; k < childCountOf(scenes.children); ++k)
                    visit(firstChildOf(scenes.children) + k, v);
                return;
            default:
                ASSERT_EQ(decision, kPairSplitView);
                ++counts.subdivided;
                for (uint k = 0; k < childCountOf(view.children); ++k)
                    visit(s, firstChildOf(view.children) + k);
        }
    }
    void run() {
        const uint res = static_cast<uint>(options.maps.resolution);
        texels.assign(views.nodes.size() * mapTexels(res), kNone);
        if (mipFilled(options.rules, options.pairs.holeFill, res))
            mips.assign(views.leafCount * std::size_t{mipTexels(res)}, kNone);
        for (uint v = 0; v < views.nodes.size() && !scene.empty(); ++v)
            if (parentOf(views.nodes[v]) == kNone) visit(0, v);
    }
};

void expectIsDefinition(const SyntheticScene& scene, const std::vector<View>& list, uint rules,
                        int res, bool flat, int viewLevels) {
    SCOPED_TRACE(std::string(rules == kPublishedRules ? "published" : "corrected") + " R=" +
                 std::to_string(res) + (flat ? " flat " : " tree ") + std::to_string(list.size()) +
                 " views, " + std::to_string(viewLevels) + " view levels");
    const ViewHierarchy views = ViewHierarchy::build(list, {viewLevels, rules, flat});
    const MethodSettings options{.rules = rules, .maps = {res}};
    const TraversalResult result = traverse(nodesOf(scene, rules), views, options);
    Naive naive{nodesOf(scene, rules), views, options, {}, {}, {}};
    naive.run();
    EXPECT_EQ(result.counts, naive.counts);
    EXPECT_EQ(result.nodeTexels, naive.texels);
    ViewMaps maps = fuseMaps(naive.texels, views, res);
    if (!naive.mips.empty()) pushMips(naive.mips, maps);
    EXPECT_EQ(result.leafMaps.texels, maps.texels);

    const PairCounts& c = result.counts;
    EXPECT_EQ(c.processed, c.culled + c.rendered + c.subdivided + c.skipped);
    EXPECT_LE(c.forced, c.rendered);
    EXPECT_EQ(sumOf(result.countsPerLevel), c);
    if (flat) {
        EXPECT_EQ(c.renderedViews, c.rendered);
    }
}

TEST(TraversalTest, VisitsThePairsOfTheDefinition) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 60, 1);
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            for (const int viewLevels : {1, 3, 6, 11})
                expectIsDefinition(room, views, rules, 16, flat, viewLevels);
            expectIsDefinition(room, views, rules, 8, flat, 6);
            expectIsDefinition(room, {views.begin(), views.begin() + 6}, rules, 64, flat, 6);
        }
    }
}

TEST(TraversalTest, RulesBetweenVisitThePairsOfTheDefinition) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 40, 1);
    for (const uint rules : testing::rulesBetween()) {
        for (const bool flat : {false, true}) expectIsDefinition(room, views, rules, 16, flat, 6);
    }
}

// Every correction changes what it is said to change; none does nothing.
TEST(TraversalTest, EveryRuleCounts) {
    const SyntheticScene room = testing::makeRoom(7);
    const auto list = testing::viewsOnSurfaces(room, 500, 2);
    const auto result = [&](uint rules) {
        return traverse(nodesOf(room, rules), ViewHierarchy::build(list, {7, rules, false}),
                        {.rules = rules, .maps = {16}});
    };
    const TraversalResult published = result(kPublishedRules);
    const std::uint64_t pairs = published.counts.processed;
    // Places alone: other maps of the same pairs.
    EXPECT_EQ(result(kRuleCentroid).counts, published.counts);
    EXPECT_NE(result(kRuleCentroid).nodeTexels, published.nodeTexels);
    // Tight boxes cull more, larger pairs need fewer, a bound splits what is not the same for all.
    EXPECT_GT(result(kRuleBoxes).counts.culled * pairs,
              published.counts.culled * result(kRuleBoxes).counts.processed);
    EXPECT_LT(result(kRuleTwoTexels).counts.processed, pairs / 2);
    EXPECT_GT(result(kRuleBound).counts.processed, pairs);
    // Voxels of one level are of one size.
    EXPECT_EQ(result(kRuleRadius).counts, published.counts);
    EXPECT_NE(result(kRuleBoxes | kRuleRadius).counts.processed,
              result(kRuleBoxes).counts.processed);
    EXPECT_NE(result(kRuleLoneViews).counts.processed, pairs);
    EXPECT_LE(result(kRuleSurfaces).counts.skipped, published.counts.skipped);
    EXPECT_NE(result(kRuleSurfaces).nodeTexels, published.nodeTexels);
    EXPECT_EQ(result(kRuleFootprint).counts, published.counts) << "of the shadow test alone";
}

TEST(TraversalTest, AwkwardSizes) {
    const SyntheticScene room = testing::makeRoom(5);
    const SyntheticScene empty = testing::makeEmptyScene();
    const SyntheticScene point = testing::makeScene({{vec3(0.5f), vec3(0), vec3(0)}}, 5);
    std::vector<View> crowd;
    for (uint i = 0; i < 50; ++i) crowd.push_back(testing::makeView(vec3(0.5f), vec3(0, 1, 0), i));
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            expectIsDefinition(room, {}, rules, 16, flat, 5);
            expectIsDefinition(room, {crowd[0]}, rules, 16, flat, 5);
            expectIsDefinition(room, crowd, rules, 16, flat, 5);
            expectIsDefinition(empty, crowd, rules, 16, flat, 5);
            expectIsDefinition(point, crowd, rules, 16, flat, 5);
        }
    }
}

TEST(TraversalTest, SharingGainsAndTheCorrectedRulesGain) {
    const SyntheticScene room = testing::makeRoom(8);
    const auto list = testing::viewsOnSurfaces(room, 3000, 2);
    std::uint64_t processed[2][2];
    for (const uint rules : kBothRules) {
        for (const bool flat : {false, true}) {
            const ViewHierarchy views = ViewHierarchy::build(list, {8, rules, flat});
            const TraversalResult r =
                traverse(nodesOf(room, rules), views, {.rules = rules, .maps = {16}});
            processed[rules == kPublishedRules][flat] = r.counts.processed;
            if (!flat) {
                EXPECT_GT(r.counts.viewsPerRenderedNode(), rules == kPublishedRules ? 1.2 : 1.7);
            }
        }
    }
    EXPECT_LT(processed[0][0] * 14, processed[0][1] * 10);  // what sharing gains
    EXPECT_LT(processed[0][0] * 4, processed[1][0]);        // what the rules gain
}

// ------------------------------------------------------------------ what the maps say

// Every scene leaf and every view leaf, by brute force: nothing that a view can see is lost.
TEST(TraversalTest, NoVisibleLeafIsLost) {
    const SyntheticScene room = testing::makeRoom(5);
    const auto list = testing::viewsOnSurfaces(room, 60, 3);
    const ViewHierarchy views = ViewHierarchy::build(list, {.levels = 5});
    const uint res = 16;
    const TraversalResult r =
        traverse(room.nodes, views, {.rules = kCorrectedRules, .maps = {int(res)}});
    const auto leaves = room.leaves();
    std::uint64_t rays = 0, empty = 0, tooFar = 0;
    for (std::size_t node = 0; node < views.nodes.size(); ++node) {
        if (views.mapOfNode[node] == kNone || views.nodes[node].viewCount > 1) continue;
        const ViewNode& view = views.nodes[node];
        const vec3 center = boxCenter(view);
        const uint* map = r.leafMaps.texels.data() + views.mapOfNode[node] * mapTexels(res);
        for (uint t = 0; t < mapTexels(res); ++t) {
            const dvec3 ray = glm::normalize(dvec3(texelRay(t, res)));
            if (glm::dot(ray, dvec3(axisOf(view))) < 0.2) continue;  // grazing its own wall
            // The nearest leaf whose shrunken box the centre ray meets, and that is not one of
            // those around the view.
            double nearest = INFINITY;
            for (const uint leaf : leaves) {
                const SceneNode& s = room.nodes[leaf];
                const dvec3 c = dvec3(boxCenter(s)) - dvec3(center), h(boxHalf(s));
                if (glm::length(c) < 3 * glm::length(h)) continue;
                // Squarely: along the surface's element, well inside the box.
                const double z = rayBox(ray, c, h * 0.7 + 1e-7);
                if (z > 0) nearest = std::min(nearest, z + 2 * glm::length(h));
            }
            if (std::isinf(nearest)) continue;
            ++rays;
            // Some node that holds this leaf was drawn here, or something nearer: to one texel's
            // footprint, since inner nodes shift by up to a texel when fused.
            if (map[t] == kNone) {
                ++empty;
            } else {
                tooFar += static_cast<double>(uintBitsToFloat(map[t])) > nearest * 1.25;
            }
        }
    }
    EXPECT_GT(rays, 4000u);
    // Measured: 0.8 % empty, where neighbouring nodes were drawn for different view nodes.
    EXPECT_LE(empty * 100, rays * 2) << empty << " of " << rays;
    EXPECT_LE(tooFar, rays / 50) << tooFar << " of " << rays;
}

// One view alone shares nothing: its map must be what rays see, texel by texel.
TEST(TraversalTest, DepthsOfASingleViewFollowExactRays) {
    const SyntheticScene room = testing::makeRoom(8);
    std::vector<View> one = {testing::makeView(vec3(0.45f, 0.2f, 0.45f), vec3(0), 0, true)};
    const ViewHierarchy views = ViewHierarchy::build(one, {.levels = 8});
    const uint res = 32;
    const TraversalResult r =
        traverse(room.nodes, views, {.rules = kCorrectedRules, .maps = {int(res)}});
    const auto leaves = room.leaves();
    std::uint64_t rays = 0, within = 0, near = 0, missing = 0;
    const uint each = testing::kSanitized ? 5 : 1;
    for (uint t = 0; t < mapTexels(res); t += each) {
        if (!texelReachable(t, res)) continue;
        const dvec3 ray = glm::normalize(dvec3(texelRay(t, res)));
        double nearest = INFINITY;
        for (const uint leaf : leaves) {
            const SceneNode& s = room.nodes[leaf];
            const double z = rayBox(ray, dvec3(boxCenter(s)) - dvec3(boxCenter(views.nodes[0])),
                                    dvec3(boxHalf(s)) + 1e-6);
            if (z > 0) nearest = std::min(nearest, z);
        }
        if (std::isinf(nearest)) continue;
        ++rays;
        if (r.leafMaps.texels[t] == kNone) {  // met the box of a leaf beside its surface
            ++missing;
            continue;
        }
        const double z = static_cast<double>(uintBitsToFloat(r.leafMaps.texels[t]));
        const double footprint = 4.0 / res;
        within += std::abs(z / nearest - 1) <= footprint;
        near += std::abs(z / nearest - 1) <= 0.3 * footprint;
    }
    EXPECT_GT(rays, 1000u / each);
    EXPECT_LE(missing * 100, rays) << missing << " of " << rays;
    // Measured: 97 % within the texel's angle times the distance, 84 % within a third of it.
    EXPECT_GE(within, rays * 94 / 100) << within << " of " << rays;
    EXPECT_GE(near, rays * 75 / 100) << near << " of " << rays;
}

// The maps of a tree of views agree with those each view would have alone, to a texel's footprint.
TEST(TraversalTest, SharedMapsAgreeWithMapsOfEachViewAlone) {
    const SyntheticScene room = testing::makeRoom(7);
    const auto list = testing::viewsOnSurfaces(room, 400, 5);
    const ViewHierarchy tree = ViewHierarchy::build(list, {.levels = 7});
    const ViewHierarchy alone = ViewHierarchy::build(list, {.levels = 7, .flat = true});
    const uint res = 16;
    const MethodSettings options{.rules = kCorrectedRules, .maps = {int(res)}};
    const TraversalResult a = traverse(room.nodes, tree, options);
    const TraversalResult b = traverse(room.nodes, alone, options);
    EXPECT_LT(a.counts.processed, b.counts.processed);
    std::uint64_t texels = 0, agree = 0;
    for (uint view = 0; view < tree.sortedViews.size(); ++view) {
        const uint leaf = tree.leafOfView[view];
        if (tree.nodes[leaf].viewCount > 1) continue;
        for (uint t = 0; t < mapTexels(res); ++t) {
            const uint x = a.leafMaps.texels[tree.mapOfNode[leaf] * mapTexels(res) + t];
            const uint y = b.leafMaps.texels[view * mapTexels(res) + t];
            if (x == kNone && y == kNone) continue;
            ++texels;
            agree += x != kNone && y != kNone &&
                     std::abs(uintBitsToFloat(x) / uintBitsToFloat(y) - 1) < 4.0f / float(res);
        }
    }
    EXPECT_GT(texels, 50000u);
    EXPECT_GE(agree, texels * 85 / 100) << agree << " of " << texels;
}

TEST(TraversalTest, QueriesOfFusedAndUnfusedMapsAgree) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto list = testing::viewsOnSurfaces(room, 100, 6);
    const ViewHierarchy views = ViewHierarchy::build(list, {.levels = 6});
    const TraversalResult r = traverse(room.nodes, views, {.rules = kCorrectedRules, .maps = {16}});
    std::mt19937 random(7);
    int both = 0, close = 0;
    for (uint v = 0; v < views.sortedViews.size(); ++v) {
        for (int k = 0; k < 50; ++k) {
            const vec3 d = testing::randomDirection(random);
            const float fused = queryFused(r.leafMaps, views.mapOfNode[views.leafOfView[v]], d);
            const float unfused = queryUnfused(r.nodeTexels, views, 16, v, d);
            ASSERT_EQ(std::isinf(fused), std::isinf(unfused));
            if (std::isinf(fused)) continue;
            ++both;
            // The last not empty is one of those whose minimum fusion takes.
            ASSERT_LE(fused, unfused * 1.2f + 1e-5f);
            close += std::abs(fused / unfused - 1) < 0.05f;
        }
    }
    EXPECT_GT(both, 2000);
    EXPECT_GT(close, both * 7 / 10) << close << " of " << both;
}

}  // namespace
}  // namespace mv
