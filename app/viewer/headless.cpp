#include "app/viewer/headless.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "app/common/frame_images.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/common/terminal.h"
#include "app/viewer/graphics_context.h"
#include "app/viewer/image_io.h"
#include "app/viewer/references.h"
#include "app/viewer/script_runner.h"
#include "app/viewer/session.h"
#include "megaviews/core/error.h"
#include "megaviews/io/ply.h"
#include "megaviews/io/save_maps.h"
#include "megaviews/io/save_scene.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

nlohmann::ordered_json toJson(const GatherShares& shares) {
    return {{"keptShare", shares.kept},
            {"facingShare", shares.facing},
            {"runs", shares.runs},
            {"receivers", shares.receivers},
            {"clampedEnergyShare", shares.clampedEnergy}};
}

// A click needs a few frames until all that it opens stands where it will stay.
constexpr int kSettlingFrames = 3;

// A framebuffer in the window's place.
class Offscreen : public Host {
  public:
    Offscreen(int width, int height) { resize(width, height); }
    void resize(int width, int height) override {
        target_ = {};
        color_ = gl::Texture("window", GL_TEXTURE_2D, GL_RGBA8, width, height);
        target_ = gl::Framebuffer("window", {&color_});
    }
    int width() const { return color_.width(); }
    int height() const { return color_.height(); }
    unsigned framebuffer() const { return target_.id(); }

  private:
    gl::Texture color_;
    gl::Framebuffer target_;
};

void checkMaps(const RunOptions& options, const Settings& settings) {
    const MethodSettings& side = settings.side[0];
    const bool anyMaps =
        makesMaps(side.method) || (settings.compare && makesMaps(settings.side[1].method));
    if (options.mapReferences > 0 && !anyMaps) {
        throw Error(ExitCode::usage, "--map-references: method " +
                                         std::string(nameOf(side.method)) + " has no maps");
    }
    if (options.saveMapsFile.empty()) return;
    if (!makesMaps(side.method)) {
        throw Error(ExitCode::usage,
                    "--save-maps: method " + std::string(nameOf(side.method)) + " has no maps");
    }
    if (testsPairs(side.method) && !side.pairs.fusion) {
        throw Error(ExitCode::usage, "--save-maps: writes fused maps; leave out --fusion off");
    }
}

void checkResolution(Size picture) {
    const int limit = gl::limits().maxTextureSize;
    if (picture.width <= limit && picture.height <= limit) return;
    throw Error(ExitCode::impossible, "--resolution: this OpenGL draws pictures up to " +
                                          std::to_string(limit) + "x" + std::to_string(limit));
}

void announce(const std::string& file) { std::printf("%s\n", file.c_str()); }

// A scene that cannot be read is the better reason where there is no OpenGL either.
GraphicsContext contextFor(const RunOptions& options, const Settings& settings) {
    try {
        return GraphicsContext(options.gl, options.glWish);
    } catch (const Error&) {
        loadAssetsWithoutHierarchy(options.scene, settings, {});
        throw;
    }
}

class HeadlessRun {
  public:
    HeadlessRun(const RunOptions& options, const Settings& settings)
        : options_(options),
          context_(contextFor(options, settings)),
          window_((checkResolution(settings.resolution), settings.resolution.width),
                  settings.resolution.height),
          session_(options, settings, window_, 1, {}) {
        spdlog::info("{}, {} ({})", gl::limits().renderer, gl::limits().version,
                     gl::limits().platform);
    }

    void prepare();
    void load();
    void performActions();
    void renderFrames();
    void writeResults();
    // Writes the statistics of the finished frames after an error that ends the run.
    void keepStatistics();
    // Writes all that the finished frames left after an interrupt within a frame.
    void keepFinished();
    // Whether all was done and is as it was asked to be.
    int verdict() const;

  private:
    bool quiet() const { return options_.logLevel >= LogLevel::error; }
    const FrameRenderer& renderer() const { return session_.picture().renderer(); }
    void frame();
    void failUnlessShown();
    bool waitForMakers();
    void finishLastFrame();
    void measureMaps();
    void writePictures(int frame);
    void drawWindow(const std::string& file);
    void keep();
    void writeViews() const;
    void writeMaps() const;
    void writeState() const;
    void writeStatistics(bool partial) const;

