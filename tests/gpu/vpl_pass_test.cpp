// VPLs traced on the GPU against their CPU twin, slot by slot.

#include "renderer/passes/vpl_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "gl/gl_fixture.h"
#include "megaviews/views/view_guide.h"
#include "views/rooms.h"

namespace mv {
namespace {

using testing::fluxOf;
using testing::furnishedRoom;
using testing::Lit;
using testing::normalOf;
using testing::positionOf;
using testing::RoomBuilder;
using testing::whiteRoom;

class VplPassTest : public GlTest {
  protected:
    static ViewSet onGpu(VplPass& pass, const Emitters& emitters, const VplOptions& options) {
        gl::Profiler profiler;
        GpuViews views;
        pass.trace(emitters, options, nullptr, profiler, views);
        EXPECT_EQ(views.count, options.count);
        expectNoGlErrors();
        return {views.views.read(0, views.count)};
    }

    // Paths part for good where rounding sends a ray past another edge; all else agrees closely.
    static void expectTwins(const ViewSet& gpu, const ViewSet& cpu, std::uint32_t pathSlots) {
        ASSERT_EQ(gpu.views.size(), cpu.views.size());
        std::size_t parted = 0, exact = 0;
        for (std::size_t i = 0; i < gpu.views.size(); ++i) {
            const View &a = gpu.views[i], &b = cpu.views[i];
            exact += std::memcmp(&a, &b, sizeof a) == 0;
            const double fluxError = glm::length(fluxOf(a) - fluxOf(b));
            const bool same = a.flags == b.flags && a.bounce == b.bounce && a.slot == b.slot &&
                              glm::length(positionOf(a) - positionOf(b)) < 2e-5 &&
                              glm::length(normalOf(a) - normalOf(b)) < 2e-4 &&
                              fluxError <= 1e-3 * glm::length(fluxOf(b));
            parted += !same;
            if (a.flags == kViewDead) {
                const View zero{};
                EXPECT_EQ(std::memcmp(&a, &zero, sizeof a), 0) << "slot " << i;
            }
        }
        EXPECT_LE(parted, pathSlots + gpu.views.size() / 500) << "of " << gpu.views.size();
        RecordProperty("exactShare", std::to_string(static_cast<double>(exact) /
                                                    static_cast<double>(cpu.views.size())));
    }
};

TEST_F(VplPassTest, AgreesWithItsTwinAtAwkwardSizes) {
    for (const int lighting : {int{testing::point}, int{testing::everything}}) {
        const Lit lit(furnishedRoom(1, lighting));
        VplPass pass;
        pass.setScene(lit.scene, lit.bvh);
        for (const int bounces : {1, 4}) {
            for (const std::uint64_t count : {0u, 1u, 7u, 8u, 9u, 63u, 64u, 65u, 1000u}) {
                SCOPED_TRACE(::testing::Message() << lighting << ", " << count << " / " << bounces);
                const VplOptions options{count, bounces, 7};
                expectTwins(onGpu(pass, lit.emitters, options),
                            traceVpls(lit.bvh, lit.emitters, options), 0);
            }
        }
    }
}

TEST_F(VplPassTest, AgreesWithItsTwinForEachKindOfLight) {
    std::uint32_t seed = 30;
    for (const int lighting : {testing::point, testing::spot, testing::sun, testing::panel}) {
        SCOPED_TRACE(lighting);
        const Lit lit(furnishedRoom(seed++, lighting));
        VplPass pass;
        pass.setScene(lit.scene, lit.bvh);
        EXPECT_GT(pass.bytes(), 1000u);
        const VplOptions options{4000, 4, 3};
        const ViewSet cpu = traceVpls(lit.bvh, lit.emitters, options);
        EXPECT_GT(cpu.alive(), 100u);
        expectTwins(onGpu(pass, lit.emitters, options), cpu, 4);
    }
}

// Beside a lamp, guided and not. The sky is a gradient: cells of every size of share.
TEST_F(VplPassTest, AgreesWithItsTwinUnderASky) {
    RoomBuilder court;
    const int stone = court.material(glm::vec3(0.7f, 0.6f, 0.5f));
    court.quad({0, 0, 0}, {0, 0, 5}, {4, 0, 0}, stone);
    court.quad({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, stone);
    court.box({1, 0, 1}, {2, 1, 2}, stone);
    court.light(LightType::point, {1, 2.7, 1}, {0, -1, 0}, {0.5f, 0.4f, 0.3f});
    const Lit lit(court.finish(), 1, {.settings = {.source = "sky"}, .image = nullptr});
    ASSERT_TRUE(lit.emitters.sky);
    VplPass pass;
    pass.setScene(lit.scene, lit.bvh);
    const VplOptions options{4000, 3, 3};
    const ViewSet cpu = traceVpls(lit.bvh, lit.emitters, options);
    EXPECT_GT(cpu.alive(), 500u);
    expectTwins(onGpu(pass, lit.emitters, options), cpu, 4);

    ImportanceCamera camera;
    camera.camera.position = lit.scene.root.rootFromWorld({2, 2, 4.5});
    camera.camera.forward = glm::normalize(glm::vec3(0, -0.3f, -1));
    const ViewGuide guide = makeViewGuide(lit.bvh, lit.emitters, camera, 3, 1);
    ASSERT_FALSE(guide.cells.empty());
    gl::Profiler profiler;
    GpuViews views;
    pass.trace(lit.emitters, options, &guide, profiler, views);
    expectTwins({views.views.read(0, views.count)},
                traceVpls(lit.bvh, lit.emitters, options, &guide), 4);
}

TEST_F(VplPassTest, SceneWithoutTexturesColoursOrLights) {
    RoomBuilder room = whiteRoom(0.5f);
    room.light(LightType::point, {1, 1, 1}, {0, -1, 0}, {1, 2, 3});
    const Lit lit(room.finish());
    VplPass pass;
    pass.setScene(lit.scene, lit.bvh);
    const VplOptions options{100, 3, 0};
    expectTwins(onGpu(pass, lit.emitters, options), traceVpls(lit.bvh, lit.emitters, options), 0);
    // The light goes out, and on again.
    EXPECT_EQ(onGpu(pass, Emitters{}, options).alive(), 0u);
    EXPECT_EQ(onGpu(pass, lit.emitters, options).alive(), 100u);

    // No triangle at all, then another scene in the same pass.
    RoomBuilder nothing;
    nothing.light(LightType::directional, {0, 0, 0}, {0, -1, 0}, {1, 1, 1});
    const Lit none(nothing.finish());
    pass.setScene(none.scene, none.bvh);
    EXPECT_EQ(onGpu(pass, none.emitters, options).alive(), 0u);
    const Lit masked(furnishedRoom(5, testing::everything));
    pass.setScene(masked.scene, masked.bvh);
    expectTwins(onGpu(pass, masked.emitters, options),
                traceVpls(masked.bvh, masked.emitters, options), 4);
}

TEST_F(VplPassTest, VertexColoursAndScaledEmittersReachTheGpu) {
    Scene scene = furnishedRoom(6, testing::panel);
    for (std::size_t i = 0; i < scene.positions.size(); ++i) {
        const vec4 r = random4(1, static_cast<uint>(i), 0, 0);
        scene.colors.push_back({r.x, r.y, r.z, 1});
    }
    const Lit lit(std::move(scene), 2.5);
    VplPass pass;
    pass.setScene(lit.scene, lit.bvh);
    const VplOptions options{2000, 2, 1};
    expectTwins(onGpu(pass, lit.emitters, options), traceVpls(lit.bvh, lit.emitters, options), 2);
}

TEST_F(VplPassTest, LightBouncesOffGlossWhereItIsAskedTo) {
    Scene scene = furnishedRoom(6, testing::panel);
    for (Material& material : scene.materials) material.specular = 0.2f;
    const Lit lit(std::move(scene));
    VplPass pass;
    pass.setScene(lit.scene, lit.bvh);
    VplOptions options{2000, 2, 1};
    double flux[2] = {};
    for (const bool gloss : {false, true}) {
        options.gloss = gloss;
        const ViewSet views = onGpu(pass, lit.emitters, options);
        expectTwins(views, traceVpls(lit.bvh, lit.emitters, options), 2);
        for (const View& view : views.views) {
            if (view.bounce > 0) flux[gloss ? 1 : 0] += double{view.fluxG};
        }
    }
    EXPECT_GT(flux[1], 1.1 * flux[0]);
}

// Behind a coloured pane all views have its colour, and those of another scene after it do not.
TEST_F(VplPassTest, WhatIsClearTintsPaths) {
    const glm::vec3 colour(0.81f, 0.25f, 0.04f);
    Material glass;
    glass.transmission = 1;
    glass.baseColor = glm::vec4(colour, 1);
    VplPass pass;
    VplOptions options{1000, 1, 0};
    options.gloss = true;
    for (const bool pane : {true, false}) {
        RoomBuilder room = whiteRoom(0.5f);
        room.light(LightType::spot, {2, 1.5, 1}, {0, 0, 1}, {1, 1, 1}, 0.1, 0.2);
        if (pane) room.quad({0, 0, 2}, {4, 0, 0}, {0, 3, 0}, room.material(glass));
        const Lit lit(room.finish());
        pass.setScene(lit.scene, lit.bvh);
        const ViewSet views = onGpu(pass, lit.emitters, options);
        expectTwins(views, traceVpls(lit.bvh, lit.emitters, options), 0);
        glm::dvec3 flux(0);
        for (const View& view : views.views) flux += fluxOf(view);
        for (int i = 0; i < 3; ++i) {
            const double expected = pane ? static_cast<double>(colour[i] / colour[0]) : 1;
            EXPECT_NEAR(flux[i] / flux[0], expected, 1e-5) << i;
        }
    }
}

TEST_F(VplPassTest, RunsAlikeTwice) {
    const Lit lit(furnishedRoom(7, testing::everything));
    VplPass pass;
    pass.setScene(lit.scene, lit.bvh);
    const VplOptions options{3000, 4, 1};
    const ViewSet a = onGpu(pass, lit.emitters, options), b = onGpu(pass, lit.emitters, options);
    EXPECT_EQ(std::memcmp(a.views.data(), b.views.data(), 3000 * sizeof(View)), 0);
}

TEST_F(VplPassTest, UploadsAnyViewSet) {
    const ViewSet set = makeParticles(SceneBounds{}, 100, 1, 0, 5);
    GpuViews views;
    upload(set, views);
    ASSERT_EQ(views.count, 100u);
    const std::vector<View> back = views.views.read(0, 100);
    EXPECT_EQ(std::memcmp(back.data(), set.views.data(), 100 * sizeof(View)), 0);
    upload(ViewSet{}, views);
    EXPECT_EQ(views.count, 0u);
}

}  // namespace
}  // namespace mv
