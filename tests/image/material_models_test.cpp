// The models of assets/materials show what docs/conformance.md says that they must: each ball's
// light is compared with its neighbours', not with pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "app/common/scene_assets.h"
#include "megaviews/core/error.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

class MaterialModel : public testing::Test {
  protected:
    static constexpr int kWidth = 240, kHeight = 160;

    void SetUp() override {
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
        settings.resolution = {kWidth, kHeight};
        settings.views.vpls = 512;
        settings.scene.octreeDepth = settings.views.octreeDepth = 6;
        settings.display.exposureEv = 0;
    }

    void show(const std::string& name) {
        const auto assets =
            loadAssets(MEGAVIEWS_SOURCE_DIR "/assets/materials/" + name + ".gltf", settings, {});
        FrameRenderer renderer;
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
        FrameInput input;
        input.camera = chosenCamera(settings, *assets, 0);
        FrameStatistics statistics;
        renderer.render(settings, input, statistics);
        EXPECT_EQ(statistics.badPixels, 0u);
        radiance_ = renderer.radiance().readFloats(4);
        clipFromRoot_ = input.camera.clipFromWorld(static_cast<float>(kWidth) / kHeight);
        root_ = assets->scene.root;
    }

    // Mean radiance of the pixels around a place in the file's units.
    glm::vec3 at(glm::dvec3 place, int reach = 2) const {
        const glm::vec4 clip = clipFromRoot_ * glm::vec4(root_.rootFromWorld(place), 1);
        const int x = static_cast<int>((clip.x / clip.w * 0.5f + 0.5f) * kWidth);
        const int y = static_cast<int>((clip.y / clip.w * 0.5f + 0.5f) * kHeight);
        glm::vec3 sum(0);
        int count = 0;
        for (int j = std::max(y - reach, 0); j <= std::min(y + reach, kHeight - 1); ++j) {
            for (int i = std::max(x - reach, 0); i <= std::min(x + reach, kWidth - 1); ++i) {
                const auto k = static_cast<std::size_t>(4 * (j * kWidth + i));
                sum += glm::vec3(radiance_[k], radiance_[k + 1], radiance_[k + 2]);
                ++count;
            }
        }
        return sum / static_cast<float>(count);
    }
    float lightAt(glm::dvec3 place, int reach = 2) const { return luminance(at(place, reach)); }
    // Of a row of balls, as wide as they are apart.
    static glm::dvec3 ball(int i, int count, double y) { return {i - (count - 1) / 2.0, y, 0}; }
    // The brightest 3 x 3 pixels of a ball.
    float peakOf(glm::dvec3 middle) const {
        float most = 0;
        for (double dy = -0.36; dy <= 0.37; dy += 0.04) {
            for (double dx = -0.36; dx <= 0.37; dx += 0.04) {
                if (dx * dx + dy * dy > 0.36 * 0.36) continue;
                const double out = std::sqrt(0.45 * 0.45 - dx * dx - dy * dy);
                most = std::max(most, lightAt(middle + glm::dvec3(dx, dy, out), 1));
            }
        }
        return most;
    }

    // Of the pixels left and right of a place.
    float contrastAt(glm::dvec3 middle) const {
        float least = INFINITY, most = 0;
        for (double dx = -0.2; dx <= 0.21; dx += 0.05) {
            const float light = lightAt(middle + glm::dvec3(dx, 0, 0), 0);
            least = std::min(least, light);
            most = std::max(most, light);
        }
        return most / least;
    }

    Settings settings;

  private:
    std::unique_ptr<gl::HeadlessContext> context_;
    std::vector<float> radiance_;
    glm::mat4 clipFromRoot_{1};
    RootCube root_;
};

constexpr glm::dvec3 kToCamera = {0, 0, 0.45};

TEST_F(MaterialModel, HighlightsSpreadWithRoughnessAndMetalsTintThem) {
    show("metal-rough");
    for (int i = 1; i + 1 < 5; ++i) {
        EXPECT_GT(peakOf(ball(i, 5, 2)), 1.2f * peakOf(ball(i + 1, 5, 2))) << i;
    }
    const auto blueness = [&](double y) {
        const glm::vec3 c = at(ball(4, 5, y) + kToCamera, 4);
        return c.b / c.r;
    };
    // What a metal reflects has its colour, what a dielectric does is white.
    EXPECT_LT(blueness(2), blueness(0));
    EXPECT_LT(at(ball(0, 5, 2) + kToCamera, 6).b, 0.5f * at(ball(0, 5, 2) + kToCamera, 6).r);
}