    const RunOptions& options_;
    GraphicsContext context_;
    Offscreen window_;
    Session session_;
    // What the frames that are done left, and what is measured of them: all that writeStatistics()
    // reads changes under kept_.lock() alone.
    struct Finished {
        RunStatistics statistics;
        std::shared_ptr<const SceneAssets> assets;
        Settings settings;  // in effect
        State state;
        ViewSet views;                     // where they are to be written
        ReadMaps maps;                     // the same
        std::optional<SceneToSave> scene;  // the same; refers to the assets
    } finished_;
    std::optional<Measurement> measured_;
    std::vector<std::optional<MapErrorReport>> mapErrors_;   // by side
    std::vector<std::optional<GatherShares>> gatherShares_;  // the same
    bool statisticsWritten_ = false;
    std::optional<Error> failure_;  // the first error of a script, where the window shows it
    // Keeps what is finished even where a frame never ends.
    KeptWhenEnded kept_{[this] { keep(); }};
};

// Refuses what cannot be had of the settings, which a reference may lend some to.
void HeadlessRun::prepare() {
    RunOptions options = options_;
    for (const script::Command& command : options.actions) {
        if (const auto* set = std::get_if<script::SetValue>(&command.step)) {
            options.given.push_back(set->key);
        }
    }
    checkMaps(options, session_.settings());
    session_.measuring().prepare(options, session_.editSettings());
}

void HeadlessRun::load() {
    TerminalProgress progress(quiet());
    session_.load(progress.callback());
    failUnlessShown();
    checkApart(session_.assets()->scene.files, outputFiles(options_));
    warnIfChanged(options_.sceneHash, session_.assets()->scene, session_.pictureInfo().viewsHash);
}

// A failure ends the run; with --ui once the window has been drawn that says it.
void HeadlessRun::failUnlessShown() {
    const auto failure = session_.takeFailure();
    if (!failure) return;
    if (!options_.ui) throw *failure;
    if (!failure_) failure_ = failure;
}

