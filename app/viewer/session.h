#pragma once
// The viewer without its window: document, scene, camera, picture, measurements and panels, and the
// frame that runs through them. A window or a script feeds it InputEvents and calls frame(); it
// draws into the framebuffer it is given, so that both see the same program. Without panels it
// renders whole frames, which is what --headless writes.

#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/common/picture_info.h"
#include "app/common/run_options.h"
#include "app/common/state.h"
#include "app/common/user_state.h"
#include "app/viewer/camera_rig.h"
#include "app/viewer/document.h"
#include "app/viewer/draft_pace.h"
#include "app/viewer/environment_image.h"
#include "app/viewer/frame_run.h"
#include "app/viewer/imgui_layer.h"
#include "app/viewer/input.h"
#include "app/viewer/instruments.h"
#include "app/viewer/light_handles.h"
#include "app/viewer/live_picture.h"
#include "app/viewer/measuring.h"
#include "app/viewer/scene_slot.h"
#include "app/viewer/scene_to_save.h"
#include "app/viewer/start_page.h"
#include "megaviews/core/error.h"
#include "megaviews/core/progress.h"
#include "megaviews/settings/actions.h"
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
    // While a picture takes long a window stays alive: poll() takes in what came since and is
    // false if it closes or no longer has that size; present() shows what was drawn.
    virtual bool isAlive() const { return false; }
    virtual bool poll(int /*width*/, int /*height*/) { return true; }
    virtual void present() {}
};

class Tour;

class Session {
  public:
    // Needs a current context that gl::limits() describes. Starts to load options.scene. Has panels
    // unless the options ask for pictures alone. scale: of the interface, 1 = 96 dots an inch.
    // userStateFile: where recent files and bookmarks are kept; empty: nowhere.
    Session(const RunOptions& options, const Settings& settings, Host& host, double scale,
            std::string userStateFile);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    InputQueue& input() { return input_; }
    // These need panels.
    ImGuiLayer& imgui() { return panels_->imgui; }
    const ui::Interface& interface() const { return panels_->interface; }
    // One turn of the program: input, loading, camera, time, picture, panels. seconds since the
    // last. Draws into the framebuffer, 0 is the window's.
    void frame(double seconds, int width, int height, unsigned framebuffer);
    // The last part of frame(): draws the panels around the picture as it is.
    void draw(double seconds, int width, int height, unsigned framebuffer);
    // Saves the next drawing, panels included, as a PNG; trouble ends in the error dialog.
    void saveWindowAfterFrame(const std::string& file) { windowFile_ = file; }

    // Waits until the scene stands that is being loaded. Throws why it could not be.
    void load(const Progress& progress);
    // Lets the next picture fit an exposure of its own, where none is given.
    void forgetExposure() { picture_.renderer().forgetExposure(); }
    // Renders the picture of a moment from nothing by LivePicture::renderWhole(). Unless that only
    // warms up, LivePicture::complete() and what is drawn over the picture follow.
    struct Whole {
        bool countLevels = false;
        std::function<bool()> wait;  // empty: to warm up
    };
    void renderWhole(double timeS, const Whole& whole);

    void perform(Action action);
    void perform(const ui::Requests& requests);
    void showInstrument(std::optional<ui::Instrument> which);
    void releaseOtherSide() { model_.otherSide = false; }
    // Opens a scene, a saved state or a picture that carries one; trouble ends in the error dialog.
    void openFile(const std::string& file);
    void restore(const State& state) { scene_.restore(state); }
    // The state that brings the picture back as it is, with exposure and camera in numbers, however
    // they were chosen.
    State state() const;
    // The same, but what is automatic stays automatic unless somebody has moved it.
    State stateAsAsked() const;
    void setTime(double seconds);
    double timeS() const { return timeS_; }
    // Saves the picture as .png or .exr. Throws Error(ExitCode::output). The functions that save
    // show nothing in the window: that is up to the caller.
    void savePicture(const std::string& file);
    void saveState(const std::string& file) const;
    // Saves the scene as the picture shows it, as glTF. Also throws Error(ExitCode::usage) where it
    // would overwrite a file that the scene was read from.
    void saveScene(const std::string& file) const;
    // The scene that saveScene() would write.
    SceneToSave sceneToSave() const { return mv::sceneToSave(pictureInfo(), bookmarks()); }
    PictureInfo pictureInfo() const;
    // A sentence for each thing that settings ask to inspect and that the picture's scene or views
    // do not have.
    std::vector<std::string> missingInspected() {
        return instruments_.missing(picture_.effective());
    }
    // What --stats writes, of the frame that is shown, and the errors panel's values.
    nlohmann::ordered_json numbers() const;

