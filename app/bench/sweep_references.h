#pragma once
// How wrong a point of a sweep is: its picture against the same picture with the indirect light of
// the references, exact (the same views) and pathtraced (no views), which the viewer made and kept
// (ReferenceStore). This program only reads them.

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/common/scene_assets.h"
#include "megaviews/measure/measurement.h"
#include "megaviews/measure/reference_store.h"
#include "renderer/frame_renderer.h"

namespace mv {

// Which of the two a metric is measured against.
enum class ErrorAgainst { exact, pathtraced };
std::string_view nameOf(ErrorAgainst against);

class SweepReferences {
  public:
    // `folder` empty: nothing is measured.
    explicit SweepReferences(std::filesystem::path folder);

    bool any() const { return !folder_.empty(); }
    // Renders; a reference method with the light that is kept in the store. Otherwise says what is
    // not there, or not whole, and the frame shows no indirect light.
    std::optional<std::string> render(FrameRenderer& renderer, const Scene& scene,
                                      const Settings& settings, const FrameInput& input,
                                      FrameStatistics& statistics);

    // Measures the picture that the renderer made last with these settings and input; afterwards it
    // shows the reference's. Without an exposure in the settings, both take the one that fits the
    // reference. If the store lacks it, its array's name goes to `missing`.
    std::optional<Measurement> measure(FrameRenderer& renderer, const Scene& scene,
                                       const Settings& settings, const FrameInput& input,
                                       const RgbImage& radiance, ErrorAgainst against,
                                       std::vector<std::string>& missing);

  private:
    std::filesystem::path folder_;
    ReferenceStore store_;
    std::string lastName_;          // of the reference that was asked for last
    std::set<std::string> missed_;  // said once each
    // Exposures that were fitted, by reference and tone map.
    std::map<std::pair<std::string, ToneMap>, double> exposuresEv_;
};

}  // namespace mv
