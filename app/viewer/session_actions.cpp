// Session: what actions and panels ask for.

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <nlohmann/json.hpp>

#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/viewer/image_io.h"
#include "app/viewer/panel_numbers.h"
#include "app/viewer/scene_to_save.h"
#include "app/viewer/session.h"
#include "app/viewer/tour.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

constexpr double kStepS = 1.0 / 30;  // one animation step
constexpr double kExposureStepEv = 0.25, kSplitStep = 0.02;
constexpr float kScaleStep = 1.125f, kSmallestScale = 0.75f, kLargestScale = 4;
constexpr int kMostSteps = 32;  // of the traversal

// Which action opens an instrument.
constexpr std::pair<ui::Instrument, Action> kInstruments[] = {
    {ui::Instrument::profiler, Action::showProfiler},
    {ui::Instrument::traversal, Action::showTraversal},
    {ui::Instrument::memory, Action::showMemory},
    {ui::Instrument::views, Action::showViews},
    {ui::Instrument::pixel, Action::showPixel},
    {ui::Instrument::steps, Action::showSteps},
    {ui::Instrument::errors, Action::showErrors},
};

// Goes to the next of a setting's choices, or to the previous one.
void cycle(Settings& s, std::string_view key, int step) {
    const auto& choice = std::get<ChoiceField>(findSetting(key)->field);
    const int count = static_cast<int>(choice.names.size());
    choice.set(s, (choice.get(s) + step + count) % count);
}

Action nth(Action first, std::size_t index) {
    return static_cast<Action>(static_cast<std::size_t>(first) + index);
}

}  // namespace

// What each action does.
struct Session::Actions {
    using Handler = std::function<void(Session&)>;
    using Table = std::map<Action, Handler>;

    static const Table& table() {
        static const Table kTable = [] {
            Table table;
            for (auto add : {addFiles, addTransport, addMethods, addCameras, addPicture,
                             addInstruments, addWindow}) {
                add(table);
            }
            return table;
        }();
        return kTable;
    }

  private:
    // A handler that changes settings alone.
    static Handler edits(void (*edit)(Settings&)) {
        return [edit](Session& s) { edit(s.document_.edit()); };
    }
    static Handler toggles(bool ui::Model::*member) {
        return [member](Session& s) { s.model_.*member = !(s.model_.*member); };
    }
    static Handler browses(ui::Browse browse) {
        return [browse](Session& s) { s.model_.browse = browse; };
    }

    static void addFiles(Table& t) {
        t[Action::open] = browses(ui::Browse::open);
        t[Action::saveState] = browses(ui::Browse::saveState);
        t[Action::saveScene] = browses(ui::Browse::saveScene);
        t[Action::loadState] = browses(ui::Browse::loadState);
        t[Action::loadReference] = browses(ui::Browse::loadReference);
        t[Action::reload] = [](Session& s) {
            if (!s.assets()) return;
            s.picture_.renderer().forgetExposure();
            s.attempt([&] { s.environment_.readAgain(); });
            s.scene_.load(s.scene_.name(), s.settings());
        };
        t[Action::screenshotPng] = [](Session& s) { s.savePictureAs(".png"); };
        t[Action::screenshotExr] = [](Session& s) { s.savePictureAs(".exr"); };
        t[Action::screenshotWindow] = [](Session& s) {
            s.attempt([&] {
                s.windowFile_ = freeFileName("megaviews", ".png");
                s.toastOfWindow_ = true;
            });
        };
        t[Action::saveNumbers] = [](Session& s) {
            if (!s.picture_.shown()) return;
            s.attempt([&] {
                const std::string file = freeFileName("megaviews", ".json");
                writeJson(file, s.numbers());
                s.toast("numbers written: " + file);
            });
        };
        t[Action::copyNumbers] = [](Session& s) {
            if (!s.picture_.shown()) return;
            s.panels_->imgui.copy(textOf(s.numbers()));
            s.toast("numbers copied");
        };
        t[Action::copyTable] = [](Session& s) {
            if (!s.picture_.shown()) return;
            s.panels_->imgui.copy(toCsv(s.numbers()));
            s.toast("numbers copied as CSV");
        };
        t[Action::measureFrames] = [](Session& s) {
            if (!s.picture_.shown()) return;
            if (s.frameRun_.running()) {
                s.frameRun_.stop();
                s.panels_->interface.freezeFrames(true);
                const auto measured = s.frameRun_.statistics().frames();
                s.toast(fmt::format("measured {} frame{}", measured, measured == 1 ? "" : "s"));
                return;
            }
            s.panels_->interface.freezeFrames(false);
            s.panels_->interface.forgetFrames();
            s.model_.instrument = ui::Instrument::profiler;
            s.model_.renderingPaused = false;
            // The size of the picture is that of the panel which opens.
            s.runAsked_ = true;
        };
        t[Action::startPage] = toggles(&ui::Model::start);
        t[Action::aboutScene] = toggles(&ui::Model::aboutScene);
        t[Action::reloadShaders] = [](Session& s) { s.reloadShaders(); };
        t[Action::quit] = [](Session& s) { s.closed_ = true; };
        t[Action::undo] = [](Session& s) { s.document_.undo(); };
        t[Action::redo] = [](Session& s) { s.document_.redo(); };
        t[Action::resetSettings] = [](Session& s) { s.document_.reset(); };
        for (const PresetInfo& preset : presetsTable()) {
            const ActionInfo* action = findAction("preset-" + std::string(preset.name));
            assert(action && "every preset has an action");
            t[action->action] = [&preset](Session& s) { applyPreset(s.document_.edit(), preset); };
        }
    }

