// Session: what actions and panels ask for.

#include <epoxy/gl.h>

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>

#include "app/common/output_names.h"
#include "app/viewer/image_io.h"
#include "app/viewer/session.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr double kStepS = 1.0 / 30;  // one animation step
constexpr double kExposureStepEv = 0.25, kSplitStep = 0.02;
constexpr double kSlowest = 1.0 / 64, kFastest = 64;
constexpr float kScaleStep = 1.125f, kSmallestScale = 0.75f, kLargestScale = 4;
constexpr std::size_t kUndoSteps = 200;
constexpr int kMostSteps = 32;  // of the traversal

// The next of an enum's values, or the one before.
template <typename Enum>
Enum cycled(Enum value, int step, Enum last) {
    const int count = static_cast<int>(last) + 1;
    return static_cast<Enum>(((static_cast<int>(value) + step) % count + count) % count);
}

// The preset whose values the settings have.
std::string presetOf(const Settings& settings) {
    for (const PresetInfo& preset : presetsTable()) {
        Settings changed = settings;
        mv::applyPreset(changed, preset);
        if (changed == settings) return std::string(preset.name);
    }
    return {};
}

int indexFrom(Action first, Action action) {
    return static_cast<int>(action) - static_cast<int>(first);
}

}  // namespace

void Session::fail(const Error& error, const std::string& hint) {
    spdlog::error("{}", error.what());
    model_.error = error.what();
    model_.errorHint = hint;
}

void Session::toast(const std::string& text) {
    spdlog::info("{}", text);
    model_.toasts.push_back({text, 0});
    redraw_ = true;
}

void Session::setTime(double seconds) {
    timeS_ = model_.animationS > 0 ? std::fmod(seconds, model_.animationS) : seconds;
    if (timeS_ < 0) timeS_ += model_.animationS;
}

void Session::stepTime(int steps) {
    model_.playing = false;
    if (model_.animationS > 0) setTime(timeS_ + steps * kStepS);
}

// ---- undo

// A change ends when the mouse lets go of it.
void Session::noteChange() {
    if (presetOf_ != settings_) {
        model_.preset = presetOf(settings_);
        presetOf_ = settings_;
    }
    if (settings_ == noted_ || imgui_.editing()) return;
    undo_.push_back(noted_);
    if (undo_.size() > kUndoSteps) undo_.pop_front();
    redo_.clear();
    noted_ = settings_;
    redraw_ = true;
}

void Session::undo(std::deque<Settings>& from, std::deque<Settings>& to) {
    if (from.empty()) return;
    to.push_back(settings_);
    settings_ = noted_ = from.back();
    from.pop_back();
}

void Session::reloadShaders() {
    model_.shaderErrors.clear();
    for (const std::string& message : renderer_.reloadShaders()) {
        spdlog::error("{}", message);
        model_.shaderErrors.push_back({{}, 0, message});
    }
    if (model_.shaderErrors.empty()) toast("shaders are up to date");
    shown_ = false;  // draw with the new ones
}

void Session::applyPreset(Action action) {
    const std::string id = idOf(infoOf(action));  // "preset-fast"
    const PresetInfo* preset = findPreset(std::string_view(id).substr(id.find('-') + 1));
    assert(preset && "every preset's action names one");
    mv::applyPreset(settings_, *preset);
}

// ---- files

PictureInfo Session::pictureInfo() const {
    PictureInfo info;
    info.assets = assets_.get();
    info.settings = effective_;
    info.timeS = shownTimeS_;
    info.camera = shownCameraPose_;
    info.statistics = statistics_;
    return info;
}

void Session::savePicture(const std::string& file) {
    if (!shown_) throw Error(ExitCode::output, file + ": there is no picture yet");
    writePicture(file, renderer_, pictureInfo());
    spdlog::info("picture written: {}", file);
}

void Session::savePictureAs(const std::string& extension) {
    if (!shown_) return;
    try {
        const std::string file = freeFileName("megaviews", extension);
        savePicture(file);
        toast("picture written: " + file);
    } catch (const Error& error) {
        fail(error);
    }
}

