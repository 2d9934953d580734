// The contribution of one view in closed form, its clamp, cutoff and degenerate ends.

#include <gtest/gtest.h>

#include "gather/random_views.h"
#include "megaviews/gather/gather.h"
#include "shaders/shared/gather.glsl"

namespace mv {
namespace {

using test::makeParticle;
using test::makeView;

ViewHierarchy treeOf(std::vector<View> views) {
    test::numberSlots(views);
    return ViewHierarchy::build(views, {});
}

TEST(GatherTerm, VplFacesReceiver) {
    // A VPL 3 m above a receiver, both facing each other: Phi / pi / r^2.
    const ViewHierarchy views = treeOf({makeView({0.5f, 0.8f, 0.5f}, {0, -1, 0}, {1, 2, 3})});
    const glm::dvec3 e =
        gatherAll({{0.5f, 0.5f, 0.5f}, {0, 1, 0}}, views, nullptr, {.worldEdge = 10});
    EXPECT_NEAR(e.x, 1 / (M_PI * 9), 1e-7);
    EXPECT_NEAR(e.y, 2 / (M_PI * 9), 1e-7);
    EXPECT_NEAR(e.z, 3 / (M_PI * 9), 1e-7);
}

TEST(GatherTerm, CosinesOfBothEnds) {
    // 60 degrees at the receiver, 30 at the VPL.
    const vec3 way(std::sqrt(0.75f) * 0.2f, 0.5f * 0.2f, 0);
    const vec3 axis(-1, 0, 0);
    const float term = gatherTerm(way, {0, 1, 0}, axis, false, 0.01f, 0);
    EXPECT_NEAR(term, 0.5 * std::sqrt(0.75) / M_PI / 0.04, 1e-4);
}

TEST(GatherTerm, ParticleHasNoCosineOfItsOwn) {
    const ViewHierarchy views = treeOf({makeParticle({0.5f, 0.7f, 0.5f}, {4, 4, 4})});
    const glm::dvec3 e = gatherAll({{0.5f, 0.5f, 0.5f}, {0, 1, 0}}, views, nullptr, {});
    EXPECT_NEAR(e.x, 4 / (4 * M_PI) / 0.04, 1e-4);
}

TEST(GatherTerm, NothingFromBehindEitherSurface) {
    EXPECT_EQ(gatherTerm({0, 0.1f, 0}, {0, -1, 0}, {0, -1, 0}, false, 0.01f, 0), 0);
    EXPECT_EQ(gatherTerm({0, 0.1f, 0}, {0, 1, 0}, {0, 1, 0}, false, 0.01f, 0), 0);
    EXPECT_EQ(gatherTerm({0, 0.1f, 0}, {0, -1, 0}, {0, 0, 0}, true, 0.01f, 0), 0);
    EXPECT_GT(gatherTerm({0, 0.1f, 0}, {0, 1, 0}, {0, 0, 0}, true, 0.01f, 0), 0);
}

TEST(GatherTerm, BelowTheClampLightFadesAndOfParticlesStays) {
    const float c = 0.05f;
    const auto term = [&](float r, bool particle) {
        return gatherTerm({0, r, 0}, {0, 1, 0}, {0, -1, 0}, particle, c, 0);
    };
    EXPECT_LT(term(0.06f, false), term(c, false));
    EXPECT_NEAR(term(c, false), 1 / (M_PI * c * c), 1e-3);
    EXPECT_NEAR(term(0.5f * c, false), 0.25f * term(c, false), 1e-3);
    EXPECT_LT(term(1e-6f, false), 1e-6f * term(c, false));
    EXPECT_FLOAT_EQ(term(1e-6f, true), term(c, true));
}

TEST(GatherTerm, CutoffIsSharp) {
    EXPECT_GT(gatherTerm({0, 0.199f, 0}, {0, 1, 0}, {0, -1, 0}, false, 0.01f, 0.2f), 0);
    EXPECT_EQ(gatherTerm({0, 0.201f, 0}, {0, 1, 0}, {0, -1, 0}, false, 0.01f, 0.2f), 0);
}

TEST(GatherTerm, ViewAtTheReceiverGivesNothingAndNoNaN) {
    EXPECT_EQ(gatherTerm(vec3(0), {0, 1, 0}, {0, 1, 0}, false, 0.01f, 0), 0);
    EXPECT_EQ(gatherTerm(vec3(0), {0, 1, 0}, vec3(0), true, 0, 0), 0);
}

TEST(GatherAll, EmptySingleAndCoincidentViews) {
    const Receiver receiver{{0.5f, 0.5f, 0.5f}, {0, 1, 0}};
    EXPECT_EQ(gatherAll(receiver, treeOf({}), nullptr, {}), glm::dvec3(0));
    const View one = makeView({0.5f, 0.8f, 0.4f}, {0, -1, 0}, {1, 1, 1});
    const double single = gatherAll(receiver, treeOf({one}), nullptr, {}).x;
    EXPECT_GT(single, 0);
    const double many = gatherAll(receiver, treeOf(std::vector<View>(100, one)), nullptr, {}).x;
    EXPECT_NEAR(many, 100 * single, 1e-9 * many);
}

TEST(GatherAll, DoesNotDependOnTheTree) {
    const std::vector<View> views = test::roomViews(500, 3, 0.2);
    const ViewHierarchy tree = ViewHierarchy::build(views, {});
    const ViewHierarchy flat = ViewHierarchy::build(views, {.flat = true});
    const Receiver receiver{{0.4f, 0.1f, 0.6f}, {0, 1, 0}};
    EXPECT_EQ(gatherAll(receiver, tree, nullptr, {}), gatherAll(receiver, flat, nullptr, {}));
}

}  // namespace
}  // namespace mv
