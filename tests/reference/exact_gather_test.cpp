// The exact gather against sums without visibility where everything is visible, and against brute
// force where it is not.

#include "megaviews/references/exact_gather.h"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/reference_scenes.h"
#include "shaders/shared/gather.glsl"

namespace mv {
namespace {

using glm::dvec3;
using testing::furnishedRoom;
using testing::Lit;
using testing::receiversInside;
using testing::traced;
using testing::whiteRoom;

IrradianceImage gathered(const Lit& lit, const ViewSet& set, const std::vector<Receiver>& receivers,
                         ExactGatherOptions options = {}) {
    const EmbreeScene embree(lit.bvh);
    IrradianceImage image;
    exactGather(embree, set.views, receivers, static_cast<int>(receivers.size()), 1, options,
                image);
    EXPECT_TRUE(image.done());
    EXPECT_TRUE(image.variance.empty());
    return image;
}

double relative(glm::vec3 a, dvec3 b) {
    return glm::length(dvec3(a) - b) / (glm::length(b) + 1e-12);
}

TEST(ExactGather, InAConvexRoomEverythingIsVisible) {
    testing::RoomBuilder builder = whiteRoom(0.7f);
    builder.light(LightType::point, {1, 2, 1}, {0, -1, 0}, {3, 2, 1});
    const Lit lit(builder.finish());
    const ViewSet set = lit.trace(3000, 3);
    // On the floor as a G-buffer has it, up to the walls, and in free space.
    std::vector<Receiver> receivers = receiversInside(5, 40, 0.25f);
    const SceneBounds b = sceneBounds(lit.scene);
    for (uint i = 0; i < 80; ++i) {
        const vec4 r = random4(6, i, 0, 0);
        const vec3 s = i < 8 ? vec3(i & 1u ? 0.999f : 0.001f, 0, i & 2u ? 0.9995f : 0.0005f)
                             : vec3(r.x, 0, r.y);
        receivers.push_back(
            {b.min + s * (b.max - b.min) + vec3(0, (r.z - 0.5f) * 4e-6f, 0), vec3(0, 1, 0)});
    }
    const IrradianceImage exact = gathered(lit, set, receivers);
    const IrradianceImage open = gathered(lit, set, receivers, {.visibility = false});
    EXPECT_TRUE(testing::sameBytes(exact.mean, open.mean));

    const ViewHierarchy views = ViewHierarchy::build(set.views, {});
    GatherReferenceOptions options;
    options.worldEdge = static_cast<float>(lit.scene.root.edge);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const dvec3 expected = gatherAll(receivers[i], views, nullptr, options);
        EXPECT_GT(expected.x, 0);
        EXPECT_LT(relative(exact.mean[i], expected), 1e-6) << i;
    }
}

// Does any triangle stand between the two points? In double, one triangle after another.
bool blocked(const Scene& scene, dvec3 from, dvec3 to) {
    const dvec3 d = to - from;
    for (const glm::uvec3& t : scene.triangles) {
        const dvec3 a(scene.positions[t.x]), e1 = dvec3(scene.positions[t.y]) - a,
                                             e2 = dvec3(scene.positions[t.z]) - a;
        const dvec3 p = glm::cross(d, e2);
        const double det = glm::dot(e1, p);
        if (det == 0) continue;
        const dvec3 s = from - a, q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
        const double along = glm::dot(e2, q) / det;
        if (u >= 0 && v >= 0 && u + v <= 1 && along > 0 && along < 1) return true;
    }
    return false;
}

TEST(ExactGather, EqualsBruteForceBehindOccluders) {
    testing::RoomBuilder builder = whiteRoom(0.5f);
    builder.box({1, 0, 1}, {2, 1.5, 2}, builder.material({0.8f, 0.3f, 0.2f}));
    builder.box({2.5, 1, 3}, {3, 2.6, 3.1}, builder.material({0.2f, 0.3f, 0.9f}));
    builder.light(LightType::point, {0.5, 2.5, 4}, {0, -1, 0}, {3, 2, 1});
    const Lit lit(builder.finish());
    const ViewSet set = lit.trace(1500, 2);
    const std::vector<Receiver> receivers = receiversInside(9, 60, 0.2f);
    const IrradianceImage exact = gathered(lit, set, receivers, {.clampDistance = 0.03f});
    const double edge2 = lit.scene.root.edge * lit.scene.root.edge;
    std::uint64_t hidden = 0, lights = 0, dark = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        dvec3 sum(0), largest(0);
        const Receiver& r = receivers[i];
        for (const View& v : set.views) {
            if (v.flags == kViewDead) continue;
            // The same term, written out in double.
            const dvec3 way = testing::positionOf(v) - dvec3(r.position);
            const double d2 = glm::dot(way, way), d = std::sqrt(d2);
            const double cosX = std::max(0.0, glm::dot(dvec3(r.normal), way) / d);
            const double cosV = std::max(0.0, -glm::dot(testing::normalOf(v), way) / d);
            const double m2 = std::max(d2, 0.03 * 0.03), fall = d2 / (m2 * m2);
            const dvec3 e = testing::fluxOf(v) * (cosX * cosV / glm::pi<double>() * fall / edge2);
            if (e.x == 0) continue;
            ++lights;
            largest = glm::max(largest, e);
            if (blocked(lit.scene, dvec3(r.position + r.normal * kVplOffset),
                        testing::positionOf(v))) {
                ++hidden;
                continue;
            }
            sum += e;
        }
        // A ray along an edge may go either way: one view.
        EXPECT_LE(std::abs(double{exact.mean[i].x} - sum.x), 1e-5 * sum.x + 1e-12)
            << i << ", largest " << largest.x;
        dark += sum.x == 0;
    }
    EXPECT_GT(hidden, lights / 20);
    EXPECT_LT(hidden, lights / 2 + lights / 4);
    EXPECT_LT(dark, receivers.size() / 2);
}