    static void addTransport(Table& t) {
        t[Action::playPause] = toggles(&ui::Model::playing);
        t[Action::pauseRendering] = toggles(&ui::Model::renderingPaused);
        t[Action::stepBackward] = [](Session& s) { s.stepTime(-1); };
        t[Action::stepForward] = [](Session& s) { s.stepTime(1); };
        t[Action::restart] = [](Session& s) { s.setTime(s.settings().scene.timeS); };
        t[Action::slower] = [](Session& s) {
            s.model_.speed = std::max(s.model_.speed * 0.5, kSlowestPlay);
        };
        t[Action::faster] = [](Session& s) {
            s.model_.speed = std::min(s.model_.speed * 2, kFastestPlay);
        };
    }

    static void toggleSplit(Settings& s) {
        if (s.compare) {
            s.compare = false;
            s.side[1] = s.side[0];
        } else {
            compareWith(
                s, s.side[0].method == Method::manylods ? Method::megaviews : Method::manylods);
        }
    }

    // References, which take their time, are left to those who choose them.
    static void nextMethod(Settings& s, int step) {
        do {
            cycle(s, "method", step);
        } while (isReference(s.side[0].method));
    }

    static void addMethods(Table& t) {
        t[Action::nextMethod] = edits([](Settings& s) { nextMethod(s, 1); });
        t[Action::previousMethod] = edits([](Settings& s) { nextMethod(s, -1); });
        t[Action::toggleSplit] = edits(toggleSplit);
        t[Action::splitLeft] = edits(
            [](Settings& s) { s.display.split = std::max(s.display.split - kSplitStep, 0.0); });
        t[Action::splitRight] = edits(
            [](Settings& s) { s.display.split = std::min(s.display.split + kSplitStep, 1.0); });
        t[Action::swapSides] = edits([](Settings& s) {
            if (s.compare) std::swap(s.side[0], s.side[1]);
        });
        t[Action::showOtherSide] = toggles(&ui::Model::otherSide);
        t[Action::flipSides] = edits([](Settings& s) {
            if (s.compare) s.display.split = s.display.split < 1 ? 1 : 0;
        });
        t[Action::keepReference] = keepReference;
        t[Action::nextDifference] = edits([](Settings& s) {
            if (!s.compare) toggleSplit(s);
            cycle(s, "difference", 1);
        });
    }

    // Once the picture is complete that the errors panel leaves room for.
    static void keepReference(Session& s) {
        s.model_.instrument = ui::Instrument::errors;
        s.keepReference_ = true;
    }

