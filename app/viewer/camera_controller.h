#pragma once
// Orbit and fly camera in root-cube units. Speeds follow the scene's size and the distance to what
// is looked at.

#include "megaviews/views/frame_camera.h"

namespace mv {

class CameraController {
  public:
    // Starts from a scene's camera. pivotDistance: how far in front the orbit's centre lies.
    void set(const FrameCamera& camera, float pivotDistance);
    // Looks at the whole of a box from the present direction.
    void frame(glm::vec3 boxMin, glm::vec3 boxMax);
    void moveTo(glm::vec3 position) { camera_.position = position; }

    // Angles in radians.
    void orbit(float yaw, float pitch);
    void look(float yaw, float pitch);
    // Shares of the picture's height: the point under the mouse follows it.
    void pan(float right, float up);
    // steps > 0: closer by a tenth of the distance each.
    void dolly(float steps);
    // Root-cube units along right, up and forward.
    void fly(glm::vec3 step);
    // Walking speed in root-cube units a second.
    float flySpeed() const { return flySpeed_; }
    void scaleFlySpeed(float factor);

    const FrameCamera& camera() const { return camera_; }
    float pivotDistance() const { return pivotDistance_; }

  private:
    void turn(float yaw, float pitch);
    FrameCamera camera_;
    float pivotDistance_ = 0.3f;
    float flySpeed_ = 0.15f;
};

}  // namespace mv
