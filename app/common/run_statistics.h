#pragma once
// What --stats writes: one JSON object with everything needed to compare two runs - program, GL
// strings, host, scene, settings, and for every method counters, memory and times over the measured
// frames. Its layout is kStatisticsSchema; names and units are those of statistics_table.h.

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/common/scene_assets.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {

inline constexpr int kStatisticsSchema = 1;

class RunStatistics {
  public:
    // Each measured frame is added, no warm-up frame. Frames differ in time, not in methods.
    void add(const FrameStatistics& frame);
    std::size_t frames() const { return frames_; }
    std::uint64_t badPixels() const { return badPixels_; }

    // Counters are those of the last frame, bad pixels the sum over all.
    struct Run {
        int warmupFrames = 0;
        bool partial = false;       // not all frames are there, or the last is not whole
        bool deterministic = true;  // frames depend on settings alone: time went by steps
    };
    nlohmann::ordered_json toJson(const SceneAssets& assets, const Settings& settings,
                                  const Run& run) const;

  private:
    std::size_t frames_ = 0;
    std::uint64_t badPixels_ = 0;
    FrameStatistics last_;
    std::vector<double> frameMs_;
    StageSamples bothSides_;
    std::vector<StageSamples> methods_;
};

// Parts that other reports share.
nlohmann::ordered_json programJson();
nlohmann::ordered_json graphicsJson();  // of the current context
nlohmann::ordered_json hostJson();
nlohmann::ordered_json sceneJson(const SceneAssets& assets);

std::string textOf(const nlohmann::ordered_json& json);
// Written aside and renamed; Error(ExitCode::output) names the file.
void writeJson(const std::string& file, const nlohmann::ordered_json& json);

}  // namespace mv
