#include "app/viewer/window.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <mutex>

#include "app/common/scene_assets.h"
#include "app/viewer/camera_controller.h"
#include "app/viewer/glfw_window.h"
#include "app/viewer/image_io.h"
#include "app/viewer/key_bindings.h"
#include "megaviews/io/ply.h"
#include "megaviews/settings/actions.h"
#include "megaviews/settings/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"
#include "ui/interface.h"

namespace mv {
namespace {

constexpr double kStepS = 1.0 / 30;     // one animation step
constexpr float kRadPerPixel = 0.005f;  // mouse look and orbit
constexpr double kLongestFrameS = 0.5;  // the animation never jumps further at once

// What a software renderer can show: of a picture that stands still, and at interactive rates while
// something moves. Said in the status bar.
constexpr int kSoftwareDepth = 8, kSoftwareSamples = 16;
constexpr int kDraftSamples = 4, kDraftScale = 2, kDraftViewRes = 8;
constexpr double kDraftPixels = 560 * 360;

// What a worker thread says of the scene it loads.
struct LoadingState {
    std::mutex mutex;
    std::string stage = "starting";
    float fraction = 0;
    std::atomic<bool> cancelled = false;
};

class Viewer {
  public:
    Viewer(const RunOptions& options, const Settings& settings)
        : options_(options), settings_(settings), window_(options.vsync), imgui_(window_.handle) {
        gl::initialise("window");
        renderer_ = std::make_unique<FrameRenderer>();
        setScale(options.uiScale);
        installCallbacks();
        model_.renderer = gl::limits().renderer;
        if (gl::limits().software) lowerQuality();
        startLoading(options.scene);
    }

    // A scene that is still loading is given up.
    ~Viewer() {
        if (loading_) loading_->cancelled = true;
    }
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    int run() {
        auto last = std::chrono::steady_clock::now();
        while (!glfwWindowShouldClose(window_.handle)) {
            // While nothing changes, sleep until something happens.
            if (idle_) {
                glfwWaitEventsTimeout(0.1);
            } else {
                glfwPollEvents();
            }
            const auto now = std::chrono::steady_clock::now();
            const double dt = std::chrono::duration<double>(now - last).count();
            last = now;
            finishLoading();
            rebuildForDepth();
            moveCamera(dt);
            advanceTime(dt);
            renderFrame();
            drawWindow(dt);
        }
        return static_cast<int>(ExitCode::ok);
    }

  private:
    // ---- scene

    // The octree is built for one depth: another one is another load of the same scene, in the
    // background, once the mouse has let go of the setting.
    void rebuildForDepth() {
        if (!assets_ || future_.valid() || ImGui::IsAnyItemActive()) return;
        if (settings_.sceneDepth == loadedDepth_) return;
        startLoading(options_.scene);
    }

    void startLoading(const std::string& scene) {
        loadingDepth_ = settings_.sceneDepth;
        loading_ = std::make_shared<LoadingState>();
        const auto state = loading_;
        const Progress progress = [state](std::string_view stage, float fraction) {
            if (state->cancelled) throw Cancelled();
            const std::lock_guard lock(state->mutex);
            state->stage = stage;
            state->fraction = fraction;
        };
        future_ = std::async(std::launch::async, [this, scene, progress, settings = settings_] {
            return loadAssets(scene, settings,
                              options_.useCache ? defaultCacheDirectory() : std::filesystem::path(),
                              progress);
        });
    }

    void finishLoading() {
        if (!future_.valid()) return;
        if (future_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
            const std::lock_guard lock(loading_->mutex);
            model_.loadingStage = loading_->stage;
            model_.loadingFraction = loading_->fraction;
            return;
        }
        model_.loadingStage.clear();
        try {
            auto assets = future_.get();
            renderer_->setScene(assets->scene, assets->bvh, assets->hierarchy);
            if (!settings_.viewsFile.empty()) {
                std::vector<std::string> warnings;
                renderer_->setViews(loadViews(settings_.viewsFile, assets->scene.root, &warnings));
                for (const std::string& warning : warnings) spdlog::warn("{}", warning);
            }
            const bool sameScene = assets_ != nullptr;
            assets_ = std::move(assets);  // the old scene goes only now
            loadedDepth_ = loadingDepth_;
            shown_ = false;
            describeScene(sameScene);
            if (!sameScene) resetCamera();
        } catch (const Error& error) {
            fail(error);
            settings_.sceneDepth = loadedDepth_;
        }
    }

