// The overlay that settings ask for, what the inspector keeps of it, and pictures of maps.

#include "megaviews/inspect/overlay.h"

#include <gtest/gtest.h>

#include <cmath>

#include "inspect/inspect_scenes.h"
#include "shaders/shared/colour_map.glsl"

namespace mv {
namespace {

using testing::InspectCase;

class OverlayTest : public ::testing::Test {
  protected:
    InspectCase room = testing::inspectCases()[0];
    SceneHierarchy hierarchy;
    ViewHierarchy views;
    OverlayInput input;
    Settings settings;

    void SetUp() override {
        hierarchy.levels = room.scene.levels;
        hierarchy.nodes = room.scene.nodes;
        hierarchy.levelBegin = room.scene.levelBegin;
        hierarchy.areas.resize(hierarchy.nodes.size());
        hierarchy.mortonKeys.resize(hierarchy.nodes.size());
        views = ViewHierarchy::build(room.slots, viewHierarchyOptions(settings));
        input = {hierarchy.nodes, hierarchy.levelBegin, &views};
    }
    std::int64_t slotOf(std::uint32_t sorted) const { return views.sortedViews[sorted].slot; }
};

TEST_F(OverlayTest, IsEmptyWhenEverythingIsOff) {
    EXPECT_FALSE(overlayWanted(settings));
    EXPECT_FALSE(overlayNeedsViews(settings));
    const Overlay overlay = makeOverlay(input, settings);
    EXPECT_TRUE(overlay.lines.empty());
    EXPECT_EQ(overlay.step, 0);
    EXPECT_EQ(overlay.sceneNodes, DrawnCount{});
}

TEST_F(OverlayTest, HoldsWhatEachSettingAsksFor) {
    const auto linesOf = [&](auto&& change, bool needsViews) {
        Settings s;
        change(s);
        EXPECT_TRUE(overlayWanted(s));
        EXPECT_EQ(overlayNeedsViews(s), needsViews);
        const Overlay overlay = makeOverlay(input, s);
        EXPECT_FALSE(overlay.lines.empty());
        // Without views nothing that needs them.
        EXPECT_EQ(makeOverlay({input.sceneNodes, input.sceneLevelBegin, nullptr}, s).lines.empty(),
                  needsViews);
        return overlay;
    };
    EXPECT_EQ(linesOf([](Settings& s) { s.inspect.showOctree = 1; }, false).sceneNodes.exist, 1u);
    const Overlay level = linesOf([](Settings& s) { s.inspect.showOctree = 5; }, false);
    EXPECT_EQ(level.sceneNodes.exist, hierarchy.levelBegin[5] - hierarchy.levelBegin[4]);
    EXPECT_EQ(linesOf([](Settings& s) { s.inspect.showViewOctree = 1; }, true).viewNodes.exist, 1u);
    EXPECT_EQ(linesOf([](Settings& s) { s.inspect.showViews = true; }, true).views.drawn,
              views.sortedViews.size());
    const Overlay steps = linesOf([](Settings& s) { s.inspect.step = 3; }, true);
    EXPECT_EQ(steps.step, 3);
    EXPECT_EQ(steps.countsPerStep.size(), 3u);
    EXPECT_EQ(steps.stepPairs.exist, steps.countsPerStep.back().processed);
    EXPECT_FALSE(steps.stepFinished);
    EXPECT_EQ(steps.stepDrawn.size(), steps.stepPairs.drawn);
    EXPECT_TRUE(linesOf([](Settings& s) { s.inspect.step = 100; }, true).stepFinished);
    const Overlay fewer = linesOf(
        [](Settings& s) {
            s.inspect.step = 5;
            s.inspect.stepHidden[kPairSplitView - kPairCulled] = true;
        },
        true);
    EXPECT_EQ(fewer.stepPairs.exist + fewer.stepDecisions[kPairSplitView],
              fewer.countsPerStep.back().processed);
    EXPECT_EQ(linesOf([&](Settings& s) { s.inspect.pairScene = s.inspect.pairView = 1; }, true)
                  .lines.back()
                  .colour,
              kPickedPairColour);

    const Overlay one = linesOf([&](Settings& s) { s.inspect.pickB = slotOf(3); }, true);
    EXPECT_EQ(one.b.sortedView, 3u);
    EXPECT_FALSE(one.a.sortedView);
    EXPECT_EQ(one.pairsOfBoth + one.pairsOfBAlone, 0u);
    const Overlay two = linesOf(
        [&](Settings& s) {
            s.inspect.pickA = slotOf(3);
            s.inspect.pickB = slotOf(4);
        },
        true);
    const ViewPairs a = pairsOfView(hierarchy.nodes, views, 3, {});
    EXPECT_EQ(two.a.counts, a.counts);
    EXPECT_EQ(two.a.chainNodes, a.chain.size());
    EXPECT_EQ(two.pairsOfBoth + two.pairsOfAAlone, a.counts.rendered);
    EXPECT_EQ(two.sharedBoxes.exist, two.pairsOfBoth + two.pairsOfAAlone + two.pairsOfBAlone);
}

TEST_F(OverlayTest, NamesThatThereAreNotGiveNothing) {
    settings.inspect.pickA = 1'000'000;
    settings.inspect.pickB = static_cast<std::int64_t>(room.slots.size()) - 1;  // dead
    settings.inspect.showOctree = 11;
    settings.inspect.showViewOctree = 11;
    settings.inspect.step = 5;
    settings.inspect.stepScene = std::int64_t{1} << 40;
    settings.inspect.stepView = 1'000'000'000;
    settings.inspect.pairScene = settings.inspect.pairView = 1'000'000;
    EXPECT_FALSE(pickedPair(input.sceneNodes, views, settings));
    ASSERT_EQ(room.slots.back().flags, kViewDead);
    const Overlay overlay = makeOverlay(input, settings);
    EXPECT_FALSE(overlay.a.sortedView || overlay.b.sortedView);
    EXPECT_EQ(overlay.step, 0);
    for (const Line& line : overlay.lines) EXPECT_TRUE(std::isfinite(line.a.x + line.b.x));

    // Nothing to show at all.
    const ViewHierarchy noViews = ViewHierarchy::build({}, {});
    settings.inspect.step = 1;
    settings.inspect.stepScene = settings.inspect.stepView = 0;
    settings.inspect.showViews = true;
    EXPECT_TRUE(makeOverlay({{}, {}, &noViews}, settings).lines.empty());
}

TEST_F(OverlayTest, TheInspectorMakesItOnceAndAnewWhenSomethingChanged) {
    Inspector inspector;
    EXPECT_TRUE(inspector.overlay(settings).lines.empty());
    inspector.setScene(hierarchy);
    settings.inspect.showOctree = 3;
    settings.inspect.showViews = true;
    settings.inspect.pickA = slotOf(0);
    const std::size_t withoutViews = inspector.overlay(settings).lines.size();
    inspector.setViews(room.slots);
    const std::uint64_t version = inspector.overlay(settings).version;
    EXPECT_EQ(inspector.overlay(settings).lines, makeOverlay(input, settings).lines);
    EXPECT_EQ(inspector.overlay(settings).version, version);
    Settings other = settings;
    other.display.exposureEv = 3;
    other.gather.samples = 1;
    EXPECT_EQ(inspector.overlay(other).version, version) << "nothing that lines depend on";

    const auto changes = [&](auto&& change) {
        Settings s = settings;
        change(s);
        const std::uint64_t before = inspector.overlay(settings).version;
        const Overlay& made = inspector.overlay(s);
        EXPECT_NE(made.version, before);
        const SceneNodes nodes = hierarchy.nodesUnder(s.side[0].rules);
        const ViewHierarchy tree = ViewHierarchy::build(room.slots, viewHierarchyOptions(s));
        EXPECT_EQ(made.lines, makeOverlay({nodes, hierarchy.levelBegin, &tree}, s).lines);
    };
    changes([](Settings& s) { s.inspect.showOctree = 4; });
    changes([](Settings& s) { s.inspect.showViewOctree = 2; });
    changes([](Settings& s) { s.inspect.showViews = false; });
    changes([&](Settings& s) { s.inspect.pickB = slotOf(5); });
    changes([](Settings& s) { s.side[0].rules = kPublishedRules; });
    changes([](Settings& s) { s.side[0].method = Method::manylods; });
    changes([](Settings& s) { s.views.octreeDepth = 3; });
    changes([](Settings& s) { s.inspect.step = 2; });
    changes([](Settings& s) { s.side[0].maps.resolution = 32, s.inspect.step = 9; });

    inspector.clearViews();
    EXPECT_EQ(inspector.overlay(settings).lines.size(), withoutViews);
    EXPECT_TRUE(inspector.viewHierarchy(settings).empty());
    EXPECT_EQ(inspector.inspectView(settings, slotOf(0)), nullptr);
}

TEST_F(OverlayTest, TheInspectorKnowsAViewsPairsAndMaps) {
    Inspector inspector;
    inspector.setScene(hierarchy);
    inspector.setViews(room.slots);
    for (const Method method : {Method::megaviews, Method::manylods, Method::megaviews}) {
        settings.side[0].method = method;
        const ViewHierarchy tree = ViewHierarchy::build(room.slots, viewHierarchyOptions(settings));
        for (std::int64_t slot = 0; slot < static_cast<std::int64_t>(room.slots.size());
             slot += 7) {
            const auto sorted = sortedViewOf(tree, slot);
            const Inspector::InspectedView* view = inspector.inspectView(settings, slot);
            ASSERT_EQ(view != nullptr, sorted.has_value()) << slot;
            if (!view) continue;
            const ViewPairs pairs = pairsOfView(hierarchy.nodes, tree, *sorted, {});
            EXPECT_EQ(view->pairs.pairs, pairs.pairs);
            EXPECT_EQ(view->maps.fused.depth,
                      mapsOfView(hierarchy.nodes, tree, pairs, {}).fused.depth);
        }
    }
    // Two picked views are kept at once.
    settings.side[0].method = Method::megaviews;
    const auto* a = inspector.inspectView(settings, slotOf(1));
    const auto pairsOfA = a->pairs.pairs;
    const auto* b = inspector.inspectView(settings, slotOf(2));
    EXPECT_NE(b->pairs.pairs, pairsOfA);
    EXPECT_EQ(inspector.inspectView(settings, slotOf(1))->pairs.pairs, pairsOfA);
    EXPECT_EQ(inspector.inspectView(settings, -1), nullptr);
}

TEST(ViewMapImage, ShowsEveryTexelWhereItsDirectionIs) {
    for (const int res : {8, 16, 64}) {
        std::vector<int> seen(static_cast<std::size_t>(2 * res * res), 0);
        for (int y = 0; y < res; ++y) {
            for (int x = 0; x < 2 * res; ++x) {
                const std::uint32_t texel = texelOfPixel(x, y, res);
                ASSERT_LT(texel, seen.size());
                ++seen[texel];
                const vec3 d = texelDirection(texel, static_cast<uint>(res));
                if (!(length3(vec3(0, d.y, d.z)) < 0.8f)) continue;
                EXPECT_EQ(d.x > 0, x < res);      // +x left, -x right
                EXPECT_EQ(d.z > 0, y < res / 2);  // up is up
                EXPECT_EQ(d.y > 0, x % res >= res / 2);
            }
        }
        for (const int count : seen) EXPECT_EQ(count, 1);
    }
}

TEST(ViewMapImage, ColoursDepthLevelAndViews) {
    const testing::SyntheticScene room = testing::makeRoom(7);
    // So many views that they share what is far from them.
    const ViewHierarchy views = ViewHierarchy::build(testing::viewsOnSurfaces(room, 4000, 9), {});
    const MethodSettings options;
    const ViewPairs pairs = pairsOfView(room.nodes, views, 10, options);
    const ViewMapsOfView maps = mapsOfView(room.nodes, views, pairs, options);
    const auto colourAt = [](double t) {
        const vec3 c = viridis(static_cast<float>(t)) * 255.0f;
        const auto byte = [](float x) { return static_cast<std::uint32_t>(std::lround(x)); };
        return rgba(byte(c.x), byte(c.y), byte(c.z));
    };
    for (const MapQuantity quantity :
         {MapQuantity::depth, MapQuantity::level, MapQuantity::views}) {
        const ViewMapImage image =
            viewMapImage(maps.fused, pairs.pairs, room.nodes, views, 16, quantity);
        ASSERT_EQ(image.width, 32);
        ASSERT_EQ(image.height, 16);
        ASSERT_EQ(image.pixels.size(), 512u);
        EXPECT_LT(image.low, image.high);
        EXPECT_GT(image.filled, 100u);
        EXPECT_LE(image.filled, image.reachable);
        std::uint64_t filled = 0, empty = 0, transparent = 0;
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 32; ++x) {
                const std::uint32_t pixel = image.pixels[static_cast<std::size_t>(y * 32 + x)];
                const std::uint32_t texel = texelOfPixel(x, y, 16);
                const double value =
                    mapValue(maps.fused, texel, pairs.pairs, room.nodes, views, quantity);
                if (pixel == 0) {
                    ++transparent;
                    EXPECT_FALSE(texelReachable(texel, 16));
                } else if (value < 0) {
                    ++empty;
                    EXPECT_EQ(pixel, kEmptyTexelColour);
                    EXPECT_EQ(maps.fused.depth[texel], kNone);
                } else {
                    ++filled;
                    ASSERT_GE(value, image.low);
                    ASSERT_LE(value, image.high);
                    EXPECT_TRUE(value != image.low || pixel == colourAt(0));
                    EXPECT_TRUE(value != image.high || image.low == image.high ||
                                pixel == colourAt(1));
                }
            }
        }
        EXPECT_EQ(filled, image.filled);
        EXPECT_EQ(filled + empty, image.reachable);
        EXPECT_EQ(filled + empty + transparent, 512u);
    }
    // The level and the views are those of a pair that the view renders; the depth is the map's.
    for (std::uint32_t texel = 0; texel < 512; ++texel) {
        const auto value = [&](MapQuantity q) {
            return mapValue(maps.fused, texel, pairs.pairs, room.nodes, views, q);
        };
        if (maps.fused.depth[texel] == kNone) continue;
        const NodePair& pair = pairs.pairs[maps.fused.pair[texel]];
        EXPECT_EQ(value(MapQuantity::level), room.nodes[pair.scene].level);
        EXPECT_EQ(value(MapQuantity::views), views.nodes[pair.view].viewCount);
        EXPECT_EQ(value(MapQuantity::depth),
                  static_cast<double>(uintBitsToFloat(maps.fused.depth[texel])));
    }
}