TEST_F(MaterialModel, NormalMapsLookAsWhatTheyStandFor) {
    show("normal-map");
    for (int i = 0; i < 3; ++i) {
        double apart = 0, sum = 0;
        // The side of the dome that no shadow reaches.
        for (double dy = -0.1; dy <= 0.31; dy += 0.05) {
            for (double dx = -0.3; dx <= 0.11; dx += 0.05) {
                const double depth = 0.09 * (1 + std::cos(3.14159 * std::hypot(dx, dy) / 0.36));
                const float shape = lightAt(ball(i, 3, 1) + glm::dvec3(dx, dy, depth), 1);
                const float mapped = lightAt(ball(i, 3, 0) + glm::dvec3(dx, dy, 0), 1);
                apart += std::abs(double{shape} - double{mapped});
                sum += double{shape};
            }
        }
        EXPECT_LT(apart, 0.08 * sum) << i;
    }
}

TEST_F(MaterialModel, CoatsReflectTheMoreTheStrongerTheyAre) {
    show("clear-coat");
    for (int i = 0; i + 1 < 4; ++i) {
        EXPECT_LT(1.05f * peakOf(ball(i, 4, 1)), peakOf(ball(i + 1, 4, 1))) << i;
        // The checked floor in the smooth coats; a shadow's edge lies on the first ball.
        const glm::dvec3 showsFloor = {0, -0.27, 0.36};
        if (i == 0) continue;
        EXPECT_LT(1.02f * contrastAt(ball(i, 4, 0) + showsFloor),
                  contrastAt(ball(i + 1, 4, 0) + showsFloor))
            << i;
    }
}

TEST_F(MaterialModel, IndicesReflectAndBend) {
    show("index-of-refraction");
    for (int i = 0; i + 1 < 5; ++i) {
        EXPECT_LT(lightAt(ball(i, 5, 0) + kToCamera, 6), lightAt(ball(i + 1, 5, 0) + kToCamera, 6))
            << i;
    }
    // Of index 1 nothing is seen but what is behind; the others show it upside down, the checked
    // floor above.
    const float beside = lightAt({-2.6, 1, 0}), through = lightAt(ball(0, 5, 1));
    EXPECT_NEAR(through, beside, 0.05f * beside);
    for (int i = 1; i < 5; ++i) {
        EXPECT_GT(contrastAt(ball(i, 5, 1) + glm::dvec3(0, 0.3, 0)),
                  1.5f * contrastAt(ball(i, 5, 1) + glm::dvec3(0, -0.3, 0)))
            << i;
    }
}

TEST_F(MaterialModel, SpecularFactorsAndColours) {
    show("specular");
    for (int i = 0; i + 1 < 4; ++i) {
        EXPECT_LT(1.05f * lightAt(ball(i, 4, 0) + kToCamera, 6),
                  lightAt(ball(i + 1, 4, 0) + kToCamera, 6))
            << i;
    }
    for (int channel = 0; channel < 3; ++channel) {
        const glm::vec3 c = at(ball(channel + 1, 4, 1) + kToCamera, 6);
        for (int other = 0; other < 3; ++other) {
            if (other != channel) {
                EXPECT_GT(c[channel], 1.5f * c[other]) << channel;
            }
        }
    }
}

TEST_F(MaterialModel, VariantsAreChosenByName) {
    const auto middle = [&](const std::string& variant) {
        settings.scene.variant = variant;
        show("variants");
        return at({0, 0.1, 0.45}, 6);
    };
    const glm::vec3 matt = middle(""), gold = middle("gold"), lacquered = middle("lacquered");
    EXPECT_GT(matt.b, 1.5f * matt.r);
    EXPECT_GT(gold.r, 1.5f * gold.b);
    EXPECT_GT(gold.g, 1.2f * gold.b);
    EXPECT_GT(lacquered.r, 2 * lacquered.g);
    EXPECT_EQ(middle("matt"), matt);
}

