#include "ui/frame_history.h"

#include <algorithm>
#include <cmath>

namespace mv::ui {
namespace {

template <typename T>
void pushBounded(std::vector<T>& ring, T value, std::size_t most) {
    if (ring.size() >= most) ring.erase(ring.begin());
    ring.push_back(value);
}

}  // namespace

FrameWork::FrameWork(const Settings& made, bool draft)
    : views(made.views),
      gather(made.gather),
      side{made.side[0], made.side[1]},
      width(draft ? 0 : made.resolution.width),
      height(draft ? 0 : made.resolution.height) {}

void FrameHistory::add(const FrameStatistics& statistics, const FrameWork& work) {
    if (statistics.clock != clock_) clear();  // times of two clocks do not mix
    if (work != work_) {
        for (Group& group : groups_) group = {};
    }
    clock_ = statistics.clock;
    work_ = work;
    ++frames_;
    pushBounded(frameMs_, static_cast<float>(statistics.frameMs), kPlottedFrames);
    addGroup(groups_[0], statistics.sharedStages);
    for (std::size_t side = 0; side < 2; ++side) {
        if (side < statistics.methods.size()) {
            addGroup(groups_[side + 1], statistics.methods[side].stages);
        } else {
            groups_[side + 1] = {};
        }
    }
}

void FrameHistory::clear() { *this = FrameHistory(); }

void FrameHistory::addGroup(Group& group, const std::vector<StageTime>& stages) {
    std::size_t place = 0;
    for (const StageTime& time : stages) {
        auto it = std::find_if(group.stages.begin(), group.stages.end(),
                               [&](const Series& s) { return s.stage == time.stage; });
        if (it == group.stages.end()) {  // where it stands in this frame
            it = group.stages.insert(group.stages.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                place, group.stages.size())),
                                     Series{time.stage, {}, 0});
        }
        place = static_cast<std::size_t>(it - group.stages.begin()) + 1;
        if (it->lastFrame == frames_) {  // a stage that ran twice is one stage
            it->ms.back() += time.ms;
        } else {
            pushBounded(it->ms, time.ms, kSummarisedFrames);
            it->lastFrame = frames_;
        }
    }
    std::erase_if(group.stages,
                  [&](const Series& s) { return s.lastFrame + kSummarisedFrames < frames_; });
}

FrameHistory::GroupTime FrameHistory::medianOf(std::size_t group,
                                               std::optional<StageGroup> of) const {
    GroupTime time;
    for (const Series& series : groups_[group].stages) {
        if (of && infoOf(series.stage).group != *of) continue;
        time.ms += summarize(series.ms).median;
        time.frames = std::max(time.frames, series.ms.size());
    }
    return time;
}

double percentile(std::vector<float> samples, double share01) {
    if (samples.empty()) return 0;
    std::sort(samples.begin(), samples.end());
    const double rank = std::ceil(share01 * static_cast<double>(samples.size()));
    const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
    return static_cast<double>(samples[std::min(index, samples.size() - 1)]);
}

}  // namespace mv::ui
