// References made on a thread of their own, and frames that show them so far.

#include "app/viewer/reference_worker.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "app/temp_folder.h"
#include "app/viewer/references.h"
#include "gpu/frame_fixture.h"
#include "megaviews/io/npy.h"
#include "megaviews/measure/picture_errors.h"
#include "megaviews/measure/reference_store.h"
#include "shaders/shared/colour_map.glsl"

namespace mv {
namespace {

namespace fs = std::filesystem;

template <typename Condition>
bool waitFor(Condition condition, double seconds = 60) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

class ReferenceWorkerTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        assets_ = loadAssetsWithoutHierarchy("builtin:cornell", Settings{});
    }
    static void TearDownTestSuite() { assets_.reset(); }
    void SetUp() override {
        settings.side[0].method = Method::pathtraced;
        settings.side[0].referenceSamples = 16;
        setSize(8, 6);
        const Emitters emitters = makeEmitters(assets_->scene, assets_->bvh, {});
        views = traceVpls(assets_->bvh, emitters, {100, 2, 0}).views;
    }
    void setSize(int width, int height) {
        settings.resolution.width = width;
        settings.resolution.height = height;
        receivers.clear();
        for (int i = 0; i < width * height; ++i) {
            const vec4 r = random4(1, static_cast<uint>(i), 0, 0);
            receivers.push_back({0.3f + 0.4f * vec3(r.x, r.y, r.z), sphereDirection(r.w, r.x)});
        }
    }
    ReferenceRequest request() const { return {settings, moment, views, receivers}; }
    std::vector<glm::vec3> expected() const {
        return References(*assets_, {}, {}).irradiance(request());
    }
    fs::path folder() const { return folder_.file("kept"); }

    Settings settings;
    FrameMoment moment;
    std::vector<View> views;
    std::vector<Receiver> receivers;
    test::TempFolder folder_;
    static inline std::shared_ptr<SceneAssets> assets_;
};

TEST_F(ReferenceWorkerTest, MakesWhatIsMadeWithoutIt) {
    ReferenceWorker worker{{}};
    worker.setScene(assets_);
    EXPECT_FALSE(worker.busy());
    EXPECT_TRUE(worker.more(0).irradiance.empty());
    // Both sides at once, one after the other.
    worker.begin(request(), 0);
    settings.side[0].method = Method::exact;
    worker.begin(request(), 1);
    for (const int side : {1, 0}) {
        settings.side[0].method = side == 1 ? Method::exact : Method::pathtraced;
        ReferenceWorker::Light light;
        ASSERT_TRUE(waitFor([&] {
            light = worker.more(side);
            return light.complete;
        }));
        EXPECT_EQ(light.irradiance, expected());
        EXPECT_TRUE(worker.more(side).irradiance.empty()) << "told twice";
    }
    EXPECT_FALSE(worker.busy());
    EXPECT_EQ(worker.status().stage, "");
}

TEST_F(ReferenceWorkerTest, LetsGoOfASceneThatIsGone) {
    std::shared_ptr<SceneAssets> own = loadAssetsWithoutHierarchy("builtin:cornell", Settings{});
    const std::weak_ptr<SceneAssets> gone = own;
    ReferenceWorker worker{{}};
    worker.setScene(own);
    worker.begin(request(), 0);
    ASSERT_TRUE(waitFor([&] { return worker.more(0).complete; }));
    own.reset();
    EXPECT_FALSE(gone.expired());
    worker.setScene(assets_);
    EXPECT_TRUE(waitFor([&] { return gone.expired(); }, 10));
}

