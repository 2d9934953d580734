// The built-in scenes as each method lights them, against pictures that were looked at: small and
// with few views, so that they are quick, but through the whole line.

#include <gtest/gtest.h>

#include <memory>

#include "app/common/scene_assets.h"
#include "image/golden_image.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

// Processors differ in their approximate reciprocals, and a shadow test near its threshold turns
// that into another sample: a few pixels may differ by more than rounding.
constexpr Tolerance kTolerance{6, 0.02};

Settings smallSettings(int levels) {
    Settings settings;
    settings.resolution.width = 160;
    settings.resolution.height = 90;
    settings.views.vpls = 1024;
    settings.gather.samples = 32;
    settings.scene.octreeDepth = settings.views.octreeDepth = levels;
    return settings;
}

class ImageTest : public testing::Test {
  protected:
    void SetUp() override {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
    }

    Picture render(FrameRenderer& renderer, const SceneAssets& assets, const Settings& settings) {
        FrameInput input;
        input.camera = chosenCamera(settings, assets, settings.scene.timeS);
        input.timeS = settings.scene.timeS;
        input.animation = assets.animation;
        renderer.render(settings, input, statistics_);
        EXPECT_EQ(statistics_.badPixels, 0u);
        const auto pixels = renderer.display().readBytes(4);
        Picture picture;
        picture.width = settings.resolution.width;
        picture.height = settings.resolution.height;
        for (int y = picture.height - 1; y >= 0; --y) {
            for (int x = 0; x < picture.width; ++x) {
                const auto p = static_cast<std::size_t>(y * picture.width + x) * 4;
                picture.rgb.insert(picture.rgb.end(), &pixels[p], &pixels[p] + 3);
            }
        }
        return picture;
    }

    std::unique_ptr<gl::HeadlessContext> context_;
    FrameStatistics statistics_;
};

class BuiltinScene : public ImageTest, public testing::WithParamInterface<const char*> {};

TEST_P(BuiltinScene, LooksAsItDidByEachMethod) {
    const std::string scene = GetParam();
    Settings settings = smallSettings(8);
    const auto assets = loadAssets("builtin:" + scene, settings, {});
    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    std::vector<Picture> pictures;
    for (const Method method : {Method::megaviews, Method::manylods, Method::none}) {
        settings.side[0].method = method;
        pictures.push_back(render(renderer, *assets, settings));
        EXPECT_TRUE(
            matchesGolden(pictures.back(), scene + "-" + std::string(nameOf(method)), kTolerance));
    }
    // Methods must differ, or the goldens prove nothing; but MegaViews and ManyLoDs show the same
    // scene by the same samples, and only texels' worth of shadow may differ.
    EXPECT_GT(failingShare(pictures[0], pictures[2], kTolerance.difference), 0.05)
        << "maps occlude nothing";
    EXPECT_LT(failingShare(pictures[0], pictures[1], 24), 0.10) << "methods disagree";
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinScene,
                         testing::Values("cornell", "atrium", "cathedral", "hairball", "door"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_F(ImageTest, AtriumWithElevenLevels) {
    Settings settings = smallSettings(11);
    settings.views.vpls = 256;
    const auto assets = loadAssets("builtin:atrium", settings, {});
    EXPECT_EQ(assets->hierarchy.levels, 11);
    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    EXPECT_TRUE(matchesGolden(render(renderer, *assets, settings), "atrium-11-levels", kTolerance));
}

TEST_F(ImageTest, ParticlesLightTheCathedral) {
    Settings settings = smallSettings(8);
    settings.views.particles = 512;
    const auto assets = loadAssets("builtin:cathedral", settings, {});
    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    EXPECT_TRUE(
        matchesGolden(render(renderer, *assets, settings), "cathedral-particles", kTolerance));
}

// Both sides of a split come from the same views and samples: with the same method on both, the
// picture is that of one method, whatever the split.
TEST_F(ImageTest, SplitOfAMethodWithItselfChangesNothing) {
    Settings settings = smallSettings(7);
    settings.display.exposureEv = 0;
    const auto assets = loadAssets("builtin:cornell", settings, {});
    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    const Picture one = render(renderer, *assets, settings);
    compareWith(settings, settings.side[0].method);
    settings.display.split = 0.3;
    EXPECT_EQ(render(renderer, *assets, settings).rgb, one.rgb);
}

TEST_F(ImageTest, SameSettingsGiveSameBytesInAnotherRenderer) {
    const Settings settings = smallSettings(7);
    const auto assets = loadAssets("builtin:cornell", settings, {});
    std::vector<std::uint8_t> first;
    for (int run = 0; run < 2; ++run) {
        FrameRenderer renderer;
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
        const Picture picture = render(renderer, *assets, settings);
        if (run == 0) first = picture.rgb;
        EXPECT_EQ(picture.rgb, first);
    }
}

// A metric that cannot fail would bless anything.
TEST(GoldenImage, CountsPixelsThatDiffer) {
    Picture a{2, 1, {0, 0, 0, 100, 100, 100}};
    Picture b = a;
    EXPECT_EQ(failingShare(a, b, 0), 0);
    b.rgb[4] = 110;
    EXPECT_EQ(failingShare(a, b, 9), 0.5);
    EXPECT_EQ(failingShare(a, b, 10), 0);
}

}  // namespace
}  // namespace mv
