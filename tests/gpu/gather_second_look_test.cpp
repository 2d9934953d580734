// Pixels that the filter lights though all their samples were blocked: dark ones are dark again,
// unlucky ones keep the filter's light.

#include "gpu/gather_fixture.h"
#include "renderer/visibility.h"
#include "shaders/shared/random.glsl"

namespace mv {
namespace {

using test::GatherGpu;

constexpr int kSize = 32;

// A patch of the room's floor, pixels 1e-3 apart, with its corner there.
GBuffer floorAt(float x, float z) {
    std::vector<float> positions, normals;
    for (int i = 0; i < kSize * kSize; ++i) {
        const float u = static_cast<float>(i % kSize) * 1e-3f;
        const float v = static_cast<float>(i / kSize) * 1e-3f;
        positions.insert(positions.end(), {x + u, 0.125f, z + v, 1});
        normals.insert(normals.end(), {0, 1, 0, 0.03f});
    }
    return test::Room::makeGBuffer(kSize, kSize, positions, normals);
}

struct Picture {
    std::vector<float> light, unfiltered, candidates;
    double mean = 0;  // of the light
    int doubted = 0;  // pixels that have light, but none of whose samples was seen to pass
};

// Eight samples of exact rays against the scene.
Picture pictureOf(const Scene& scene, const GBuffer& gbuffer, const std::vector<View>& views,
                  bool secondLook, const GpuViewMaps& maps = {}) {
    const TriangleBvh bvh = TriangleBvh::build(scene);
    BvhTables triangles;
    triangles.setScene(scene, bvh);
    GatherOptions options = test::plainOptions();
    options.samples = 8;
    options.secondLook = secondLook;
    options.sample = shadowRaySample(triangles);
    if (maps.present) options.sampleAsked = SampleAsked::inDoubt;
    const GpuViewHierarchy tree = upload(ViewHierarchy::build(views, {.levels = 5}));
    gl::Profiler profiler;
    GatherResult result;
    test::gatherOnce(GatherGpu::pass(), gbuffer, scene.root, tree, maps, options, profiler, result);
    EXPECT_EQ(gl::reportedErrors(), 0u);
    Picture p{result.irradiance.readFloats(4), result.unfiltered.readFloats(4),
              result.candidates.readFloats(4)};
    for (std::size_t i = 0; i < p.light.size(); i += 4) {
        p.mean += double{p.light[i]} / (kSize * kSize);
        p.doubted += p.candidates[i + 2] > 0 && p.light[i] > 0;
    }
    return p;
}

// A box over one pixel, whose neighbours are lit. Maps that let all light through are no evidence.
TEST_F(GatherGpu, ADarkPixelAmongLitOnesIsDarkOnASecondLook) {
    constexpr std::size_t kDark = 4 * (16 * kSize + 17);
    constexpr float kX = 0.7f, kZ = 0.7f;
    const vec3 p(kX + 17e-3f, 0.125f, kZ + 16e-3f);
    Scene scene = test::roomScene();
    test::addBox(scene, p - vec3(0.4e-3f, 1e-3f, 0.4e-3f), p + vec3(0.4e-3f, 2e-3f, 0.4e-3f),
                 false);
    const GBuffer gbuffer = floorAt(kX, kZ);
    const std::vector<View> views = room->views(400, 31);
    const std::uint32_t leaves = ViewHierarchy::build(views, {.levels = 5}).leafCount;
    const GpuViewMaps open =
        test::uploadMaps(std::vector(leaves * mapTexels(16), kNone), 16, leaves);
    const GpuViewMaps none;
    for (const GpuViewMaps* maps : {&none, &open}) {
        const Picture before = pictureOf(scene, gbuffer, views, false, *maps);
        EXPECT_EQ(before.unfiltered[kDark] > 0, maps->present);
        ASSERT_GT(before.light[kDark], 0.3 * before.mean) << "the filter takes it for bad luck";
        const Picture now = pictureOf(scene, gbuffer, views, true, *maps);
        EXPECT_EQ(now.unfiltered, before.unfiltered);
        // Twice what one of 64 samples would give 2.3 times, and that has noise.
        EXPECT_LT(now.light[kDark], 0.15 * before.mean);
        for (std::size_t i = 0; i < now.light.size(); i += 4) {
            if (i == kDark) continue;
            ASSERT_EQ(now.light[i], before.light[i]) << i / 4;
        }
    }
}

// Slats stand before a row of views. Where each hides as many as one and a half of a sample's
// stratum of 30, a third of the pixels have none that sees a view; where one of seven is left, here
// and there, some have none in 24 samples either.
TEST_F(GatherGpu, AnUnluckyPixelKeepsWhatTheFilterGivesIt) {
    constexpr float kApart = 1e-3f;
    struct Slats {
        float from, to;  // of the views
        bool (*hides)(std::uint32_t view);
    };
    const Slats wide{0.01f, 0.005f, [](std::uint32_t i) { return i % 20 < 13; }};
    const Slats scattered{6e-4f, 4e-4f,
                          [](std::uint32_t i) { return pcg4d(uvec4(i, 0u, 0u, 1u)).x % 7u > 0u; }};
    for (const Slats& slats : {wide, scattered}) {
        Scene scene = test::roomScene();
        std::vector<View> views;
        for (std::uint32_t i = 0; i < 240; ++i) {
            const vec3 p(0.7f, 0.3f, 0.62f + static_cast<float>(i) * kApart);
            views.push_back(test::makeView(p, {-1, 0, 0}, vec3(1)));
            if (!slats.hides(i)) continue;
            test::addBox(scene, p + vec3(-slats.from, -0.1f, -0.5f * kApart),
                         p + vec3(-slats.to, 0.1f, 0.5f * kApart), false);
        }
        test::numberSlots(views);
        const GBuffer gbuffer = floorAt(0.3f, 0.7f);
        const Picture before = pictureOf(scene, gbuffer, views, false);
        const Picture now = pictureOf(scene, gbuffer, views, true);
        EXPECT_GT(now.doubted, 50);
        int changed = 0;
        for (std::size_t i = 0; i < now.light.size(); i += 4) {
            changed += now.light[i] != before.light[i];
        }
        EXPECT_EQ(changed, 0) << "of " << now.doubted;
    }
}

}  // namespace
}  // namespace mv
