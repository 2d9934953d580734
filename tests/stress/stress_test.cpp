// Every case of `megaviews-bench stress`, and that its verdicts can be bad ones.

#include "app/bench/stress.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/bench/stress_scene.h"
#include "app/bench/stress_truth.h"
#include "megaviews/core/error.h"
#include "megaviews/references/exact_gather.h"
#include "renderer/gl/context.h"

namespace mv::stress {
namespace {

class Stress : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        if (context_ || !reason_.empty()) return;
        try {
            context_ = std::make_unique<gl::HeadlessContext>();
            runner_ = std::make_unique<Runner>();
        } catch (const Error& e) {
            reason_ = e.what();
        }
    }
    static void TearDownTestSuite() {
        runner_.reset();
        context_.reset();
    }
    void SetUp() override {
        if (!context_) GTEST_SKIP() << "no OpenGL context: " << reason_;
    }
    static std::string failuresOf(const Case& oneCase) {
        std::string all;
        for (const std::string& f : runner_->run(oneCase).failures) all += f + "\n";
        return all;
    }

  private:
    static inline std::unique_ptr<gl::HeadlessContext> context_;
    static inline std::unique_ptr<Runner> runner_;
    static inline std::string reason_;
};

class StressCase : public Stress, public ::testing::WithParamInterface<std::size_t> {};

TEST_P(StressCase, Holds) {
    EXPECT_EQ(failuresOf(cases()[GetParam()]), "");
    EXPECT_EQ(gl::reportedErrors(), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, StressCase, ::testing::Range(std::size_t{0}, cases().size()),
                         [](const ::testing::TestParamInfo<std::size_t>& parameter) {
                             std::string name = cases()[parameter.param].name;
                             for (char& c : name)
                                 if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                             return name;
                         });

TEST_F(Stress, AnErrorAboveItsBoundFails) {
    Case strict = cases().front();
    strict.name = "strict";
    strict.factor = 0.9;
    EXPECT_NE(failuresOf(strict).find("times the benign case's error"), std::string::npos);
}

TEST_F(Stress, AnotherPictureFails) {
    Case moved = cases().front();
    moved.name = "moved";
    moved.sameAs = Equality{"room", 1, 1e-3};
    EXPECT_EQ(failuresOf(moved), "");
    moved.sameAs->gain = 1.01;
    EXPECT_NE(failuresOf(moved).find("from that of room"), std::string::npos);
}

TEST_F(Stress, BadPixelsFail) {
    Case endless = cases().front();
    endless.name = "endless";
    endless.make = [] {
        World w = litRoom();
        w.use(glm::vec3(0.5f), glm::vec3(std::numeric_limits<float>::infinity()));
        w.quad({7.98, 1, 4}, {7.98, 1, 5}, {7.98, 2, 5}, {7.98, 2, 4});
        Input input{w.finish(5), std::nullopt, {}};
        input.settings.resolution.width = 64;
        input.settings.resolution.height = 48;
        input.settings.views.vpls = 50;
        input.settings.scene.octreeDepth = input.settings.views.octreeDepth = 5;
        return input;
    };
    EXPECT_NE(failuresOf(endless).find("bad pixels"), std::string::npos);
}

TEST(StressCases, HaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const Case& c : cases()) {
        EXPECT_TRUE(names.insert(c.name).second) << c.name;
        EXPECT_FALSE(c.why.empty()) << c.name;
        EXPECT_EQ(c.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-.^'"),
                  std::string::npos)
            << c.name;
        EXPECT_TRUE(!c.sameAs || names.count(c.sameAs->other)) << c.name;
    }
}

TEST(StressCommand, RefusesWhatItDoesNotKnow) {
    EXPECT_THROW(stressCommand({"--onyl"}), Error);
    EXPECT_THROW(stressCommand({"--only"}), Error);
    EXPECT_THROW(stressCommand({"--only", "rooms"}), Error);
    EXPECT_THROW(stressCommand({"--json"}), Error);
}

// The brute force against Embree's rays, in a room that hides a good part of its light.
TEST(StressTruth, IsTheReferencesExactGather) {
    const Input input = cases().front().make();
    const Scene& scene = input.assets->scene;
    const Emitters emitters = makeEmitters(scene, input.assets->bvh, {});
    const ViewSet set = traceVpls(input.assets->bvh, emitters, {300, 4, 1});
    std::vector<Receiver> receivers;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const auto hit = input.assets->bvh.intersect(scene.root.rootFromWorld({6.5, 2, 2}),
                                                     randomDirection(1, i), 0, 10);
        ASSERT_TRUE(hit);
        const glm::vec3 n = scene.normals[scene.triangles[hit->triangle].x];
        receivers.push_back(
            {scene.root.rootFromWorld({6.5, 2, 2}) + randomDirection(1, i) * hit->t, n});
    }
    receivers.push_back({});  // no surface
    const Truth truth = bruteForceGather(scene, set.views, receivers, 0.01f);
    IrradianceImage exact, open;
    const EmbreeScene embree(input.assets->bvh);
    const auto width = static_cast<int>(receivers.size());
    exactGather(embree, set.views, receivers, width, 1, {}, exact);
    exactGather(embree, set.views, receivers, width, 1, {.visibility = false}, open);
    double sum = 0, hidden = 0, wrong = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        EXPECT_LE(glm::length(truth.open[i] - open.mean[i]), 1e-5f * glm::length(open.mean[i]));
        sum += glm::length(glm::dvec3(open.mean[i]));
        hidden += glm::length(glm::dvec3(open.mean[i] - exact.mean[i]));
        // A ray along an edge may be decided either way.
        wrong += glm::length(glm::dvec3(truth.irradiance[i] - exact.mean[i]));
    }
    EXPECT_GT(hidden, 0.1 * sum);
    EXPECT_LT(wrong, 1e-4 * sum);
    EXPECT_EQ(truth.irradiance.back(), glm::vec3(0));
}

TEST(StressTruth, SeesTrianglesFromBothSidesAndNoneBeyondTheEnds) {
    World w;
    w.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const auto assets = w.finish(3);
    const auto at = [&](double x, double y, double z) {
        return glm::dvec3(assets->scene.root.rootFromWorld({x, y, z}));
    };
    EXPECT_TRUE(blocked(assets->scene, at(0.2, 0.2, 1), at(0.2, 0.2, -1)));
    EXPECT_TRUE(blocked(assets->scene, at(0.2, 0.2, -1), at(0.2, 0.2, 1)));
    EXPECT_FALSE(blocked(assets->scene, at(0.2, 0.2, 1), at(0.2, 0.2, 0.1)));
    EXPECT_FALSE(blocked(assets->scene, at(0.2, 0.2, -0.1), at(0.2, 0.2, -1)));
    EXPECT_FALSE(blocked(assets->scene, at(0.8, 0.8, 1), at(0.8, 0.8, -1)));
    EXPECT_FALSE(blocked(assets->scene, at(0.2, 0.2, 1), at(0.3, 0.2, 1)));
}

}  // namespace
}  // namespace mv::stress
