#pragma once
// Measures the points of a sweep: time by stage, pairs, memory and error of every one, in one
// process. Points that differ in nothing but the method are measured together, the methods in turn
// within each repetition, so that what disturbs the machine disturbs them alike; their ratios are
// taken within a repetition.

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/bench/sweep_grid.h"
#include "app/bench/sweep_references.h"
#include "app/common/scene_assets.h"
#include "megaviews/measure/metrics.h"

namespace mv {

// For every point: which value of one more setting meets a time or an error (sweep_search.h).
struct SweepSearch {
    enum class Goal { time, error };
    Goal goal = Goal::time;
    double limit = 0;  // ms of indirect light (maps and gather), or in the metric's unit
    Metric metric = Metric::relMse;
    ErrorAgainst against = ErrorAgainst::exact;
    SweepAxis vary;
};

struct SweepRequest {
    std::string scene;
    std::filesystem::path cacheFolder;  // of scene octrees; empty: none
    std::string referencesFolder;       // empty: no errors
    Settings base;
    std::vector<SweepAxis> axes;
    std::optional<SweepSearch> search;
    int warmup = 1, frames = 5;
    bool quiet = false;  // show no progress of loading

    // Every point, or with a search every point and value it may try; see sweepPoints().
    std::vector<SweepPoint> points() const { return sweepPoints(base, axes); }
    void check() const;  // throws as sweepPoints(), and Error(ExitCode::usage) of an image
};

class Sweep {
  public:
    // Loads the scene and checks every point's camera. Needs no context yet.
    explicit Sweep(const SweepRequest& request);
    ~Sweep();
    const SceneAssets& assets() const;

    // Calls `finished` with the index of a point and what was measured of it (docs/benchmark.md),
    // in order; points whose `skip` is set are left out. A point that cannot fit the memory has a
    // "refusal". Throws Cancelled when interrupted. Needs a current context.
    using Finished = std::function<void(std::size_t, nlohmann::ordered_json)>;
    void run(const std::vector<SweepPoint>& points, const std::vector<bool>& skip,
             const Finished& finished);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
