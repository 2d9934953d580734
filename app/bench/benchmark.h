#pragma once
// How long the methods take on one scene over a list of view counts. All counts and methods run in
// one process, methods in turn within each repetition, so that what disturbs the machine disturbs
// them alike; ratios are taken within a repetition.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/common/run_options.h"
#include "app/common/scene_assets.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {

struct BenchmarkRequest {
    std::vector<std::int64_t> viewCounts;
    std::vector<Method> methods;
    int warmup = 1, frames = 5;
};

// One method at one count.
struct BenchmarkRow {
    Method method = Method::megaviews;
    std::int64_t views = 0;
    FrameStatistics statistics;   // of the last frame
    StageSamples shared, stages;  // common to all methods, and the method's own
    std::vector<double> visibilityMs, frameMs;
    Summary ratioToManyLods;  // ManyLoDs' visibility time over this method's; count 0 without it
    std::string refusal;      // why it could not run; everything else is then empty
};

std::vector<BenchmarkRow> runBenchmark(const SceneAssets& assets, const Settings& settings,
                                       const BenchmarkRequest& request);

std::string benchmarkTable(const std::vector<BenchmarkRow>& rows);
std::string benchmarkCsv(const std::vector<BenchmarkRow>& rows);
nlohmann::ordered_json benchmarkJson(const std::vector<BenchmarkRow>& rows,
                                     const SceneAssets& assets, const Settings& settings,
                                     const BenchmarkRequest& request);

}  // namespace mv