TEST(ViewMapImage, ATexelSaysItsRayAndThePairThatWonIt) {
    const testing::SyntheticScene room = testing::makeRoom(7);
    const ViewHierarchy views = ViewHierarchy::build(testing::viewsOnSurfaces(room, 500, 9), {});
    const ViewPairs pairs = pairsOfView(room.nodes, views, 10, {});
    const ViewMapsOfView maps = mapsOfView(room.nodes, views, pairs, {});
    std::uint64_t filled = 0, back = 0;
    for (std::uint32_t texel = 0; texel < 512; ++texel) {
        const auto said = mapTexel(maps.fused, texel, pairs.pairs, 16);
        ASSERT_EQ(said.has_value(), texelReachable(texel, 16));
        if (!said) continue;
        EXPECT_NEAR(length3(said->direction), 1, 1e-6f);
        EXPECT_EQ(said->back, texel >= 256);
        if (length3(vec3(0, said->direction.y, said->direction.z)) < 0.8f) {
            EXPECT_EQ(texelOfDirection(said->direction, 16), texel);
        }
        back += said->back;
        ASSERT_EQ(said->depth.has_value(), maps.fused.depth[texel] != kNone);
        ASSERT_EQ(said->pair.has_value(), said->depth.has_value());
        if (!said->depth) continue;
        ++filled;
        EXPECT_EQ(*said->depth, uintBitsToFloat(maps.fused.depth[texel]));
        EXPECT_TRUE(isRendered(*said->pair));
        // The node that won lies in that direction, at about that distance.
        const SceneNode& node = room.nodes[said->pair->scene];
        const vec3 at = boxCenter(views.nodes[pairs.chain.back()]) + said->direction * *said->depth;
        EXPECT_LT(length3(at - boxCenter(node)), 3 * length3(boxHalf(node)) + 0.4f * *said->depth);
        EXPECT_FALSE(mapTexel(maps.fused, texel, {}, 16)->pair) << "without pairs, depth alone";
    }
    EXPECT_GT(filled, 100u);
    EXPECT_GT(back, 150u);
}

TEST(ViewMapImage, OfAnEmptyMapIsEmpty) {
    const ViewHierarchy views = ViewHierarchy::build(testing::particlesInside(3, 5), {});
    const ViewPairs pairs = pairsOfView({}, views, 1, {});
    EXPECT_TRUE(pairs.pairs.empty());
    const ViewMapsOfView maps = mapsOfView({}, views, pairs, {});
    const ViewMapImage image =
        viewMapImage(maps.fused, pairs.pairs, {}, views, 16, MapQuantity::views);
    EXPECT_EQ(image.filled, 0u);
    EXPECT_EQ(image.low, 0);
    EXPECT_EQ(image.high, 0);
    for (const std::uint32_t pixel : image.pixels) {
        EXPECT_TRUE(pixel == 0 || pixel == kEmptyTexelColour);
    }
}

}  // namespace
}  // namespace mv