TEST_F(ReferenceWorkerTest, ShowsRowsAndGoesOnWhereItWasAbandoned) {
    constexpr int kWidth = 64;
    setSize(kWidth, 200);
    settings.side[0].referenceSamples = 400;
    std::size_t done = 0;
    {
        ReferenceWorker worker(folder());
        worker.setScene(assets_);
        worker.begin(request(), 0);
        ReferenceWorker::Light light;
        ASSERT_TRUE(waitFor([&] {
            light = worker.more(0);
            done = 0;  // of rows after the first, which then is whole
            for (std::size_t i = kWidth; i < light.irradiance.size(); ++i) {
                done += light.irradiance[i] != glm::vec3(0);
            }
            return done > 0 || light.complete;
        }));
        EXPECT_FALSE(light.complete) << "too fast for this test";
        EXPECT_EQ(light.irradiance.size(), receivers.size());
        EXPECT_EQ(light.irradiance.back(), glm::vec3(0));
        EXPECT_EQ(worker.status().stage, "path tracing");
        worker.end(0);
        EXPECT_FALSE(worker.busy());
        EXPECT_TRUE(worker.more(0).irradiance.empty());
    }
    const fs::path file = ReferenceStore(folder()).fileFor(assets_->scene, request());
    ASSERT_TRUE(fs::exists(file.string() + ".partial.npy"));
    EXPECT_GT(readNpy<float>(file.string() + ".partial.npy").shape[0], 0u);
    EXPECT_FALSE(fs::exists(file.string() + ".npy"));
}

TEST_F(ReferenceWorkerTest, SaysWhatCannotBe) {
    ReferenceWorker worker{{}};
    worker.setScene(assets_);
    settings.views.particles = 10;  // pathtraced has none
    worker.begin(request(), 1);
    std::optional<ReferenceWorker::Failure> failure;
    ASSERT_TRUE(waitFor([&] { return (failure = worker.takeFailure()).has_value(); }));
    EXPECT_EQ(failure->side, 1);
    EXPECT_EQ(failure->error.code, ExitCode::usage);
    EXPECT_FALSE(worker.takeFailure());
    EXPECT_FALSE(worker.busy());
    // Another scene, another try.
    settings.views.particles = 0;
    worker.setScene(assets_);
    worker.begin(request(), 1);
    ASSERT_TRUE(waitFor([&] { return worker.more(1).complete; }));
}

TEST_F(ReferenceWorkerTest, MakesMapsInTurnWithPictures) {
    settings.side[0].maps.resolution = 8;
    ReferenceWorker worker{{}};
    worker.setScene(assets_);
    EXPECT_FALSE(worker.maps(0));
    worker.begin(request(), 0);
    worker.beginMaps(request(), 20, 0);
    settings.side[0].maps.resolution = 16;
    worker.beginMaps(request(), 30, 1);
    EXPECT_TRUE(worker.busyWithMaps());
    ASSERT_TRUE(waitFor([&] { return !worker.busy(); }));
    EXPECT_TRUE(worker.more(0).complete) << "the picture of the same side";
    for (const int side : {0, 1}) {
        settings.side[0].maps.resolution = side == 0 ? 8 : 16;
        const auto maps = worker.maps(side);
        ASSERT_TRUE(maps);
        const MapReferences expected =
            References(*assets_, {}, {}).maps(request(), side == 0 ? 20 : 30);
        EXPECT_EQ(maps->mapRes, settings.side[0].maps.resolution);
        EXPECT_EQ(maps->slots, expected.slots);
        EXPECT_EQ(maps->depth, expected.depth);
        EXPECT_EQ(maps->farthest, expected.farthest);
    }
    worker.endMaps(0);
    EXPECT_FALSE(worker.maps(0));
    EXPECT_TRUE(worker.maps(1));
    worker.setScene(assets_);
    EXPECT_FALSE(worker.maps(1));
    EXPECT_FALSE(worker.busy());
}

TEST_F(ReferenceWorkerTest, AbandonsMaps) {
    settings.side[0].maps.resolution = 64;
    ReferenceWorker worker(folder());
    worker.setScene(assets_);
    worker.beginMaps(request(), 100, 0);
    ASSERT_TRUE(waitFor([&] { return worker.status().stage == "exact maps"; }));
    worker.endMaps(0);
    EXPECT_FALSE(worker.busyWithMaps());
    EXPECT_EQ(worker.status().stage, "");
    settings.side[0].maps.resolution = 8;  // the thread is free for others
    worker.beginMaps(request(), 100, 0);
    ASSERT_TRUE(waitFor([&] { return worker.maps(0) != nullptr; }));
    EXPECT_EQ(worker.maps(0)->mapRes, 8);
}

