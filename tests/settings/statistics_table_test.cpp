#include "megaviews/settings/statistics_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "megaviews/settings/actions.h"

namespace mv {
namespace {

TEST(StatisticsTable, PathsAreUniqueAndDescribed) {
    const auto check = [](const auto& table) {
        std::set<std::string_view> paths;
        for (const auto& info : table) {
            EXPECT_TRUE(paths.insert(info.path).second) << info.path;
            EXPECT_TRUE(info.path.starts_with("/")) << info.path;
            EXPECT_TRUE(info.description.ends_with(".")) << info.path;
            EXPECT_FALSE(info.label.empty()) << info.path;
        }
    };
    check(frameStatistics());
    check(methodStatistics());
    std::set<std::string_view> stages;
    for (const StageInfo& stage : stageTable()) {
        EXPECT_TRUE(stages.insert(stage.name).second) << stage.name;
        EXPECT_TRUE(stage.description.ends_with(".")) << stage.name;
    }
}

TEST(StatisticsTable, JsonHoldsEveryNumberAtItsPath) {
    MethodStatistics m;
    m.pairs = {18'000'000'000ull, 2, 3, 4, 5, 6, 9};
    m.queuePeakPairs = 7;
    m.passes = {8, 1, 3, 7, 0.0625};
    m.queueBytes = 9;
    m.mapBytes = 10;
    m.sceneHierarchyBytes = 11;
    m.viewHierarchyBytes = 12;
    m.maps = 13;
    const auto json = toJson(m);
    EXPECT_EQ(json["pairs"]["processed"], 18'000'000'000ull);
    EXPECT_EQ(json["pairs"]["culled"], 2);
    EXPECT_EQ(json["pairs"]["rendered"], 3);
    EXPECT_EQ(json["pairs"]["subdivided"], 4);
    EXPECT_EQ(json["pairs"]["skipped"], 5);
    EXPECT_EQ(json["pairs"]["forced"], 6);
    EXPECT_EQ(json["viewsPerRenderedNode"], 3.0);
    EXPECT_EQ(json["queuePeakPairs"], 7);
    EXPECT_EQ(json["passes"], 8);
    EXPECT_EQ(json["prediction"]["overflows"], 1);
    EXPECT_EQ(json["prediction"]["falseAlarms"], 3);
    EXPECT_EQ(json["prediction"]["error"], 0.0625);
    EXPECT_EQ(json["memoryBytes"]["queue"], 9);
    EXPECT_EQ(json["memoryBytes"]["maps"], 10);
    EXPECT_EQ(json["memoryBytes"]["sceneHierarchy"], 11);
    EXPECT_EQ(json["memoryBytes"]["viewHierarchy"], 12);
    EXPECT_EQ(json["maps"], 13);
    // Methods that test no pairs have none, which is not to say 0.
    const auto none = toJson(MethodStatistics{});
    EXPECT_TRUE(none["viewsPerRenderedNode"].is_null());
    EXPECT_TRUE(none["pairs"]["processed"].is_null());
    EXPECT_TRUE(none["queuePeakPairs"].is_null());
    EXPECT_TRUE(none["prediction"]["error"].is_null());
    EXPECT_EQ(none["maps"], 0);

    FrameStatistics f;
    f.viewsRequested = 1;
    f.viewsAlive = 2;
    f.viewNodes = 3;
    f.viewLeaves = 4;
    f.viewNodesPerLevel = {1, 2};
    f.badPixels = 5;
    f.exposureEv = -1.5;
    f.frameMs = 2.5;
    const auto frame = toJson(f);
    EXPECT_EQ(frame["views"]["requested"], 1);
    EXPECT_EQ(frame["views"]["alive"], 2);
    EXPECT_EQ(frame["views"]["nodes"], 3);
    EXPECT_EQ(frame["views"]["leaves"], 4);
    EXPECT_EQ(frame["views"]["nodesPerLevel"].size(), 2u);
    EXPECT_EQ(frame["picture"]["badPixels"], 5);
    EXPECT_EQ(frame["picture"]["exposureEv"], -1.5);
    EXPECT_EQ(frame["frameMs"], 2.5);
    EXPECT_EQ(frame["picture"]["accumulatedFrames"], 1);
    EXPECT_TRUE(frame["memory"].empty());
    EXPECT_FALSE(frame.contains("freeGpuBytes"));
}

TEST(StatisticsTable, JsonHoldsMemoryAndLevels) {
    FrameStatistics f;
    f.accumulatedFrames = 7;
    f.differenceRange = 0.25;
    f.memory = {{"scene octree", 100, 0}, {"final maps, left", 300, 200}};
    f.freeGpuBytes = 1000;
    const auto frame = toJson(f);
    EXPECT_EQ(frame["picture"]["accumulatedFrames"], 7);
    EXPECT_EQ(frame["picture"]["differenceRange"], 0.25);
    ASSERT_EQ(frame["memory"].size(), 2u);
    EXPECT_EQ(frame["memory"][0]["name"], "scene octree");
    EXPECT_EQ(frame["memory"][0]["usedBytes"], 100);
    EXPECT_FALSE(frame["memory"][0].contains("predictedBytes"));
    EXPECT_EQ(frame["memory"][1]["predictedBytes"], 200);
    EXPECT_EQ(frame["freeGpuBytes"], 1000);

    MethodStatistics m;
    m.predictedQueueBytes = 1;
    m.predictedMapBytes = 2;
    m.predictedWorkingMapBytes = 3;
    m.occupancy = {4, 5};
    EXPECT_FALSE(toJson(m).contains("pairsPerLevel"));
    m.pairsPerLevel = {{10, 1, 2, 3, 4, 5, 6}, {}};
    const auto method = toJson(m);
    EXPECT_EQ(method["memoryBytes"]["predictedQueue"], 1);
    EXPECT_EQ(method["memoryBytes"]["predictedMaps"], 5);
    EXPECT_EQ(method["occupancy"], nlohmann::ordered_json({4, 5}));
    ASSERT_EQ(method["pairsPerLevel"].size(), 2u);
    EXPECT_EQ(method["pairsPerLevel"][0], nlohmann::ordered_json({{"processed", 10},
                                                                  {"culled", 1},
                                                                  {"rendered", 2},
                                                                  {"subdivided", 3},
                                                                  {"skipped", 4},
                                                                  {"forced", 5},
                                                                  {"renderedViews", 6}}));
}

TEST(Summary, MatchesTheDefinitionOnRandomSamples) {
    std::mt19937 random(3);
    for (const std::size_t n : {1u, 2u, 3u, 19u, 20u, 21u, 100u, 101u}) {
        std::vector<double> samples(n);
        for (double& x : samples) x = std::uniform_real_distribution<>(0, 10)(random);
        const Summary s = summarize(samples);
        EXPECT_EQ(s.count, n);
        const auto notAbove = [&](double x) {
            return std::count_if(samples.begin(), samples.end(), [&](double y) { return y <= x; });
        };
        EXPECT_GE(notAbove(s.p95), 0.95 * static_cast<double>(n)) << n;
        for (const double x : samples) {
            EXPECT_LE(s.min, x);
            EXPECT_GE(s.max, x);
            if (x < s.p95) {
                EXPECT_LT(notAbove(x), 0.95 * static_cast<double>(n)) << n;
            }
        }
        const auto below =
            std::count_if(samples.begin(), samples.end(), [&](double y) { return y < s.median; });
        const auto above =
            std::count_if(samples.begin(), samples.end(), [&](double y) { return y > s.median; });
        EXPECT_EQ(below, above) << n;
        EXPECT_GE(s.sd, 0);
    }
    EXPECT_EQ(summarize({}).count, 0u);
    EXPECT_EQ(summarize({4}).sd, 0);
    EXPECT_DOUBLE_EQ(summarize({1, 3}).sd, std::sqrt(2.0));
    EXPECT_EQ(summarize({3, 1}).median, 2);
}

TEST(StageSamples, AddsEqualNamesAndCountsMissingAsZero) {
    StageSamples samples;
    samples.add({{Stage::fuse, 1}, {Stage::fill, 2}, {Stage::fuse, 3}});
    samples.add({{Stage::fill, 5}});
    samples.add({{Stage::filter, 7}});
    ASSERT_EQ(samples.stages().size(), 3u);
    EXPECT_EQ(samples.stages()[0].ms, (std::vector<double>{4, 0, 0}));
    EXPECT_EQ(samples.stages()[1].ms, (std::vector<double>{2, 5, 0}));
    EXPECT_EQ(samples.stages()[2].ms, (std::vector<double>{0, 0, 7}));
    EXPECT_EQ(samples.toJson()["fill"]["median"], 2);
}

TEST(Actions, NamesAndKeysAreUnique) {
    std::set<std::string_view> names, keys;
    std::set<Action> actions;
    for (const ActionInfo& info : actionsTable()) {
        EXPECT_TRUE(actions.insert(info.action).second) << info.name;
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_TRUE(info.help.ends_with(".")) << info.name;
        EXPECT_FALSE(info.menu.empty()) << info.name;
        std::string_view rest = info.key;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find(' '), rest.size());
            EXPECT_TRUE(keys.insert(rest.substr(0, end)).second) << info.name << " " << rest;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    }
    // Every enumerator up to the last has its row.
    for (int i = 0; i <= static_cast<int>(Action::vsync); ++i) {
        EXPECT_TRUE(actions.contains(static_cast<Action>(i))) << i;
        EXPECT_EQ(infoOf(static_cast<Action>(i)).action, static_cast<Action>(i));
    }
}

}  // namespace
}  // namespace mv
