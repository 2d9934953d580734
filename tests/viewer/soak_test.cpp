// Frames of whatever a hand could do: no GL error, no GL object and no memory left over.
// MEGAVIEWS_SOAK_FRAMES asks for more of them, MEGAVIEWS_SOAK_SEED for others.

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <random>

#include "app/temp_folder.h"
#include "megaviews/io/save_scene.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/program.h"
#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

constexpr GLuint kMostNames = 60000;
constexpr std::size_t kLongestStory = 1 << 16;  // of a failed test

long number(const char* variable, long otherwise) {
    const char* value = std::getenv(variable);
    return value ? std::atol(value) : otherwise;
}

// GL objects alive, by kind.
std::array<int, 6> liveObjects() {
    std::array<int, 6> counts{};
    for (GLuint id = 1; id < kMostNames; ++id) {
        counts[0] += glIsTexture(id);
        counts[1] += glIsBuffer(id);
        counts[2] += glIsFramebuffer(id);
        counts[3] += glIsVertexArray(id);
        if (glIsProgram(id)) {  // drivers keep deleted ones while they like
            GLint deleted = 0;
            glGetProgramiv(id, GL_DELETE_STATUS, &deleted);
            counts[4] += deleted == GL_FALSE;
        }
        counts[5] += glIsQuery(id);
    }
    return counts;
}

// What the program and the driver hold of the heap, with the same scene and settings each time. Not
// the resident size: that also follows what malloc keeps for later, by tens of MiB from run to run.
// The least of several readings: a scene that was given up may still be loading in its thread.
double heapMiB(Viewer& viewer) {
    if (viewer.model().renderingPaused) viewer.run("pause-rendering");
    viewer.session->editSettings() = Viewer::smallSettings();
    double least = std::numeric_limits<double>::max();
    for (int i = 0; i < 6; ++i) {
        viewer.run("key Escape; open builtin:cornell; wait-loading; wait 3");
        const auto heap = mallinfo2();
        least = std::min(least, static_cast<double>(heap.uordblks + heap.hblkhd) / (1 << 20));
    }
    return least;
}

class Hand {
  public:
    explicit Hand(std::uint32_t seed) : random_(seed) {}

    // One thing at random, as a script would write it.
    std::string next() {
        switch (below(10)) {
            case 0:
            case 1:
            case 2:
                return action();
            case 3:
            case 4:
                return setting();
            case 5:
                return fmt("click %d%%,%d%%%s", below(100), below(100),
                           below(3) == 0 ? " right" : "");
            case 6:
                return fmt("drag %d%%,%d%% %d%%,%d%%", below(60), below(100), below(60),
                           below(100));
            case 7:
                return below(2) ? fmt("scroll %d", below(7) - 3) : "key Escape";
            case 8:
                return below(4) == 0 ? fmt("resize %dx%d", 320 + below(100), 240 + below(80))
                                     : fmt("time %d.5", below(20));
            default:
                return "wait 1";
        }
    }

