// Paths of pairs against the traversal's definition: a surface point and a view end in one pair
// that the traversal visits, and the pairs that are visited account for every leaf and view once.

#include "shaders/shared/pair_path.glsl"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/settings/settings.h"
#include "support/synthetic.h"

namespace mv {
namespace {

using testing::nodesOf;
using testing::SyntheticScene;
using Pair = std::pair<uint, uint>;  // scene node, view node

// Every pair that the traversal ends at, by recursion, with its decision.
struct Ends {
    const SceneNodes& scene;
    const ViewHierarchy& views;
    uint rules;
    float pairRes;
    std::map<Pair, uint> decisions;

    void visit(uint s, uint v) {
        const uint decision = decidePair(scene[s], views.nodes[v], rules, pairRes);
        if (decision == kPairSplitScene) {
            for (uint k = 0; k < childCountOf(scene[s].children); ++k)
                visit(firstChildOf(scene[s].children) + k, v);
        } else if (decision == kPairSplitView) {
            for (uint k = 0; k < childCountOf(views.nodes[v].children); ++k)
                visit(s, firstChildOf(views.nodes[v].children) + k);
        } else {
            EXPECT_TRUE(decisions.emplace(Pair{s, v}, decision).second) << "visited twice";
        }
    }
    void run() {
        for (uint v = 0; v < views.nodes.size() && !scene.empty(); ++v)
            if (parentOf(views.nodes[v]) == kNone) visit(0, v);
    }
};

bool holds(const SceneNode& node, vec3 p, float slack) {
    const vec3 d = glm::abs(p - boxCenter(node)) - boxHalf(node);
    return d.x <= slack && d.y <= slack && d.z <= slack;
}

void expectPathsEndInPairs(const SyntheticScene& scene, const std::vector<View>& list, uint rules,
                           int res, bool flat, int viewLevels, int points) {
    SCOPED_TRACE(std::string(rules == kPublishedRules ? "published" : "corrected") + " R=" +
                 std::to_string(res) + (flat ? " flat " : " tree ") + std::to_string(list.size()) +
                 " views, " + std::to_string(viewLevels) + " view levels");
    const ViewHierarchy views = ViewHierarchy::build(list, {viewLevels, rules, flat});
    const SceneNodes& nodes = nodesOf(scene, rules);
    Ends ends{nodes, views, rules, pairResolution({.rules = rules, .maps = {res}}), {}};
    ends.run();
    // The recursion is the traversal: the same number of each decision.
    const PairCounts counts = traverse(nodes, views, {.rules = rules, .maps = {res}}).counts;
    PairCounts seen;
    for (const auto& [pair, decision] : ends.decisions) {
        seen.culled += decision == kPairCulled;
        seen.skipped += decision == kPairSkipped;
        seen.forced += decision == kPairForced;
        seen.rendered += decision == kPairRendered || decision == kPairForced;
        if (decision == kPairRendered || decision == kPairForced)
            seen.renderedViews += views.nodes[pair.second].viewCount;
    }
    EXPECT_EQ(seen.culled, counts.culled);
    EXPECT_EQ(seen.skipped, counts.skipped);
    EXPECT_EQ(seen.forced, counts.forced);
    EXPECT_EQ(seen.rendered, counts.rendered);
    EXPECT_EQ(seen.renderedViews, counts.renderedViews);

    const PairTrees trees{nodes.data(), views.nodes.data()};
    std::mt19937 random(17);
    const auto leaves = scene.leaves();
    std::uint64_t shared = 0;
    for (int i = 0; i < points; ++i) {
        // A point of a leaf's surface, nudged as rasterisation does.
        const uint leaf = leaves[random() % leaves.size()];
        const SceneNode& tight = scene.nodes[leaf];
        const vec3 p = boxCenter(tight) + boxHalf(tight) * testing::randomIn(random, -1, 1) * 0.5f +
                       testing::randomDirection(random) * 1e-7f;
        const NodePath scenePath = scenePathTo(trees, p);
        ASSERT_TRUE(isLeaf(nodes[scenePath.nodes[scenePath.count - 1]]));
        for (uint k = 0; k < scenePath.count; ++k) {
            ASSERT_EQ(nodes[scenePath.nodes[k]].level, k);
            ASSERT_TRUE(holds(nodes[scenePath.nodes[k]], p, 1e-6f)) << "level " << k;
        }
        ASSERT_EQ(scenePath.nodes[scenePath.count - 1], leaf);

        const uint view = static_cast<uint>(random() % views.sortedViews.size());
        const NodePath viewPath = viewPathFrom(trees, views.leafOfView[view]);
        ASSERT_EQ(viewPath.nodes[0], views.leafOfView[view]);
        const PairEnd end = pairEnd(trees, scenePath, viewPath, rules, ends.pairRes);
        const auto found = ends.decisions.find({end.sceneNode, end.viewNode});
        ASSERT_NE(found, ends.decisions.end()) << end.sceneNode << ", " << end.viewNode;
        EXPECT_EQ(found->second, end.decision);
        const ViewNode& node = views.nodes[end.viewNode];
        EXPECT_EQ(end.viewCount, node.viewCount);
        EXPECT_EQ(end.sceneLevel, nodes[end.sceneNode].level);
        EXPECT_TRUE(node.firstView <= view && view < node.firstView + node.viewCount);
        if (flat) {
            EXPECT_EQ(end.viewCount, 1u);
        }
        shared += isRendered(end) && end.viewCount > 1;
        // It is the only end that both of them share.
        if (i < 20) {
            int others = 0;
            for (uint s = 0; s < scenePath.count; ++s)
                for (uint v = 0; v < viewPath.count; ++v)
                    others += static_cast<int>(
                        ends.decisions.count({scenePath.nodes[s], viewPath.nodes[v]}));
            EXPECT_EQ(others, 1);
        }
    }
    if (!flat && list.size() >= 500 && rules == kCorrectedRules) {
        EXPECT_GT(shared, static_cast<std::uint64_t>(points) / 50);
    }
}

TEST(PairPathTest, EndsInAPairOfTheTraversal) {
    const SyntheticScene room = testing::makeRoom(6);
    const auto views = testing::viewsOnSurfaces(room, 500, 3);
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        for (const bool flat : {false, true}) {
            expectPathsEndInPairs(room, views, rules, 16, flat, 6, 2000);
            expectPathsEndInPairs(room, {views.begin(), views.begin() + 30}, rules, 64, flat, 11,
                                  1000);
            expectPathsEndInPairs(room, {views.begin(), views.begin() + 30}, rules, 16, flat, 1,
                                  500);
        }
    }
}

TEST(PairPathTest, AwkwardSizes) {
    const SyntheticScene room = testing::makeRoom(5);
    const SyntheticScene point = testing::makeScene({{vec3(0.5f), vec3(0), vec3(0)}}, 5);
    const SyntheticScene root = testing::makeScene({{vec3(0.5f), vec3(0.1f), vec3(0)}}, 1);
    std::vector<View> crowd;
    for (uint i = 0; i < 50; ++i) crowd.push_back(testing::makeView(vec3(0.4f), vec3(0, 1, 0), i));
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        for (const bool flat : {false, true}) {
            expectPathsEndInPairs(room, {crowd[0]}, rules, 16, flat, 5, 100);
            expectPathsEndInPairs(room, crowd, rules, 16, flat, 5, 100);
            expectPathsEndInPairs(point, crowd, rules, 16, flat, 5, 20);
            expectPathsEndInPairs(root, crowd, rules, 16, flat, 5, 20);
        }
    }
}

}  // namespace
}  // namespace mv
