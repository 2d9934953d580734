// Session: how its picture is rendered, and the window meanwhile where that takes long.

#include <GLFW/glfw3.h>

#include <chrono>
#include <utility>

#include "app/viewer/session.h"
#include "megaviews/scene/pose.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

// The window, while a picture takes long.
constexpr double kRedrawnAfterS = 0.1, kLongDraftS = 0.5;

double pixelsOf(const Settings& settings) {
    return 1.0 * settings.resolution.width * settings.resolution.height;
}

}  // namespace

Settings Session::wantedSettings() const {
    Settings wanted = settings();
    if (model_.otherSide && wanted.compare) {
        wanted.display.split = wanted.display.smallerSide() == 0 ? 1 : 0;
        wanted.display.difference = Difference::off;
    }
    if (!wanted.compare) wanted.display.difference = Difference::off;
    // What is explained and measured is of pixel centres and of one set of views, and then so is
    // the picture.
    const bool ofCentres =
        model_.instrument == ui::Instrument::pixel || model_.instrument == ui::Instrument::errors;
    if (ofCentres) {
        wanted.picture.pixelSamples = 1;
        wanted.picture.freshViews = false;
    }
    return wanted;
}

// References are made of the scene as it stands.
std::function<void()> Session::poserFor(double timeS) {
    if (!assets()->scene.moving) return {};
    return [this, timeS] {
        const Scene& scene = assets()->scene;
        if (scene.poseS == loopTime(timeS, scene.moving->durationS)) return;
        measuring_.rest();
        scene_.pose(timeS);
    };
}

void Session::renderPicture(unsigned framebuffer) {
    // A scene that is about to be replaced is worth no picture: progress and Cancel stay alive.
    const bool waits = model_.renderingPaused || scene_.reloading();
    if (!assets() || (waits && picture_.shown())) {
        picture_.rest();
        model_.work.reset();
        return;
    }
    const Settings wanted = wantedSettings();
    FrameInput input;
    input.camera = camera_.camera();
    input.timeS = timeS_;
    input.animation = assets()->animation;
    input.pose = poserFor(timeS_);
    input.countLevels = model_.instrument == ui::Instrument::traversal;
    if (host_.isAlive()) {
        input.watch = [this, framebuffer](Stage stage, double done) {
            whileRendering(stage, done, framebuffer);
        };
    }
    if (!picture_.interrupted()) {
        begun_ = std::chrono::steady_clock::now();
        model_.work.reset();
    }
    drawn_ = std::chrono::steady_clock::now();
    try {
        input.environment = environment_.of(wanted.scene.environment);
        if (std::exchange(runAsked_, false)) {
            frameRun_.begin(model_.frameRun.wanted, wanted, input);
        }
        if (frameRun_.keepOnlyOf(wanted, input)) panels_->interface.freezeFrames(false);
        if (frameRun_.running()) {
            measureFrame(wanted, input);
            return;
        }
        if (!picture_.advance(wanted, document_.draftOf(wanted, pace_.pixels()), input)) return;
    } catch (const Cancelled&) {
        return;
    } catch (...) {
        fail(thrownError());
        frameRun_.stop();
        document_.edit() = good_;  // the last picture stays, and what made it
        document_.takeBack();
        picture_.keep(wantedSettings());
        return;
    }
    model_.work.reset();
    panels_->interface.addFrame(statistics(), picture_.effective(), picture_.makesDraft());
    if (picture_.makesDraft()) {
        pace_.note(statistics().frameMs / 1000, pixelsOf(picture_.effective()), pixelsOf(wanted));
    }
    if (!picture_.isDraft()) {
        good_ = settings();
        goodCamera_ = input.camera;
    }
}

// What is shown of them is theirs alone, until the picture becomes another.
void Session::measureFrame(const Settings& wanted, const FrameInput& input) {
    if (frameRun_.advance(picture_, wanted, input)) {
        panels_->interface.addFrame(statistics(), picture_.effective(), false);
    }
    if (!frameRun_.running()) panels_->interface.freezeFrames(true);
}