TEST_F(MaterialModel, EveryInstanceIsThere) {
    show("instancing");
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 7; ++column) {
            const glm::vec3 c = at({column - 3.0, row, 0.03}, 0);
            EXPECT_GT(c.g, 1.2f * c.r) << column << " " << row;
            EXPECT_GT(c.g, c.b) << column << " " << row;
        }
    }
    const glm::vec3 between = at({0.5, 3, 0}, 0);
    EXPECT_LT(between.g, 1.2f * between.r);
}

// While something turns by 9 degrees a frame, the mean of frames has it where it is: a little
// softer than many points of each pixel, where it is off 3.4 times as much as one frame if it is
// looked up as if it stood still.
TEST_F(MaterialModel, TheMeanOfFramesFollowsWhatMoves) {
    const auto assets =
        loadAssets(MEGAVIEWS_SOURCE_DIR "/assets/materials/turning.gltf", settings, {});
    ASSERT_TRUE(assets->scene.moving);
    FrameInput input;
    input.animation = assets->animation;
    input.camera = chosenCamera(settings, *assets, 0);
    settings.picture.view = DebugView::direct;
    const auto shown = [&](bool temporal, int points, double from) {
        FrameRenderer renderer;
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
        settings.picture.temporal = temporal;
        settings.gather.history = temporal ? 16 : 0;
        settings.picture.pixelSamples = points;
        input.moving = temporal;
        FrameStatistics statistics;
        const auto renderAt = [&](double timeS) {
            input.timeS = timeS;
            input.pose = [&, timeS] { assets->pose(timeS); };
            renderer.render(settings, input, statistics);
        };
        for (int frame = 0; frame <= 8; ++frame) renderAt(from + 0.1 * frame);
        while (statistics.accumulatedFrames < points) renderAt(from + 0.8);
        return renderer.display().readBytes(4);
    };
    double ofMean = 0, ofOne = 0;
    for (const double from : {0.3, 2.1}) {
        const auto truth = shown(false, 32, from), mean = shown(true, 1, from),
                   one = shown(false, 1, from);
        for (std::size_t i = 0; i < truth.size(); ++i) {
            ofMean += std::pow(double(mean[i]) - double(truth[i]), 2.0);
            ofOne += std::pow(double(one[i]) - double(truth[i]), 2.0);
        }
    }
    EXPECT_LT(ofMean, 1.6 * ofOne) << ofMean / ofOne;
}

// And the light that was gathered of it before is remembered.
TEST_F(MaterialModel, RememberedLightFollowsWhatMoves) {
    const auto assets =
        loadAssets(MEGAVIEWS_SOURCE_DIR "/assets/materials/sliding.gltf", settings, {});
    FrameInput input;
    input.animation = assets->animation;
    input.camera = chosenCamera(settings, *assets, 0);
    settings.picture.view = DebugView::indirect;
    settings.gather.filter = false;
    settings.gather.samples = 4;
    const auto lightOf = [&](int history, int frames, int sets, int atRest = 0) {
        FrameRenderer renderer;
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
        settings.gather.history = history;
        settings.picture.accumulate = sets;
        input.moving = history > 0;
        FrameStatistics statistics;
        for (int frame = 9 - frames; frame < 9; ++frame) {
            input.timeS = 0.1 + 0.1 * frame;
            input.pose = [&] { assets->pose(input.timeS); };
            renderer.render(settings, input, statistics);
        }
        while (statistics.accumulatedFrames < sets) renderer.render(settings, input, statistics);
        if (atRest > 0) input.moving = false, settings.picture.accumulate = 16;
        for (int i = 0; i < atRest; ++i) renderer.render(settings, input, statistics);
        return renderer.radiance().readFloats(4);
    };
    const auto truth = lightOf(0, 1, 64), remembered = lightOf(16, 9, 1), alone = lightOf(0, 1, 1);
    const auto rested = lightOf(16, 9, 1, 4);
    double ofRemembered = 0, ofAlone = 0, ofRested = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        ofRemembered += std::pow(double{remembered[i]} - double{truth[i]}, 2.0);
        ofAlone += std::pow(double{alone[i]} - double{truth[i]}, 2.0);
        ofRested += std::pow(double{rested[i]} - double{truth[i]}, 2.0);
    }
    EXPECT_LT(ofRemembered, 0.2 * ofAlone) << ofRemembered / ofAlone;
    EXPECT_LT(ofRested, ofRemembered) << ofRested / ofAlone;  // of what no longer moves
}

}  // namespace
}  // namespace mv