TEST_F(ReferenceWorkerTest, GivesWhatItCannotKeep) {
    std::ofstream(folder_.file("kept")) << "a file where a folder should be";
    ReferenceWorker worker(folder());
    worker.setScene(assets_);
    worker.beginMaps(request(), 3, 1);
    ASSERT_TRUE(waitFor([&] { return worker.maps(1) != nullptr; }));
    EXPECT_EQ(worker.maps(1)->slots.size(), 3u);
    EXPECT_FALSE(worker.takeFailure());
    EXPECT_FALSE(worker.busy());
}

// ---------------------------------------------------------------- frames

class WantedReference : public test::FrameTest {
  protected:
    float light(int side = 0) const {
        float sum = 0;
        for (const float value : renderer->radianceOf(side).readFloats(4)) sum += value;
        return sum;
    }
    std::vector<glm::vec3> grey(std::size_t pixels = 75 * 43) const {
        std::vector<glm::vec3> out(75 * 43, glm::vec3(0));
        std::fill_n(out.begin(), pixels, glm::vec3(1));
        return out;
    }
};

TEST_F(WantedReference, IsShownAsFarAsItIs) {
    settings.side[0].method = Method::exact;
    render();
    const std::uint64_t wanted = renderer->wantedReference(0);
    ASSERT_NE(wanted, 0u);
    EXPECT_EQ(renderer->readReceivers().size(), 75u * 43u);
    const float dark = light();  // direct light alone
    renderer->setReference(0, wanted, grey(75 * 21), false);
    render();
    const float half = light();
    EXPECT_GT(half, dark);
    EXPECT_EQ(renderer->wantedReference(0), wanted);
    render();  // nothing new
    EXPECT_EQ(light(), half);
    renderer->setReference(0, wanted, grey(), true);
    render();
    const float whole = light();
    EXPECT_GT(whole, half);
    EXPECT_FALSE(renderer->awaitsReferences());
    // Exposure is none of its business, the seed is.
    settings.display.exposureEv = 1;
    render();
    EXPECT_FALSE(renderer->awaitsReferences());
    EXPECT_EQ(light(), whole);
    settings.seed = 7;
    render();
    const std::uint64_t other = renderer->wantedReference(0);
    EXPECT_NE(other, 0u);
    EXPECT_NE(other, wanted);
    EXPECT_NEAR(light(), dark, 0.01f * dark);
    // What is no longer wanted comes too late.
    renderer->setReference(0, wanted, grey(), true);
    renderer->setReference(1, other, grey(), true);
    render();
    EXPECT_EQ(renderer->wantedReference(0), other);
    EXPECT_NEAR(light(), dark, 0.01f * dark);
    settings.side[0].method = Method::none;
    render();
    EXPECT_FALSE(renderer->awaitsReferences());
}

TEST_F(WantedReference, StandsOnEitherSide) {
    settings.side[0].method = Method::none;
    compareWith(settings, Method::pathtraced);
    render();
    EXPECT_EQ(renderer->wantedReference(0), 0u);
    const std::uint64_t wanted = renderer->wantedReference(1);
    ASSERT_NE(wanted, 0u);
    const float left = light(0), dark = light(1);
    renderer->setReference(1, wanted, grey(), true);
    render();
    EXPECT_EQ(light(0), left);
    EXPECT_GT(light(1), dark);
    settings.compare = false;
    render();
    EXPECT_FALSE(renderer->awaitsReferences());
}

// ---------------------------------------------------------------- FLIP as a difference

