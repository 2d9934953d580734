#pragma once
// Where the picture is seen from: a camera of the scene, which an animation may move, what the
// settings put in its place, or one that mouse and keys have moved since.

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <glm/vec3.hpp>

#include "app/common/scene_assets.h"
#include "app/common/user_state.h"
#include "app/viewer/camera_controller.h"
#include "app/viewer/camera_input.h"

namespace mv {

class CameraRig {
  public:
    CameraInput& input() { return input_; }
    const CameraInput& input() const { return input_; }
    const FrameCamera& camera() const { return controller_.camera(); }
    float pivotDistance() const { return controller_.pivotDistance(); }

    // The scene that the camera stands in from now on; where it stands is reset()'s business.
    void setScene(std::shared_ptr<const SceneAssets> assets);

    // All that follows needs a scene. What throws Error(ExitCode::usage), because no camera can be
    // made of the settings, takes them back to those of the present camera.

    // Takes the camera from the settings alone: the scene's, and what they put in its place.
    void reset(Settings& settings, double timeS);
    // Takes input, what was changed of the camera's settings, and the animation, if the time is
    // another.
    void update(Settings& settings, double timeS, bool timeMoved, double seconds, int pictureHeight,
                bool keysFree);
    // Shows all of the scene from outside, or in a room as much of it as stepping back shows.
    void frameScene(Settings& settings);
    // The camera has left the rooms that the scene's own camera stands in.
    bool isOutside() const;
    // Chooses the scene's next camera, or the previous one, in effect with the next update().
    void choose(Settings& settings, int step);
    void recall(Settings& settings, const Bookmark& bookmark, double timeS);
    // Goes back to an earlier camera; the settings stay as they are.
    void returnTo(const FrameCamera& camera);

    // The settings say where it stands, and nobody has moved it since.
    bool following() const { return following_; }
    // Number of the scene's camera through which the picture is seen, where it is one of them.
    std::optional<std::size_t> sceneCamera() const;
    // The settings with the camera written into them.
    Settings filledIn(const Settings& settings) const;
    // Where the camera stands at another time.
    FrameCamera at(const Settings& settings, double timeS) const;

  private:
    void place(Settings& settings, const Settings& there, double timeS, bool follow);
    void takeSettings(Settings& settings, double timeS);
    void leaveNamed(Settings& settings);
    float pivotInFront(const FrameCamera& camera) const;
    struct Place {
        bool inRoom = false;
        float clearance = 0;  // to the nearest surface, root-cube units
    };
    Place placeAt(glm::vec3 position) const;
    float shareInSight(const FrameCamera& camera) const;
    bool isClear(glm::vec3 from, glm::vec3 to) const;
    void move(const std::function<void(CameraController&, float share)>& change);

    std::shared_ptr<const SceneAssets> assets_;
    std::pair<glm::vec3, glm::vec3> bounds_;  // of the scene
    CameraController controller_;
    CameraInput input_;
    CameraSettings taken_;   // the settings that the camera was last taken from
    bool following_ = true;  // the scene's camera, also where it is animated
    int index_ = 0;          // the camera that choose() took last
    bool startsInRoom_ = false;
    float leastInSight_ = 0;  // share of the picture that hands leave to the scene
};

}  // namespace mv