    static void addCameras(Table& t) {
        const auto add = [&](Action action, auto move) {
            t[action] = [move](Session& s) {
                if (s.assets()) s.attempt([&] { move(s, s.document_.edit()); });
            };
        };
        add(Action::frameScene, [](Session& s, Settings& of) { s.camera_.frameScene(of); });
        add(Action::resetCamera, [](Session& s, Settings& of) { s.camera_.reset(of, s.timeS_); });
        add(Action::nextCamera, [](Session& s, Settings& of) { s.camera_.choose(of, 1); });
        add(Action::previousCamera, [](Session& s, Settings& of) { s.camera_.choose(of, -1); });
        for (std::size_t i = 0; i < kBookmarks; ++i) {
            add(nth(Action::storeBookmark1, i), [i](Session& s, Settings&) { s.storeBookmark(i); });
            add(nth(Action::recallBookmark1, i),
                [i](Session& s, Settings&) { s.recallBookmark(i); });
        }
    }

    static void addPicture(Table& t) {
        const auto expose = [](double ev) {
            return [ev](Session& s) {
                auto& exposure = s.document_.edit().display.exposureEv;
                exposure = exposure.value_or(s.statistics().exposureEv) + ev;
            };
        };
        t[Action::exposureDown] = expose(-kExposureStepEv);
        t[Action::exposureUp] = expose(kExposureStepEv);
        t[Action::exposureReset] = [](Session& s) {
            s.document_.edit().display.exposureEv.reset();
            s.picture_.renderer().forgetExposure();
            s.picture_.forget();
        };
        t[Action::nextDebugView] = edits([](Settings& s) { cycle(s, "view", 1); });
        t[Action::previousDebugView] = edits([](Settings& s) { cycle(s, "view", -1); });
    }

    static void addInstruments(Table& t) {
        for (const auto& [instrument, action] : kInstruments) {
            t[action] = [instrument = instrument](Session& s) {
                auto& open = s.model_.instrument;
                open = open == instrument ? std::nullopt : std::optional(instrument);
            };
        }
        const auto step = [](int by) {
            return [by](Session& s) {
                int& shown = s.document_.edit().inspect.step;
                shown = std::clamp(shown + by, 0, kMostSteps);
                s.model_.instrument = ui::Instrument::steps;
            };
        };
        t[Action::stepTraversal] = step(1);
        t[Action::stepTraversalBack] = step(-1);
    }

    static void addWindow(Table& t) {
        t[Action::hideUi] = toggles(&ui::Model::hidden);
        t[Action::help] = toggles(&ui::Model::help);
        t[Action::tour] = [](Session& s) {
            if (s.tour_) {
                s.tour_->restart();
            } else if (s.assets()) {
                s.tour_ = std::make_unique<Tour>(s, s.host_);
            }
            s.tourAsked_ = !s.assets();
        };
        t[Action::commands] = toggles(&ui::Model::palette);
        t[Action::largerInterface] = [](Session& s) {
            const float larger = std::min(s.scale_ * kScaleStep, kLargestScale);
            if (ui::fittingScale(s.width_, s.height_, larger) <= s.scale_) {
                return s.toast("there is no room for a larger interface");
            }
            s.newScale_ = larger;
        };
        t[Action::smallerInterface] = [](Session& s) {
            s.newScale_ = std::max(s.scale_ / kScaleStep, kSmallestScale);
        };
        t[Action::fullScreen] = [](Session& s) {
            s.host_.setFullScreen(s.model_.fullScreen = !s.model_.fullScreen);
        };
        t[Action::vsync] = [](Session& s) { s.host_.setVsync(s.model_.vsync = !s.model_.vsync); };
    }
};

void Session::perform(Action action) {
    redraw_ = true;
    Actions::table().at(action)(*this);
}

