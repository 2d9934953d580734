// Lines of boxes, cones and views: where they are, how many, and what is left out.

#include "megaviews/inspect/lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "inspect/inspect_scenes.h"

namespace mv {
namespace {

using testing::makeView;

TEST(Lines, ABoxHasTwelveEdgesAndFewerWhereItIsFlat) {
    const glm::vec3 center(0.5f, 0.25f, 0.75f);
    const std::pair<glm::vec3, std::size_t> boxes[] = {
        {{0.125f, 0.25f, 0.5f}, 12}, {{0.125f, 0, 0.5f}, 4}, {{0, 0, 0.5f}, 1}, {{0, 0, 0}, 0}};
    for (const auto& [half, count] : boxes) {
        std::vector<Line> lines;
        appendBox(center, half, kGreen, lines);
        ASSERT_EQ(lines.size(), count);
        for (const Line& line : lines) {
            EXPECT_EQ(line.colour, kGreen);
            int differ = 0;
            for (int a = 0; a < 3; ++a) {
                EXPECT_EQ(std::abs(line.a[a] - center[a]), half[a]);
                EXPECT_EQ(std::abs(line.b[a] - center[a]), half[a]);
                differ += line.a[a] != line.b[a];
            }
            EXPECT_EQ(differ, 1);
            EXPECT_EQ(std::count(lines.begin(), lines.end(), line), 1);
        }
    }
}

TEST(Lines, MoreThanTheCapAreDrawnEvenly) {
    for (const std::uint64_t exist : {0u, 1u, 9u, 10u, 11u, 1000u, 1'000'003u}) {
        std::vector<std::uint64_t> drawn;
        const DrawnCount count =
            drawEvenly(exist, 10, [&](std::uint64_t i) { drawn.push_back(i); });
        EXPECT_EQ(count, (DrawnCount{exist, std::min<std::uint64_t>(exist, 10)}));
        ASSERT_EQ(drawn.size(), count.drawn);
        for (std::size_t k = 0; k + 1 < drawn.size(); ++k) {
            EXPECT_GE(drawn[k + 1] - drawn[k], exist / drawn.size());
            EXPECT_LE(drawn[k + 1] - drawn[k], exist / drawn.size() + 1);
        }
        EXPECT_TRUE(drawn.empty() || drawn.back() < exist);
    }
}

TEST(Lines, ALevelOfTheSceneOctreeIsItsNodesBoxes) {
    const testing::SyntheticScene room = testing::makeRoom(5);
    std::uint64_t all = 0;
    for (int level = 0; level < 5; ++level) {
        std::vector<Line> lines;
        const DrawnCount count = appendSceneLevel(testing::nodesOf(room, kPublishedRules),
                                                  room.levelBegin, level, lines);
        const auto l = static_cast<std::size_t>(level);
        EXPECT_EQ(count.exist, room.levelBegin[l + 1] - room.levelBegin[l]);
        EXPECT_EQ(count.drawn, count.exist);
        EXPECT_EQ(lines.size(), 12 * count.drawn) << "voxels are not flat";
        for (const Line& line : lines) {
            EXPECT_FLOAT_EQ(glm::distance(line.a, line.b), 1 / static_cast<float>(1 << level));
        }
        all += count.exist;
        lines.clear();
        EXPECT_EQ(appendSceneLevel(room.nodes, room.levelBegin, level, lines, 3).drawn,
                  std::min<std::uint64_t>(count.exist, 3));
        EXPECT_LE(lines.size(), 36u);
    }
    EXPECT_EQ(all, room.nodes.size());
    std::vector<Line> none;
    for (const int level : {-1, 5, 1000, std::numeric_limits<int>::max()}) {
        EXPECT_EQ(appendSceneLevel(room.nodes, room.levelBegin, level, none), DrawnCount{});
        EXPECT_EQ(appendSceneLevel({}, {}, level, none), DrawnCount{});
        EXPECT_EQ(appendViewLevel({}, level, none), DrawnCount{});
    }
    EXPECT_EQ(appendSceneLevel({}, {}, 0, none), DrawnCount{});
    EXPECT_TRUE(none.empty());
}

TEST(Lines, AConesRaysLeanFromItsAxisByItsAngle) {
    const testing::SyntheticScene room = testing::makeRoom(5);
    const ViewHierarchy views =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 300, 7), {.levels = 6});
    int cones = 0, crosses = 0, axes = 0;
    for (const ViewNode& node : views.nodes) {
        std::vector<Line> lines;
        appendCone(node, kYellow, lines);
        ASSERT_FALSE(lines.empty());
        const vec3 apex = boxCenter(node);
        if ((node.flags & kViewNodeNoCull) != 0) {
            EXPECT_EQ(lines.size(), 3u);
            for (const Line& line : lines)
                EXPECT_LT(glm::distance((line.a + line.b) / 2.0f, apex), 1e-6f);
            ++crosses;
            continue;
        }
        const float length = glm::distance(lines[0].a, lines[0].b);
        EXPECT_EQ(lines[0].a, apex);
        EXPECT_NEAR(dot3(lines[0].b - apex, axisOf(node)), length, 1e-5f);
        (lines.size() == 1 ? axes : cones) += 1;
        int rays = 0;
        for (std::size_t i = 1; i < lines.size(); ++i) {
            // psi is 90 degrees more than the cone of normals.
            const vec3 ray = (lines[i].b - apex) / length;
            EXPECT_NEAR(dot3(ray, axisOf(node)), node.sinPsi, 1e-3f);
            EXPECT_NEAR(length3(ray), 1, 1e-3f);
            rays += lines[i].a == apex;
        }
        EXPECT_EQ(rays, lines.size() == 1 ? 0 : 4);
        EXPECT_TRUE(node.viewCount > 1 || lines.size() == 1u);
    }
    EXPECT_GT(cones, 10);
    EXPECT_GT(crosses, 3);
    EXPECT_GT(axes, 100);
}