// Runs one session frame into the off-screen framebuffer.
void HeadlessRun::frame() {
    if (interrupted()) throw Cancelled();
    session_.frame(1 / options_.frameRate, window_.width(), window_.height(),
                   window_.framebuffer());
    failUnlessShown();
    if (session_.loading() || session_.waiting()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

void HeadlessRun::performActions() {
    if (!options_.ui) session_.perform(Action::hideUi);
    frame();
    ScriptRunner script(options_.actions, session_, window_);
    while (!script.done() && !session_.closed() && !failure_) {
        script.step(window_.width(), window_.height());
        frame();
    }
    const int settling = options_.ui ? kSettlingFrames : 1;
    for (int i = 0; i < settling || session_.loading(); ++i) frame();
}

// False if the run was interrupted: the picture then stays as far as it is, unless it shows a
// reference, which is all or nothing.
bool HeadlessRun::waitForMakers() {
    TerminalProgress progress(quiet());
    while (session_.measuring().busy()) {
        const ReferenceWorker::Status status = session_.measuring().references().status();
        report(progress.callback(), status.stage, status.fraction);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (const auto failure = session_.measuring().takeFailure()) throw failure->error;
    if (const auto error = session_.measuring().takeErrorsFailure()) throw *error;
    return !interrupted() || renderer().awaitsReferences();
}

void HeadlessRun::renderFrames() {
    const Settings& settings = session_.settings();
    if (settings.picture.pixelSamples > 1 && !settings.mayAveragePixels()) {
        spdlog::info("--pixel-samples {}: references and differences are of pixels' centres",
                     settings.picture.pixelSamples);
    }
    session_.forgetExposure();  // a script's picture may have been another
    const double start = session_.timeS();
    const auto timeOf = [&](int frame) { return start + frame / options_.frameRate; };
    for (int i = 0; i < options_.warmup && !interrupted(); ++i) session_.renderWhole(start, {});
    for (int i = 0; i < options_.frames && !interrupted(); ++i) {
        const bool last = i + 1 == options_.frames;
        session_.renderWhole(
            timeOf(i), {!options_.statsFile.empty() && last, [this] { return waitForMakers(); }});
        const FrameStatistics& statistics = session_.statistics();
        {
            const auto lock = kept_.lock();
            finished_.statistics.add(statistics);
            finished_.assets = session_.sharedAssets();
            finished_.settings = session_.picture().effective();
            finished_.state = stateOf(session_.pictureInfo());
            if (!options_.saveViewsFile.empty()) finished_.views = renderer().readViews();
            if (!options_.saveMapsFile.empty()) finished_.maps = renderer().readMaps();
            // What moves will not stand still until it is written.
            if (!options_.saveSceneFile.empty() && !finished_.assets->scene.moving) {
                finished_.scene.emplace(session_.sceneToSave());
            }
        }
        // A window's panels say so.
        if (i == 0 && !options_.ui) {
            for (const std::string& what : session_.missingInspected()) spdlog::warn("{}", what);
        }
        spdlog::info("frame {}: {} views ({} asked for), {:.1f} ms", i, statistics.viewsAlive,
                     statistics.viewsRequested, statistics.frameMs);
        if (last) finishLastFrame();
        writePictures(i);
    }
}

void HeadlessRun::finishLastFrame() {
    if (!options_.statsFile.empty()) {
        std::vector<std::optional<GatherShares>> shares;
        for (std::size_t i = 0; i < session_.statistics().methods.size(); ++i) {
            shares.push_back(renderer().readGatherShares(static_cast<int>(i)));
        }
        const auto lock = kept_.lock();
        gatherShares_ = std::move(shares);
    }
    try {
        measureMaps();
    } catch (const Cancelled&) {
        // What else was asked for is still written.
    }
    if (options_.measure.referenceFile.empty()) return;
    Measurement measured = session_.measuring().measure(renderer(), session_.picture().effective());
    {
        const auto lock = kept_.lock();
        measured_ = std::move(measured);
    }
    std::fputs(toText(*measured_).c_str(), stdout);
    if (!options_.measure.diffFile.empty()) announce(options_.measure.diffFile);
}

// Exact maps of the last frame's views, made if they are asked for, and how far the methods' maps
// are from those there are.
void HeadlessRun::measureMaps() {
    const std::filesystem::path folder = referenceFolder(options_);
    const int wanted = options_.mapReferences;
    if (wanted == 0 && (folder.empty() || options_.statsFile.empty())) return;
    const LivePicture& picture = session_.picture();
    const Settings& settings = picture.effective();
    std::array<Measuring::SideMaps, 2> made;
    do {
        made =
            session_.measuring().measureMaps(renderer(), settings, picture.input(), wanted, false);
        waitForMakers();
    } while (made[0].waits || made[1].waits);
    for (int i = 0; i < static_cast<int>(settings.sideCount()); ++i) {
        const Settings side = sideAlone(settings, static_cast<std::size_t>(i));
        const MapErrorReport* report = made.at(static_cast<std::size_t>(i)).report;
        std::optional<MapErrorReport> errors =
            wanted == 0 ? findMapErrors(ReferenceStore(folder), renderer(),
                                        session_.assets()->scene, side, picture.input(), i)
            : report    ? std::optional(*report)
                        : std::nullopt;
        {
            const auto lock = kept_.lock();
            mapErrors_.push_back(std::move(errors));
        }
        if (wanted == 0 && mapErrors_.back()) {
            spdlog::info("{}", toText(*mapErrors_.back(), side.side[0].method));
        }
    }
}

void HeadlessRun::writePictures(int frame) {
    PictureInfo info = session_.pictureInfo();
    info.frame = frame;
    info.measured = measured_;
    for (const std::string& pattern : options_.outputs) {
        const std::string file = outputName(pattern, frame, options_.frames);
        if (options_.ui) {
            drawWindow(file);
        } else {
            writePicture(file, renderer(), info);
        }
        announce(file);
    }
}

// The window around the frame's picture, once the errors panel has measured that.
void HeadlessRun::drawWindow(const std::string& file) {
    const auto draw = [&] {
        session_.draw(1 / options_.frameRate, window_.width(), window_.height(),
                      window_.framebuffer());
    };
    for (int i = 0; i < kSettlingFrames || !session_.still(); ++i) {
        if (interrupted()) throw Cancelled();
        draw();
        if (session_.waiting()) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    failUnlessShown();
    session_.saveWindowAfterFrame(file);
    draw();
    if (const auto failure = session_.takeFailure()) throw *failure;
}

void HeadlessRun::writeResults() {
    const auto lock = kept_.lock();  // once, and to the end
    if (finished_.statistics.frames() > 0) {
        writeState();
        writeViews();
        writeMaps();
        if (!options_.saveSceneFile.empty()) {
            session_.saveScene(options_.saveSceneFile);
            announce(options_.saveSceneFile);
        }
    }
    statisticsWritten_ = true;
    writeStatistics(interrupted());
}

void HeadlessRun::writeViews() const {
    if (options_.saveViewsFile.empty()) return;
    saveViews(options_.saveViewsFile, finished_.views, finished_.assets->scene.root);
    announce(options_.saveViewsFile);
}

void HeadlessRun::writeMaps() const {
    if (options_.saveMapsFile.empty()) return;
    saveMaps(options_.saveMapsFile, finished_.maps, finished_.assets->scene.root);
    for (const std::string& file : mapsFiles(options_.saveMapsFile)) announce(file);
}

void HeadlessRun::writeState() const {
    if (options_.saveStateFile.empty()) return;
    saveState(options_.saveStateFile, finished_.state);
    announce(options_.saveStateFile);
}

void HeadlessRun::writeStatistics(bool partial) const {
    if (options_.statsFile.empty()) return;
    const SceneAssets& assets = finished_.assets ? *finished_.assets : *session_.assets();
    const Settings& settings =
        finished_.assets ? finished_.settings : session_.picture().effective();
    auto json = finished_.statistics.toJson(assets, settings,
                                            {.warmupFrames = options_.warmup, .partial = partial});
    if (measured_) json["metrics"] = toJson(*measured_);
    for (std::size_t i = 0; i < gatherShares_.size(); ++i) {
        if (gatherShares_[i]) json["methods"][i]["gather"] = toJson(*gatherShares_[i]);
    }
    for (std::size_t i = 0; i < mapErrors_.size(); ++i) {
        if (mapErrors_[i]) json["methods"][i]["mapErrors"] = toJson(*mapErrors_[i]);
    }
    writeJson(options_.statsFile, json);
    announce(options_.statsFile);
}

void HeadlessRun::keepStatistics() {
    const auto lock = kept_.lock();
    if (statisticsWritten_ || finished_.statistics.frames() == 0) return;
    statisticsWritten_ = true;
    try {
        writeStatistics(true);
    } catch (const Error& error) {  // of two the first counts
        spdlog::debug("{}", error.what());
    }
}

void HeadlessRun::keepFinished() {
    const auto lock = kept_.lock();
    keep();
}

void HeadlessRun::keep() {
    if (!finished_.assets || statisticsWritten_) return;
    writeState();
    writeViews();
    statisticsWritten_ = true;
    writeStatistics(true);
    // What takes longest.
    writeMaps();
    if (!finished_.scene) return;
    saveScene(options_.saveSceneFile, *finished_.scene);
    announce(options_.saveSceneFile);
}

int HeadlessRun::verdict() const {
    if (interrupted()) throw Cancelled();
    if (failure_) throw *failure_;
    const std::uint64_t badPixels = finished_.statistics.badPixels() + session_.badPixelsWritten();
    if (badPixels > 0) {
        throw Error(
            ExitCode::checkFailed,
            std::to_string(badPixels) + " pixels are NaN or infinite; --view nan shows them");
    }
    const std::string missed = measured_ ? missedThresholds(*measured_) : "";
    if (!missed.empty()) throw Error(ExitCode::checkFailed, missed);
    return static_cast<int>(ExitCode::ok);
}

}  // namespace

int runHeadless(const RunOptions& options, const Settings& settings) {
    // Everything that can be refused is refused before anything takes long.
    for (const std::string& file : options.outputs) {
        if (options.ui && extensionOf(file) != ".png") {
            throw Error(ExitCode::usage, "--ui: the window is written as .png, not '" + file + "'");
        }
    }
    if (options.actions.empty()) checkMaps(options, settings);  // a script may change them
    noteInterrupts();

    HeadlessRun run(options, settings);
    const bool hasPanels = options.ui || !options.actions.empty();
    if (!hasPanels) run.prepare();
    run.load();
    if (hasPanels) {
        run.performActions();
        run.prepare();
    }
    try {
        if (options.wantsResults() || !options.saveStateFile.empty()) run.renderFrames();
        run.writeResults();
    } catch (const Cancelled&) {
        run.keepFinished();
        throw;
    } catch (...) {
        run.keepStatistics();
        throw;
    }
    return run.verdict();
}

}  // namespace mv