TEST(ExactGather, HonoursAlphaMasksAsOurOwnRaysDo) {
    const Lit lit(furnishedRoom(4, testing::point));
    ASSERT_TRUE(lit.bvh.flags & kBvhMasks);
    const ViewSet set = lit.trace(2000, 3);
    const std::vector<Receiver> receivers = receiversInside(2, 60, 0.25f);
    const IrradianceImage exact = gathered(lit, set, receivers);
    Lit solid(furnishedRoom(4, testing::point));
    for (Material& m : solid.scene.materials) m.alphaCutoff = 0;
    solid.bvh = TriangleBvh::build(solid.scene);
    const IrradianceImage opaque = gathered(solid, set, receivers);
    int differ = 0, throughMask = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const Receiver& r = receivers[i];
        const vec3 from = r.position + r.normal * kVplOffset;
        dvec3 sum(0);
        for (const View& v : set.views) {
            if (v.flags == kViewDead) continue;
            const vec3 to(v.positionX, v.positionY, v.positionZ);
            const float term =
                gatherTerm(to - r.position, r.normal, vec3(testing::normalOf(v)), false, 0.01f, 0);
            if (term > 0 && !lit.bvh.occluded(from, to - from, 0, 1)) {
                sum += double{term} * testing::fluxOf(v);
            }
        }
        sum /= lit.scene.root.edge * lit.scene.root.edge;
        differ += relative(exact.mean[i], sum) > 1e-5;
        throughMask += exact.mean[i] != opaque.mean[i];
    }
    EXPECT_LE(differ, 2);  // rays along the edge of a box or of a hole may go either way
    EXPECT_GT(throughMask, 10);
}

// What a clamp at c takes of the light of a floor from a receiver that looks down on it from height
// h < c: the integral of 1 - r^4 / c^4 over the cosines whose rays meet it at r = h / cosine < c.
double takenAbove(double h, double c) {
    const double a = h / c;
    return (1 - a * a) * (1 - a * a);
}

struct Floor : Lit {
    explicit Floor(testing::RoomBuilder builder, const Environment& environment = {})
        : Lit(builder.finish(), 1, environment) {}
    vec3 middle() const { return vec3(scene.root.rootFromWorld({0, 0, 0})); }
    std::vector<Receiver> over(float h) const {
        return {{middle() + vec3(0, h, 0), vec3(0, -1, 0)}};
    }
};