TEST(Lines, ViewsShowWhereTheyLookAndHowBrightTheyAre) {
    std::vector<View> views = {makeView({0.5f, 0.5f, 0.5f}, {0, 1, 0}, 0),
                               makeView({0.2f, 0.5f, 0.5f}, {1, 0, 0}, 1),
                               {},  // dead
                               makeView({0.8f, 0.5f, 0.5f}, {}, 3, true)};
    views[0].fluxR = 8;
    views[0].fluxG = views[0].fluxB = 0;
    views[1].fluxR = 1;
    views[1].fluxG = views[1].fluxB = 0;
    views[3].fluxR = views[3].fluxG = views[3].fluxB = 0;  // black
    std::vector<Line> lines;
    EXPECT_EQ(appendViews(views, lines), (DrawnCount{3, 3}));
    ASSERT_EQ(lines.size(), 9u);
    const auto normalLine = [&](vec3 from) {
        return *std::find_if(lines.begin(), lines.end(),
                             [&](const Line& l) { return l.a == from; });
    };
    const Line bright = normalLine({0.5f, 0.5f, 0.5f}), dim = normalLine({0.2f, 0.5f, 0.5f});
    EXPECT_GT(bright.b.y, bright.a.y);
    EXPECT_GT(dim.b.x, dim.a.x);
    EXPECT_NEAR(glm::distance(bright.a, bright.b) / glm::distance(dim.a, dim.b), 2, 1e-3)
        << "the cube root of the flux";
    EXPECT_EQ(bright.colour, dim.colour);
    EXPECT_EQ(bright.colour & 255, 255u) << "red";
    EXPECT_LT(bright.colour >> 8 & 255, 100u);
    for (const Line& line : lines) {
        EXPECT_EQ(line.colour >> 24, 255u);
        EXPECT_GT(glm::distance(line.a, line.b), 1e-4f);
    }

    lines.clear();
    EXPECT_EQ(appendViews(views, lines, 2), (DrawnCount{3, 2}));
    lines.clear();
    EXPECT_EQ(appendViews({}, lines), DrawnCount{});
    const std::vector<View> dead(4);
    EXPECT_EQ(appendViews(dead, lines), DrawnCount{});
    EXPECT_TRUE(lines.empty());
}

TEST(Lines, LegendsNameEveryColourOnce) {
    for (const auto legend : {decisionLegend(), sharingLegend()}) {
        std::set<std::uint32_t> colours;
        std::set<std::string_view> names;
        for (const LegendEntry& entry : legend) {
            EXPECT_TRUE(colours.insert(entry.colour).second) << entry.name;
            EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
        }
    }
    ASSERT_EQ(decisionLegend().size(), 6u);
    EXPECT_EQ(colourOfDecision(kPairCulled), decisionLegend()[0].colour);
    EXPECT_EQ(decisionLegend()[kPairForced - kPairCulled].name, "forced");
    EXPECT_EQ(decisionLegend()[kPairSplitView - kPairCulled].name, "split view");
    EXPECT_EQ(colourOfDecision(kPairSkipped), decisionLegend()[5].colour);
    EXPECT_EQ(colourOfDecision(77), kGrey);
}

}  // namespace
}  // namespace mv
