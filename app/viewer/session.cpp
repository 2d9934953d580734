#include "app/viewer/session.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "app/viewer/image_io.h"
#include "app/viewer/key_bindings.h"
#include "app/viewer/tour.h"
#include "megaviews/hierarchy/scene_hierarchy_cache.h"
#include "megaviews/scene/load_scene.h"
#include "renderer/gl/context.h"
#include "ui/format.h"

namespace mv {
namespace {

constexpr double kLongestFrameS = 0.5;  // the animation never jumps further at once
constexpr double kParticlesLoopS = 60;

double wrapped(double seconds, double lengthS) {
    if (!(lengthS > 0)) return seconds;
    const double wrapped = std::fmod(seconds, lengthS);
    return wrapped < 0 ? wrapped + lengthS : wrapped;
}

}  // namespace

Session::Session(const RunOptions& options, const Settings& settings, Host& host, double scale,
                 std::string userStateFile)
    : options_(options),
      host_(host),
      userStateFile_(std::move(userStateFile)),
      askedScale_(static_cast<float>(options.uiScale > 0 ? options.uiScale : std::max(scale, 1.0))),
      document_(settings, options.given),
      pace_(!options.headless && !options.deterministic),
      scene_(options.useCache ? defaultCacheDirectory() : std::filesystem::path()),
      // The software renderer's clock waits in any case.
      picture_(options.headless || gl::limits().software ? gl::Results::waited : gl::Results::late),
      measuring_(options) {
    model_.renderer = gl::limits().renderer;
    model_.software = gl::limits().software;
    model_.builtinScenes = builtinNames();
    model_.vsync = options.vsync;
    model_.playing = options.playing.value_or(!options.headless);
    model_.speed = options.speed;
    model_.errors.mapViews = options.mapReferences;
    // A picture that nobody waits for is what was asked for; a window's is what it can show.
    if (!options.headless || options.ui) {
        document_.averageFrames();
        if (model_.software) document_.lowerQuality();
        document_.replace(document_.settings());
    }
    good_ = document_.settings();
    timeS_ = good_.scene.timeS;
    view_.width = good_.resolution.width;
    view_.height = good_.resolution.height;
    if (!options.headless || options.ui || !options.actions.empty()) {
        if (!userStateFile_.empty()) userState_ = loadUserState(userStateFile_);
        if (userState_.uiScale && options.uiScale <= 0) {
            askedScale_ = static_cast<float>(*userState_.uiScale);
        }
        showPanel(userState_.panel);
        if (options.mapReferences > 0) model_.instrument = ui::Instrument::errors;
        if (good_.inspect.step > 0 || good_.inspect.pairScene) {
            model_.instrument = ui::Instrument::steps;
        }
        panels_ = std::make_unique<Panels>();
        panels_->imgui.setScale(scale_ = askedScale_);
    }
    environment_.of(good_.scene.environment);  // refused before a window opens
    scene_.load(options.scene, document_.settings());
}

Session::~Session() = default;

bool Session::idle() const {
    return !redraw_ && !loading() && input_.empty() && windowFile_.empty();
}

bool Session::waiting() const { return measuring_.busy() && !picture_.isSupplied() && idle(); }

// ---- the frame

void Session::frame(double seconds, int width, int height, unsigned framebuffer) {
    changeScale(width, height);
    panels_->imgui.addGlyphs(panels_->interface.missingCharacters());
    if (tourAsked_ && assets()) perform(Action::tour);
    if (tour_) attempt([&] { tour_->advance(width, height); });
    takeInput();
    attempt([&] { takeScene(); },
            assets() ? "The scene on screen was kept." : "Open another scene.");
    if (!panels_->imgui.editing()) scene_.reloadWhereNeeded(settings());
    advanceTime(seconds);
    moveCamera(seconds);
    layOut(width, height);
    renderPicture(framebuffer);
    draw(std::max(seconds - std::exchange(drawnS_, 0), 1e-3), width, height, framebuffer);
}

void Session::draw(double seconds, int width, int height, unsigned framebuffer) {
    panels_->imgui.beginFrame(width, height, seconds);
    followReferences();
    fillPanels();
    show(width, height, framebuffer);
    const ui::Requests requests =
        panels_->interface.draw(document_.edit(), model_, statistics(), width, height, scale_);
    fitWindow();
    panels_->imgui.endFrame(framebuffer);
    writeWindow(width, height, framebuffer);
    redraw_ = requests.redraw;
    perform(requests);
    noteChange();
}

void Session::load(const Progress& progress) {
    while (loading() && !takeScene()) {
        const SceneLoader::Status status = scene_.status();
        report(progress, status.stage, status.fraction);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

void Session::changeScale(int width, int height) {
    if (newScale_) {
        askedScale_ = *std::exchange(newScale_, std::nullopt);
        remember([&](UserState& state) { state.uiScale = static_cast<double>(askedScale_); });
    }
    const float fitting = ui::fittingScale(width, height, askedScale_);
    if (fitting != scale_) panels_->imgui.setScale(scale_ = fitting);
}

void Session::layOut(int width, int height) {
    view_ = ui::pictureViewport(width, height, scale_, model_);
    width_ = width;
    height_ = height;
    document_.setPictureSize(view_.width, view_.height);
}

void Session::fitWindow() {
    const Size wanted = settings().resolution;
    if (wanted.width == view_.width && wanted.height == view_.height) return;
    host_.resize(width_ + wanted.width - view_.width, height_ + wanted.height - view_.height);
}

// A change ends when the mouse lets go of it.
void Session::noteChange() {
    model_.preset = document_.preset();
    if (!panels_->imgui.editing() && document_.noteChange()) redraw_ = true;
}

// ---- input

void Session::takeInput() {
    for (const ui::Requests& requests : std::exchange(pending_, {})) perform(requests);
    tookInput_ = false;
    for (const InputEvent& event : input_.takeFrame()) {
        tookInput_ |= !std::holds_alternative<MouseMoved>(event);
        panels_->imgui.handle(event);
        camera_.input().handle(event, panels_->imgui.takesMouse());
        if (const auto* key = std::get_if<KeyChanged>(&event)) keyPressed(*key);
        if (const auto* drop = std::get_if<FilesDropped>(&event)) {
            if (drop->files.empty()) continue;
            openFile(drop->files.front());
            if (const std::size_t others = drop->files.size() - 1; others > 0) {
                toast(fmt::format("one file at a time: {} left", others));
            }
        }
        redraw_ = true;
    }
    const bool catchMouse = camera_.input().wantsMouseCaught();
    if (catchMouse != mouseCaught_) {
        host_.catchMouse(catchMouse);
        camera_.input().forgetPosition();
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
    if (key.key == GLFW_KEY_ESCAPE && !model_.help && !dialogOpen() &&
        !panels_->imgui.takesKeyboard()) {
        giveUp();
        return;
    }
    const bool enter = key.key == GLFW_KEY_ENTER || key.key == GLFW_KEY_KP_ENTER;
    if (enter && model_.picking != ui::Picking::none && !dialogOpen() &&
        !panels_->imgui.takesKeyboard()) {
        clicked({view_.x + view_.width / 2.0, view_.y + view_.height / 2.0, false});
        return;
    }
    const bool types = key.key < GLFW_KEY_F1 || key.key > GLFW_KEY_F25;
    if ((types && panels_->imgui.takesKeyboard()) || dialogOpen()) return;
    if (camera_.input().flying() && key.modifiers != 0) return;  // faster, slower
    if (!action || (key.repeated && !infoOf(*action).repeats)) return;
    perform(*action);
}

// Keys are a dialog's while it is open.
bool Session::dialogOpen() const {
    return !model_.error.empty() || model_.browse != ui::Browse::none || model_.palette ||
           model_.aboutScene || model_.start;
}

// What takes long: a scene being loaded, references or exact maps being made. Rows that are done
// are kept.
void Session::giveUp() {
    if (loading()) {
        cancelLoading();
    } else if (frameRun_.running()) {
        perform(Action::measureFrames);
    } else if (model_.work && model_.work->draft) {
        document_.edit() = good_;
        document_.takeBack();
        camera_.returnTo(goodCamera_);
    } else if (model_.work) {
        picture_.settleForDraft();
    } else if (picture_.renderer().awaitsReferences()) {
        document_.leaveReferences();
    } else if (measuring_.references().busyWithMaps()) {
        model_.errors.mapViews = 0;
    }
}

std::optional<Instruments::Pixel> Session::pixelAt(double x, double y) const {
    const double u = (x - view_.x) / view_.width, v = (y - view_.y) / view_.height;
    if (!picture_.shown() || u < 0 || u >= 1 || v < 0 || v >= 1) return std::nullopt;
    const Size shown = picture_.effective().resolution;
    return Instruments::Pixel{static_cast<int>(u * shown.width),
                              static_cast<int>(v * shown.height)};
}

// A click on the picture picks for the instrument that asks for it, or that is open.
void Session::clicked(const CameraInput::Click& click) {
    const auto pixel = pixelAt(click.x, click.y);
    if (!pixel) return;
    ui::Picking picking = std::exchange(model_.picking, ui::Picking::none);
    if (picking == ui::Picking::none) {
        if (model_.instrument == ui::Instrument::views) {
            picking = click.shift ? ui::Picking::viewB : ui::Picking::viewA;
        } else if (model_.instrument == ui::Instrument::pixel) {
            picking = ui::Picking::pixel;
        } else if (model_.instrument == ui::Instrument::steps) {
            picking = ui::Picking::pair;
        }
    }
    const FrameCamera& camera = picture_.input().camera;
    const Settings shown = shownByInstruments();
    InspectSettings& inspect = document_.edit().inspect;
    switch (picking) {
        case ui::Picking::none:
            return;
        case ui::Picking::pixel:
            instruments_.pickPixel(*pixel);
            return;
        case ui::Picking::pair: {
            const auto pair = instruments_.pairAt(picture_.renderer(), camera, shown, *pixel);
            if (!pair) return toast("there is no pair here");
            inspect.pairScene = pair->scene;
            inspect.pairView = pair->view;
            return;
        }
        case ui::Picking::sceneNode: {
            const auto node = instruments_.sceneNodeAt(camera, shown, *pixel);
            if (!node) return toast("there is no surface here");
            inspect.stepScene = *node;
            inspect.step = std::max(inspect.step, 1);
            return;
        }
        case ui::Picking::viewA:
        case ui::Picking::viewB:
        case ui::Picking::viewNode:
            break;
    }
    const auto view = instruments_.viewAt(picture_.renderer(), camera, shown, *pixel);
    if (!view) return toast("there is no view here");
    if (picking == ui::Picking::viewNode) {
        inspect.stepView = instruments_.viewNodeOf(shown, *view).value_or(0);
        inspect.step = std::max(inspect.step, 1);
    } else {
        (picking == ui::Picking::viewA ? inspect.pickA : inspect.pickB) = view;
    }
}

// ---- scene

// True if another scene stands.
bool Session::takeScene() {
    const SceneLoader::Status status = scene_.status();
    model_.loadingStage = status.stage;
    model_.loadingFraction = status.fraction;
    std::optional<SceneSlot::Change> change;
    try {
        change = scene_.take(picture_.renderer());
    } catch (...) {
        model_.loadingStage.clear();
        scene_.keepLoaded(document_.edit());
        document_.takeBack();
        throw;
    }
    if (!change) return false;
    model_.loadingStage.clear();
    measuring_.setScene(scene_.assets());
    camera_.setScene(scene_.assets());
    instruments_.setScene(*assets());
    if (change->sameScene && !model_.renderingPaused) {
        picture_.outdate();
    } else {
        picture_.forget();
        if (host_.isAlive()) picture_.outdate();  // somebody waits
    }
    if (panels_) panels_->interface.forgetFrames();
    if (change->restored) {
        warnIfChanged(change->restored->sceneHash, assets()->scene, scene_.viewsHash());
        model_.playing = change->restored->playing;
        model_.speed = change->restored->speed;
    }
    if (change->restored || change->opened) {
        const Settings taken =
            change->restored ? change->restored->settings : forAnotherScene(settings());
        // Of the scene on screen it is a change of settings, which may be undone.
        if (change->sameFile) {
            document_.edit() = taken;
        } else {
            document_.replace(taken);
        }
    }
    describeScene();
    remember([&](UserState& state) { state.noteRecent(scene_.name()); });
    if (change->sameScene) return true;
    if (!change->sameFile) {
        document_.forgetChanges();
        good_ = forAnotherScene(settings());  // until a picture of it stands
        scene_.keepLoaded(good_);
    }
    startS_ = settings().scene.timeS;
    model_.animationS = animationLengthS();
    setTime(startS_);
    attempt([&] { camera_.reset(document_.edit(), timeS_); });
    goodCamera_ = camera_.camera();
    return true;
}

void Session::describeScene() {
    const Scene& scene = assets()->scene;
    model_.sceneName = scene.name;
    const SceneHierarchy& hierarchy = assets()->hierarchy;
    model_.sceneSummary = ui::withThousands(scene.triangles.size()) + " triangles, " +
                          ui::withThousands(hierarchy.leafCount()) +
                          (hierarchy.samples ? " surface samples" : " octree leaves");
    model_.cameras.clear();
    for (const Camera& camera : scene.cameras) model_.cameras.push_back(camera.name);
    model_.animations.clear();
    for (const Animation& animation : scene.animations) {
        model_.animations.push_back(animation.name);
    }
    model_.variants = scene.variants;
    model_.warnings = scene.warnings;
    model_.notes = scene.notes;
    model_.extensions = scene.extensions;
    model_.ignored = scene.ignored;
    host_.setTitle(scene.name + " - MegaViews");
}

// ---- time and camera

void Session::setTime(double seconds) { timeS_ = wrapped(seconds, model_.animationS); }

// Particles follow closed paths of their own.
double Session::animationLengthS() const {
    const auto& animations = assets()->scene.animations;
    const int chosen = assets()->animation;
    const double length = chosen >= 0 ? animations[static_cast<std::size_t>(chosen)].duration : 0;
    return settings().views.particles > 0 ? std::max(length, kParticlesLoopS) : length;
}

void Session::advanceTime(double seconds) {
    if (!assets()) return;
    model_.animationS = animationLengthS();
    if (settings().scene.timeS != startS_) setTime(startS_ = settings().scene.timeS);
    if (!model_.playing || model_.renderingPaused || frameRun_.running() || model_.animationS <= 0)
        return;
    const double step =
        options_.deterministic ? 1 / options_.frameRate : std::min(seconds, kLongestFrameS);
    setTime(timeS_ + step * model_.speed);
}

void Session::moveCamera(double seconds) {
    if (!assets()) return;
    if (const auto click = camera_.input().takeClick()) clicked(*click);
    attempt([&] {
        camera_.update(document_.edit(), timeS_, timeS_ != picture_.input().timeS, seconds,
                       view_.height, !panels_->imgui.takesKeyboard() && !dialogOpen());
    });
    model_.outside = camera_.isOutside();
    model_.camera = camera_.filledIn(settings()).camera;
}

// ---- panels

void Session::fillPanels() {
    const LivePicture& p = picture_;
    const Measuring::Picture measured{.settings = p.effective(),
                                      .wanted = p.wanted(),
                                      .moment = p.input(),
                                      .number = p.number(),
                                      .draft = p.isDraft(),
                                      .still = p.still()};
    const bool errors = model_.instrument == ui::Instrument::errors && p.shown();
    measuring_.fill(p.renderer(), errors ? &measured : nullptr, model_.errors);
    model_.timeS = timeS_;
    model_.sceneCamera = assets() ? camera_.sceneCamera() : std::nullopt;
    model_.tour = tour_ ? std::optional(tour_->shown()) : std::nullopt;
    if (model_.software) model_.notices = {document_.notice()};
    model_.defaults = document_.defaults();
    model_.defaults.resolution = settings().resolution;  // the window's
    model_.canUndo = document_.canUndo();
    model_.canRedo = document_.canRedo();
    model_.setsWanted = wantedSettings().setsWanted();
    model_.draft.reset();
    model_.foreseenS = 0;
    if (p.shown() && p.isDraft()) {
        model_.draft = p.effective();
        const bool plays = model_.playing && model_.animationS > 0;
        if (!plays) model_.foreseenS = foreseenS();
    }
    if (model_.start != (startPage_ != nullptr)) {
        startPage_ = model_.start ? std::make_unique<StartPage>() : nullptr;
        model_.startTiles = startPage_ ? startPage_->tiles() : std::vector<ui::StartTile>();
        model_.startFound = startPage_ ? startPage_->found() : std::vector<std::string>();
    }
    model_.settled = p.settledForDraft();
    model_.atRest = p.shown() && p.still() && !frameRun_.running() && !loading();
    model_.frameRun.running = frameRun_.running();
    model_.frameRun.done = static_cast<int>(frameRun_.statistics().frames());
    if (!p.shown() || p.interrupted()) return;
    instruments_.setHover(panels_->imgui.takesMouse()
                              ? std::nullopt
                              : pixelAt(camera_.input().x(), camera_.input().y()));
    const Settings shown = shownByInstruments();
    instruments_.readFrame(p.renderer(), shown, model_);
    instruments_.fill(p.renderer(), shown, p.statistics(), p.number(), model_);
    instruments_.drawOverlay(picture_.renderer(), shown, picture_.statistics());
    describeLights();
    if (statistics().freeGpuBytes > 0) model_.freeGpuBytes = statistics().freeGpuBytes;
}

// What is inspected is asked of the picture as it stands, also while rendering is paused. Views are
// in sight while one is to be picked, a step of the traversal and a pair while their panel is open.
Settings Session::shownByInstruments() const {
    Settings shown = picture_.effective();
    shown.inspect = settings().inspect;
    const bool picks = model_.picking == ui::Picking::viewA ||
                       model_.picking == ui::Picking::viewB ||
                       model_.picking == ui::Picking::viewNode ||
                       (model_.instrument == ui::Instrument::views && !shown.inspect.pickA);
    shown.inspect.showViews |= picks;
    if (model_.instrument != ui::Instrument::steps) {
        shown.inspect.step = 0;
        shown.inspect.pairScene.reset();
    }
    return shown;
}

LightView Session::lightView() const {
    return {*assets(), camera_.camera(), camera_.pivotDistance(), view_};
}

void Session::describeLights() {
    // Closed, the panel only says how many there are.
    if (!model_.lightsOpen && model_.lights.size() == assets()->scene.lights.size()) return;
    model_.lights = lightRows(*assets(), settings().scene.lights, timeS_);
    if (!model_.lightsOpen) return;
    for (ui::LightRow& row : model_.lights) placeHandles(lightView(), row);
}

void Session::show(int width, int height, unsigned framebuffer) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    glClearColor(0.06f, 0.06f, 0.07f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!picture_.shown()) return;
    const gl::Texture& picture = picture_.renderer().display();
    const gl::Framebuffer source("picture in the window", {&picture});
    const int bottom = height - view_.y - view_.height;
    glBlitNamedFramebuffer(source.id(), framebuffer, 0, 0, picture.width(), picture.height(),
                           view_.x, bottom, view_.x + view_.width, bottom + view_.height,
                           GL_COLOR_BUFFER_BIT,
                           picture.width() == view_.width ? GL_NEAREST : GL_LINEAR);
}

void Session::writeWindow(int width, int height, unsigned framebuffer) {
    if (windowFile_.empty()) return;
    const std::string file = std::exchange(windowFile_, {});
    attempt([&] {
        writeFramebuffer(file, framebuffer, width, height,
                         assets() ? pictureMetadata(pictureInfo()) : Metadata());
        badPixelsWritten_ += statistics().badPixels;
        const std::string said = "window written: " + file;
        if (std::exchange(toastOfWindow_, false)) {
            toast(said);
        } else {
            spdlog::info("{}", said);
        }
    });
}

}  // namespace mv
