#include "app/viewer/session.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/image_io.h"
#include "app/viewer/key_bindings.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr double kLongestFrameS = 0.5;  // the animation never jumps further at once
constexpr int kStillSamples = 64;       // frames averaged while nothing moves, unless given

// What a software renderer can show: of a picture that stands still, and at interactive rates while
// something moves. Said in the status bar.
constexpr int kSoftwareDepth = 8, kSoftwareSamples = 16, kSoftwareStill = 16;
constexpr int kDraftSamples = 4, kDraftScale = 2, kDraftViewRes = 8;
constexpr double kDraftPixels = 560 * 360;

bool samePose(const FrameCamera& a, const FrameCamera& b) {
    return a.position == b.position && a.forward == b.forward && a.up == b.up &&
           a.yfovRad == b.yfovRad && a.orthoHalfHeight == b.orthoHalfHeight;
}

// Whether two settings differ only in how the gathered light is shown, and in what is drawn over
// it.
bool sameLight(Settings a, const Settings& b) {
    a.scene.camera = b.scene.camera;  // poses are compared
    a.picture.view = b.picture.view;
    a.picture.accumulate = b.picture.accumulate;
    a.display = b.display;
    a.inspect = b.inspect;
    return a == b;
}

}  // namespace

Session::Session(const RunOptions& options, const Settings& settings, Host& host, double scale,
                 std::string userStateFile)
    : options_(options),
      settings_(settings),
      host_(host),
      userStateFile_(std::move(userStateFile)),
      scale_(static_cast<float>(options.uiScale > 0 ? options.uiScale : std::max(scale, 1.0))),
      measuring_(options),
      // The software renderer's clock waits in any case.
      renderer_(gl::limits().software ? gl::Results::waited : gl::Results::late) {
    if (!userStateFile_.empty()) userState_ = loadUserState(userStateFile_);
    if (userState_.uiScale && options.uiScale <= 0) {
        scale_ = static_cast<float>(*userState_.uiScale);
    }
    if (const ActionInfo* open = findAction(userState_.panel)) perform(open->action);
    model_.errors.mapViews = options.mapReferences;
    if (options.mapReferences > 0) model_.instrument = ui::Instrument::errors;
    imgui_.setScale(scale_);
    model_.renderer = gl::limits().renderer;
    model_.software = gl::limits().software;
    model_.vsync = options.vsync;
    timeS_ = settings_.scene.timeS;
    if (!options_.isGiven("accumulate")) settings_.picture.accumulate = kStillSamples;
    if (gl::limits().software) lowerQuality();
    noted_ = good_ = settings_;
    model_.playing = options.playing.value_or(!options.headless);
    model_.speed = options.speed;
    startLoading(options.scene, settings_);
}

Session::~Session() = default;

// A software renderer gets what it can do, and the status bar says so. Whatever was asked for on
// the command line stays.
void Session::lowerQuality() {
    const auto lower = [&](const char* key, int& value, int lowered) {
        if (!options_.isGiven(key)) value = lowered;
    };
    lower("scene-depth", settings_.scene.octreeDepth, kSoftwareDepth);
    lower("view-depth", settings_.views.octreeDepth, kSoftwareDepth);
    lower("gather-samples", settings_.gather.samples, kSoftwareSamples);
    lower("accumulate", settings_.picture.accumulate, kSoftwareStill);
    model_.notices = {fmt::format("{} octree levels, {} samples; draft while moving",
                                  settings_.scene.octreeDepth, settings_.gather.samples)};
}

// What is shown while something moves and the renderer is software.
Settings Session::draftOf(Settings settings) const {
    const auto lower = [&](const char* key, int& value, int draft) {
        if (!options_.isGiven(key)) value = std::min(value, draft);
    };
    lower("gather-samples", settings.gather.samples, kDraftSamples);
    lower("view-res", settings.side[0].maps.resolution, kDraftViewRes);
    lower("compare-view-res", settings.side[1].maps.resolution, kDraftViewRes);
    if (!options_.isGiven("gather-scale")) settings.gather.cull.scale = kDraftScale;
    const double shrink =
        std::min(1.0, std::sqrt(kDraftPixels / (settings.picture.width * settings.picture.height)));
    settings.picture.width = std::max(static_cast<int>(settings.picture.width * shrink), 1);
    settings.picture.height = std::max(static_cast<int>(settings.picture.height * shrink), 1);
    return settings;
}

