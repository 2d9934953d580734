#pragma once
// The viewer without its window: scene, camera, time, picture, panels and actions. A window or a
// script feeds it InputEvents and calls frame(); it draws into the framebuffer it is given, so that
// both see the same program.

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "app/common/picture_info.h"
#include "app/common/run_options.h"
#include "app/common/state.h"
#include "app/common/user_state.h"
#include "app/viewer/camera_input.h"
#include "app/viewer/image_io.h"
#include "app/viewer/imgui_layer.h"
#include "app/viewer/input.h"
#include "app/viewer/instruments.h"
#include "app/viewer/measuring.h"
#include "app/viewer/scene_loader.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/actions.h"
#include "renderer/frame_renderer.h"
#include "ui/interface.h"

namespace mv {

// What only a window can do; without one nothing happens.
class Host {
  public:
    virtual ~Host() = default;
    virtual void setTitle(const std::string&) {}
    virtual void setVsync(bool) {}
    virtual void setFullScreen(bool) {}
    virtual void catchMouse(bool) {}  // hides it and lets it move without end
    virtual void resize(int, int) {}  // width and height in pixels
};

class Session {
  public:
    // Needs a current context that gl::limits() describes. Starts to load options.scene. scale: of
    // the interface, 1 = 96 dots an inch.
    // userStateFile: where recent files and bookmarks are kept; empty: nowhere.
    Session(const RunOptions& options, const Settings& settings, Host& host, double scale,
            std::string userStateFile);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    InputQueue& input() { return input_; }
    ImGuiLayer& imgui() { return imgui_; }

    // One turn of the program: input, loading, camera, time, picture, panels. seconds since the
    // last. Draws into the framebuffer, 0 is the window's.
    void frame(double seconds, int width, int height, unsigned framebuffer);

    void perform(Action action);
    void perform(const ui::Requests& requests);
    void releaseOtherSide() { model_.otherSide = false; }
    // A scene, a saved state or a picture that carries one; trouble ends in the error dialog.
    void openFile(const std::string& file);
    void restore(const State& state);
    State state() const;
    void setTime(double seconds);
    // The picture as .png or .exr. Throws Error(ExitCode::output). None of these says so in the
    // window: that is for who asks.
    void savePicture(const std::string& file);
    void saveState(const std::string& file) const;
    // What the next frame draws, panels included, as a PNG; trouble ends in the error dialog.
    void saveWindowAfterFrame(const std::string& file) { windowFile_ = file; }

    bool closed() const { return closed_; }
    // Nothing will change before something is put in: no need for another frame.
    bool resting() const;
    // The same but for what other threads make: references, measurements.
    bool waiting() const;
    bool loading() const { return loader_.loading(); }
    // The picture shows what the settings ask for, with all the samples they ask for, and is
    // measured where the errors panel is open.
    bool still() const { return still_ && !measuring_.unfinished(model_.errors); }
    const Settings& settings() const { return settings_; }
    // Changes come into effect with the next frame and can be undone.
    Settings& editSettings() { return settings_; }
    // Asks for a window in which the picture has the resolution that the settings ask for.
    void fitWindow();
    // Of the instrument that is open, or empty: what UserState::panel keeps.
    std::string openPanel() const;
    const ui::Model& model() const { return model_; }
    const FrameStatistics& statistics() const { return statistics_; }
    const ui::Interface& interface() const { return interface_; }

  private:
    // session_scene.cpp: loading, state, camera
    void startLoading(const std::string& scene, const Settings& settings);
    void finishLoading();
    void takeScene(std::unique_ptr<SceneAssets> assets);
    void reloadWhereNeeded();
    void keepLoaded();
    double animationLengthS() const;
    void takeCameraSettings();
    void describeScene();
    void resetCamera();
    void leaveNamedCamera();
    void chooseCamera(int step);
    void showUserState();
    float pivotInFront(const FrameCamera& camera) const;

    // session.cpp: the frame
    void takeInput();
    void keyPressed(const KeyChanged& key);
    void moveCamera(double seconds);
    void advanceTime(double seconds);
    void renderPicture();
    FrameMoment shownMoment() const;
    void followReferences();
    void giveUpReferences();

    void measureErrors();
    void show(int width, int height, unsigned framebuffer);
    void noteChange();
    void clicked(const CameraInput::Click& click);
    std::optional<Instruments::Pixel> pixelAt(double x, double y) const;
    void describeLights();
    void placeHandles(ui::LightRow& row) const;
    std::pair<glm::vec3, glm::vec3> handlesOf(const ui::LightRow& row) const;
    std::optional<std::array<float, 2>> windowPosition(glm::vec3 point) const;
    void drag(const ui::LightDrag& drag);
    void place(const ui::LightEdit& edit);
    Settings wantedSettings() const;
    Settings draftOf(Settings settings) const;
    void lowerQuality();

    // session_actions.cpp
    void stepTime(int steps);
    void savePictureAs(const std::string& extension);
    PictureInfo pictureInfo() const;
    void toast(const std::string& text);
    void fail(const Error& error, const std::string& hint = {});
    void undo(std::deque<Settings>& from, std::deque<Settings>& to);
    void resetSettings();
    void reloadShaders();
    void applyPreset(Action action);
    void storeBookmark(int index);
    void recallBookmark(int index);
    void cancelLoading();

    RunOptions options_;
    Settings settings_;
    Host& host_;
    const std::string userStateFile_;
    UserState userState_;
    float scale_;
    ImGuiLayer imgui_;
    ui::Interface interface_;
    ui::Model model_;
    Measuring measuring_;
    FrameRenderer renderer_;
    FrameStatistics statistics_;
    Instruments instruments_;
    InputQueue input_;
    bool closed_ = false, mouseCaught_ = false, redraw_ = true;

    SceneLoader loader_;
    std::shared_ptr<SceneAssets> assets_;
    std::string scene_;               // name of what assets_ holds
    std::optional<State> restoring_;  // what comes into effect with the scene being loaded
    Settings loaded_;                 // that assets_ was loaded with

    CameraController controller_;
    CameraInput cameraInput_;
    Settings cameraOf_;      // that the camera was last taken from
    bool following_ = true;  // the scene's camera, also where it is animated
    int cameraIndex_ = 0;
    int animation_ = -1;
    double timeS_ = 0, startS_ = 0;

    // What the picture shows: asked for, and in effect (a draft while something moves).
    bool shown_ = false, still_ = false, draft_ = false;
    Settings wanted_, effective_;
    Settings good_;  // the last that could be rendered, not only as a draft
    double shownTimeS_ = 0;
    FrameCamera shownCameraPose_;
    bool countedLevels_ = false;
    bool moving_ = false;    // something does, as of this frame
    bool supplied_ = false;  // light or errors that the next picture shows
    // What each side showed before it showed a reference.
    Method lastMethod_ = Method::megaviews;
    std::optional<Method> lastCompare_;
    std::uint64_t picture_ = 0;   // how many were rendered
    int width_ = 0, height_ = 0;  // of the window
    ui::Viewport view_;
    gl::Framebuffer blit_;
    unsigned blitTexture_ = 0;
    std::string windowFile_;
    bool toastOfWindow_ = false;

    std::deque<Settings> undo_, redo_;
    Settings noted_;                    // the settings that undo goes back to from here
    std::optional<float> newScale_;     // from the next frame on
    std::optional<Settings> presetOf_;  // whose preset model_ names
};

}  // namespace mv
