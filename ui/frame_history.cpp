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

FrameWork::FrameWork(const Settings& made, bool ofDraft)
    : draft(ofDraft), views(made.views), gather(made.gather), side{made.side[0], made.side[1]} {}

void FrameHistory::add(const FrameStatistics& statistics, const FrameWork& work) {
    if (statistics.clock != clock_) clear();  // times of two clocks do not mix
    clock_ = statistics.clock;
    pushBounded(frameMs_, static_cast<float>(statistics.frameMs), kPlottedFrames);
    draft_ = work.draft;
    Kind& kind = kinds_[draft_ ? 1 : 0];
    kind.forgetOther(work);
    ++kind.frames;
    kind.addGroup(kind.groups[0], statistics.stagesOfBothSides);
    for (std::size_t side = 0; side < 2; ++side) {
        if (side < statistics.methods.size()) {
            kind.addGroup(kind.groups[side + 1], statistics.methods[side].stages);
        } else {
            kind.groups[side + 1] = {};
        }
    }
}

void FrameHistory::clear() { *this = FrameHistory(); }

// The stages that did other work.
void FrameHistory::Kind::forgetOther(const FrameWork& other) {
    for (std::size_t g = 0; g < 3; ++g) {
        if (other.views != work.views || (g > 0 && other.side[g - 1] != work.side[g - 1])) {
            groups[g] = {};
        } else if (other.gather != work.gather) {
            std::erase_if(groups[g].stages, [](const Series& series) {
                return infoOf(series.stage).group == StageGroup::gather;
            });
        }
    }
    work = other;
}

void FrameHistory::Kind::addGroup(Group& group, const std::vector<StageTime>& stages) {
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
        if (it->lastFrame == frames) {  // a stage that ran twice is one stage
            it->ms.back() += time.ms;
        } else {
            pushBounded(it->ms, time.ms, kSummarisedFrames);
            it->lastFrame = frames;
        }
    }
    std::erase_if(group.stages,
                  [&](const Series& s) { return s.lastFrame + kSummarisedFrames < frames; });
}

FrameHistory::GroupTime FrameHistory::medianOf(std::size_t group,
                                               std::optional<StageGroup> of) const {
    GroupTime time;
    for (const Series& series : stages(group)) {
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