void Session::resetSettings() {
    Settings fresh;
    copySceneChoices(fresh, settings_);
    settings_ = fresh;
    if (gl::limits().software) lowerQuality();
}

std::string Session::openPanel() const {
    constexpr Action kActions[] = {Action::showProfiler, Action::showTraversal, Action::showMemory,
                                   Action::showViews,    Action::showPixel,     Action::showSteps,
                                   Action::showErrors};
    if (!model_.instrument) return {};
    return idOf(infoOf(kActions[static_cast<std::size_t>(*model_.instrument)]));
}

// ---- actions

void Session::perform(Action action) {
    const auto toggleInstrument = [&](ui::Instrument instrument) {
        if (model_.instrument == instrument) {
            model_.instrument.reset();
        } else {
            model_.instrument = instrument;
        }
    };
    redraw_ = true;
    switch (action) {
        case Action::open:
            model_.browse = ui::Browse::open;
            break;
        case Action::reload:
            if (assets_) startLoading(scene_, settings_);
            break;
        case Action::saveState:
            model_.browse = ui::Browse::saveState;
            break;
        case Action::loadState:
            model_.browse = ui::Browse::loadState;
            break;
        case Action::screenshotPng:
            savePictureAs(".png");
            break;
        case Action::screenshotExr:
            savePictureAs(".exr");
            break;
        case Action::screenshotWindow:
            windowFile_ = freeFileName("megaviews", ".png");
            toastOfWindow_ = true;
            break;
        case Action::reloadShaders:
            reloadShaders();
            break;
        case Action::quit:
            closed_ = true;
            break;
        case Action::playPause:
            model_.playing = !model_.playing;
            break;
        case Action::stepBackward:
            stepTime(-1);
            break;
        case Action::stepForward:
            stepTime(1);
            break;
        case Action::slower:
            model_.speed = std::max(model_.speed * 0.5, kSlowest);
            break;
        case Action::faster:
            model_.speed = std::min(model_.speed * 2, kFastest);
            break;
        case Action::restart:
            setTime(settings_.scene.timeS);
            break;
        case Action::pauseRendering:
            model_.renderingPaused = !model_.renderingPaused;
            break;
        case Action::nextMethod:
            setMethod(settings_, cycled(settings_.side[0].method, 1, Method::none));
            break;
        case Action::previousMethod:
            setMethod(settings_, cycled(settings_.side[0].method, -1, Method::none));
            break;
        case Action::toggleSplit:
            if (settings_.compare) {
                settings_.compare = false;
                settings_.side[1] = settings_.side[0];
            } else {
                compareWith(settings_, settings_.side[0].method == Method::manylods
                                           ? Method::megaviews
                                           : Method::manylods);
            }
            break;
        case Action::splitLeft:
            settings_.display.split = std::max(settings_.display.split - kSplitStep, 0.0);
            break;
        case Action::splitRight:
            settings_.display.split = std::min(settings_.display.split + kSplitStep, 1.0);
            break;
        case Action::swapSides:
            if (settings_.compare) std::swap(settings_.side[0], settings_.side[1]);
            break;
        case Action::showOtherSide:
            model_.otherSide = !model_.otherSide;
            break;
        case Action::nextDifference:
            if (!settings_.compare) perform(Action::toggleSplit);
            settings_.display.difference =
                cycled(settings_.display.difference, 1, Difference::flip);
            break;
        case Action::frameScene:
            if (assets_ && !assets_->scene.empty()) {
                const auto [low, high] = assets_->bounds();
                controller_.frame(low, high);
                leaveNamedCamera();
            }
            break;
        case Action::resetCamera:
            if (assets_) resetCamera();
            break;
        case Action::nextCamera:
            chooseCamera(1);
            break;
        case Action::previousCamera:
            chooseCamera(-1);
            break;
        case Action::storeBookmark1:
        case Action::storeBookmark2:
        case Action::storeBookmark3:
        case Action::storeBookmark4:
        case Action::storeBookmark5:
        case Action::storeBookmark6:
        case Action::storeBookmark7:
        case Action::storeBookmark8:
        case Action::storeBookmark9:
            storeBookmark(indexFrom(Action::storeBookmark1, action));
            break;
        case Action::recallBookmark1:
        case Action::recallBookmark2:
        case Action::recallBookmark3:
        case Action::recallBookmark4:
        case Action::recallBookmark5:
        case Action::recallBookmark6:
        case Action::recallBookmark7:
        case Action::recallBookmark8:
        case Action::recallBookmark9:
            recallBookmark(indexFrom(Action::recallBookmark1, action));
            break;
        case Action::exposureDown:
        case Action::exposureUp:
            settings_.display.exposureEv =
                settings_.display.exposureEv.value_or(statistics_.exposureEv) +
                (action == Action::exposureUp ? kExposureStepEv : -kExposureStepEv);
            break;
        case Action::exposureReset:
            settings_.display.exposureEv.reset();
            renderer_.forgetExposure();
            shown_ = false;
            break;
        case Action::nextDebugView:
            settings_.picture.view = cycled(settings_.picture.view, 1, DebugView::shared);
            break;
        case Action::previousDebugView:
            settings_.picture.view = cycled(settings_.picture.view, -1, DebugView::shared);
            break;
        case Action::showProfiler:
            toggleInstrument(ui::Instrument::profiler);
            break;
        case Action::showTraversal:
            toggleInstrument(ui::Instrument::traversal);
            break;
        case Action::showMemory:
            toggleInstrument(ui::Instrument::memory);
            break;
        case Action::showViews:
            toggleInstrument(ui::Instrument::views);
            break;
        case Action::showPixel:
            toggleInstrument(ui::Instrument::pixel);
            break;
        case Action::showSteps:
            toggleInstrument(ui::Instrument::steps);
            break;
        case Action::showErrors:
            toggleInstrument(ui::Instrument::errors);
            break;
        case Action::stepTraversal:
            settings_.inspect.step = std::min(settings_.inspect.step + 1, kMostSteps);
            break;
        case Action::stepTraversalBack:
            settings_.inspect.step = std::max(settings_.inspect.step - 1, 0);
            break;
        case Action::undo:
            undo(undo_, redo_);
            break;
        case Action::redo:
            undo(redo_, undo_);
            break;
        case Action::resetSettings:
            resetSettings();
            break;
        case Action::presetFast:
        case Action::presetBalanced:
        case Action::presetQuality:
        case Action::presetPaperMegaviews:
        case Action::presetPaperManylods:
            applyPreset(action);
            break;
        case Action::hideUi:
            model_.hidden = !model_.hidden;
            break;
        case Action::largerInterface:
            newScale_ = std::min(scale_ * kScaleStep, kLargestScale);
            break;
        case Action::smallerInterface:
            newScale_ = std::max(scale_ / kScaleStep, kSmallestScale);
            break;
        case Action::fullScreen:
            model_.fullScreen = !model_.fullScreen;
            host_.setFullScreen(model_.fullScreen);
            break;
        case Action::vsync:
            model_.vsync = !model_.vsync;
            host_.setVsync(model_.vsync);
            break;
        case Action::help:
            model_.help = !model_.help;
            break;
    }
}

void Session::perform(const ui::Requests& requests) {
    if (requests.timeChanged) setTime(model_.timeS);
    if (requests.errorDismissed) model_.error.clear();
    if (requests.cancelLoading) cancelLoading();
    for (const Action action : requests.actions) perform(action);
    if (!requests.openFile.empty()) openFile(requests.openFile);
    if (!requests.loadState.empty()) openFile(requests.loadState);
    if (requests.clearRecent) {
        userState_.recent.clear();
        updateUserState(userStateFile_, [](UserState& state) { state.recent.clear(); });
        showUserState();
    }
    for (const ui::LightEdit& edit : requests.lights) place(edit);
    if (requests.lightDrag) drag(*requests.lightDrag);
    try {
        if (!requests.saveState.empty()) {
            saveState(requests.saveState);
            toast("state written: " + requests.saveState);
        }
    } catch (const Error& error) {
        fail(error);
    }
}

}  // namespace mv
