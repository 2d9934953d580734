#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "views/rooms.h"

namespace mv {
namespace {

using testing::fluxOf;
using testing::positionOf;

const SceneBounds kBox{{0.1f, 0.3f, 0.2f}, {0.9f, 0.5f, 0.8f}};

TEST(Particles, StayInsideTheBox) {
    for (const double t : {0.0, 0.5, 17.3, 1e4, -3.0, 1e7}) {
        for (const View& v : makeParticles(kBox, 3000, 5, t, 1).views) {
            const glm::dvec3 p = positionOf(v);
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(p[axis], static_cast<double>(kBox.min[axis])) << "at " << t;
                ASSERT_LE(p[axis], static_cast<double>(kBox.max[axis])) << "at " << t;
            }
        }
    }
}

TEST(Particles, ShareThePowerAndShineAllRound) {
    for (const std::uint64_t count : {1u, 2u, 7u, 1000u}) {
        const ViewSet set = makeParticles(kBox, count, 1, 3, 12);
        ASSERT_EQ(set.views.size(), count);
        EXPECT_EQ(set.alive(), count);
        double sum = 0;
        for (std::uint32_t i = 0; i < count; ++i) {
            const View& v = set.views[i];
            EXPECT_EQ(v.slot, i);
            EXPECT_EQ(v.bounce, 0u);
            EXPECT_EQ(v.flags, kViewOmnidirectional);
            EXPECT_EQ(testing::normalOf(v), glm::dvec3(0));
            const glm::dvec3 flux = fluxOf(v);
            EXPECT_NEAR((flux.x + flux.y + flux.z) / 3, 12.0 / static_cast<double>(count), 1e-5);
            sum += (flux.x + flux.y + flux.z) / 3;
        }
        EXPECT_NEAR(sum, 12, 1e-4);
    }
    EXPECT_TRUE(makeParticles(kBox, 0, 1, 0, 1).views.empty());
}

TEST(Particles, MoveContinuouslyAndComeBack) {
    const auto at = [](double t) { return makeParticles(kBox, 500, 9, t, 1); };
    // At 60 frames a second nobody jumps; over seconds everybody has moved.
    for (const double t : {0.0, 12.345, 59.99, 1000.0}) {
        const ViewSet a = at(t), b = at(t + 1.0 / 60), later = at(t + 3);
        for (std::size_t i = 0; i < 500; ++i) {
            EXPECT_LT(glm::length(positionOf(a.views[i]) - positionOf(b.views[i])), 0.004);
            EXPECT_EQ(fluxOf(a.views[i]), fluxOf(later.views[i]));
        }
        double moved = 0;
        for (std::size_t i = 0; i < 500; ++i) {
            moved += glm::length(positionOf(a.views[i]) - positionOf(later.views[i])) / 500;
        }
        EXPECT_GT(moved, 0.01);
    }
    // Closed: some time between 20 and 60 s every particle is back at its place with its velocity.
    const ViewSet start = at(0), next = at(0.01);
    for (std::size_t i = 0; i < 500; i += 150) {
        double nearest = 1;
        for (double t = 19.5; t < 60.5; t += 0.01) {
            const View v = makeParticles(kBox, i + 1, 9, t, 1).views[i];
            nearest = std::min(nearest, glm::length(positionOf(v) - positionOf(start.views[i])));
        }
        const double step = glm::length(positionOf(next.views[i]) - positionOf(start.views[i]));
        EXPECT_LT(nearest, step + 1e-6) << i;
    }
}

TEST(Particles, FillTheBoxWithManyColours) {
    const ViewSet set = makeParticles(kBox, 4096, 2, 0, 1);
    std::array<int, 64> cells{};
    std::array<int, 6> hues{};
    for (const View& v : set.views) {
        std::size_t cell = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double share = (positionOf(v)[axis] - static_cast<double>(kBox.min[axis])) /
                                 static_cast<double>(kBox.max[axis] - kBox.min[axis]);
            cell = cell * 4 + static_cast<std::size_t>(std::min(share * 4, 3.0));
        }
        ++cells[cell];
        const glm::dvec3 f = fluxOf(v);
        const double strongest = std::max({f.x, f.y, f.z}), weakest = std::min({f.x, f.y, f.z});
        EXPECT_GT(strongest, 3 * weakest) << "saturated";
        const int order = (f.x > f.y) + 2 * (f.y > f.z) + 4 * (f.z > f.x);
        ++hues[static_cast<std::size_t>(order - 1)];
    }
    for (const int n : cells) EXPECT_GT(n, 16);  // 64 on average, fewer beside walls
    for (const int n : hues) EXPECT_NEAR(n, 4096 / 6, 150);
}

