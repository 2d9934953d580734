// More than one point of a pixel: what their mean is, when it grows, and that nothing but the
// picture has it.

#include <cmath>

#include "gpu/frame_fixture.h"
#include "gpu/picture_scenes.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using test::FrameTest;

// How far n even points are from an edge's coverage, at worst.
double coverageTolerance(int n) { return 2.5 / n; }

class Pixels : public FrameTest {
  protected:
    void SetUp() override {
        FrameTest::SetUp();
        settings.picture.pixelSamples = 8;
    }
    void renderTo(int sets) {
        while (render().accumulatedFrames < sets) {
        }
    }
    // At those points of the pixels alone.
    std::vector<float> radianceAt(std::uint32_t point, Settings one) {
        one.picture.pixelSamples = 1;
        FrameInput there = input;
        there.reuse = false;
        there.camera.offset =
            2.0f * pixelOffset(point) / glm::vec2(one.resolution.width, one.resolution.height);
        FrameRenderer other;
        other.setScene(scene(), bvh(), hierarchy());
        FrameStatistics statistics;
        other.render(one, there, statistics);
        return other.radiance().readFloats(4);
    }
};

TEST_F(Pixels, FirstPictureIsThatOfTheCentres) {
    render();
    const auto first = radiance();
    const auto shown = display();
    startAfresh();
    settings.picture.pixelSamples = 1;
    render();
    EXPECT_EQ(radiance(), first);
    EXPECT_EQ(display(), shown);
}

// Of full sums, which have no samples of their own: of every point the same picture as alone.
TEST_F(Pixels, MeanIsThatOfThePicturesAtThePoints) {
    settings.gather.samples = 0;
    for (const char* sky : {"none", "white"}) {
        settings.scene.environment.source = sky;
        settings.gather.filter = sky == std::string("none");
        if (sky == std::string("white")) setMethod(settings, Method::none);
        settings.picture.view = sky == std::string("none") ? DebugView::final : DebugView::direct;
        std::vector<double> sum(radianceAt(0, settings).size());
        for (std::uint32_t i = 0; i < 8; ++i) {
            const auto one = radianceAt(i, settings);
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += double{one[k]} / 8;
        }
        startAfresh();
        renderTo(8);
        const auto mean = radiance();
        double others = 0;
        const auto centres = radianceAt(0, settings);
        for (std::size_t k = 0; k < sum.size(); ++k) {
            ASSERT_NEAR(mean[k], sum[k], 2e-6 * std::abs(sum[k]) + 1e-9) << sky << ' ' << k;
            others += std::abs(mean[k] - centres[k]) > 0.05f * std::abs(centres[k]) + 1e-6f;
        }
        EXPECT_GT(others, 300) << "edges are soft";
    }
}

TEST_F(Pixels, EachPointHasGatherSamplesOfItsOwn) {
    settings.picture.view = DebugView::indirect;
    settings.gather.filter = false;
    settings.gather.clampDistance = 0.25;
    Settings full = settings;
    full.gather.samples = 0;
    const auto error = [](const std::vector<float>& a, const std::vector<float>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double{a[i]} - double{b[i]}, 2);
        return sum;
    };
    render();
    const auto first = radiance();
    renderTo(8);
    const auto mean = radiance();
    startAfresh();
    while (render(full).accumulatedFrames < 8) {
    }
    const auto smooth = radiance();
    full.picture.pixelSamples = 1;
    render(full);
    EXPECT_LT(error(mean, smooth), 0.2 * error(first, radiance()));
}

TEST_F(Pixels, RestsWhenAllAreThereAndRepeatsItself) {
    renderTo(8);
    const auto last = radiance();
    const auto shown = display();
    for (int i = 0; i < 2; ++i) {
        const FrameStatistics rest = render();
        EXPECT_EQ(rest.accumulatedFrames, 8);
        EXPECT_TRUE(rest.stagesOfBothSides.empty());
        EXPECT_TRUE(rest.methods[0].stages.empty());
    }
    EXPECT_EQ(radiance(), last);
    // As many points as sets where those are more; fewer than there are begin anew.
    settings.picture.accumulate = 11;
    renderTo(11);
    const auto eleven = radiance();
    settings.picture.accumulate = 1;
    EXPECT_EQ(render().accumulatedFrames, 1);
    renderTo(8);
    EXPECT_EQ(radiance(), last);
    EXPECT_EQ(display(), shown);
    startAfresh();
    settings.picture.accumulate = 4;
    settings.picture.pixelSamples = 11;
    renderTo(11);
    EXPECT_EQ(radiance(), eleven);
}