TEST_F(WantedReference, FlipIsWantedWhenThePictureIsComplete) {
    settings.side[0].method = Method::megaviews;
    compareWith(settings, Method::none);
    settings.display.difference = Difference::flip;
    settings.picture.accumulate = 2;
    render();
    EXPECT_EQ(renderer->wantedFlip(), 0u) << "one set of two";
    render();
    const std::uint64_t wanted = renderer->wantedFlip();
    ASSERT_NE(wanted, 0u);
    const auto split = display();
    std::vector<float> errors(75 * 43);
    for (std::size_t i = 0; i < errors.size(); ++i) {
        errors[i] = static_cast<float>(i % 101) / 100.0f;
    }
    errors[5] = std::numeric_limits<float>::quiet_NaN();
    render();
    EXPECT_EQ(renderer->wantedFlip(), wanted) << "the same picture under another name";
    EXPECT_EQ(display(), split);
    renderer->setFlip(wanted + 1, errors);
    EXPECT_EQ(display(), split);
    renderer->setFlip(wanted, errors);
    const FrameStatistics statistics = render();
    EXPECT_EQ(renderer->wantedFlip(), 0u);
    EXPECT_EQ(statistics.differenceRange, 1);
    const auto shown = display();
    const auto values = radiance();
    for (const std::size_t i : {0u, 5u, 50u, 100u, 1234u}) {
        const glm::vec3 colour = i == 5 ? glm::vec3(0.5f) : viridis(errors[i]);
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(shown[4 * i + c], 255 * colour[static_cast<int>(c)], 1);
            EXPECT_EQ(values[4 * i + c], i == 5 ? 0 : errors[i]);
        }
    }
    settings.display.exposureEv = 1;
    render();
    EXPECT_NE(renderer->wantedFlip(), 0u);
    EXPECT_NE(renderer->wantedFlip(), wanted);
    settings.display.difference = Difference::off;
    render();
    EXPECT_EQ(renderer->wantedFlip(), 0u);
    // A reference that is not whole is no side of a measurement.
    settings.display.difference = Difference::flip;
    compareWith(settings, Method::exact);
    render();
    render();
    EXPECT_EQ(renderer->wantedFlip(), 0u);
    renderer->setReference(1, renderer->wantedReference(1), grey(), true);
    EXPECT_EQ(renderer->wantedFlip(), 0u) << "before it is drawn";
    render();
    EXPECT_NE(renderer->wantedFlip(), 0u);
}

// ---------------------------------------------------------------- measurements

Comparison example(int width, int height) {
    Comparison c;
    c.test = c.reference = {width, height, {}};
    for (int i = 0; i < 3 * width * height; ++i) {
        const vec4 r = random4(3, static_cast<uint>(i), 0, 0);
        c.test.rgb.push_back(r.x);
        c.reference.rgb.push_back(0.5f * (r.x + r.y));
    }
    c.exposureEv = 0.5;
    return c;
}

TEST(PictureErrors, AreThoseOfTheMetrics) {
    const Comparison a = example(24, 17), b = example(20, 15);
    PictureErrors errors;
    EXPECT_FALSE(errors.version());
    errors.start(4, {a, b});
    ASSERT_TRUE(waitFor([&] { return !errors.busy(); }));
    EXPECT_EQ(errors.version(), 4u);
    const auto results = errors.results();
    ASSERT_EQ(results.size(), 2u);
    Compared compared;
    compared.radiance.emplace(a.test, a.reference);
    compared.display = ImagePair(displayImage(a.test, 0.5, ToneMap::aces),
                                 displayImage(a.reference, 0.5, ToneMap::aces));
    const auto expected = evaluate(compared, metricsOf(compared));
    ASSERT_EQ(results[0].values.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(results[0].values[i].metric, expected[i].metric);
        EXPECT_EQ(results[0].values[i].value, expected[i].value);
    }
    EXPECT_NE(results[1].values[0].value, expected[0].value);
    Comparison display = a;
    display.linear = false;
    errors.start(5, {display});
    ASSERT_TRUE(waitFor([&] { return !errors.busy(); }));
    EXPECT_EQ(errors.results().at(0).values.size(), 3u);
    errors.stop();
    EXPECT_FALSE(errors.version());
    EXPECT_TRUE(errors.results().empty());
}

TEST(PictureErrors, GiveFlipFromTheBottomUp) {
    Comparison c = example(24, 17);
    c.test.rgb[0] = std::numeric_limits<float>::quiet_NaN();  // the first of the top row
    PictureErrors errors;
    errors.startFlip(1, c);
    ASSERT_TRUE(waitFor([&] { return !errors.busy(); }));
    const std::vector<float> found = errors.flip();
    EXPECT_EQ(found.size(), 24u * 17u);
    EXPECT_TRUE(std::isnan(found[16 * 24]));
    const ImagePair pair(displayImage(c.test, 0.5, ToneMap::aces),
                         displayImage(c.reference, 0.5, ToneMap::aces));
    const FlipMap map = flip(pair);
    EXPECT_EQ(found[0], map.errors[16 * 24]);
    EXPECT_EQ(found[3 * 24 + 5], map.errors[13 * 24 + 5]);
    EXPECT_GT(found[0], 0);
}

}  // namespace
}  // namespace mv
