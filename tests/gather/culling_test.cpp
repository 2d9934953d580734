// Gather culling never removes a view that lights any point and normal of the receiver, and it
// does remove what it can.

#include <gtest/gtest.h>

#include "gather/random_views.h"
#include "megaviews/gather/gather.h"
#include "shaders/shared/gather.glsl"

namespace mv {
namespace {

using test::Rng;

std::vector<bool> keptViews(const std::vector<std::uint32_t>& nodes, const ViewHierarchy& views) {
    std::vector<bool> kept(views.sortedViews.size(), false);
    for (const std::uint32_t n : nodes) {
        const ViewNode& node = views.nodes[n];
        for (std::uint32_t v = node.firstView; v < node.firstView + node.viewCount; ++v) {
            EXPECT_FALSE(kept[v]) << "view " << v << " is kept twice";
            kept[v] = true;
        }
    }
    return kept;
}

// Draws points and normals of the receiver; whatever lights them must be kept. Returns the number
// of culled views.
std::size_t expectNothingLost(const ReceiverBounds& r, const ViewHierarchy& views, int level,
                              Rng& rng) {
    const std::vector<bool> kept = keptViews(keptViewNodes(r, views, level), views);
    for (int sample = 0; sample < 24; ++sample) {
        vec3 p = test::point(rng, -1, 1);
        if (sample % 2) p = sign(p);
        p = r.center + p * r.half;
        const vec3 n = r.cosCone > 0 ? test::inCone(rng, r.axis, r.cosCone, sample % 3 == 0)
                                     : test::direction(rng);
        for (std::uint32_t v = 0; v < kept.size(); ++v) {
            if (kept[v]) continue;
            const View& view = views.sortedViews[v];
            const vec3 toView = vec3(view.positionX, view.positionY, view.positionZ) - p;
            const float term = gatherTerm(toView, n, {view.normalX, view.normalY, view.normalZ},
                                          view.flags == kViewOmnidirectional, 0.01f, 0);
            EXPECT_EQ(term, 0) << "lost view " << v << " of " << kept.size() << " at level "
                               << level << "; view at " << view.positionX << " " << view.positionY
                               << " " << view.positionZ << " normal " << view.normalX << " "
                               << view.normalY << " " << view.normalZ << "; receiver at " << p.x
                               << " " << p.y << " " << p.z << " normal " << n.x << " " << n.y << " "
                               << n.z;
            if (term != 0) return 0;
        }
    }
    return static_cast<std::size_t>(std::count(kept.begin(), kept.end(), false));
}

ReceiverBounds randomReceiver(Rng& rng) {
    ReceiverBounds r;
    r.center = test::point(rng);
    r.half = test::point(rng) * std::pow(10.0f, test::uniform(rng, -6, -0.5f));
    if (rng() % 3 == 0) r.half[static_cast<int>(rng() % 3)] = 0;
    r.axis = test::direction(rng);
    if (rng() % 3 == 0) r.axis = round(r.axis);
    r.axis = normalizeOr(r.axis, vec3(0, 1, 0));
    const float angle = test::uniform(rng, 0, 1) * test::uniform(rng, 0, 1) * 1.7f;
    r.cosCone = rng() % 8 == 0 ? 1.0f : std::cos(angle);
    r.sinCone = rng() % 8 == 0 ? 0.0f : std::sin(angle);
    if (r.cosCone == 1) r.sinCone = 0;
    if (r.sinCone == 0) r.cosCone = 1;
    return r;
}

TEST(GatherCulling, LosesNothingInRandomScenes) {
    Rng rng(17);
    std::size_t culled = 0, views = 0;
    for (unsigned scene = 0; scene < 12; ++scene) {
        const ViewHierarchy h =
            ViewHierarchy::build(test::roomViews(300, scene, 0.1 * (scene % 3)),
                                 {.rules = scene % 4 == 3 ? kPublishedRules : kCorrectedRules});
        for (int i = 0; i < 40; ++i) {
            culled += expectNothingLost(randomReceiver(rng), h, static_cast<int>(rng() % 11), rng);
            views += h.sortedViews.size();
        }
    }
    EXPECT_GT(static_cast<double>(culled), 0.2 * static_cast<double>(views));
}

TEST(GatherCulling, LosesNothingWithScatteredDirections) {
    Rng rng(18);
    for (unsigned scene = 0; scene < 8; ++scene) {
        std::vector<View> views;
        for (int i = 0; i < 300; ++i) {
            const vec3 p = scene % 2 ? test::point(rng) : vec3(0.5f) + test::point(rng) * 1e-4f;
            views.push_back(test::makeView(p, test::direction(rng), {1, 1, 1}));
        }
        const ViewHierarchy h = ViewHierarchy::build(views, {});
        for (int i = 0; i < 40; ++i) {
            ReceiverBounds r = randomReceiver(rng);
            if (i % 2) r.center = vec3(0.5f) + test::direction(rng) * 2e-4f;  // amid the views
            expectNothingLost(r, h, static_cast<int>(rng() % 11), rng);
        }
    }
}

TEST(GatherCulling, FlatHierarchyIsCulledViewByView) {
    Rng rng(19);
    const ViewHierarchy h = ViewHierarchy::build(test::roomViews(200, 5), {.flat = true});
    std::size_t culled = 0;
    for (int i = 0; i < 40; ++i) culled += expectNothingLost(randomReceiver(rng), h, 6, rng);
    EXPECT_GT(culled, 1000u);
}

TEST(GatherCulling, DegenerateViewSets) {
    Rng rng(20);
    const ReceiverBounds anything{.center = vec3(0.5f), .half = vec3(0.5f)};
    EXPECT_TRUE(keptViewNodes(anything, ViewHierarchy::build({}, {}), 6).empty());
    const ViewHierarchy one = ViewHierarchy::build(test::roomViews(1, 1), {});
    EXPECT_EQ(keptViewNodes(anything, one, 6), std::vector<std::uint32_t>{0});
    std::vector<View> same(64, test::makeView({0.5f, 0.5f, 0.5f}, {0, 1, 0}, {1, 1, 1}));
    for (std::size_t i = 0; i < same.size(); i += 2) same[i].normalY = -1;
    test::numberSlots(same);
    const ViewHierarchy together = ViewHierarchy::build(same, {});
    for (int i = 0; i < 100; ++i) expectNothingLost(randomReceiver(rng), together, 10, rng);
}

// A floor with VPLs 2 % of a leaf above it gets nothing from them and keeps none of them.
TEST(GatherCulling, FlatWallDropsItsOwnViews) {
    std::vector<View> views;
    Rng rng(21);
    for (int i = 0; i < 500; ++i) {
        const vec3 p(test::uniform(rng, 0.1f, 0.9f), 0.25f + 0.02f / 1024,
                     test::uniform(rng, 0.1f, 0.9f));
        views.push_back(test::makeView(p, {0, 1, 0}, {1, 1, 1}));
    }
    test::numberSlots(views);
    const ViewHierarchy h = ViewHierarchy::build(views, {});
    ReceiverBounds floor;
    floor.center = {0.5f, 0.25f, 0.5f};
    floor.half = vec3(0.4f, 0, 0.4f) + vec3(kReceiverMargin);
    EXPECT_TRUE(keptViewNodes(floor, h, 6).empty());
    // A ceiling facing down keeps all of them, facing up none.
    ReceiverBounds ceiling = floor;
    ceiling.center.y = 0.75f;
    ceiling.axis = {0, -1, 0};
    ceiling.cosCone = 1;
    EXPECT_EQ(keptViews(keptViewNodes(ceiling, h, 6), h), std::vector<bool>(500, true));
    ceiling.axis = {0, 1, 0};
    EXPECT_TRUE(keptViewNodes(ceiling, h, 6).empty());
}

TEST(GatherCulling, CutoffKeepsWhatIsNear) {
    Rng rng(22);
    const ViewHierarchy h = ViewHierarchy::build(test::roomViews(400, 8), {});
    std::size_t culled = 0;
    for (int i = 0; i < 50; ++i) {
        ReceiverBounds r = randomReceiver(rng);
        r.cosCone = -1;
        r.half = r.half * 0.1f;
        const float cutoff = test::uniform(rng, 0.05f, 0.5f);
        const std::vector<bool> all = keptViews(keptViewNodes(r, h, 10), h);
        const std::vector<bool> kept = keptViews(keptViewNodes(r, h, 10, cutoff), h);
        for (std::uint32_t v = 0; v < kept.size(); ++v) {
            const View& view = h.sortedViews[v];
            const vec3 d = abs(vec3(view.positionX, view.positionY, view.positionZ) - r.center);
            if (length(max(d - r.half, vec3(0))) < cutoff) {
                EXPECT_EQ(kept[v], all[v]);
            }
            culled += all[v] && !kept[v];
        }
    }
    EXPECT_GT(culled, 1000u);
}

TEST(ReceiverBounds, HoldTheirPixels) {
    EXPECT_EQ(receiverBounds({}).cosCone, -1);
    Rng rng(23);
    int wide = 0;
    for (int i = 0; i < 2000; ++i) {
        const vec3 place = test::point(rng), axis = test::direction(rng);
        const float size = std::pow(10.0f, test::uniform(rng, -7, -1));
        const float spread = i % 4 == 0 ? 0.0f : test::uniform(rng, 0, 1.5f);
        std::vector<Receiver> pixels(1 + rng() % 64);
        for (Receiver& r : pixels) {
            r.position = place + test::point(rng, -1, 1) * size;
            r.normal =
                unpackNormal(packNormal(normalizeOr(axis + test::direction(rng) * spread, axis)));
        }
        const ReceiverBounds bounds = receiverBounds(pixels);
        wide += bounds.cosCone <= 0;
        for (const Receiver& r : pixels) {
            const vec3 off = abs(r.position - bounds.center);
            EXPECT_TRUE(off.x <= bounds.half.x && off.y <= bounds.half.y && off.z <= bounds.half.z);
            if (bounds.cosCone <= 0) continue;
            // sin(angle - half angle) <= 0, exact at small angles.
            const float c = dot(bounds.axis, r.normal), s = length(cross(bounds.axis, r.normal));
            EXPECT_LE(s * bounds.cosCone, c * bounds.sinCone);
        }
    }
    EXPECT_GT(wide, 100);
    EXPECT_LT(wide, 1500);
}

TEST(PackedNormal, KeepsDirections) {
    Rng rng(24);
    float worst = 0;
    for (int i = 0; i < 100000; ++i) {
        vec3 n = test::direction(rng);
        if (i % 8 == 0) n = normalize(round(n * 2.0f) + vec3(0, 0, 1e-9f));
        const uint code = packNormal(n);
        ASSERT_NE(code, kNoSurface);
        worst = std::max(worst, length(unpackNormal(code) - n));
    }
    EXPECT_LT(worst, 8e-5f);
    EXPECT_EQ(unpackNormal(packNormal({0, 1, 0})), vec3(0, 1, 0));
    EXPECT_EQ(unpackNormal(packNormal({0, 0, -1})), vec3(0, 0, -1));
}

}  // namespace
}  // namespace mv