bool Session::resting() const {
    return still() && !redraw_ && !loader_.loading() && input_.empty() && windowFile_.empty();
}

bool Session::waiting() const {
    return measuring_.busy() && !supplied_ && !redraw_ && !loader_.loading() && input_.empty() &&
           windowFile_.empty();
}

void Session::frame(double seconds, int width, int height, unsigned framebuffer) {
    if (newScale_) {
        scale_ = *std::exchange(newScale_, std::nullopt);
        imgui_.setScale(scale_);
        const double kept = static_cast<double>(scale_);
        updateUserState(userStateFile_, [&](UserState& state) { state.uiScale = kept; });
    }
    takeInput();
    finishLoading();
    reloadWhereNeeded();
    advanceTime(seconds);
    moveCamera(seconds);
    imgui_.beginFrame(width, height, seconds);
    view_ = ui::pictureViewport(width, height, scale_, model_);
    width_ = width;
    height_ = height;
    settings_.picture.width = noted_.picture.width = view_.width;
    settings_.picture.height = noted_.picture.height = view_.height;
    renderPicture();
    followReferences();
    measureErrors();
    if (shown_) {
        instruments_.setHover(imgui_.takesMouse() ? std::nullopt
                                                  : pixelAt(cameraInput_.x(), cameraInput_.y()));
        instruments_.readFrame(renderer_, effective_, model_);
        instruments_.fill(renderer_, effective_, statistics_, picture_, model_);
        instruments_.drawOverlay(renderer_, effective_, statistics_);
        describeLights();
    }
    if (statistics_.freeGpuBytes > 0) model_.freeGpuBytes = statistics_.freeGpuBytes;
    show(width, height, framebuffer);

    model_.timeS = timeS_;
    const ui::Requests requests =
        interface_.draw(settings_, model_, statistics_, width, height, scale_);
    fitWindow();
    imgui_.endFrame(framebuffer);
    if (!windowFile_.empty()) {
        const std::string file = std::exchange(windowFile_, {});
        try {
            writeFramebuffer(file, framebuffer, width, height,
                             assets_ ? pictureMetadata(pictureInfo()) : Metadata());
            spdlog::info("window written: {}", file);
            if (std::exchange(toastOfWindow_, false)) toast("window written: " + file);
        } catch (const Error& error) {
            fail(error);
        }
    }
    redraw_ = requests.redraw;
    perform(requests);
    noteChange();
}

void Session::fitWindow() {
    if (settings_.picture.width == view_.width && settings_.picture.height == view_.height) return;
    host_.resize(width_ + settings_.picture.width - view_.width,
                 height_ + settings_.picture.height - view_.height);
}

// ---- input

void Session::takeInput() {
    for (const InputEvent& event : input_.takeFrame()) {
        imgui_.handle(event);
        cameraInput_.handle(event, imgui_.takesMouse());
        if (const auto* key = std::get_if<KeyChanged>(&event)) keyPressed(*key);
        if (const auto* drop = std::get_if<FilesDropped>(&event)) {
            if (!drop->files.empty()) openFile(drop->files.front());
        }
        redraw_ = true;
    }
    const bool catchMouse = cameraInput_.wantsMouseCaught();
    if (catchMouse != mouseCaught_) {
        host_.catchMouse(catchMouse);
        cameraInput_.forgetPosition();
        mouseCaught_ = catchMouse;
    }
}