constexpr double kFloorSize = 4;  // m
int addFloor(testing::RoomBuilder& builder, glm::vec3 albedo, glm::vec3 emission = glm::vec3(0)) {
    const int material = builder.material(albedo, emission);
    builder.quad({-kFloorSize / 2, 0, kFloorSize / 2}, {kFloorSize, 0, 0}, {0, 0, -kFloorSize},
                 material);
    return material;
}

constexpr float kNearClamp = 0.05f;
ExactGatherOptions nearField(const Lit& lit, int rays = 8192) {
    ExactGatherOptions options{.clampDistance = kNearClamp};
    options.nearFieldRays = rays;
    options.lights = lit.emitters.lights;
    options.sky = lit.emitters.sky;
    return options;
}

TEST(ExactGather, WhatGlowsGivesItsOwnLightBack) {
    testing::RoomBuilder builder;
    addFloor(builder, glm::vec3(0), glm::vec3(2));
    const Floor lit(builder);
    const float lambert = 2 * glm::pi<float>();
    const auto edge = static_cast<float>(lit.scene.root.edge);
    View view{};  // gives pi L at its clamp distance
    view.positionX = lit.middle().x, view.positionY = lit.middle().y + kVplOffset;
    view.positionZ = lit.middle().z;
    view.normalY = 1;
    view.fluxR = view.fluxG = view.fluxB =
        lambert * glm::pi<float>() * kNearClamp * kNearClamp * edge * edge;
    view.flags = kViewHemisphere;
    for (const float h : {0.025f, 0.03f}) {
        const float a = h / kNearClamp;
        const float clamped =
            gathered(lit, {{view}}, lit.over(h), {.clampDistance = kNearClamp}).mean[0].x;
        EXPECT_NEAR(clamped, a * a * lambert, 3e-3f * lambert);
        ExactGatherOptions options = nearField(lit);
        options.emissionScale = 1;
        const float whole = gathered(lit, {{view}}, lit.over(h), options).mean[0].x;
        EXPECT_NEAR(whole - clamped, takenAbove(h, kNearClamp) * lambert, 0.015f * lambert) << h;
    }
}

// A floor that reflects what lights it: as much of that comes back, whatever it is; but not what a
// wall keeps from it, nor views at the end of their paths, which light nothing that reflects on.
TEST(ExactGather, WhatLightsANearSurfaceComesBack) {
    const float h = 0.02f;
    const double taken = takenAbove(h, kNearClamp);
    const glm::vec3 albedo(0.5f, 0.25f, 0.125f);
    // A view right below the receiver, at the end of its path: it lights it so much that what is
    // added is not bounded, and nothing else.
    const auto below = [](const Floor& floor) {
        View v{};
        v.positionX = floor.middle().x, v.positionZ = floor.middle().z;
        v.positionY = floor.middle().y + kVplOffset;
        v.normalY = 1;
        v.fluxR = v.fluxG = v.fluxB = 100;
        v.flags = kViewHemisphere;
        v.bounce = 99;
        return v;
    };
    const auto expectGiven = [&](const Floor& floor, const std::vector<View>& views,
                                 const ExactGatherOptions& options, dvec3 irradiance) {
        ExactGatherOptions without = options;
        without.nearFieldRays = 0;
        const dvec3 added = dvec3(gathered(floor, {views}, floor.over(h), options).mean[0]) -
                            dvec3(gathered(floor, {views}, floor.over(h), without).mean[0]);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(added[c], taken * double{albedo[c]} * irradiance[c],
                        0.03 * taken * double{albedo[c]} * irradiance[c] + 1e-4)
                << c;
        }
    };
    for (const bool walled : {false, true}) {
        testing::RoomBuilder builder;
        const int material = addFloor(builder, albedo);
        if (walled) builder.box({-1, 1, -1}, {1, 1.1, 1}, material);
        builder.light(LightType::directional, {0, 2, 0}, {0, -1, 0}, {3, 5, 7});
        const Floor sun(builder);
        expectGiven(sun, {below(sun)}, nearField(sun), walled ? dvec3(0) : dvec3(3, 5, 7));
    }
    // Gloss above it reflects more.
    testing::RoomBuilder shiny;
    Material coated;
    coated.baseColor = glm::vec4(albedo, 1);
    coated.specular = 0.3f;
    coated.roughness = 0.5f;
    shiny.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, shiny.material(coated));
    shiny.light(LightType::directional, {0, 2, 0}, {0, -1, 0}, {3, 5, 7});
    const Floor gloss(shiny);
    ExactGatherOptions glossy = nearField(gloss);
    const float matt = gathered(gloss, {{below(gloss)}}, gloss.over(h), glossy).mean[0].x;
    glossy.gloss = true;
    EXPECT_GT(gathered(gloss, {{below(gloss)}}, gloss.over(h), glossy).mean[0].x, matt + 0.1f);

    testing::RoomBuilder open;
    addFloor(open, albedo);
    const Floor white(open, {.settings = {.source = "white"}, .image = nullptr});
    expectGiven(white, {below(white)}, nearField(white), dvec3(glm::pi<double>()));

    const Floor dark(open);
    View above = below(dark);
    above.positionY += 0.5f;
    above.normalY = -1;
    above.bounce = 1;
    ExactGatherOptions options = nearField(dark);
    const double distance = 0.5 * dark.scene.root.edge;
    const double fromView = 100 / (glm::pi<double>() * distance * distance);
    expectGiven(dark, {above, below(dark)}, options, dvec3(fromView));
    options.bounces = 1;
    expectGiven(dark, {above, below(dark)}, options, dvec3(0));
}