    void describeScene(bool sameScene) {
        const Scene& scene = assets_->scene;
        animation_ = assets_->animation;
        if (!sameScene) timeS_ = settings_.timeS;
        model_.sceneName = scene.name;
        model_.sceneSummary = fmt::format(std::locale("C"), "{} triangles, {} octree leaves",
                                          scene.triangles.size(), assets_->hierarchy.leafCount());
        model_.cameras.clear();
        for (const Camera& camera : scene.cameras) model_.cameras.push_back(camera.name);
        model_.animationS =
            animation_ >= 0 ? scene.animations[static_cast<std::size_t>(animation_)].duration : 0;
        // Particles follow closed paths of their own.
        if (settings_.particles > 0) model_.animationS = std::max(model_.animationS, 60.0);
        model_.warnings = scene.warnings;
    }

    // ---- camera

    void resetCamera() {
        const FrameCamera camera = chosenCamera(settings_, *assets_, timeS_);
        controller_.set(camera, pivotInFront(camera));
        shownCamera_ = settings_.camera;
    }

    // The orbit's centre: what the middle of the picture shows.
    float pivotInFront(const FrameCamera& camera) const {
        const auto hit = assets_->bvh.intersect(camera.position, camera.forward, 0, 2);
        return hit ? hit->t : 0.3f;
    }

    void moveCamera(double dt) {
        if (!assets_) return;
        const ImGuiIO& io = ImGui::GetIO();
        double x = 0, y = 0;
        glfwGetCursorPos(window_.handle, &x, &y);
        const auto dx = static_cast<float>(x - cursorX_), dy = static_cast<float>(y - cursorY_);
        cursorX_ = x;
        cursorY_ = y;

        int button = -1;
        for (int b : {GLFW_MOUSE_BUTTON_LEFT, GLFW_MOUSE_BUTTON_RIGHT, GLFW_MOUSE_BUTTON_MIDDLE}) {
            if (glfwGetMouseButton(window_.handle, b) == GLFW_PRESS) button = b;
        }
        // A drag that began on a panel stays the panel's, one on the picture the camera's.
        if (button < 0) {
            drag_ = -1;
        } else if (drag_ == -1) {
            drag_ = io.WantCaptureMouse ? -2 : button;
        } else if (drag_ >= 0 && (dx != 0 || dy != 0)) {
            const float h = static_cast<float>(std::max(view_.height, 1));
            if (drag_ == GLFW_MOUSE_BUTTON_RIGHT) {
                controller_.look(dx * kRadPerPixel, -dy * kRadPerPixel);
            } else if (drag_ == GLFW_MOUSE_BUTTON_MIDDLE || io.KeyShift) {
                controller_.pan(dx / h, -dy / h);
            } else {
                controller_.orbit(dx * kRadPerPixel, -dy * kRadPerPixel);
            }
            leaveNamedCamera();
        }
        if (drag_ == GLFW_MOUSE_BUTTON_RIGHT) fly(dt);
        if (settings_.camera != shownCamera_) resetCamera();
    }

    // GLFW's key names stand for places on the keyboard: W A S D is the same cluster everywhere.
    void fly(double dt) {
        const auto down = [&](int key) {
            return glfwGetKey(window_.handle, key) == GLFW_PRESS ? 1.0f : 0.0f;
        };
        glm::vec3 step(down(GLFW_KEY_D) - down(GLFW_KEY_A), down(GLFW_KEY_E) - down(GLFW_KEY_Q),
                       down(GLFW_KEY_W) - down(GLFW_KEY_S));
        if (step == glm::vec3(0)) return;
        float speed = controller_.flySpeed();
        if (down(GLFW_KEY_LEFT_SHIFT) > 0) speed *= 4;
        if (down(GLFW_KEY_LEFT_CONTROL) > 0) speed *= 0.25f;
        controller_.fly(step * speed * static_cast<float>(std::min(dt, kLongestFrameS)));
        leaveNamedCamera();
    }