TEST_F(Pixels, ViewsMapsAndCentresStay) {
    for (const Placement placement : {Placement::importance, Placement::traced}) {
        startAfresh();
        settings.views.placement = placement;
        compareWith(settings, Method::manylods);
        render();
        const auto views = renderer->viewsVersion();
        const auto left = renderer->mapsVersion(0), right = renderer->mapsVersion(1);
        const PixelValues before = renderer->readPixel(31, 20);
        const auto receivers = renderer->readReceivers();
        for (int n = 2; n <= 8; ++n) {
            const FrameStatistics statistics = render();
            EXPECT_EQ(statistics.accumulatedFrames, n);
            std::vector<StageTime> stages = statistics.stagesOfBothSides;
            for (const MethodStatistics& m : statistics.methods) {
                stages.insert(stages.end(), m.stages.begin(), m.stages.end());
            }
            for (const StageTime& time : stages) {
                const StageGroup group = infoOf(time.stage).group;
                EXPECT_TRUE(group != StageGroup::views && group != StageGroup::maps)
                    << infoOf(time.stage).name;
            }
        }
        EXPECT_EQ(renderer->viewsVersion(), views);
        EXPECT_EQ(renderer->mapsVersion(0), left);
        EXPECT_EQ(renderer->mapsVersion(1), right);
        // What is read back of a pixel is of its centre.
        const PixelValues after = renderer->readPixel(31, 20);
        EXPECT_EQ(after.position, before.position);
        const auto receiversAfter = renderer->readReceivers();
        ASSERT_EQ(receiversAfter.size(), receivers.size());
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            ASSERT_EQ(receiversAfter[i].position, receivers[i].position);
        }
        for (int side = 0; side < 2; ++side) {
            const auto& values = after.sides[static_cast<std::size_t>(side)];
            EXPECT_EQ(values.radiance, before.sides[static_cast<std::size_t>(side)].radiance);
            glm::dvec3 sum(0);
            for (const GatheredSample& s : renderer->readSamples(31, 20, side)) {
                sum += glm::dvec3(s.irradiance);
            }
            const glm::dvec3 want(values.unfiltered);
            EXPECT_GT(glm::length(want), 0);
            EXPECT_LT(glm::length(sum - want), 3e-6 * glm::length(want));
        }
        // And the next points are as if nobody had asked.
        settings.picture.pixelSamples = 12;
        renderTo(12);
        const auto twelve = radiance();
        startAfresh();
        renderTo(12);
        EXPECT_EQ(radiance(), twelve);
        settings.picture.pixelSamples = 8;
    }
}

TEST_F(Pixels, EveryChangeBeginsAnew) {
    const std::vector<std::pair<const char*, void (*)(Settings&, FrameInput&)>> changes = {
        {"camera", [](Settings&, FrameInput& i) { i.camera.position.x += 0.01f; }},
        {"light scale", [](Settings& s, FrameInput&) { s.scene.lightScale = 2; }},
        {"sky", [](Settings& s, FrameInput&) { s.scene.environment.source = "white"; }},
        {"sky's turn", [](Settings& s, FrameInput&) { s.scene.environment.rotationDeg = 80; }},
        {"size", [](Settings& s, FrameInput&) { s.resolution.width = 70; }},
        {"samples", [](Settings& s, FrameInput&) { s.gather.samples = 9; }},
        {"view", [](Settings& s, FrameInput&) { s.picture.view = DebugView::direct; }},
        {"exposure by far", [](Settings& s, FrameInput&) { s.display.exposureEv = 4; }},
        {"second side", [](Settings& s, FrameInput&) { compareWith(s, Method::none); }},
        {"no reuse", [](Settings&, FrameInput& i) { i.reuse = false; }},
    };
    render();
    for (const auto& [name, change] : changes) {
        renderTo(4);
        change(settings, input);
        EXPECT_EQ(render().accumulatedFrames, 1) << name;
        input.reuse = true;
        renderTo(8);
        const auto got = radiance();
        const auto shown = display();
        startAfresh();
        renderTo(8);
        EXPECT_EQ(radiance(), got) << name;
        EXPECT_EQ(display(), shown) << name;
    }
    // What only shows the light, and an exposure that is near, take nothing away.
    settings.display.toneMap = ToneMap::neutral;
    settings.display.exposureEv = 2.5;  // the mean is of 4 EV by AgX, which is near
    EXPECT_EQ(render().accumulatedFrames, 8);
    // Nor does data that is looked at meanwhile.
    const auto light = radiance();
    settings.picture.view = DebugView::normals;
    for (int i = 0; i < 2; ++i) {
        const FrameStatistics data = render();
        for (const StageTime& time : data.methods[0].stages) {
            EXPECT_EQ(infoOf(time.stage).group, StageGroup::picture) << infoOf(time.stage).name;
        }
    }
    EXPECT_NE(radiance(), light);
    settings.picture.view = DebugView::direct;
    render();
    EXPECT_EQ(radiance(), light);
}

