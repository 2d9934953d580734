// Views chosen by importance: as many as asked for, unbiased, and where the camera has use for
// them.

#include "megaviews/views/view_guide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "megaviews/views/view_spacing.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/view_spacing.glsl"
#include "support/sanitized.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::fluxOf;
using testing::furnishedRoom;
using testing::Lit;
using testing::normalOf;
using testing::positionOf;

ImportanceCamera lookingInto(const Lit& lit, glm::vec3 forward = {-1, -0.3f, -1}) {
    const SceneBounds bounds = sceneBounds(lit.scene);
    ImportanceCamera from;
    from.camera.position = bounds.min + (bounds.max - bounds.min) * glm::vec3(0.9f, 0.6f, 0.9f);
    from.camera.forward = glm::normalize(forward);
    from.aspect = 1.5f;
    return from;
}

// A frame's views.
ViewSet chosenViews(const Lit& lit, const ImportanceCamera& from, std::uint64_t wanted, int bounces,
                    std::uint32_t seed) {
    const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, from, bounces, seed);
    ViewSet set =
        traceVpls(lit.bvh, lit.emitters, {candidateCount(guide, wanted), bounces, seed}, &guide);
    thinViews(set, guide.importance, wanted, seed);
    return set;
}

// What all views give a place without visibility: the sum that thinning must not change.
double lightAt(const ViewSet& set, const ImportancePoint& p) {
    double sum = 0;
    for (const View& v : set.views) {
        if (v.flags == kViewDead) continue;
        const glm::vec3 to = glm::vec3(v.positionX, v.positionY, v.positionZ) -
                             glm::vec3(p.positionX, p.positionY, p.positionZ);
        sum += double{gatherTerm(to, {p.normalX, p.normalY, p.normalZ},
                                 {v.normalX, v.normalY, v.normalZ}, false, 0.02f, 0)} *
               double{viewLuminance(v)};
    }
    return sum;
}

TEST(ViewGuide, AsManyViewsLiveAsWereAskedFor) {
    for (const int lighting : {int{testing::point}, int{testing::everything}}) {
        const Lit lit(furnishedRoom(3, lighting));
        for (const std::uint64_t wanted : {16u, 256u, 2048u}) {
            const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, lookingInto(lit), 4, 7);
            ViewSet set =
                traceVpls(lit.bvh, lit.emitters, {candidateCount(guide, wanted), 4, 7}, &guide);
            thinViews(set, guide.importance, wanted, 7);
            const double off = static_cast<double>(set.alive()) - static_cast<double>(wanted);
            EXPECT_LE(std::abs(off), 4 * std::sqrt(static_cast<double>(wanted)))
                << set.alive() << " of " << wanted;
            for (const View& v : set.views) EXPECT_TRUE(std::isfinite(v.fluxR + v.fluxG + v.fluxB));
        }
    }
}

// The candidates stay; only the numbers that decide on them change.
TEST(ViewGuide, ThinningIsUnbiasedForEveryLightAndCamera) {
    const glm::vec3 ways[] = {{-1, -0.3f, -1}, {1, 0, 0}, {0, 1, 0.01f}};  // two at a wall
    for (const int lighting : {int{testing::point}, int{testing::everything}}) {
        const Lit lit(furnishedRoom(5, lighting));
        for (const glm::vec3 way : ways) {
            const ImportanceCamera from = lookingInto(lit, way);
            const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, from, 3, 1);
            const ViewSet candidates = traceVpls(lit.bvh, lit.emitters, {1200, 3, 1}, &guide);
            const auto places = importancePoints(lit.bvh, from, 99, 6);
            ASSERT_FALSE(places.empty());
            constexpr int kDraws = testing::kSanitized ? 80 : 400;
            for (const ImportancePoint& place : places) {
                double sum = 0, squares = 0;
                for (int draw = 0; draw < kDraws; ++draw) {
                    ViewSet set = candidates;
                    thinViews(set, guide.importance, 200, 1000u + static_cast<std::uint32_t>(draw));
                    const double light = lightAt(set, place);
                    sum += light;
                    squares += light * light;
                }
                const double mean = sum / kDraws;
                const double error =
                    std::sqrt(std::max(squares / kDraws - mean * mean, 0.0) / kDraws);
                const double whole = lightAt(candidates, place);
                EXPECT_LE(std::abs(mean - whole), 4.5 * error + 1e-6 * whole);
            }
        }
    }
}