void Session::perform(const ui::Requests& requests) {
    if (requests.timeChanged) setTime(model_.timeS);
    if (requests.errorDismissed) model_.error.clear();
    if (tour_ && requests.tour != 0) tour_->move(requests.tour);
    if (tour_ && requests.leaveTour) {
        tour_->leave();
        tour_.reset();
    }
    if (requests.cancelLoading) cancelLoading();
    if (requests.cancelPicture) picture_.settleForDraft();
    if (requests.wholePicture) picture_.askForWhole();
    for (const Action action : requests.actions) perform(action);
    if (!requests.openFile.empty()) openFile(requests.openFile);
    if (!requests.loadState.empty()) openFile(requests.loadState);
    if (!requests.loadReference.empty()) {
        attempt([&] {
            measuring_.loadReference(requests.loadReference);
            model_.instrument = ui::Instrument::errors;
        });
    }
    if (requests.clearRecent) remember([](UserState& state) { state.recent.clear(); });
    attempt([&] {
        std::string lights = settings().scene.lights;
        for (const ui::LightEdit& edit : requests.lights) lights = edited(lights, edit);
        if (requests.lightDrag && requests.lightDrag->light < model_.lights.size()) {
            const ui::LightRow& row = model_.lights[requests.lightDrag->light];
            lights = edited(lights, editOf(lightView(), row, *requests.lightDrag));
        }
        parseLightPlacements(lights, "lights");  // whether they can be placed so
        document_.edit().scene.lights = lights;
    });
    if (!requests.saveState.empty()) {
        attempt([&] {
            saveState(requests.saveState);
            toast("state written: " + requests.saveState);
        });
    }
    if (!requests.saveScene.empty()) {
        attempt([&] {
            saveScene(requests.saveScene);
            toast("scene written: " + requests.saveScene);
        });
    }
}

void Session::attempt(const std::function<void()>& change, const std::string& hint) {
    try {
        change();
    } catch (...) {
        fail(thrownError(), hint);
    }
}

void Session::fail(const Error& error, const std::string& hint) {
    // Without a window the error ends the run, which reports it.
    if (!options_.headless) spdlog::error("{}", error.what());
    model_.error = error.what();
    model_.errorHint = hint;
    failure_ = error;
}

void Session::toast(const std::string& text) {
    spdlog::info("{}", text);
    model_.toasts.push_back({text, 0});
    redraw_ = true;
}

void Session::stepTime(int steps) {
    model_.playing = false;
    if (model_.animationS > 0) setTime(timeS_ + steps * kStepS);
}

void Session::cancelLoading() {
    scene_.cancel();
    scene_.keepLoaded(document_.edit());
    document_.takeBack();
}

void Session::reloadShaders() {
    model_.shaderErrors.clear();
    for (const std::string& message : picture_.renderer().reloadShaders()) {
        spdlog::error("{}", message);
        model_.shaderErrors.push_back(message);
    }
    if (model_.shaderErrors.empty()) toast("shaders are up to date");
    picture_.forget();  // draw with the new ones
}

void Session::showInstrument(std::optional<ui::Instrument> which) {
    model_.instrument = which;
    model_.picking = ui::Picking::none;
}

std::string Session::openPanel() const {
    for (const auto& [instrument, action] : kInstruments) {
        if (model_.instrument == instrument) return idOf(infoOf(action));
    }
    return {};
}

void Session::showPanel(const std::string& name) {
    for (const auto& [instrument, action] : kInstruments) {
        if (idOf(infoOf(action)) == name) perform(action);
    }
}

// ---- files

// Opening a scene keeps what is about methods and pictures, and forgets what was about the scene.
void Session::openFile(const std::string& file) {
    attempt(
        [&] {
            if (isEnvironmentFile(file) && findPictureState(file).empty()) {
                EnvironmentSettings dropped = settings().scene.environment;
                dropped.source = file;
                environment_.of(dropped);  // whether it can be read
                document_.edit().scene.environment = dropped;
                toast("Lit by " + std::filesystem::path(file).filename().string());
                return;
            }
            if (isStateFile(file)) {
                restore(loadState(file, readPictureState));
                return;
            }
            scene_.open(file, forAnotherScene(settings()));
        },
        "The scene on screen was kept.");
}

State Session::state() const {
    State state = stateAsAsked();
    if (assets()) state.settings = camera_.filledIn(state.settings);
    auto& exposure = state.settings.display.exposureEv;
    if (!exposure) exposure = statistics().exposureEv;
    return state;
}