// Data seen before the second point is there: that is of light all the same.
TEST_F(Pixels, DataIsNoPoint) {
    renderTo(8);
    const auto light = radiance();
    startAfresh();
    settings.picture.view = DebugView::normals;
    render();
    settings.picture.view = DebugView::final;
    renderTo(8);
    EXPECT_EQ(radiance(), light);
}

TEST_F(Pixels, DataDifferencesAndReferencesAreOfCentres) {
    for (const DebugView view :
         {DebugView::normals, DebugView::depth, DebugView::albedo, DebugView::candidates,
          DebugView::nan, DebugView::sharing, DebugView::undecided}) {
        settings.picture.view = view;
        EXPECT_EQ(render().accumulatedFrames, 1);
        EXPECT_EQ(render().accumulatedFrames, 1);
    }
    settings.picture.view = DebugView::final;
    compareWith(settings, Method::none);
    settings.display.difference = Difference::absolute;
    render();
    EXPECT_EQ(render().accumulatedFrames, 1);
    settings.display.difference = Difference::off;
    render();
    EXPECT_EQ(render().accumulatedFrames, 2);
    settings.side[1].method = Method::exact;
    render();
    EXPECT_EQ(render().accumulatedFrames, 1);
    const auto receivers = renderer->readReceivers();
    renderer->setReference(1, renderer->wantedReference(1),
                           std::vector<glm::vec3>(receivers.size(), glm::vec3(1)), true);
    render();
    EXPECT_EQ(render().accumulatedFrames, 1);
}

// Frames that move are those of centres, and what they leave is gone from the last picture.
TEST_F(Pixels, MovingFramesAndTheirHistoryKnowNothingOfThem) {
    settings.gather.history = 16;
    settings.gather.filter = false;
    settings.picture.accumulate = 20;
    std::vector<std::vector<float>> pictures;
    for (const int points : {1, 20}) {
        startAfresh();
        settings.picture.pixelSamples = points;
        input.moving = true;
        input.camera.position.x = 0.5f;
        for (int i = 0; i < 4; ++i) {
            input.camera.position.x += 0.004f;
            render();
            pictures.push_back(radiance());
        }
        input.moving = false;
        EXPECT_EQ(render().accumulatedFrames, 1);
        pictures.push_back(radiance());
    }
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(pictures[i], pictures[i + 5]) << i;
    renderTo(20);
    const auto rested = radiance();
    startAfresh();
    settings.gather.history = 0;
    renderTo(1);
    const auto alone = radiance();
    renderTo(20);
    EXPECT_EQ(radiance(), rested);
    const auto error = [&](const std::vector<float>& of) {
        double sum = 0;
        for (std::size_t i = 0; i < of.size(); ++i) {
            sum += std::abs(double{of[i]} - double{rested[i]});
        }
        return sum;
    };
    EXPECT_LT(error(pictures.back()), 0.8 * error(alone)) << "what was remembered helps at first";
}

// ---- edges