// Guided paths carry the same light as unguided ones, on the mean over seeds.
TEST(ViewGuide, GuidedPathsAreUnbiased) {
    for (const int lighting : {int{testing::point}, int{testing::everything}}) {
        const Lit lit(furnishedRoom(2, lighting));
        const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, lookingInto(lit), 2, 3);
        ASSERT_FALSE(guide.cells.empty());
        EXPECT_EQ(guide.cells.back(), 1.0f);
        const auto flux = [&](const ViewGuide* with, std::uint32_t seed) {
            double sum = 0;
            for (const View& v : traceVpls(lit.bvh, lit.emitters, {4000, 2, seed}, with).views) {
                sum += double{viewLuminance(v)};
            }
            return sum;
        };
        double guided = 0, plain = 0, guided2 = 0, plain2 = 0;
        constexpr int kSeeds = 24;
        for (std::uint32_t seed = 100; seed < 100 + kSeeds; ++seed) {
            const double a = flux(&guide, seed), b = flux(nullptr, seed);
            guided += a / kSeeds;
            plain += b / kSeeds;
            guided2 += a * a / kSeeds;
            plain2 += b * b / kSeeds;
        }
        const double error = std::sqrt(
            (std::max(guided2 - guided * guided, 0.0) + std::max(plain2 - plain * plain, 0.0)) /
            kSeeds);
        EXPECT_LE(std::abs(guided - plain), 4.5 * error + 1e-9 * plain);
    }
}

TEST(ViewGuide, ChosenViewsGiveMoreThanTracedOnes) {
    const Lit lit(furnishedRoom(4, testing::everything));
    const ImportanceCamera from = lookingInto(lit);
    const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, from, 4, 0);
    ViewSet chosen = traceVpls(lit.bvh, lit.emitters, {candidateCount(guide, 256), 4, 0}, &guide);
    thinViews(chosen, guide.importance, 256, 0);
    const ViewSet traced = traceVpls(lit.bvh, lit.emitters, {256, 4, 0});
    // Of a set that is sampled by what it gives, every view gives alike.
    const auto unevenness = [&](const ViewSet& set) {
        double sum = 0, squares = 0, count = 0;
        for (const View& v : set.views) {
            if (v.flags == kViewDead) continue;
            const auto given = static_cast<double>(guide.importance.of(v));
            sum += given;
            squares += given * given;
            ++count;
        }
        return squares * count / (sum * sum);
    };
    EXPECT_LT(unevenness(chosen), 0.6 * unevenness(traced));
}

// A dim room beside a bright one, with a wall between them.
TEST(ViewGuide, ViewsLieInTheRoomThatIsSeen) {
    testing::RoomBuilder rooms;
    const int white = rooms.material(glm::vec3(0.7f));
    rooms.box({0, 0, 0}, {4, 3, 4}, white, true);
    rooms.box({4.01, 0, 0}, {8, 3, 4}, white, true);
    rooms.light(LightType::point, {2, 2.5, 2}, {0, -1, 0}, glm::vec3(100));
    rooms.light(LightType::point, {6, 2.5, 2}, {0, -1, 0}, glm::vec3(0.2f));
    const Lit lit(rooms.finish());
    const auto inSight = [&](const View& v) {
        return v.flags != kViewDead &&
               lit.scene.root.worldFromRoot(glm::vec3(v.positionX, v.positionY, v.positionZ)).x > 4;
    };
    ImportanceCamera from;
    from.camera.position = lit.scene.root.rootFromWorld({7.5, 1.5, 3.5});
    from.camera.forward = glm::normalize(glm::vec3(-1, -0.2f, -1));
    double flux = 0, squares = 0, seen = 0, all = 0;
    constexpr int kSeeds = 12;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const ViewSet set = chosenViews(lit, from, 1000, 2, seed);
        double sum = 0;
        for (const View& v : set.views) {
            if (!inSight(v)) continue;
            sum += double{viewLuminance(v)};
            ++seen;
        }
        flux += sum / kSeeds;
        squares += sum * sum / kSeeds;
        all += static_cast<double>(set.alive());
    }
    EXPECT_GT(seen, 0.2 * all);  // of the light a five-hundredth is here
    double plain = 0;
    for (const View& v : traceVpls(lit.bvh, lit.emitters, {1 << 20, 2, 77}).views) {
        if (inSight(v)) plain += double{viewLuminance(v)};
    }
    const double deviation = std::sqrt(squares - flux * flux);
    EXPECT_LT(deviation, 0.1 * flux);
    EXPECT_NEAR(flux, plain, 0.05 * plain);
}

