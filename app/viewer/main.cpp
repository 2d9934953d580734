// megaviews: the viewer, with a window or without.

#include <GLFW/glfw3.h>
#include <OpenImageIO/oiioversion.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

#include "app/common/command_line.h"
#include "app/common/output_names.h"
#include "app/common/scene_report.h"
#include "app/common/terminal.h"
#include "app/viewer/environment_image.h"
#include "app/viewer/headless.h"
#include "app/viewer/image_io.h"
#include "app/viewer/window.h"
#include "megaviews/core/error.h"

namespace mv {
namespace {

constexpr const char* kDefaultPicture = "megaviews.png";

std::string glfwVersion() {
    int major = 0, minor = 0, revision = 0;
    glfwGetVersion(&major, &minor, &revision);
    return "GLFW " + std::to_string(major) + "." + std::to_string(minor) + "." +
           std::to_string(revision);
}

// Before anything is opened, the log too.
void checkFiles(const RunOptions& run, const Settings& settings) {
    checkApart(inputFiles(run, settings), outputFiles(run));
    checkWritable(outputFiles(run));
    if (!run.referencesFolder.empty()) checkFolder(run.referencesFolder);
}

// Gives the picture that stands for a window a few points a pixel: it takes a quarter of the time
// that the window takes for its own.
void softenEdges(PictureSettings& picture, const std::vector<std::string>& given) {
    constexpr int kPoints = 4;
    const auto isGiven = [&](const char* key) {
        return std::find(given.begin(), given.end(), key) != given.end();
    };
    if (isGiven("pixel-samples") || isGiven("accumulate")) return;
    picture.pixelSamples = kPoints;
}

// What is asked for without a window, in a place that is said if nobody chose one. reason: why
// there is none where one was wanted, as the beginning of a sentence.
int headless(RunOptions run, Settings settings, const std::string& reason) {
    run.headless = true;
    if (run.tour && !run.ui) {
        throw Error(ExitCode::usage,
                    reason + "--tour: needs panels; --headless --ui -o FILE.png draws them");
    }
    const bool tourAlone = run.tour && run.actions.size() == 1;
    if (!run.wantsResults() && (run.actions.empty() || tourAlone)) {
        run.outputs.push_back(kDefaultPicture);
        checkFiles(run, settings);
        const std::string first = outputName(kDefaultPicture, 0, run.frames);
        spdlog::info("{}writing the picture{} to {}", reason, run.frames > 1 ? "s" : "",
                     first + (run.frames > 1 ? ", ..." : ""));
        if (!reason.empty()) softenEdges(settings.picture, run.given);
    } else if (!reason.empty()) {
        spdlog::info("{}performing the script without a window", reason);
    }
    return runHeadless(run, settings);
}

int inform(const CommandLine& line) {
    const RunOptions& run = line.run;
    std::unique_ptr<SceneAssets> assets;
    if (run.info != InfoFormat::none || run.list == "cameras" || run.list == "animations") {
        TerminalProgress progress(run.logLevel >= LogLevel::error);
        assets = loadAssetsWithoutHierarchy(run.scene, line.settings, progress.callback());
        EnvironmentSlot().of(line.settings.scene.environment);  // whether it can be read
    }
    if (!run.list.empty()) std::fputs(listText(run.list, assets.get()).c_str(), stdout);
    if (run.info == InfoFormat::text) {
        std::fputs(infoText(*assets, line.settings).c_str(), stdout);
    }
    if (run.info == InfoFormat::json) {
        std::fputs(infoJson(*assets, line.settings).c_str(), stdout);
    }
    return static_cast<int>(ExitCode::ok);
}

int run(int argc, char** argv) {
    const ProgramInfo program = {
        "megaviews",
        "Lights a scene indirectly from thousands of views, by MegaViews or ManyLoDs, in a window "
        "or without.",
        {glfwVersion(), "Dear ImGui " IMGUI_VERSION, "OpenImageIO " OIIO_VERSION_STRING},
        OptionSet::viewer,
        {},
        readPictureState};
    const CommandLine line = parseCommandLine({argv + 1, argv + argc}, program);
    if (!line.reply.empty()) {
        std::fputs(line.reply.c_str(), stdout);
        return static_cast<int>(ExitCode::ok);
    }
    checkFiles(line.run, line.settings);
    startLogging(line.run);
    if (line.run.info != InfoFormat::none || !line.run.list.empty()) {
        const bool wantsMore = line.run.wantsResults() || !line.run.saveStateFile.empty() ||
                               !line.run.actions.empty() || line.run.mapReferences > 0;
        if (!wantsMore) return inform(line);
        throw Error(ExitCode::usage,
                    "--info and --list print and render nothing: what else is asked for would not "
                    "be written");
    }

    const RunOptions& options = line.run;
    if (options.ui && !options.headless) {
        throw Error(ExitCode::usage, "--ui: draws the window without a display; needs --headless");
    }
    if (options.headless || options.gl == GlPlatform::egl || options.wantsResults()) {
        return headless(options, line.settings, "");
    }
    const auto window = [&] {
        if (options.frames > 1 || options.warmup > 0) {
            spdlog::warn("--frames and --warmup: a window draws as many frames as it shows");
        }
        return runWindow(options, line.settings);
    };
    if (options.gl == GlPlatform::window) return window();
    if (!displayAvailable()) return headless(options, line.settings, "no display: ");
    try {
        return window();
    } catch (const Error& error) {
        if (error.code != ExitCode::graphics) throw;
        spdlog::warn("{}", error.what());
        return headless(options, line.settings, "no window: ");
    }
}

}  // namespace
}  // namespace mv

int main(int argc, char** argv) { return mv::runProgram("megaviews", mv::run, argc, argv); }
