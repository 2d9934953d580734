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

// What frames have in common whose stages' times are summarised together. Pictures of all sizes:
// maps know nothing of it, and stay when a window is resized.
struct FrameWork {
    FrameWork() = default;
    FrameWork(const Settings& made, bool draft);

    bool draft = false;
    ViewSettings views;
    GatherSettings gather;               // maps know nothing of it either
    std::array<MethodSettings, 2> side;  // each side's own
};

class FrameHistory {
  public:
    // Drafts and whole pictures have stages of their own, of which those of the last frame's kind
    // are shown; those of frames that did other work are forgotten. The plot shows them all.
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
    // 0: of both sides, 1: left, 2: right. Stages in the order of a frame; those that no
    // summarised frame ran have gone.
    const std::vector<Series>& stages(std::size_t group) const {
        return shown().groups[group].stages;
    }
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
    struct Kind {
        FrameWork work;
        Group groups[3];
        std::size_t frames = 0;
        void forgetOther(const FrameWork& other);
        void addGroup(Group& group, const std::vector<StageTime>& stages);
    };
    const Kind& shown() const { return kinds_[draft_ ? 1 : 0]; }

    std::string clock_;
    std::vector<float> frameMs_;
    Kind kinds_[2];  // whole pictures, drafts
    bool draft_ = false;
};

// The smallest sample that at least `share01` of the samples do not exceed; 0 without samples.
double percentile(std::vector<float> samples, double share01);

}  // namespace mv::ui