// A room with a hole in its roof, on a ground a hundred times as wide.
TEST(ViewGuide, LightFromFarAwayFindsARoomOnAWideGround) {
    testing::RoomBuilder room;
    const int white = room.material(glm::vec3(0.7f));
    room.quad({-200, 0, 200}, {400, 0, 0}, {0, 0, -400}, white);
    for (const double x : {-2.0, 2.0}) {
        room.quad({x, 0, x}, {0, 0, -2 * x}, {0, 3, 0}, white);
        room.quad({-x, 0, x}, {2 * x, 0, 0}, {0, 3, 0}, white);
    }
    room.quad({-2, 3, -2}, {3, 0, 0}, {0, 0, 4}, white);  // a strip of 1 m is open
    room.light(LightType::directional, {0, 0, 0}, {0.3, -1, 0.1}, glm::vec3(5));
    const Lit lit(room.finish());
    ImportanceCamera from;
    from.camera.position = lit.scene.root.rootFromWorld({-1.8, 1.6, 1.8});
    from.camera.forward = glm::normalize(glm::vec3(1, -0.3f, -1));
    const auto within = [&](const View& v) {
        const glm::dvec3 p =
            lit.scene.root.worldFromRoot(glm::vec3(v.positionX, v.positionY, v.positionZ));
        return v.flags != kViewDead && std::abs(p.x) < 2.01 && std::abs(p.z) < 2.01 && p.y < 2.99;
    };
    double flux = 0;
    int seen = 0;
    constexpr int kSeeds = 12;
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
        const ViewSet set = chosenViews(lit, from, 500, 1, seed);
        for (const View& v : set.views) {
            if (!within(v)) continue;
            flux += double{viewLuminance(v)} / kSeeds;
            ++seen;
        }
    }
    EXPECT_GT(seen, kSeeds * 100);
    // What falls through the strip, of which none is lost: W, of a surface that sends on 0.7.
    const double cosine = 1 / std::sqrt(1 + 0.3 * 0.3 + 0.1 * 0.1);
    EXPECT_NEAR(flux, 0.7 * 5 * cosine * 1 * 4, 0.1 * 0.7 * 5 * cosine * 4);
}

TEST(ViewGuide, ViewsStayWhileTheCameraMovesALittle) {
    const Lit lit(furnishedRoom(6, testing::everything));
    const auto chosenFrom = [&](const ImportanceCamera& from) {
        const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, from, 4, 0);
        // The same candidates: only what is important changes.
        ViewSet set = traceVpls(lit.bvh, lit.emitters, {2048, 4, 0});
        thinViews(set, guide.importance, 512, 0);
        return set;
    };
    ImportanceCamera from = lookingInto(lit);
    const ViewSet before = chosenFrom(from);
    from.camera.position += glm::vec3(-0.01f, 0, 0);
    const ViewSet after = chosenFrom(from);
    int same = 0, lived = 0;
    for (std::size_t i = 0; i < before.views.size(); ++i) {
        if (before.views[i].flags == kViewDead) continue;
        ++lived;
        same += after.views[i].flags != kViewDead;
    }
    EXPECT_GT(same, 0.85 * lived);
    const auto points = [&](const ImportanceCamera& c) { return importancePoints(lit.bvh, c, 0); };
    EXPECT_LT(importanceChange(lit.bvh, lit.emitters, points(lookingInto(lit)), points(from), 4, 0),
              0.1);
    const ImportanceCamera away = lookingInto(lit, {1, 0.1f, 1});
    EXPECT_GT(importanceChange(lit.bvh, lit.emitters, points(lookingInto(lit)), points(away), 4, 0),
              0.1);
}

TEST(ViewGuide, ACameraThatSeesNothingSpreadsViewsByFlux) {
    const Lit lit(furnishedRoom(3, testing::point));
    ViewSet set = traceVpls(lit.bvh, lit.emitters, {1024, 4, 0});
    thinViews(set, {}, 128, 0);
    EXPECT_NEAR(static_cast<double>(set.alive()), 128, 45);
}