    // ---- time

    void advanceTime(double dt) {
        if (!assets_ || !model_.playing || model_.animationS <= 0) return;
        timeS_ = std::fmod(timeS_ + std::min(dt, kLongestFrameS) * model_.speed, model_.animationS);
        if (timeS_ < 0) timeS_ += model_.animationS;
    }

    // ---- frame

    // A software renderer gets what it can do, and the status bar says so. Whatever was asked for
    // on the command line stays.
    void lowerQuality() {
        const auto lower = [&](const char* key, int& value, int lowered) {
            if (!options_.isGiven(key)) value = lowered;
        };
        lower("scene-depth", settings_.sceneDepth, kSoftwareDepth);
        lower("view-depth", settings_.viewDepth, kSoftwareDepth);
        lower("gather-samples", settings_.gatherSamples, kSoftwareSamples);
        model_.notices.push_back(
            fmt::format("software renderer: {} octree levels, {} samples; draft while moving",
                        kSoftwareDepth, kSoftwareSamples));
    }

    // What is shown while something moves and the renderer is software.
    Settings draftOf(Settings settings) const {
        const auto lower = [&](const char* key, int& value, int draft) {
            if (!options_.isGiven(key)) value = std::min(value, draft);
        };
        lower("gather-samples", settings.gatherSamples, kDraftSamples);
        lower("view-res", settings.viewRes, kDraftViewRes);
        if (!options_.isGiven("gather-scale")) settings.gatherScale = kDraftScale;
        const double shrink =
            std::min(1.0, std::sqrt(kDraftPixels / (settings.width * settings.height)));
        settings.width = std::max(static_cast<int>(settings.width * shrink), 1);
        settings.height = std::max(static_cast<int>(settings.height * shrink), 1);
        return settings;
    }

    void renderFrame() {
        if (!assets_) return;
        Settings wanted = settings_;
        wanted.width = view_.width;
        wanted.height = view_.height;
        FrameInput input;
        input.camera = controller_.camera();
        input.timeS = timeS_;
        input.animation = animation_;
        const bool moved = !shown_ || wanted != wantedSettings_ || shownTimeS_ != timeS_ ||
                           shownPosition_ != input.camera.position ||
                           shownForward_ != input.camera.forward;
        const Settings now = moved && shown_ && gl::limits().software ? draftOf(wanted) : wanted;
        // Once nothing moves any more, a draft gives way to the whole picture, and that stays.
        idle_ = !moved && now == shownSettings_ && !future_.valid();
        if (!moved && now == shownSettings_) return;
        try {
            renderer_->render(now, input, statistics_);
            shown_ = true;
            interface_.addFrame(statistics_);
        } catch (const Error& error) {
            fail(error);
            settings_ = goodSettings_;  // the last picture stays, and what made it
            return;
        }
        goodSettings_ = settings_;
        wantedSettings_ = wanted;
        shownSettings_ = now;
        shownTimeS_ = timeS_;
        shownPosition_ = input.camera.position;
        shownForward_ = input.camera.forward;
    }