// Half of a picture of that radiance over nothing, its border slanted.
class Edges : public FrameTest {
  protected:
    static constexpr glm::vec2 kFrom{0.1f, 0.45f}, kTo{0.9f, 0.62f};  // of the border, x and y
    void SetUp() override {
        FrameTest::SetUp();
        settings.resolution = {40, 24};
        setMethod(settings, Method::none);
        settings.views.vpls = 4;
    }
    void open(glm::vec3 radiance) {
        quad_ = testing::emptyScene();
        quad_.materials[0].baseColor = {0, 0, 0, 1};
        quad_.materials[0].emission = radiance;
        testing::addQuad(quad_, {glm::vec3(0.1f, 0.1f, 0.5f),
                                 {0.9f, 0.1f, 0.5f},
                                 {kTo.x, kTo.y, 0.5f},
                                 {kFrom.x, kFrom.y, 0.5f}});
        quadBvh_ = TriangleBvh::build(quad_);
        quadHierarchy_ = SceneHierarchy::build(quad_, quadBvh_, 4);
        renderer = std::make_unique<FrameRenderer>();
        renderer->setScene(quad_, quadBvh_, quadHierarchy_);
    }
    void lookFlat(bool flat) {
        input.camera = {};
        input.camera.position = {0.5f, 0.5f, 0.9f};
        if (flat) {
            input.camera.orthoHalfHeight = 0.3f;
        } else {
            input.camera.yfovRad = 2 * std::atan(0.3f / 0.4f);
        }
    }
    // The share of a pixel below the border: the square cut by the line. Pixels 1/40 wide.
    static double coverage(int x, int y) {
        const auto below = [](glm::dvec2 p) {
            const glm::dvec2 a(kFrom), b(kTo);
            return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);  // < 0: below
        };
        std::vector<glm::dvec2> kept;
        const glm::dvec2 low(x / 40.0, 0.2 + y / 40.0);
        const glm::dvec2 corners[] = {low, low + glm::dvec2(0.025, 0), low + glm::dvec2(0.025),
                                      low + glm::dvec2(0, 0.025)};
        for (int i = 0; i < 4; ++i) {
            const glm::dvec2 p = corners[i], q = corners[(i + 1) % 4];
            const double dp = below(p), dq = below(q);
            if (dp < 0) kept.push_back(p);
            if ((dp < 0) != (dq < 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
        }
        double area = 0;
        for (std::size_t i = 0; i < kept.size(); ++i) {
            const glm::dvec2 p = kept[i], q = kept[(i + 1) % kept.size()];
            area += 0.5 * (p.x * q.y - p.y * q.x);
        }
        return area / (0.025 * 0.025);
    }
    template <typename Visit>
    void eachPixelOfTheBorder(const Visit& visit) const {
        for (int y = 6; y < 20; ++y) {
            for (int x = 6; x < 34; ++x) {
                visit(static_cast<std::size_t>(4 * (y * 40 + x)), coverage(x, y));
            }
        }
    }

    Scene quad_;
    TriangleBvh quadBvh_;
    SceneHierarchy quadHierarchy_;
};

TEST_F(Edges, CoverageIsThatOfTheCutPixel) {
    open(glm::vec3(1));
    for (const bool flat : {true, false}) {
        lookFlat(flat);
        double before = 0;
        for (const int points : {1, 4, 16, 64}) {
            settings.picture.pixelSamples = points;
            while (render().accumulatedFrames < points) {
            }
            const auto light = radiance();
            double worst = 0, sum = 0, absolute = 0;
            int cut = 0;
            eachPixelOfTheBorder([&](std::size_t at, double covered) {
                worst = std::max(worst, std::abs(light[at] - covered));
                sum += light[at] - covered;
                absolute += std::abs(light[at] - covered);
                cut += covered > 0.001 && covered < 0.999;
            });
            ASSERT_GT(cut, 25);
            if (points == 1) {
                EXPECT_GT(worst, 0.4);
            } else {
                EXPECT_LE(worst, coverageTolerance(points)) << points << (flat ? " flat" : "");
                EXPECT_LE(std::abs(sum) / cut, 0.6 / points) << points;
                EXPECT_LE(absolute / cut, 1.0 / points) << points;
                EXPECT_LT(worst, before);
            }
            before = worst;
        }
    }
}

// A lamp far brighter than white: its radiance is a plain mean, its picture has soft edges still,
// and a rim as white as the lamp is.
TEST_F(Edges, BrightOnesAreSoftOnTheDisplay) {
    open({4000, 2000, 1000});
    lookFlat(true);
    settings.picture.pixelSamples = 64;
    for (const ToneMap map : {ToneMap::aces, ToneMap::neutral, ToneMap::agx, ToneMap::none}) {
        settings.display.toneMap = map;
        while (render().accumulatedFrames < 64) {
        }
        const auto light = radiance();
        const auto shown = display();
        int between = 0, white = 0;
        eachPixelOfTheBorder([&](std::size_t at, double covered) {
            EXPECT_NEAR(light[at] / 4000, covered, coverageTolerance(64));
            if (covered < 0.02) {
                EXPECT_LT(shown[at], 40);
            } else if (covered > 0.98) {
                EXPECT_GT(shown[at], 240);
            } else {
                EXPECT_LT(std::abs(int{shown[at]} - int{shown[at + 2]}), 16) << covered;
            }
            if (covered < 0.2 || covered > 0.7) return;
            ++between;
            white += shown[at] > 235;
        });
        EXPECT_GT(between, 10);
        EXPECT_EQ(white, 0);
    }
}

}  // namespace
}  // namespace mv