TEST(ViewGuide, ADarkSceneHasNoViews) {
    const Lit lit(testing::whiteRoom(0.5f).finish());
    const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, lookingInto(lit), 4, 0);
    ViewSet set = traceVpls(lit.bvh, lit.emitters, {candidateCount(guide, 64), 4, 0}, &guide);
    thinViews(set, guide.importance, 64, 0);
    EXPECT_EQ(set.alive(), 0u);
}

// ---------------------------------------------------------------- spacing

// A grid of equal views on a plane stands for its cells: pi c^2 is the area of one, or somewhat
// more where the Morton curve misses a neighbour.
TEST(ViewSpacing, OfAGridIsItsCell) {
    std::vector<View> views;
    constexpr int kEdge = 16;
    constexpr float kStep = 0.02f;
    for (int y = 0; y < kEdge; ++y) {
        for (int x = 0; x < kEdge; ++x) {
            views.push_back(vplAt(
                {0.2f + kStep * static_cast<float>(x), 0.5f, 0.2f + kStep * static_cast<float>(y)},
                {0, 1, 0}, {1, 1, 1}, 1, static_cast<uint>(views.size())));
        }
    }
    double sum = 0;
    for (const float c : clampDistances(views)) {
        const double radius = double{c} / double{kClampSpread};  // of the view's patch
        sum += kPi * radius * radius;
    }
    const double cells = kEdge * kEdge * double{kStep} * double{kStep};
    EXPECT_GT(sum, 0.5 * cells);
    EXPECT_LT(sum, 2.5 * cells);
    // A view that carries more stands for more, and one that faces elsewhere is no neighbour.
    const float before = clampDistances(views)[100];
    views[100].fluxR = views[100].fluxG = views[100].fluxB = 4;
    EXPECT_GT(clampDistances(views)[100], 1.3f * before);
    for (View& v : views) v.normalY = -1;
    views[100].normalY = 1;
    EXPECT_EQ(clampDistances(views)[100], kMaxClampDistance);
}

// A room of a thousandth of the root cube, a few views all over the rest: it is clamped as if it
// were alone.
TEST(ViewSpacing, OfARoomOnWideGroundIsThatOfTheRoom) {
    std::vector<View> views;
    constexpr float kStep = 2e-5f;
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            views.push_back(vplAt(
                {0.2f + kStep * static_cast<float>(x), 0.5f, 0.2f + kStep * static_cast<float>(y)},
                {0, 1, 0}, {1, 1, 1}, 1, static_cast<uint>(views.size())));
        }
    }
    for (int i = 0; i < 24; ++i) {
        const float at = 0.3f + 0.025f * static_cast<float>(i);
        views.push_back(vplAt({at, 0.4f, 1 - at}, {0, 1, 0}, {1, 1, 1}, 1, 0));
    }
    std::vector<float> distances = clampDistances(views);
    distances.resize(256);
    std::nth_element(distances.begin(), distances.begin() + 128, distances.end());
    EXPECT_LT(distances[128], 4 * kClampSpread * kStep);
}

// However many views one cell holds, in any order, each stands for its own patch.
TEST(ViewSpacing, OfACrowdedCellIsThatOfItsDensity) {
    for (const uint count : {512u, 8192u}) {
        std::vector<View> views;
        constexpr float kEdge = 0.9f / 1024;
        for (uint i = 0; i < count; ++i) {
            const vec4 r = random4(4, i, 0, 0);
            const vec3 at = vec3(r.x, 0, r.y) * kEdge + vec3(0.25f, 0.5f, 0.25f);
            views.push_back(vplAt(at, {0, 1, 0}, {1, 1, 1}, 1, i));
        }
        std::vector<float> distances = clampDistances(views);
        std::nth_element(distances.begin(), distances.begin() + count / 2, distances.end());
        const float radius = kEdge / std::sqrt(kPi * static_cast<float>(count));
        EXPECT_NEAR(distances[count / 2] / (kClampSpread * radius), 1, 0.2) << count;
    }
}

TEST(ViewSpacing, ParticlesAreClampedAsPoints) {
    View particle = vplAt({0.5f, 0.5f, 0.5f}, {0, 0, 0}, {1, 1, 1}, 0, 0);
    particle.flags = kViewOmnidirectional;
    const std::vector<View> views(40, particle);
    for (const float c : clampDistances(views)) EXPECT_EQ(c, kPointClampDistance);
    EXPECT_TRUE(clampDistances({}).empty());
}

}  // namespace
}  // namespace mv