    void drawWindow(double dt) {
        int width = 0, height = 0;
        glfwGetFramebufferSize(window_.handle, &width, &height);
        if (width == 0 || height == 0) {  // minimised
            idle_ = true;
            return;
        }
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glViewport(0, 0, width, height);
        glClearColor(0.06f, 0.06f, 0.07f, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        if (shown_) {
            const gl::Texture& picture = renderer_->display();
            if (picture.id() != blitTexture_) {
                blit_ = gl::Framebuffer("window blit", {&picture});
                blitTexture_ = picture.id();
            }
            const int bottom = height - view_.y - view_.height;
            glBlitNamedFramebuffer(blit_.id(), 0, 0, 0, picture.width(), picture.height(), view_.x,
                                   bottom, view_.x + view_.width, bottom + view_.height,
                                   GL_COLOR_BUFFER_BIT,
                                   picture.width() == view_.width ? GL_NEAREST : GL_LINEAR);
        }

        imgui_.beginFrame();
        meanFrameS_ = meanFrameS_ > 0 ? 0.8 * meanFrameS_ + 0.2 * dt : dt;
        model_.framesPerSecond = 1 / std::max(meanFrameS_, 1e-4);
        model_.timeS = timeS_;
        view_ = ui::pictureViewport(width, height, scale_, model_);
        const ui::Requests requests =
            interface_.draw(settings_, model_, statistics_, width, height, scale_);
        imgui_.endFrame();
        glfwSwapBuffers(window_.handle);

        if (requests.timeChanged) timeS_ = model_.timeS;
        if (requests.errorDismissed) model_.error.clear();
        for (const Action action : requests.actions) perform(action);
    }

    // ---- actions

    void perform(Action action);

    // Keys act while the pointer rests too: never wait for the next event to show what they did.
    static Viewer& of(GLFWwindow* window) {
        return *static_cast<Viewer*>(glfwGetWindowUserPointer(window));
    }
    // ImGui's own callbacks run first: they are installed before and chained.
    void installCallbacks() {
        glfwSetWindowUserPointer(window_.handle, this);
        imguiKey_ = glfwSetKeyCallback(
            window_.handle, [](GLFWwindow* w, int key, int scancode, int event, int modifiers) {
                Viewer& viewer = of(w);
                if (viewer.imguiKey_) viewer.imguiKey_(w, key, scancode, event, modifiers);
                if (event == GLFW_RELEASE || ImGui::GetIO().WantTextInput) return;
                // Space, Enter and arrows belong to ImGui while one of its widgets has the focus.
                if (ImGui::GetIO().WantCaptureKeyboard && ImGui::GetIO().NavVisible) return;
                if (viewer.drag_ == GLFW_MOUSE_BUTTON_RIGHT && modifiers != 0) return;  // flying
                if (const auto action = actionOfKey(key, modifiers)) viewer.perform(*action);
            });
        imguiScroll_ = glfwSetScrollCallback(window_.handle, [](GLFWwindow* w, double x, double y) {
            Viewer& viewer = of(w);
            if (viewer.imguiScroll_) viewer.imguiScroll_(w, x, y);
            if (ImGui::GetIO().WantCaptureMouse) return;
            const auto steps = static_cast<float>(y);
            if (viewer.drag_ == GLFW_MOUSE_BUTTON_RIGHT) {
                viewer.controller_.scaleFlySpeed(std::pow(1.25f, steps));
            } else {
                viewer.controller_.dolly(steps);
                viewer.leaveNamedCamera();
            }
        });
    }

    void leaveNamedCamera() {
        settings_.camera.clear();
        shownCamera_.clear();
    }

    void chooseCamera(int step) {
        if (!assets_) return;
        const int count = static_cast<int>(model_.cameras.size());
        cameraIndex_ = ((cameraIndex_ + step) % count + count) % count;
        settings_.camera = std::to_string(cameraIndex_);
    }

    // The first of megaviews-1.png, megaviews-2.png, ... that does not exist yet.
    static std::string freeFileName() {
        for (int i = 1;; ++i) {
            std::string name = "megaviews-" + std::to_string(i) + ".png";
            if (!std::filesystem::exists(name)) return name;
        }
    }

    PictureInfo pictureInfo() const {
        PictureInfo info;
        info.assets = assets_.get();
        info.settings = shownSettings_;
        info.timeS = shownTimeS_;
        info.camera = controller_.camera();
        info.statistics = statistics_;
        return info;
    }

    void savePicture() {
        if (!shown_) return;
        const std::string file = freeFileName();
        try {
            writePicture(file, *renderer_, pictureInfo());
            spdlog::info("picture written: {}", file);
        } catch (const Error& error) {
            fail(error);
        }
    }

    void fail(const Error& error) {
        spdlog::error("{}", error.what());
        model_.error = error.what();
    }

    void setScale(double scale) {
        float monitor = 1, unused = 1;
        glfwGetWindowContentScale(window_.handle, &monitor, &unused);
        scale_ = scale > 0 ? static_cast<float>(scale) : std::max(monitor, 1.0f);
        ui::applyStyle(scale_);
    }

    RunOptions options_;
    Settings settings_, goodSettings_;
    GlfwWindow window_;
    ImGuiLayer imgui_;
    std::unique_ptr<FrameRenderer> renderer_;
    ui::Model model_;
    ui::Interface interface_;
    FrameStatistics statistics_;
    float scale_ = 1;

    std::shared_ptr<LoadingState> loading_;
    std::future<std::unique_ptr<SceneAssets>> future_;
    std::unique_ptr<SceneAssets> assets_;
    int loadingDepth_ = 0, loadedDepth_ = 0;

    CameraController controller_;
    std::string shownCamera_;
    double cursorX_ = 0, cursorY_ = 0;
    int drag_ = -1;  // mouse button that drags the picture; -1 none, -2 a panel's
    int animation_ = -1;
    int cameraIndex_ = 0;
    double timeS_ = 0;
    bool vsync_ = true;
    double meanFrameS_ = 0;
    GLFWkeyfun imguiKey_ = nullptr;
    GLFWscrollfun imguiScroll_ = nullptr;

    bool shown_ = false, idle_ = false;
    Settings wantedSettings_, shownSettings_;  // asked for; in effect
    double shownTimeS_ = 0;
    glm::vec3 shownPosition_{0}, shownForward_{0};
    ui::Viewport view_{0, 0, kInitialWidth, kInitialHeight};
    gl::Framebuffer blit_;
    GLuint blitTexture_ = 0;
};

// The next of a setting's choices, or the one before.
template <typename Enum>
Enum cycled(Enum value, int step, int count) {
    return static_cast<Enum>(((static_cast<int>(value) + step) % count + count) % count);
}

constexpr int kMethods = 3;  // of enum Method
constexpr int kDebugViews = static_cast<int>(DebugView::nan) + 1;
constexpr double kExposureStepEv = 0.25, kSplitStep = 0.02;

void Viewer::perform(Action action) {
    switch (action) {
        case Action::quit:
            glfwSetWindowShouldClose(window_.handle, GLFW_TRUE);
            break;
        case Action::screenshotPng:
            savePicture();
            break;
        case Action::playPause:
            model_.playing = !model_.playing;
            break;
        case Action::stepBackward:
        case Action::stepForward: {
            model_.playing = false;
            const double step = action == Action::stepForward ? kStepS : -kStepS;
            if (model_.animationS > 0) {
                timeS_ = std::fmod(timeS_ + step + model_.animationS, model_.animationS);
            }
            break;
        }
        case Action::slower:
            model_.speed *= 0.5;
            break;
        case Action::faster:
            model_.speed *= 2;
            break;
        case Action::restart:
            timeS_ = settings_.timeS;
            break;
        case Action::nextMethod:
            settings_.method = cycled(settings_.method, 1, kMethods);
            break;
        case Action::previousMethod:
            settings_.method = cycled(settings_.method, -1, kMethods);
            break;
        case Action::toggleSplit:
            if (settings_.compare) {
                settings_.compare.reset();
            } else {
                settings_.compare =
                    settings_.method == Method::manylods ? Method::megaviews : Method::manylods;
            }
            break;
        case Action::splitLeft:
            settings_.split = std::max(settings_.split - kSplitStep, 0.0);
            break;
        case Action::splitRight:
            settings_.split = std::min(settings_.split + kSplitStep, 1.0);
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
        case Action::exposureDown:
        case Action::exposureUp:
            settings_.exposureEv =
                settings_.exposureEv.value_or(statistics_.exposureEv) +
                (action == Action::exposureUp ? kExposureStepEv : -kExposureStepEv);
            break;
        case Action::exposureReset:
            settings_.exposureEv.reset();
            renderer_->forgetExposure();
            shown_ = false;
            break;
        case Action::nextDebugView:
            settings_.view = cycled(settings_.view, 1, kDebugViews);
            break;
        case Action::previousDebugView:
            settings_.view = cycled(settings_.view, -1, kDebugViews);
            break;
        case Action::hideUi:
            model_.hidden = !model_.hidden;
            break;
        case Action::help:
            model_.help = !model_.help;
            break;
        case Action::vsync:
            vsync_ = !vsync_;
            glfwSwapInterval(vsync_ ? 1 : 0);
            break;
    }
}

}  // namespace

bool displayAvailable() {
    return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr;
}

int runWindow(const RunOptions& options, const Settings& settings) {
    Viewer viewer(options, settings);
    return viewer.run();
}

}  // namespace mv