State Session::stateAsAsked() const {
    State state;
    state.scene = scene_.name();
    state.settings = settings();
    if (assets()) {
        state.sceneHash = inputHash(assets()->scene, scene_.viewsHash());
        if (!camera_.following()) state.settings = camera_.filledIn(settings());
    }
    state.settings.resolution = {view_.width, view_.height};
    state.settings.scene.timeS = timeS_;
    state.playing = model_.playing;
    state.speed = model_.speed;
    return state;
}

void Session::saveState(const std::string& file) const {
    if (!assets()) throw Error(ExitCode::output, file + ": there is no scene yet");
    mv::saveState(file, state());
}

void Session::saveScene(const std::string& file) const {
    if (!picture_.shown()) throw Error(ExitCode::output, file + ": there is no picture yet");
    std::vector<std::string> inputs = assets()->scene.files;
    inputs.push_back(scene_.name());
    checkApart(inputs, {file});
    mv::saveScene(file, sceneToSave());
}

PictureInfo Session::pictureInfo() const {
    PictureInfo info;
    info.assets = assets();
    info.viewsHash = scene_.viewsHash();
    info.settings = picture_.effective();
    info.timeS = picture_.input().timeS;
    info.camera = picture_.input().camera;
    info.statistics = statistics();
    info.playing = model_.playing;
    info.speed = model_.speed;
    return info;
}

nlohmann::ordered_json Session::numbers() const {
    // Frames that were measured count, where there are some.
    RunStatistics frame = frameRun_.statistics();
    const int warmUps = frame.frames() > 0 ? FrameRun::kWarmUps : 0;
    if (frame.frames() == 0) frame.add(statistics());
    auto json = frame.toJson(*assets(), picture_.effective(),
                             {.warmupFrames = warmUps,
                              .partial = !picture_.still(),
                              .deterministic = options_.headless || options_.deterministic});
    json["draft"] = picture_.isDraft();
    json["memory"] = toJson(statistics())["memory"];  // as it is now
    // Pairs are counted by level while that is looked at.
    for (std::size_t i = 0; i < json["methods"].size(); ++i) {
        if (statistics().methods.at(i).pairsPerLevel.empty()) continue;
        json["methods"][i].update(toJson(statistics().methods[i]));
    }
    json["errors"] = errorNumbers(model_.errors);
    if (auto panel = panelNumbers(model_); !panel.is_null()) json["panel"] = std::move(panel);
    return json;
}

void Session::savePicture(const std::string& file) {
    if (!picture_.shown()) throw Error(ExitCode::output, file + ": there is no picture yet");
    writePicture(file, picture_.renderer(), pictureInfo());
    badPixelsWritten_ += statistics().badPixels;
}

void Session::savePictureAs(const std::string& extension) {
    if (!picture_.shown()) return;
    attempt([&] {
        const std::string file = freeFileName("megaviews", extension);
        savePicture(file);
        toast("picture written: " + file);
    });
}

// ---- what is remembered from run to run

void Session::remember(const std::function<void(UserState&)>& change) {
    change(userState_);
    updateUserState(userStateFile_, change);
    showUserState();
}

// Recent files and this scene's bookmarks, as the panels show them.
void Session::showUserState() {
    model_.recent.clear();
    for (const std::string& file : userState_.recent) {
        model_.recent.push_back({file, isThere(file)});
    }
    const SceneBookmarks* kept = bookmarks();
    for (std::size_t i = 0; i < model_.bookmarks.size(); ++i) {
        model_.bookmarks[i] = kept && kept->cameras[i].has_value();
    }
}

// This scene's; nullptr if there are none.
const SceneBookmarks* Session::bookmarks() const {
    return assets() ? userState_.bookmarksOf(scene_.name(), assets()->scene.hash) : nullptr;
}

void Session::storeBookmark(std::size_t index) {
    const Bookmark bookmark = bookmarkOf(camera_.filledIn(settings()));
    remember([&](UserState& state) {
        state.bookmarksFor(scene_.name(), assets()->scene.hash).cameras.at(index) = bookmark;
    });
    toast(fmt::format("camera remembered under {}", index + 1));
}

void Session::recallBookmark(std::size_t index) {
    const SceneBookmarks* kept = bookmarks();
    if (!kept || !kept->cameras.at(index)) return;
    camera_.recall(document_.edit(), *kept->cameras[index], timeS_);
}

}  // namespace mv
