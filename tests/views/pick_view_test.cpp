#include "megaviews/views/pick_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace mv {
namespace {

View viewAt(glm::vec3 p, std::uint32_t slot, std::uint32_t flags = kViewHemisphere) {
    View v{};
    v.positionX = p.x;
    v.positionY = p.y;
    v.positionZ = p.z;
    v.flags = flags;
    v.slot = slot;
    return v;
}
const PickRay kAlongX{{0, 0.5f, 0.5f}, {1, 0, 0}, 0, 0.02f};

TEST(PickViewTest, TakesTheNearestToTheAxisByAngle) {
    // 0.008 at 0.5 is farther off the axis, but less in angle than 0.004 at 0.2.
    std::vector<View> views = {viewAt({0.2f, 0.504f, 0.5f}, 4), viewAt({0.5f, 0.508f, 0.5f}, 9),
                               viewAt({0.5f, 0.52f, 0.5f}, 2)};
    EXPECT_EQ(pickView(views, kAlongX), 9u);
    views[1].flags = kViewDead;
    EXPECT_EQ(pickView(views, kAlongX), std::nullopt);  // 0.02 rad off at least
    EXPECT_EQ(pickView(views, {kAlongX.origin, kAlongX.direction, 0, 0.03f}), 4u);
    // With parallel rays the distance decides.
    EXPECT_EQ(pickView(views, {kAlongX.origin, kAlongX.direction, 0.01f, 0}), 4u);
    views[1].flags = kViewOmnidirectional;
    views[0].positionY = 0.509f;
    EXPECT_EQ(pickView(views, {kAlongX.origin, kAlongX.direction, 0.01f, 0}), 9u);
}

TEST(PickViewTest, NothingBehindTheCameraOrTheSurface) {
    const std::vector<View> views = {viewAt({-0.3f, 0.5f, 0.5f}, 0),
                                     viewAt({0.3f, 0.502f, 0.5f}, 1),
                                     viewAt({0.8f, 0.5f, 0.5f}, 2)};
    EXPECT_EQ(pickView(views, kAlongX), 2u);
    EXPECT_EQ(pickView(views, kAlongX, 0.9f), 2u);
    EXPECT_EQ(pickView(views, kAlongX, 0.8f), 2u);     // on it
    EXPECT_EQ(pickView(views, kAlongX, 0.7999f), 2u);  // to rounding
    EXPECT_EQ(pickView(views, kAlongX, 0.6f), 1u);
    EXPECT_EQ(pickView(views, kAlongX, 0.1f), std::nullopt);
    EXPECT_EQ(pickView({}, kAlongX), std::nullopt);
    // A floor seen at a grazing angle: the view lies on it beyond the ray's own hit.
    const float slope = std::tan(1.2f);
    const std::vector<View> floor = {viewAt({0.5f + slope * 0.008f, 0.508f, 0.5f}, 5)};
    EXPECT_EQ(pickView(floor, kAlongX, 0.5f), 5u);
}

TEST(PickViewTest, TiesGoToTheNearerThenTheLowerSlot) {
    const std::vector<View> views = {viewAt({0.6f, 0.5f, 0.5f}, 0), viewAt({0.4f, 0.5f, 0.5f}, 8),
                                     viewAt({0.4f, 0.5f, 0.5f}, 3)};
    EXPECT_EQ(pickView(views, kAlongX), 3u);
}

TEST(PickViewTest, IsTheBestOfAll) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<View> views;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        views.push_back(viewAt({unit(random), unit(random), unit(random)}, i,
                               i % 5 ? kViewHemisphere : kViewDead));
    }
    int found = 0;
    for (int n = 0; n < 200; ++n) {
        const glm::vec3 from(unit(random), unit(random), unit(random));
        const glm::vec3 d =
            glm::normalize(glm::vec3(unit(random), unit(random), unit(random)) - from);
        const PickRay ray{from, d, 0, 0.1f};
        const float surface = unit(random);
        const auto got = pickView(views, ray, surface);
        double bestTan = INFINITY;
        for (const View& v : views) {
            const glm::dvec3 way =
                glm::dvec3(v.positionX, v.positionY, v.positionZ) - glm::dvec3(from);
            const double along = glm::dot(way, glm::dvec3(d));
            if (v.flags == kViewDead || along <= 0 || along > double{surface}) continue;
            bestTan = std::min(bestTan, glm::length(glm::cross(way, glm::dvec3(d))) / along);
        }
        if (!got) {
            EXPECT_GT(bestTan, 0.1 - 1e-5);
            continue;
        }
        ++found;
        const View& v = views[*got];
        EXPECT_NE(v.flags, kViewDead);
        const glm::dvec3 way = glm::dvec3(v.positionX, v.positionY, v.positionZ) - glm::dvec3(from);
        EXPECT_LE(glm::length(glm::cross(way, glm::dvec3(d))) / glm::dot(way, glm::dvec3(d)),
                  bestTan + 1e-5);
    }
    EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace mv
