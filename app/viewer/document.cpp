#include "app/viewer/document.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "megaviews/settings/presets.h"

namespace mv {
namespace {

constexpr std::size_t kUndoSteps = 200;
constexpr int kStillSamples = 64;  // frames averaged while nothing moves
constexpr int kStillPoints = 16;   // points of a pixel averaged meanwhile
constexpr int kMovingFrames = 16;  // frames remembered while something does
constexpr int kSoftwareDepth = 8, kSoftwareStill = 16;
constexpr int kDraftSamples = 4, kDraftCandidates = 8, kDraftSkySamples = 1;
constexpr int kDraftScale = 3, kDraftResolution = 8;
constexpr std::int64_t kDraftViews = 4096, kDraftMaps = 1024;

std::string presetOf(const Settings& settings) {
    for (const PresetInfo& preset : presetsTable()) {
        Settings changed = settings;
        applyPreset(changed, preset);
        if (changed == settings) return std::string(preset.name);
    }
    return {};
}

}  // namespace

Document::Document(const Settings& settings, std::vector<std::string> given)
    : settings_(settings), given_(std::move(given)), noted_(settings) {}

bool Document::isGiven(const char* key) const {
    return std::find(given_.begin(), given_.end(), key) != given_.end();
}

void Document::averageFrames() {
    defaults_.picture.accumulate = kStillSamples;
    defaults_.picture.pixelSamples = kStillPoints;
    defaults_.picture.temporal = true;
    defaults_.gather.history = kMovingFrames;
    if (!isGiven("accumulate")) settings_.picture.accumulate = kStillSamples;
    // Each of the sets that are averaged anyway at a point of its own, and no more.
    if (!isGiven("pixel-samples")) {
        settings_.picture.pixelSamples = std::min(kStillPoints, settings_.picture.accumulate);
    }
    if (!isGiven("temporal")) settings_.picture.temporal = true;
    if (!isGiven("history")) settings_.gather.history = kMovingFrames;
    noted_ = settings_;
}

void Document::lowerQuality() {
    const auto lower = [&](const char* key, auto&& of, int lowered) {
        of(defaults_) = lowered;
        if (!isGiven(key)) of(settings_) = lowered;
    };
    lower(
        "scene-depth", [](Settings& s) -> int& { return s.scene.octreeDepth; }, kSoftwareDepth);
    lower(
        "view-depth", [](Settings& s) -> int& { return s.views.octreeDepth; }, kSoftwareDepth);
    lower(
        "accumulate", [](Settings& s) -> int& { return s.picture.accumulate; }, kSoftwareStill);
}

std::string Document::notice() const {
    const int samples = settings_.gather.samples;
    return fmt::format("{} octree levels, {} samples; draft while moving",
                       settings_.scene.octreeDepth, samples > 0 ? std::to_string(samples) : "all");
}

Settings Document::draftOf(Settings settings, double pixels) const {
    const auto lower = [&](const char* key, auto& value, auto draft) {
        if (!isGiven(key)) value = std::min(value, draft);
    };
    lower("vpls", settings.views.vpls, kDraftViews);
    if (settings.views.maps > 0 && settings.views.vpls > kDraftMaps) {
        lower("maps", settings.views.maps, kDraftMaps);
    }
    lower("gather-samples", settings.gather.samples, kDraftSamples);
    if (!isGiven("gather-samples") && settings.gather.samples == 0) {  // all
        settings.gather.samples = kDraftSamples;
    }
    lower("gather-candidates", settings.gather.candidates, kDraftCandidates);
    lower("sky-samples", settings.gather.skySamples, kDraftSkySamples);
    lower("view-res", settings.side[0].maps.resolution, kDraftResolution);
    lower("compare-view-res", settings.side[1].maps.resolution, kDraftResolution);
    if (!isGiven("gather-scale")) settings.gather.cull.scale = kDraftScale;
    auto& [width, height] = settings.resolution;
    const double shrink = std::min(1.0, std::sqrt(pixels / (width * height)));
    width = std::max(static_cast<int>(width * shrink), 1);
    height = std::max(static_cast<int>(height * shrink), 1);
    return settings;
}

void Document::setPictureSize(int width, int height) {
    settings_.resolution = noted_.resolution = {width, height};
}

bool Document::noteChange() {
    // Hands move it without a setting, and the window has the size: no step leads back there.
    noted_.camera = settings_.camera;
    noted_.resolution = settings_.resolution;
    if (settings_ == noted_) return false;
    undo_.push_back(noted_);
    if (undo_.size() > kUndoSteps) undo_.pop_front();
    redo_.clear();
    noted_ = settings_;
    return true;
}

void Document::takeBack() {
    const auto isThere = [&](Settings step) {
        step.camera = settings_.camera;
        step.resolution = settings_.resolution;
        return step == settings_;
    };
    if (!undo_.empty() && isThere(undo_.back())) undo_.pop_back();
    if (!redo_.empty() && isThere(redo_.back())) redo_.pop_back();
    noted_ = settings_;
}

void Document::step(std::deque<Settings>& from, std::deque<Settings>& to) {
    if (from.empty()) return;
    to.push_back(settings_);
    from.back().camera = settings_.camera;
    replace(from.back());
    from.pop_back();
}

void Document::forgetChanges() {
    undo_.clear();
    redo_.clear();
}

Settings Document::afterReset() const {
    Settings fresh = defaults_;
    copySceneChoices(fresh, settings_);
    fresh.resolution = settings_.resolution;  // the window's
    return fresh;
}

void Document::reset() { settings_ = afterReset(); }

const std::string& Document::preset() {
    if (presetOf_ != settings_) {
        preset_ = afterReset() == settings_ ? "defaults" : presetOf(settings_);
        presetOf_ = settings_;
    }
    return preset_;
}

void Document::noteMethods() {
    const Method left = settings_.side[0].method, right = settings_.side[1].method;
    if (!isReference(left)) methods_.left = left;
    if (settings_.compare && isReference(right)) return;
    methods_.right = right;
    methods_.compare = settings_.compare;
}

void Document::leaveReferences() {
    auto& [left, right] = settings_.side;
    if (isReference(left.method)) setMethod(settings_, methods_.left);
    if (settings_.compare && isReference(right.method)) {
        settings_.compare = methods_.compare;
        if (settings_.compare) {
            right.method = methods_.right;
        } else {
            right = left;
        }
    }
    takeBack();
}

}  // namespace mv
