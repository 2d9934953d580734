#include "app/viewer/headless.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/common/frame_images.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/common/scene_assets.h"
#include "app/common/terminal.h"
#include "app/viewer/graphics_context.h"
#include "app/viewer/image_io.h"
#include "app/viewer/measuring.h"
#include "app/viewer/references.h"
#include "megaviews/core/error.h"
#include "megaviews/inspect/overlay.h"
#include "megaviews/io/ply.h"
#include "megaviews/io/save_maps.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_renderer.h"

namespace mv {
namespace {

void checkRequest(const RunOptions& options, const Settings& settings) {
    if (options.saveMapsFile.empty()) return;
    if (!makesMaps(settings.side[0].method)) {
        throw Error(
            ExitCode::usage,
            "--save-maps: method " + std::string(nameOf(settings.side[0].method)) + " has no maps");
    }
    if (testsPairs(settings.side[0].method) && !settings.side[0].pairs.fusion) {
        throw Error(ExitCode::usage, "--save-maps: writes fused maps; leave out --fusion off");
    }
}

void checkResolution(const Settings& settings) {
    const int limit = gl::limits().maxTextureSize;
    if (settings.picture.width <= limit && settings.picture.height <= limit) return;
    throw Error(ExitCode::impossible, "--resolution: this OpenGL draws pictures up to " +
                                          std::to_string(limit) + "x" + std::to_string(limit));
}

void announce(const std::string& file) { std::printf("%s\n", file.c_str()); }

void saveMapsOf(const FrameRenderer& renderer, const RootCube& root, const std::string& file) {
    const ReadMaps read = renderer.readMaps();
    MapsToSave maps;
    maps.viewRes = read.maps.viewRes;
    maps.centers = read.maps.centers;
    maps.mapOfSlot = read.mapOfSlot;
    maps.root = root;
    const auto resolution = static_cast<std::uint64_t>(read.maps.viewRes);
    const std::uint64_t texelsPerMap = 2 * resolution * resolution;
    maps.read = [&](std::uint64_t firstMap, std::span<std::uint32_t> texels) {
        const auto begin =
            read.maps.texels.begin() + static_cast<std::ptrdiff_t>(firstMap * texelsPerMap);
        std::copy_n(begin, texels.size(), texels.begin());
    };
    saveMaps(file, maps);
}

// Pairs by level of the scene node, of the frame just rendered. Counting them slows the traversal,
// so it is done apart from the times.
void countLevels(FrameRenderer& renderer, const Settings& settings, FrameInput input,
                 FrameStatistics& statistics) {
    input.reuse = true;
    input.countLevels = true;
    FrameStatistics counted;
    renderer.render(settings, input, counted);
    for (std::size_t i = 0; i < statistics.methods.size(); ++i) {
        statistics.methods[i].pairsPerLevel = std::move(counted.methods[i].pairsPerLevel);
    }
}

// Waits for what is made on other threads. Throws Cancelled once the program was interrupted.
void waitFor(Measuring& measuring, bool quiet) {
    TerminalProgress progress(quiet);
    while (measuring.busy()) {
        const ReferenceWorker::Status status = measuring.references().status();
        report(progress.callback(), status.stage, status.fraction);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (const auto failure = measuring.takeFailure()) throw failure->error;
}

// Exact maps of the last frame's views, made if they are asked for, and how far the methods' maps
// are from those there are: by side.
std::vector<std::optional<MapErrorReport>> measureMaps(
    const RunOptions& options, const Settings& settings, const SceneAssets& assets,
    const FrameInput& input, const FrameRenderer& renderer, Measuring& measuring) {
    const std::filesystem::path folder = referenceFolder(options);
    const int wanted = options.mapReferences;
    if (wanted == 0 && (folder.empty() || options.statsFile.empty())) return {};
    std::vector<std::optional<MapErrorReport>> reports;
    std::array<Measuring::SideMaps, 2> made;
    do {
        made = measuring.measureMaps(renderer, settings, input, wanted, false);
        waitFor(measuring, options.logLevel >= LogLevel::error);
    } while (made[0].waits || made[1].waits);
    for (int i = 0; i < (settings.compare ? 2 : 1); ++i) {
        const Settings side = i == 0 ? settings : sideAlone(settings, 1);
        const MapErrorReport* report = made[static_cast<std::size_t>(i)].report;
        reports.push_back(wanted == 0 ? findMapErrors(ReferenceStore(folder), renderer,
                                                      assets.scene, side, input, i)
                          : report    ? std::optional(*report)
                                      : std::nullopt);
        if (wanted == 0 && reports.back()) {
            spdlog::info("{}", toText(*reports.back(), side.side[0].method));
        }
    }
    return reports;
}

// Renders until the frame's picture has all that it should: references, every set of samples, FLIP.
// Its times stay those of the first set, which is a whole frame: the others gather only.
void complete(FrameRenderer& renderer, Measuring& measuring, const Settings& settings,
              FrameInput input, bool quiet, FrameStatistics& statistics) {
    input.reuse = true;
    while (!interrupted() || renderer.awaitsReferences()) {
        bool more = measuring.supply(renderer, settings, input, false);
        waitFor(measuring, quiet);
        more = measuring.supply(renderer, settings, input, false) || more;
        if (!more && statistics.accumulatedFrames >= settings.picture.accumulate) break;
        FrameStatistics next;
        renderer.render(settings, input, next);
        if (!more && next.accumulatedFrames <= statistics.accumulatedFrames) break;  // full sums
        statistics.accumulatedFrames = next.accumulatedFrames;
        statistics.badPixels = next.badPixels;
        statistics.differenceRange = next.differenceRange;
        statistics.exposureEv = next.exposureEv;
        statistics.memory = next.memory;
    }
}

void drawOverlay(Inspector& inspector, const Settings& settings, FrameRenderer& renderer,
                 FrameStatistics& statistics) {
    if (!overlayWanted(settings)) return;
    if (overlayNeedsViews(settings)) inspector.setViews(renderer.readViews().views);
    const Overlay& overlay = inspector.overlay(settings);
    renderer.drawOverlay(overlay.lines, overlay.version, statistics);
}

}  // namespace

int runHeadless(const RunOptions& options, const Settings& given) {
    // Everything that can be refused is refused before anything takes long.
    checkRequest(options, given);
    checkWritable(outputFiles(options));
    Settings settings = given;
    Measuring measuring(options);
    measuring.prepare(options, settings);
    noteInterrupts();

    std::shared_ptr<SceneAssets> assets;
    std::unique_ptr<GraphicsContext> context;
    std::optional<ViewSet> loadedViews;
    {
        TerminalProgress progress(options.logLevel >= LogLevel::error);
        assets = loadAssetsWithoutHierarchy(options.scene, settings, progress.callback());
        if (!settings.views.file.empty()) {
            std::vector<std::string> warnings;
            loadedViews = loadViews(settings.views.file, assets->scene.root, &warnings);
            for (const std::string& warning : warnings) spdlog::warn("{}", warning);
        }
        context = std::make_unique<GraphicsContext>(options.gl, options.glWish);
        checkResolution(settings);
        buildHierarchy(*assets, settings,
                       options.useCache ? defaultCacheDirectory() : std::filesystem::path(),
                       progress.callback());
    }
    warnIfChanged(options.sceneHash, assets->scene);
    spdlog::info("{}, {} ({})", gl::limits().renderer, gl::limits().version, gl::limits().platform);

    FrameRenderer renderer;
    renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
    renderer.setViews(std::move(loadedViews));
    measuring.setScene(assets);

    Inspector inspector;
    inspector.setScene(assets->hierarchy);
    RunStatistics statistics;
    std::vector<std::optional<MapErrorReport>> mapErrors;
    PictureInfo info;
    info.assets = assets.get();
    info.settings = settings;
    info.playing = options.playing.value_or(false);
    info.speed = options.speed;
    for (int i = -options.warmup; i < options.frames && !interrupted(); ++i) {
        info.frame = std::max(i, 0);
        info.timeS = settings.scene.timeS + info.frame / options.frameRate;
        info.camera = chosenCamera(settings, *assets, info.timeS);
        FrameInput input;
        input.camera = info.camera;
        input.timeS = info.timeS;
        input.animation = assets->animation;
        input.reuse = false;
        renderer.render(settings, input, info.statistics);
        if (i < 0) continue;
        if (!options.statsFile.empty() && i + 1 == options.frames) {
            countLevels(renderer, settings, input, info.statistics);
        }
        complete(renderer, measuring, settings, input, options.logLevel >= LogLevel::error,
                 info.statistics);
        drawOverlay(inspector, settings, renderer, info.statistics);
        statistics.add(info.statistics);
        spdlog::info("frame {}: {} of {} views, {:.1f} ms", i, info.statistics.viewsAlive,
                     info.statistics.viewsRequested, info.statistics.frameMs);
        if (i + 1 == options.frames) {
            try {
                mapErrors = measureMaps(options, settings, *assets, input, renderer, measuring);
            } catch (const Cancelled&) {
                // What else was asked for is still written.
            }
        }
        if (!options.measure.referenceFile.empty() && i + 1 == options.frames) {
            info.measured = measuring.measure(renderer, settings);
            std::fputs(toText(*info.measured).c_str(), stdout);
            if (!options.measure.diffFile.empty()) announce(options.measure.diffFile);
        }
        for (const std::string& pattern : options.outputs) {
            const std::string file = outputName(pattern, i, options.frames);
            writePicture(file, renderer, info);
            announce(file);
        }
    }

    const bool partial = interrupted();
    if (statistics.frames() > 0) {
        if (!options.saveViewsFile.empty()) {
            saveViews(options.saveViewsFile, renderer.readViews(), assets->scene.root);
            announce(options.saveViewsFile);
        }
        if (!options.saveMapsFile.empty()) {
            saveMapsOf(renderer, assets->scene.root, options.saveMapsFile);
            announce(options.saveMapsFile);
        }
        if (!options.saveStateFile.empty()) {
            saveState(options.saveStateFile, stateOf(info));
            announce(options.saveStateFile);
        }
    }
    if (!options.statsFile.empty()) {
        auto json = statistics.toJson(*assets, settings, options.warmup, partial);
        if (info.measured) json["metrics"] = toJson(*info.measured);
        for (std::size_t i = 0; i < mapErrors.size(); ++i) {
            if (mapErrors[i]) json["methods"][i]["mapErrors"] = toJson(*mapErrors[i]);
        }
        writeJson(options.statsFile, json);
        announce(options.statsFile);
    }
    if (partial) throw Cancelled();
    if (statistics.badPixels() > 0) {
        throw Error(ExitCode::checkFailed,
                    std::to_string(statistics.badPixels()) +
                        " pixels are NaN or infinite; --view nan shows them");
    }
    const std::string missed = info.measured ? missedThresholds(*info.measured) : "";
    if (!missed.empty()) throw Error(ExitCode::checkFailed, missed);
    return static_cast<int>(ExitCode::ok);
}

}  // namespace mv