// A picture on a software renderer may take long. A whole one is given up for whatever comes in but
// the mouse's way, and begins in a frame in which nothing did; what was finished of it is kept. A
// draft is of what moves, and another would be no sooner there: it is given up for Esc alone, which
// takes back what the settings were changed to.
void Session::whileRendering(Stage stage, double done, unsigned framebuffer) {
    const auto now = std::chrono::steady_clock::now();
    const auto since = [&](auto then) { return std::chrono::duration<double>(now - then).count(); };
    const bool draft = picture_.makesDraft();
    const bool stays = host_.poll(width_, height_);
    const bool disturbed =
        draft ? input_.holdsPress(GLFW_KEY_ESCAPE)
              : tookInput_ || !input_.holdsOnlyMoves() || camera_.input().dragging();
    if (!stays || disturbed) throw Cancelled();
    if (since(drawn_) < (draft ? kLongDraftS : kRedrawnAfterS)) return;
    // What only adds samples to a whole picture needs no word.
    if (draft || !picture_.shown() || picture_.isDraft()) {
        const bool foreseen = !draft && picture_.shown();
        model_.work = ui::Work{.stage = std::string(infoOf(stage).name),
                               .done = static_cast<float>(done),
                               .elapsedS = since(begun_),
                               .wholeS = foreseen ? foreseenS() : 0,
                               .draft = draft};
    }
    if (!draft) takeInput();
    panels_->imgui.beginFrame(width_, height_, since(drawn_));
    show(width_, height_, framebuffer);
    const Settings before = settings();
    ui::Requests requests =
        panels_->interface.draw(document_.edit(), model_, statistics(), width_, height_, scale_);
    panels_->imgui.endFrame(framebuffer);
    host_.present();
    drawnS_ += since(drawn_);
    drawn_ = std::chrono::steady_clock::now();
    requests.redraw = false;
    const bool asked = requests != ui::Requests();
    if (asked) pending_.push_back(requests);
    if (!draft && (asked || settings() != before)) throw Cancelled();
}

// What the whole picture takes, from what its draft did: maps by their texels, the gather by its
// samples. An upper bound, since what is far needs no more pairs for finer maps.
double Session::foreseenS() const {
    const Settings &draft = picture_.effective(), &whole = picture_.wanted();
    // A sample costs as much as so many candidates that are weighed for it (llvmpipe, atrium).
    constexpr int kCandidatesOfSample = 40;
    const FrameStatistics& f = statistics();
    const auto samples = [&](const Settings& s) {
        const double pixels = pixelsOf(s) / (s.gather.cull.scale * s.gather.cull.scale);
        if (s.gather.samples == 0) {  // all, of which each is its own candidate
            return pixels * static_cast<double>(f.viewsAlive) * (kCandidatesOfSample + 1);
        }
        return pixels * s.gather.samples * (kCandidatesOfSample + s.gather.candidates);
    };
    double ms = f.frameMs;
    for (std::size_t i = 0; i < f.methods.size(); ++i) {
        const double finer =
            static_cast<double>(whole.side[i].maps.resolution) / draft.side[i].maps.resolution;
        ms += f.methods[i].mapsMs * (finer * finer - 1) +
              f.methods[i].gatherMs * (samples(whole) / samples(draft) - 1);
    }
    return ms / 1000;
}

void Session::followReferences() {
    picture_.supply(measuring_);
    if (const auto error = measuring_.takeErrorsFailure()) fail(*error);
    if (const auto failure = measuring_.takeFailure()) {
        fail(failure->error);
        if (failure->ofMaps) {
            model_.errors.mapViews = 0;
        } else {
            document_.leaveReferences();
        }
    }
    const bool fits = picture_.shown() && picture_.still() &&
                      picture_.effective().resolution.width == view_.width;
    if (keepReference_ && fits) {
        keepReference_ = false;
        measuring_.keepReference(picture_.renderer(), picture_.effective(), picture_.input().camera,
                                 0);
        toast("the left picture is the reference now");
    }
    document_.noteMethods();
    const bool holds =
        picture_.shown() && picture_.renderer().awaitsReferences() && picture_.moving();
    const ReferenceWorker::Status status = measuring_.references().status();
    model_.referenceStage = holds ? "reference waits until nothing moves" : status.stage;
    model_.referenceFraction = holds ? -1 : status.fraction;
}

void Session::renderWhole(double timeS, const Whole& whole) {
    timeS_ = timeS;
    FrameInput input;
    input.camera = camera_.at(settings(), timeS);
    input.timeS = timeS;
    input.animation = assets()->animation;
    input.pose = poserFor(timeS);
    input.environment = environment_.of(settings().scene.environment);
    picture_.renderWhole(wantedSettings(), input);
    if (!whole.wait) return;
    picture_.complete(measuring_, whole.countLevels, whole.wait);
    instruments_.readFrame(picture_.renderer(), picture_.effective(), model_);
    instruments_.drawOverlay(picture_.renderer(), picture_.effective(), picture_.statistics());
    if (panels_) panels_->interface.addFrame(statistics(), picture_.effective(), false);
}

}  // namespace mv
