#include "app/viewer/camera_controller.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/constants.hpp>

namespace mv {
namespace {

constexpr glm::vec3 kWorldUp{0, 1, 0};
constexpr float kSmallestPitchFromPole = 0.02f;  // rad: keeps right = forward x up defined
constexpr float kNearestPivot = 0.002f;          // root-cube units

glm::vec3 direction(float yaw, float pitch) {
    return {std::cos(pitch) * std::sin(yaw), std::sin(pitch), -std::cos(pitch) * std::cos(yaw)};
}

}  // namespace

void CameraController::set(const FrameCamera& camera, float pivotDistance) {
    camera_ = camera;
    pivotDistance_ = std::max(pivotDistance, kNearestPivot);
    // Kept to the last bit until it is turned: a restored camera gives the saved picture.
    const float sine = glm::length(glm::cross(camera.forward, kWorldUp));
    if (!(sine > std::sin(kSmallestPitchFromPole))) turn(0, 0);
}

void CameraController::frame(glm::vec3 boxMin, glm::vec3 boxMax) {
    const glm::vec3 center = (boxMin + boxMax) * 0.5f;
    const float radius = std::max(glm::length(boxMax - boxMin) * 0.5f, kNearestPivot);
    pivotDistance_ = radius / std::sin(camera_.yfovRad * 0.5f);
    camera_.position = center - camera_.forward * pivotDistance_;
    if (camera_.orthoHalfHeight > 0) camera_.orthoHalfHeight = radius;
}

void CameraController::turn(float yaw, float pitch) {
    const glm::vec3 f = camera_.forward;
    const float limit = glm::half_pi<float>() - kSmallestPitchFromPole;
    const float newPitch = std::clamp(std::atan2(f.y, std::hypot(f.x, f.z)) + pitch, -limit, limit);
    camera_.forward = direction(std::atan2(f.x, -f.z) + yaw, newPitch);
    // Orthogonal: states keep it to the last bit.
    camera_.up = glm::cross(glm::normalize(glm::cross(camera_.forward, kWorldUp)), camera_.forward);
}

void CameraController::orbit(float yaw, float pitch) {
    const glm::vec3 pivot = camera_.position + camera_.forward * pivotDistance_;
    turn(yaw, pitch);
    camera_.position = pivot - camera_.forward * pivotDistance_;
}

void CameraController::look(float yaw, float pitch) { turn(yaw, pitch); }

void CameraController::pan(float right, float up) {
    const glm::vec3 r = glm::normalize(glm::cross(camera_.forward, kWorldUp));
    const glm::vec3 u = glm::cross(r, camera_.forward);
    const float height = camera_.orthoHalfHeight > 0
                             ? 2 * camera_.orthoHalfHeight
                             : 2 * pivotDistance_ * std::tan(camera_.yfovRad * 0.5f);
    camera_.position -= (r * right + u * up) * height;
}

void CameraController::dolly(float steps) {
    const float distance = std::max(pivotDistance_ * std::pow(0.9f, steps), kNearestPivot);
    camera_.position += camera_.forward * (pivotDistance_ - distance);
    camera_.orthoHalfHeight *= distance / pivotDistance_;
    pivotDistance_ = distance;
}

void CameraController::fly(glm::vec3 step) {
    const glm::vec3 r = glm::normalize(glm::cross(camera_.forward, kWorldUp));
    camera_.position += r * step.x + kWorldUp * step.y + camera_.forward * step.z;
}

void CameraController::scaleFlySpeed(float factor) {
    flySpeed_ = std::clamp(flySpeed_ * factor, 0.001f, 3.0f);
}

}  // namespace mv
