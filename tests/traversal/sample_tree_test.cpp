// Cuts through the binary tree over samples: those that are kept have the maps of those from the
// root, however its views and what moves of its surface go.

#include <gtest/gtest.h>

#include "megaviews/methods/manylods/cuts.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "support/binary_scene.h"

namespace mv {
namespace {

using testing::flat;

TEST(SampleTreeCuts, IncrementalOnesAreThoseFromTheRoot) {
    testing::BinaryScene door("builtin:door", 7);
    ASSERT_FALSE(door.movingBegin().empty());
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        const MethodSettings method{.rules = rules};
        std::mt19937 random(4);
        std::vector<View> views = testing::viewsOfAllKinds(door.tree(), 60, 1);
        ViewCuts cuts(door.nodes(rules), door.movingBegin());
        std::uint64_t merged = 0, kept = 0;
        int frame = 0;
        for (const float far : {0.001f, 0.01f, 0.1f, 0.0f, 0.003f, 1.0f, 0.02f}) {
            SCOPED_TRACE("rules " + std::to_string(static_cast<int>(rules)) + " frame " +
                         std::to_string(frame));
            door.pose(1 + frame++ / 30.0);
            const ViewHierarchy hierarchy = flat(views);
            const TraversalResult want = traverse(door.nodes(rules), hierarchy, method);
            const CutUpdate got = cuts.update(door.nodes(rules), hierarchy, {method});
            EXPECT_EQ(got.leafMaps.texels, want.leafMaps.texels);
            EXPECT_EQ(got.cuts.nodes, want.counts.processed - want.counts.subdivided);
            EXPECT_EQ(got.cuts.coarse, 0u);
            EXPECT_EQ(sumOf(want.countsPerLevel), want.counts);
            EXPECT_EQ(want.countsPerLevel.size(), static_cast<std::size_t>(door.tree().levels));
            merged += got.cuts.merged;
            kept += got.cuts.kept;
            testing::moveViews(views, far, random);
        }
        EXPECT_GT(merged, 100u);
        EXPECT_GT(kept, 1000u);
    }
}

TEST(SampleTreeCuts, LazyOnesCatchUp) {
    testing::BinaryScene door("builtin:door", 6);
    std::mt19937 random(8);
    std::vector<View> views = testing::viewsOfAllKinds(door.tree(), 40, 1);
    ViewCuts cuts(door.nodes(kCorrectedRules), door.movingBegin());
    cuts.update(door.nodes(kCorrectedRules), flat(views), {{}, 1});
    testing::moveViews(views, 0.5f, random);
    const ViewHierarchy hierarchy = flat(views);
    CutUpdate last = cuts.update(door.nodes(kCorrectedRules), hierarchy, {{}, 1});
    EXPECT_GT(last.cuts.coarse, 0u);
    for (int k = 0; k < door.tree().levels && last.cuts.coarse > 0; ++k) {
        last = cuts.update(door.nodes(kCorrectedRules), hierarchy, {{}, 1});
    }
    EXPECT_EQ(last.leafMaps.texels,
              traverse(door.nodes(kCorrectedRules), hierarchy, {}).leafMaps.texels);
}

}  // namespace
}  // namespace mv