  private:
    int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }
    template <typename... T>
    static std::string fmt(const char* format, T... values) {
        char text[256];
        std::snprintf(text, sizeof text, format, values...);
        return text;
    }
    std::string action() {
        const auto table = actionsTable();
        while (true) {
            const ActionInfo& info =
                table[static_cast<std::size_t>(below(static_cast<int>(table.size())))];
            switch (info.action) {
                case Action::quit:
                case Action::screenshotPng:  // files
                case Action::screenshotExr:
                case Action::screenshotWindow:
                case Action::saveNumbers:
                case Action::presetQuality:  // minutes
                case Action::presetBalanced:
                case Action::presetBench:
                case Action::presetPaperMegaviews:
                case Action::presetPaperManylods:
                case Action::resetSettings:
                case Action::tour:
                    continue;
                case Action::measureFrames:
                    return idOf(info) + "; wait 2; " + idOf(info);  // its 32 frames count as one
                default:
                    return idOf(info);
            }
        }
    }
    std::string setting() {
        static const std::vector<std::string> kChoices = {"method=megaviews",
                                                          "method=manylods",
                                                          "method=none",
                                                          "vpls=1",
                                                          "vpls=33",
                                                          "vpls=100",
                                                          "particles=0",
                                                          "particles=50",
                                                          "bounces=1",
                                                          "bounces=5",
                                                          "view-res=8",
                                                          "view-res=16",
                                                          "fusion=off",
                                                          "fusion=on",
                                                          "hole-fill=off",
                                                          "rules=published",
                                                          "rules=corrected",
                                                          "traversal=queue",
                                                          "cut=incremental",
                                                          "cut=lazy",
                                                          "traversal=lists",
                                                          "fresh-views=off",
                                                          "fresh-views=on",
                                                          "temporal=off",
                                                          "temporal=on",
                                                          "view=sharing",
                                                          "view=shared",
                                                          "view=final",
                                                          "show-octree=3",
                                                          "show-octree=0",
                                                          "show-view-octree=2",
                                                          "show-views=on",
                                                          "show-views=off",
                                                          "step=3",
                                                          "step=0",
                                                          "step-pairs=largest",
                                                          "step-pairs=pair",
                                                          "step-pairs=views",
                                                          "step-hide=culled,split-view",
                                                          "step-hide=",
                                                          "pair-scene=2",
                                                          "pair-view=1",
                                                          "pair-view=99",
                                                          "map-colours=depth",
                                                          "map-colours=views",
                                                          "pick-a=3",
                                                          "pick-b=9",
                                                          "pick-a=-1",
                                                          "scene-depth=4",
                                                          "scene-depth=5",
                                                          "scene-tree=binary",
                                                          "scene-tree=octree",
                                                          "view-depth=3",
                                                          "gather-scale=2",
                                                          "compare-rules=published",
                                                          "compare-view-res=16",
                                                          "compare-traversal=queue",
                                                          "gather-samples=0",
                                                          "gather-samples=3",
                                                          "accumulate=1",
                                                          "accumulate=3",
                                                          "lights=0:0,1,0",
                                                          "lights=",
                                                          "environment=sky",
                                                          "environment=white",
                                                          "environment=none",
                                                          "sky-scale=0",
                                                          "sky-scale=2",
                                                          "sky-rotation=90",
                                                          "sky-samples=5",
                                                          "sky-views=16",
                                                          "sky-views=0",
                                                          "undecided=rays",
                                                          "undecided=off",
                                                          "near-field=on",
                                                          "exposure=1",
                                                          "tonemap=neutral",
                                                          "tonemap=agx"};
        return kChoices[static_cast<std::size_t>(below(static_cast<int>(kChoices.size())))];
    }
    std::mt19937 random_;
};

// What a hand may drag to take minutes a frame is brought back to what takes milliseconds. Rays
// through a million fibres take seconds on a software renderer: they have the other scenes.
void keepSmall(Settings& s, const std::string& scene) {
    if (scene == "builtin:hairball") {
        s.gather.undecided = Undecided::off;
        s.gather.nearField = false;
        s.scene.environment.source = "none";
        for (MethodSettings& side : s.side) {
            if (side.method == Method::shadowRays || side.method == Method::raster ||
                side.method == Method::vir) {
                side.method = Method::megaviews;
            }
        }
    }
    const auto atMost = [](auto& value, auto most) { value = std::min(value, most); };
    atMost(s.scene.octreeDepth, 6);
    atMost(s.views.octreeDepth, 6);
    atMost(s.views.vpls, std::int64_t{256});
    atMost(s.views.particles, std::int64_t{256});
    atMost(s.gather.samples, 2);
    atMost(s.gather.candidates, 2);
    atMost(s.picture.accumulate, 4);
    for (MethodSettings& side : s.side) {
        atMost(side.maps.resolution, 16);
        atMost(side.ism.points, 256);
        atMost(side.ism.pool, 65536);
        atMost(side.referenceSamples, 4);
    }
}

class SoakTest : public ViewerTest {};