// A pane of colour over all of the receiver's sky, of which the path tracer knows the same.
TEST(ExactGather, WhatIsClearTintsTheSky) {
    const glm::vec3 colour(0.81f, 0.25f, 0.04f);
    for (const bool pane : {false, true}) {
        testing::RoomBuilder builder;
        addFloor(builder, glm::vec3(0));
        Material glass;
        glass.baseColor = glm::vec4(colour, 1);
        glass.transmission = 1;
        const int material = builder.material(glass);
        if (pane) builder.quad({-99, 0.1, 99}, {198, 0, 0}, {0, 0, -198}, material);
        const Floor lit(builder, {{.source = "white"}, nullptr});
        ExactGatherOptions options;
        options.sky = lit.emitters.sky;
        options.skyRays = 4096;
        options.gloss = true;
        const glm::vec3 given =
            gathered(lit, {}, {{lit.middle() + vec3(0, 1e-5f, 0), vec3(0, 1, 0)}}, options).mean[0];
        const float white = glm::pi<float>();
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(given[c], pane ? white * colour[c] : white, 0.02f * white) << c;
        }
    }
}

// A bent normal sends rays below the receiver's own triangle, which has no light for them.
TEST(ExactGather, NothingNearComesFromBelowTheSurface) {
    testing::RoomBuilder builder;
    addFloor(builder, glm::vec3(0), glm::vec3(2));
    const Floor lit(builder);
    ExactGatherOptions options = nearField(lit);
    options.emissionScale = 1;
    View view{};  // behind the floor: it is there, and gives nothing
    view.positionY = -1;
    view.normalY = -1;
    view.flags = kViewHemisphere;
    Receiver bent{lit.middle(), glm::normalize(vec3(1, 0.5f, 0))};
    EXPECT_GT(gathered(lit, {{view}}, {bent}, options).mean[0].x, 0);
    bent.plane = vec3(0, 1, 0);
    EXPECT_EQ(gathered(lit, {{view}}, {bent}, options).mean[0].x, 0);
}

