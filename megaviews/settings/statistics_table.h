#pragma once
// Each number a frame reports, named once with its unit and what it means: panels, statistics files
// and benchmark tables are made from these lists. Times carry no unit but "ms": which clock they
// were taken with is FrameStatistics::clock.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/settings/statistics.h"

namespace mv {

template <typename Source>
struct StatisticInfo {
    std::string_view path;   // JSON pointer within its object: "/pairs/processed"
    std::string_view label;  // for panels and tables
    std::string_view unit;   // "pairs", "bytes", "ms", ...; empty: a plain number
    std::string_view description;
    double (*value)(const Source&);  // NaN: there is none, null in JSON
    bool whole = true;               // a count: printed and stored as an integer
};

std::span<const StatisticInfo<FrameStatistics>> frameStatistics();
std::span<const StatisticInfo<MethodStatistics>> methodStatistics();

// What a stage's time counts to. Many-view methods are compared by the time of their maps.
enum class StageGroup { views, surfaces, maps, gather, picture };

// Stages that passes time, in the order of a frame: a pass cannot time anything else.
struct StageInfo {
    Stage stage{};
    StageGroup group{};
    std::string_view name;
    std::string_view description;
};
std::span<const StageInfo> stageTable();
const StageInfo& infoOf(Stage stage);
double groupMs(const std::vector<StageTime>& stages, StageGroup group);

// The numbers of a frame or of one of its methods as JSON, laid out by their paths.
nlohmann::ordered_json toJson(const FrameStatistics& statistics);
nlohmann::ordered_json toJson(const MethodStatistics& statistics);

// A repeated measurement in a few numbers; all zero without samples. p95 is the smallest sample
// that at least 95 % of the samples do not exceed; the median of an even count is the mean of the
// two in the middle.
struct Summary {
    std::size_t count = 0;
    double median = 0, p95 = 0, min = 0, max = 0, mean = 0, sd = 0;
};
Summary summarize(std::vector<double> samples);
nlohmann::ordered_json toJson(const Summary& summary);

// Milliseconds of each stage over several frames, stages in order of first appearance.
class StageSamples {
  public:
    void add(const std::vector<StageTime>& stages);
    struct Series {
        Stage stage{};
        std::vector<double> ms;
    };
    const std::vector<Series>& stages() const { return stages_; }
    nlohmann::ordered_json toJson() const;  // {stage: summary}

  private:
    std::vector<Series> stages_;
    std::size_t frames_ = 0;
};

}  // namespace mv