void Session::keyPressed(const KeyChanged& key) {
    // Releases always arrive, or keys would stay held.
    const auto action = actionOfKey(key.key, key.modifiers);
    if (!key.pressed) {
        if (key.key == keyOf(Action::showOtherSide)) releaseOtherSide();
        return;
    }
    if (key.key == GLFW_KEY_ESCAPE && model_.error.empty() && !model_.help &&
        model_.browse == ui::Browse::none) {
        if (loader_.loading()) {
            cancelLoading();
        } else if (renderer_.awaitsReferences()) {
            giveUpReferences();
        } else if (measuring_.references().busyWithMaps()) {
            model_.errors.mapViews = 0;
        }
        return;
    }
    const bool types = key.key < GLFW_KEY_F1 || key.key > GLFW_KEY_F25;
    if (types && imgui_.takesKeyboard()) return;
    if (cameraInput_.flying() && key.modifiers != 0) return;  // faster, slower
    if (!action || (key.repeated && !infoOf(*action).repeats)) return;
    perform(*action);
}

void Session::moveCamera(double seconds) {
    if (!assets_) return;
    if (const auto click = cameraInput_.takeClick()) clicked(*click);
    if (cameraInput_.update(controller_, seconds, view_.height)) leaveNamedCamera();
    takeCameraSettings();
    if (following_ && assets_->scene.animated() && timeS_ != shownTimeS_) resetCamera();
}

void Session::advanceTime(double seconds) {
    if (!assets_) return;
    model_.animationS = animationLengthS();
    if (settings_.scene.timeS != startS_) setTime(startS_ = settings_.scene.timeS);
    if (!model_.playing || model_.renderingPaused || model_.animationS <= 0) return;
    const double step =
        options_.deterministic ? 1 / options_.frameRate : std::min(seconds, kLongestFrameS);
    timeS_ = std::fmod(timeS_ + step * model_.speed, model_.animationS);
    if (timeS_ < 0) timeS_ += model_.animationS;
}

std::optional<Instruments::Pixel> Session::pixelAt(double x, double y) const {
    const double u = (x - view_.x) / view_.width, v = (y - view_.y) / view_.height;
    if (!shown_ || u < 0 || u >= 1 || v < 0 || v >= 1) return std::nullopt;
    return Instruments::Pixel{static_cast<int>(u * effective_.picture.width),
                              static_cast<int>(v * effective_.picture.height)};
}

// A click on the picture picks for the instrument that asks for it, or that is open.
void Session::clicked(const CameraInput::Click& click) {
    const auto pixel = pixelAt(click.x, click.y);
    if (!pixel) return;
    ui::Picking picking = std::exchange(model_.picking, ui::Picking::none);
    if (picking == ui::Picking::none && model_.instrument == ui::Instrument::views) {
        picking = click.shift ? ui::Picking::viewB : ui::Picking::viewA;
    }
    if (picking == ui::Picking::none && model_.instrument == ui::Instrument::pixel) {
        picking = ui::Picking::pixel;
    }
    if (picking == ui::Picking::pixel) instruments_.pickPixel(*pixel);
    if (picking == ui::Picking::viewA || picking == ui::Picking::viewB) {
        const std::int64_t slot =
            instruments_.viewAt(renderer_, shownCameraPose_, effective_, *pixel);
        (picking == ui::Picking::viewA ? settings_.inspect.pickA : settings_.inspect.pickB) = slot;
    }
}

// ---- picture

Settings Session::wantedSettings() const {
    Settings wanted = settings_;
    if (model_.otherSide && wanted.compare) {
        wanted.display.split = wanted.display.split > 0.5 ? 0 : 1;
        wanted.display.difference = Difference::off;
    }
    if (!wanted.compare) wanted.display.difference = Difference::off;
    return wanted;
}