TEST(Particles, DependOnSeedAndSlotAlone) {
    const ViewSet few = makeParticles(kBox, 10, 3, 5, 10),
                  many = makeParticles(kBox, 100, 3, 5, 10);
    const ViewSet other = makeParticles(kBox, 10, 4, 5, 10);
    for (std::size_t i = 0; i < 10; ++i) {
        EXPECT_EQ(positionOf(few.views[i]), positionOf(many.views[i]));
        EXPECT_NE(positionOf(few.views[i]), positionOf(other.views[i]));
    }
}

TEST(Particles, HaveRoomInFlatAndEmptyScenes) {
    testing::RoomBuilder room;
    room.quad({0, 0, 0}, {4, 0, 0}, {0, 0, 2}, room.material(glm::vec3(1)));
    const Scene flat = room.finish();
    const SceneBounds bounds = sceneBounds(flat);
    EXPECT_EQ(bounds.min.y, bounds.max.y);
    EXPECT_NEAR(bounds.max.x - bounds.min.x, 1 - 2.0 / 64, 1e-6);
    std::set<float> heights;
    for (const View& v : makeParticles(flat, 100, 0, 1, 1).views) {
        EXPECT_GE(v.positionY, 0.0f);
        EXPECT_LE(v.positionY, 1.0f);
        heights.insert(v.positionY);
    }
    EXPECT_GT(heights.size(), 90u);
    for (const View& v : makeParticles(Scene{}, 100, 0, 1, 1).views) {
        EXPECT_GE(v.positionX, 0.25f);
        EXPECT_LE(v.positionX, 0.75f);
    }
}

TEST(RandomViews, FillTheBoxAndLookEverywhere) {
    constexpr std::uint32_t kCount = 4000;
    const ViewSet set = makeRandomViews(kBox, kCount, 5, 12);
    ASSERT_EQ(set.views.size(), kCount);
    EXPECT_EQ(set.alive(), kCount);
    glm::dvec3 place(0), squares(0), normal(0);
    double power = 0;
    for (std::uint32_t k = 0; k < kCount; ++k) {
        const View& v = set.views[k];
        EXPECT_EQ(v.slot, k);
        EXPECT_EQ(v.flags, kViewHemisphere);
        const glm::dvec3 unit =
            (positionOf(v) - glm::dvec3(kBox.min)) / glm::dvec3(kBox.max - kBox.min);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_GE(unit[axis], -1e-6);
            ASSERT_LE(unit[axis], 1 + 1e-6);
        }
        const glm::dvec3 n = testing::normalOf(v);
        ASSERT_NEAR(glm::length(n), 1, 1e-6);
        place += unit;
        squares += n * n;
        normal += n;
        power += (fluxOf(v).x + fluxOf(v).y + fluxOf(v).z) / 3;
    }
    EXPECT_NEAR(power, 12, 1e-3);
    // Five standard deviations of means over as many uniform samples.
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(place[axis] / kCount, 0.5, 5 * std::sqrt(1 / 12.0 / kCount));
        EXPECT_NEAR(normal[axis] / kCount, 0, 5 * std::sqrt(1 / 3.0 / kCount));
        EXPECT_NEAR(squares[axis] / kCount, 1 / 3.0, 5 * std::sqrt(4 / 45.0 / kCount));
    }
}

TEST(RandomViews, SlotsDependOnSeedAndSlotAlone) {
    const ViewSet few = makeRandomViews(kBox, 10, 5, 1), many = makeRandomViews(kBox, 1000, 5, 1);
    for (std::size_t k = 0; k < few.views.size(); ++k) {
        EXPECT_EQ(positionOf(few.views[k]), positionOf(many.views[k]));
        EXPECT_EQ(testing::normalOf(few.views[k]), testing::normalOf(many.views[k]));
    }
    const ViewSet other = makeRandomViews(kBox, 10, 6, 1);
    EXPECT_NE(positionOf(few.views[3]), positionOf(other.views[3]));
    EXPECT_TRUE(makeRandomViews(kBox, 0, 5, 1).views.empty());
}

}  // namespace
}  // namespace mv