    bool closed() const { return closed_; }
    // Nothing will change without input: no further frame is needed.
    bool resting() const { return still() && idle(); }
    // Nothing will change but by input and by what other threads are making: references,
    // measurements.
    bool waiting() const;
    bool loading() const { return scene_.loading(); }
    // The picture shows what the settings ask for, with all the samples they ask for, and is
    // measured where the errors panel is open.
    bool still() const { return picture_.still() && !measuring_.unfinished(model_.errors); }
    const Settings& settings() const { return document_.settings(); }
    // Changes come into effect with the next frame and can be undone.
    Settings& editSettings() { return document_.edit(); }
    // Asks for a window in which the picture has the resolution that the settings ask for.
    void fitWindow();
    // How many pixels were NaN or infinite in the pictures that savePicture() and
    // saveWindowAfterFrame() wrote.
    std::uint64_t badPixelsWritten() const { return badPixelsWritten_; }
    // The error since the last call, which the window shows in a dialog.
    std::optional<Error> takeFailure() { return std::exchange(failure_, std::nullopt); }
    // Names the instrument that is open, or is empty: what UserState::panel keeps.
    std::string openPanel() const;
    void showPanel(const std::string& name);  // nothing where none is called so
    const ui::Model& model() const { return model_; }
    const FrameStatistics& statistics() const { return picture_.statistics(); }
    const LivePicture& picture() const { return picture_; }
    Measuring& measuring() { return measuring_; }
    const SceneAssets* assets() const { return scene_.assets().get(); }
    std::shared_ptr<const SceneAssets> sharedAssets() const { return scene_.assets(); }

  private:
    // session.cpp: the parts of a frame
    void changeScale(int width, int height);
    void takeInput();
    void keyPressed(const KeyChanged& key);
    bool dialogOpen() const;
    void giveUp();
    bool takeScene();
    void describeScene();
    void advanceTime(double seconds);
    double animationLengthS() const;
    void moveCamera(double seconds);
    void layOut(int width, int height);
    void fillPanels();
    void describeLights();
    void show(int width, int height, unsigned framebuffer);
    void writeWindow(int width, int height, unsigned framebuffer);
    void noteChange();
    bool idle() const;
    std::optional<Instruments::Pixel> pixelAt(double x, double y) const;
    void clicked(const CameraInput::Click& click);
    Settings shownByInstruments() const;
    LightView lightView() const;

    // session_picture.cpp: the picture, and the window while that takes long
    Settings wantedSettings() const;
    // FrameInput::pose of a frame at that time.
    std::function<void()> poserFor(double timeS);
    void renderPicture(unsigned framebuffer);
    void measureFrame(const Settings& wanted, const FrameInput& input);
    void whileRendering(Stage stage, double done, unsigned framebuffer);
    double foreseenS() const;
    void followReferences();

    // session_actions.cpp: what actions and panels ask for
    struct Actions;
    void attempt(const std::function<void()>& change, const std::string& hint = {});
    void stepTime(int steps);
    void savePictureAs(const std::string& extension);
    void toast(const std::string& text);
    void fail(const Error& error, const std::string& hint = {});
    void reloadShaders();
    void cancelLoading();
    void remember(const std::function<void(UserState&)>& change);
    void showUserState();
    const SceneBookmarks* bookmarks() const;
    void storeBookmark(std::size_t index);
    void recallBookmark(std::size_t index);

    struct Panels {
        ImGuiLayer imgui;
        ui::Interface interface;
    };

    const RunOptions options_;
    Host& host_;
    const std::string userStateFile_;
    UserState userState_;
    float askedScale_, scale_ = 0;   // the scale asked for, and what of it fits the window
    std::optional<float> newScale_;  // replaces askedScale_ with the next frame
    std::unique_ptr<Panels> panels_;
    ui::Model model_;
    ui::Viewport view_;           // of the picture
    int width_ = 0, height_ = 0;  // of the window
    InputQueue input_;
    bool closed_ = false, mouseCaught_ = false, redraw_ = true;
    bool tookInput_ = false;  // in this frame, other than motion of the mouse
    // When the picture under way was begun, and when the window was last drawn meanwhile.
    std::chrono::steady_clock::time_point begun_, drawn_;
    double drawnS_ = 0;                  // seconds of this frame that such drawings took
    std::vector<ui::Requests> pending_;  // of such drawings, one each
    FrameRun frameRun_;
    bool runAsked_ = false;  // frameRun_ begins with the next frame
    std::optional<Error> failure_;
    std::uint64_t badPixelsWritten_ = 0;

    Document document_;
    DraftPace pace_;
    SceneSlot scene_;
    EnvironmentSlot environment_;
    CameraRig camera_;
    double timeS_ = 0, startS_ = 0;
    LivePicture picture_;
    Settings good_;           // the last that could be rendered, in a whole picture
    FrameCamera goodCamera_;  // and what they were rendered from
    Measuring measuring_;
    Instruments instruments_;
    std::unique_ptr<Tour> tour_;
    bool tourAsked_ = false;  // before there was a scene
    std::unique_ptr<StartPage> startPage_;
    std::string windowFile_;
    bool toastOfWindow_ = false;
    bool keepReference_ = false;  // keep the picture as reference as soon as it is complete
};

}  // namespace mv
