#pragma once
// The last frames' times: whole frames for the plot, stages for the profiler's tree. Rings of plain
// numbers, cheap enough to be kept whether or not the profiler is open.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "megaviews/settings/statistics_table.h"

namespace mv::ui {

inline constexpr std::size_t kPlottedFrames = 512, kSummarisedFrames = 256;

// What frames have in common whose stages' times are summarised together. A draft has any size.
struct FrameWork {
    FrameWork() = default;
    FrameWork(const Settings& made, bool draft);
    bool operator==(const FrameWork&) const = default;

    ViewSettings views;
    GatherSettings gather;
    std::array<MethodSettings, 2> side;
    int width = 0, height = 0;  // 0: of a draft
};

class FrameHistory {
  public:
    // Stages of frames that did other work are forgotten; the plot shows them all.
    void add(const FrameStatistics& statistics, const FrameWork& work = {});
    void clear();

    // Oldest first.
    const std::vector<float>& frameMs() const { return frameMs_; }
    const std::string& clock() const { return clock_; }

    struct Series {
        Stage stage{};
        std::vector<double> ms;  // newest last; frames that did not run the stage are not in it
        std::size_t lastFrame = 0;
    };
    // 0: shared by both sides, 1: left, 2: right. Stages in the order of a frame; those that no
    // summarised frame ran have gone.
    const std::vector<Series>& stages(std::size_t group) const { return groups_[group].stages; }
    // The sum of its medians, of one kind of stages or of all, and how many frames they are of.
    struct GroupTime {
        double ms = 0;
        std::size_t frames = 0;
    };
    GroupTime medianOf(std::size_t group, std::optional<StageGroup> of = {}) const;

  private:
    struct Group {
        std::vector<Series> stages;
    };
    void addGroup(Group& group, const std::vector<StageTime>& stages);

    std::string clock_;
    FrameWork work_;
    std::vector<float> frameMs_;
    Group groups_[3];
    std::size_t frames_ = 0;
};

// The smallest sample that at least `share01` of the samples do not exceed; 0 without samples.
double percentile(std::vector<float> samples, double share01);

}  // namespace mv::ui