// Where a wall meets the floor the clamp takes a good part of the light that paths find there, and
// most of that comes back.
TEST(ExactGather, CornersHaveTheLightOfPaths) {
    testing::RoomBuilder builder = whiteRoom(0.7f);
    builder.light(LightType::point, {1, 2, 1}, {0, -1, 0}, {3, 2, 1});
    const Lit lit(builder.finish());
    const SceneBounds b = sceneBounds(lit.scene);
    std::vector<Receiver> receivers;
    for (int i = 0; i < 24; ++i) {
        const vec3 s((static_cast<float>(i) + 0.5f) / 24, 0,
                     0.004f + 0.0005f * static_cast<float>(i));
        receivers.push_back({b.min + s * (b.max - b.min), vec3(0, 1, 0)});
    }
    dvec3 paths(0), clamped(0), whole(0);
    for (const glm::vec3& light : traced(lit, receivers, {3, 4000, 1}).mean) paths += dvec3(light);
    constexpr int kSets = 6;
    for (int seed = 0; seed < kSets; ++seed) {
        const ViewSet views = lit.trace(1500, 3, static_cast<std::uint32_t>(seed));
        ExactGatherOptions options = nearField(lit, 256);
        options.clampDistance.reset();
        options.bounces = 3;
        options.seed = static_cast<std::uint32_t>(seed);
        for (const glm::vec3& light : gathered(lit, views, receivers, options).mean) {
            whole += dvec3(light) / double(kSets);
        }
        options.nearFieldRays = 0;
        for (const glm::vec3& light : gathered(lit, views, receivers, options).mean) {
            clamped += dvec3(light) / double(kSets);
        }
    }
    // What lights near surfaces is clamped, too.
    for (int c = 0; c < 3; ++c) {
        const double before = 1 - clamped[c] / paths[c], after = 1 - whole[c] / paths[c];
        EXPECT_GT(before, 0.2);
        EXPECT_LT(after, before / 3);
        EXPECT_GT(after, -0.03);
    }
}

TEST(ExactGather, ParticlesShineAllAround) {
    const Lit lit(whiteRoom(0.5f).finish());
    View particle{};
    particle.positionX = particle.positionY = particle.positionZ = 0.5f;
    particle.flags = kViewOmnidirectional;
    particle.fluxR = 4 * glm::pi<float>();
    const ViewSet set{{particle, View{}}};
    for (const vec3 side : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 0, 1)}) {
        const IrradianceImage image = gathered(lit, set, {{vec3(0.5f) + 0.2f * side, -side}});
        const double r = 0.2 * lit.scene.root.edge;
        EXPECT_NEAR(image.mean[0].x, 1 / (r * r), 1e-5 / (r * r));  // I / r^2, I = 1 W/sr
        EXPECT_EQ(image.mean[0].y, 0);
    }
}

TEST(ExactGather, GivesTheSameBytesForAnyThreadsAndWhenResumed) {
    const Lit lit(furnishedRoom(1, testing::everything));
    const ViewSet set = lit.trace(500, 3);
    std::vector<Receiver> receivers = receiversInside(7, 13 * 7, 0.1f);
    receivers[17].normal = vec3(0);  // no surface there
    const IrradianceImage image = testing::expectRepeatable(
        [&](IrradianceImage& out, const Progress& progress) {
            const EmbreeScene embree(lit.bvh);
            exactGather(embree, set.views, receivers, 13, 7, {}, out, progress);
        },
        7);
    EXPECT_EQ(image.mean[17], vec3(0));
    EXPECT_NE(image.mean[18], vec3(0));
}

TEST(ExactGather, OfNothing) {
    const Lit empty{testing::RoomBuilder().finish()};
    const EmbreeScene embree(empty.bvh);
    IrradianceImage none, dark;
    exactGather(embree, {}, {}, 0, 0, {}, none);
    EXPECT_TRUE(none.done() && none.mean.empty());
    const std::vector<Receiver> one = {{vec3(0.5f), vec3(0, 1, 0)}};
    exactGather(embree, std::vector<View>(5), one, 1, 1, {}, dark);
    EXPECT_EQ(dark.mean.at(0), vec3(0));
    testing::RoomBuilder builder;
    addFloor(builder, vec3(0.5f));
    builder.light(LightType::directional, {0, 2, 0}, {0, -1, 0}, {3, 5, 7});
    const Floor sun(builder);
    EXPECT_EQ(gathered(sun, {std::vector<View>(5)}, sun.over(0.02f), nearField(sun, 8)).mean[0],
              vec3(0))
        << "a near field of no views";
}

}  // namespace
}  // namespace mv