void Session::renderPicture() {
    moving_ = false;
    if (!assets_ || (model_.renderingPaused && shown_)) {
        still_ = assets_ != nullptr;
        return;
    }
    const Settings wanted = wantedSettings();
    FrameInput input;
    input.camera = controller_.camera();
    input.timeS = timeS_;
    input.animation = animation_;
    input.countLevels = model_.instrument == ui::Instrument::traversal;
    const bool moved = !shown_ || !sameLight(wanted, wanted_) || shownTimeS_ != timeS_ ||
                       !samePose(shownCameraPose_, input.camera);
    const bool changed = moved || wanted != wanted_ || input.countLevels != countedLevels_;
    // Once nothing moves any more, a draft gives way to the whole picture, which then gathers more
    // and more samples.
    const bool draft = moved && shown_ && gl::limits().software;
    moving_ = moved && shown_;
    if (!changed && !draft_ && statistics_.accumulatedFrames >= effective_.picture.accumulate) {
        const bool underWay = renderer_.underWay();
        still_ =
            !supplied_ && !renderer_.awaitsReferences() && renderer_.wantedFlip() == 0 && !underWay;
        if (!supplied_ && !underWay) return;
    }
    still_ = false;
    const Settings now = draft ? draftOf(wanted) : wanted;
    try {
        if (!renderer_.render(now, input, statistics_)) return;
    } catch (const Error& error) {
        fail(error);
        settings_ = good_;  // the last picture stays, and what made it, unless it is a draft
        if (!std::exchange(draft_, false)) wanted_ = wantedSettings();
        still_ = shown_;
        return;
    }
    interface_.addFrame(statistics_);
    supplied_ = false;
    ++picture_;
    shown_ = true;
    draft_ = draft;
    if (!draft) good_ = settings_;
    wanted_ = wanted;
    effective_ = now;
    shownTimeS_ = timeS_;
    shownCameraPose_ = input.camera;
    countedLevels_ = input.countLevels;
}

// ---- references

FrameMoment Session::shownMoment() const { return {shownCameraPose_, shownTimeS_, animation_}; }

void Session::followReferences() {
    if (shown_ && measuring_.supply(renderer_, effective_, shownMoment(), moving_))
        supplied_ = true;
    if (const auto failure = measuring_.takeFailure()) {
        fail(failure->error);
        if (failure->ofMaps) {
            model_.errors.mapViews = 0;
        } else {
            giveUpReferences();
        }
    }
    if (!isReference(settings_.side[0].method)) lastMethod_ = settings_.side[0].method;
    if (!settings_.compare) {
        lastCompare_.reset();
    } else if (!isReference(settings_.side[1].method)) {
        lastCompare_ = settings_.side[1].method;
    }
    const bool holds = shown_ && renderer_.awaitsReferences() && moving_;
    const ReferenceWorker::Status status = measuring_.references().status();
    model_.referenceStage = holds ? "reference waits until nothing moves" : status.stage;
    model_.referenceFraction = holds ? -1 : status.fraction;
}

void Session::measureErrors() {
    const FrameMoment moment = shownMoment();
    const Measuring::Picture picture{effective_, wanted_, moment, picture_, draft_, still_};
    const bool open = model_.instrument == ui::Instrument::errors && shown_;
    measuring_.fill(renderer_, open ? &picture : nullptr, model_.errors);
}

// Back to what was shown before. Rows that are done are kept.
void Session::giveUpReferences() {
    if (isReference(settings_.side[0].method)) settings_.side[0].method = lastMethod_;
    if (settings_.compare && isReference(settings_.side[1].method)) {
        settings_.compare = lastCompare_.has_value();
        settings_.side[1].method = lastCompare_.value_or(settings_.side[0].method);
    }
}

void Session::show(int width, int height, unsigned framebuffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glClearColor(0.06f, 0.06f, 0.07f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!shown_) return;
    const gl::Texture& picture = renderer_.display();
    if (picture.id() != blitTexture_) {
        blit_ = gl::Framebuffer("picture in the window", {&picture});
        blitTexture_ = picture.id();
    }
    const int bottom = height - view_.y - view_.height;
    glBlitNamedFramebuffer(blit_.id(), framebuffer, 0, 0, picture.width(), picture.height(),
                           view_.x, bottom, view_.x + view_.width, bottom + view_.height,
                           GL_COLOR_BUFFER_BIT,
                           picture.width() == view_.width ? GL_NEAREST : GL_LINEAR);
}

}  // namespace mv