// A file of the Cornell box whose materials do all that materials can: metal, clear coats, glass.
std::string shinyBox(const test::TempFolder& folder) {
    Scene scene = makeBuiltin("cornell", {});
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        Material& m = scene.materials[i];
        m.roughness = 0.3f * static_cast<float>(i);
        m.metallic = i % 3 == 0 ? 1.0f : 0.0f;
        m.coat = i % 3 == 1 ? 1.0f : 0.0f;
        m.transmission = i % 3 == 2 ? 0.8f : 0.0f;
    }
    const std::string file = folder.file("shiny.glb");
    saveScene(file, {.scene = scene,
                     .lights = scene.lightsAt(0, -1),
                     .cameras = scene.camerasAt(0, -1),
                     .aspect = 1.5});
    return file;
}

std::unique_ptr<Viewer> openViewer(const std::string& scene) {
    return std::make_unique<Viewer>(400, 280, Viewer::smallSettings(), scene);
}

// What a random hand does in so many frames; the same every time. A hand that quits starts again.
void use(std::unique_ptr<Viewer>& used, const std::string& firstScene, Hand& hand, int frameCount) {
    // Fibres take seconds to load.
    static const std::vector<std::string> kScenes = {
        "builtin:cornell", "no-such-file.glb", "builtin:hairball", "builtin:cornell",
        "builtin:door",    "no-such-file.glb", "builtin:cornell",  "builtin:cornell"};
    std::string done;
    for (int i = 0, frames = 0; frames < frameCount; ++i) {
        if (used->session->closed()) {
            used.reset();
            used = openViewer(firstScene);
        }
        Viewer& viewer = *used;
        const std::string command = hand.next();
        done += command + "\n";
        if (done.size() > kLongestStory) done.erase(0, kLongestStory / 2);
        ScriptRunner runner(script::parse(command, "soak"), *viewer.session, viewer.screen);
        while (!runner.done() && !viewer.session->closed()) {
            try {
                runner.step(viewer.screen.color.width(), viewer.screen.color.height());
            } catch (const Error& error) {  // a setting that contradicts another
                ASSERT_EQ(error.code, ExitCode::usage) << error.what() << "\n" << done;
                break;
            }
            keepSmall(viewer.session->editSettings(), viewer.model().sceneName);
            viewer.frame();
            if (++frames % 10000 == 0) std::printf("%d frames\n", frames), std::fflush(stdout);
        }
        // Whatever is asked for can be drawn or is refused.
        ASSERT_EQ(gl::reportedErrors(), 0u) << done;
        const std::optional<Error> failure = viewer.session->takeFailure();
        ASSERT_FALSE(failure && failure->code == ExitCode::graphics) << failure->what() << done;
        if (i % 67 == 66) {
            const auto scene = static_cast<std::size_t>(i / 67) % kScenes.size();
            viewer.run("key Escape; open " + kScenes[scene] + "; wait-loading; key Escape");
        }
    }
}

TEST_F(SoakTest, FramesOfAnythingLeaveNothingBehind) {
    const test::TempFolder folder;
    const std::string shiny = shinyBox(folder);
    const auto before = liveObjects();
    // The first time compiles shaders and fills caches; the others find them there. The driver
    // keeps more or fewer variants of shaders as frames happen to fall, by tens of MiB: what is
    // lost is lost every time.
    std::array<double, 3> heap{};
    const int frames = static_cast<int>(number("MEGAVIEWS_SOAK_FRAMES", 300));
    {
        auto viewer = openViewer(shiny);
        const auto seed = static_cast<std::uint32_t>(number("MEGAVIEWS_SOAK_SEED", 20));
        for (std::size_t i = 0; i < heap.size(); ++i) {
            Hand hand(frames > 300 ? seed + static_cast<std::uint32_t>(i) : seed);
            use(viewer, shiny, hand, frames / 3);
            heap[i] = heapMiB(*viewer);
        }
    }
    gl::forgetPrograms();  // which renderers share
    EXPECT_EQ(liveObjects(), before) << "textures, buffers, framebuffers, vertex arrays, "
                                        "programs, queries";
    std::printf("%.0f MiB of heap after %d frames, then %.0f, then %.0f\n", heap[0], frames / 3,
                heap[1], heap[2]);
    EXPECT_LT(std::min(heap[1] - heap[0], heap[2] - heap[1]), 25);
}

}  // namespace
}  // namespace mv
