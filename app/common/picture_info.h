#pragma once
// What a picture says about itself: everything needed to make it again, as text chunks of a PNG or
// attributes of an EXR. Holds nothing that differs between two runs with the same settings, so that
// the files have the same bytes; times are in the statistics file.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/common/scene_assets.h"
#include "app/common/state.h"
#include "megaviews/measure/measurement.h"
#include "megaviews/settings/statistics.h"

namespace mv {

struct PictureInfo {
    const SceneAssets* assets = nullptr;
    std::string viewsHash;  // of the file of views, if there is one
    Settings settings;
    int frame = 0;
    double timeS = 0;
    FrameCamera camera;  // root-cube units
    FrameStatistics statistics;
    bool playing = false;  // the animation, and how fast
    double speed = 1;
    std::optional<Measurement> measured;  // against --reference
};

// The state that makes this very picture again.
State stateOf(const PictureInfo& info);

// Names start with "megaviews."; "megaviews.settings" is one JSON object of all settings in effect,
// exposure and camera filled in, which applyJson() takes back; "megaviews.state" is what
// loadState() restores.
std::vector<std::pair<std::string, std::string>> pictureMetadata(const PictureInfo& info);

}  // namespace mv
