#include "app/viewer/camera_rig.h"

#include <cmath>

#include "app/common/state.h"
#include "megaviews/core/error.h"

namespace mv {
namespace {

constexpr float kFromWalls = 0.002f;  // root-cube units that the camera keeps from what stops it
constexpr float kSurrounded = 0.6f;   // share of all directions in which a room has walls

}  // namespace

void CameraRig::setScene(std::shared_ptr<const SceneAssets> assets) {
    assets_ = std::move(assets);
    bounds_ = assets_->bounds();
}

// In the bounds, with something to see in most directions: a roof may be open.
bool CameraRig::isInRoom(glm::vec3 position) const {
    const auto& [low, high] = bounds_;
    if (glm::any(glm::lessThan(position, low)) || glm::any(glm::greaterThan(position, high))) {
        return false;
    }
    int hits = 0, directions = 0;
    for (int i = 0; i < 27; ++i) {
        const glm::vec3 to(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        if (i == 13) continue;
        ++directions;
        hits += assets_->bvh.intersect(position, glm::normalize(to), 0, 2).has_value();
    }
    return static_cast<float>(hits) >= kSurrounded * static_cast<float>(directions);
}

bool CameraRig::isOutside() const { return startsInRoom_ && !isInRoom(camera().position); }

// As far on the way as nothing stands in it.
glm::vec3 CameraRig::unobstructed(glm::vec3 from, glm::vec3 to) const {
    const float distance = glm::length(to - from);
    if (distance == 0) return to;
    const glm::vec3 direction = (to - from) / distance;
    const auto hit = assets_->bvh.intersect(from, direction, 0, distance + kFromWalls);
    return hit ? from + direction * std::max(hit->t - kFromWalls, 0.0f) : to;
}

// Through no wall, nor out of a room through its windows; false: it stays where it was.
bool CameraRig::moveWithin(glm::vec3 from, glm::vec3 to) {
    const glm::vec3 there = unobstructed(from, to);
    const bool leaves = isInRoom(from) && !isInRoom(there);
    controller_.moveTo(leaves ? from : there);
    return !leaves;
}

// Anything of the scene in the middle of the picture.
bool CameraRig::hasInSight(const FrameCamera& camera) const {
    constexpr int kRays = 7;  // across
    const float tangent = 0.6f * std::tan(camera.yfovRad / 2);
    const glm::vec3 right = glm::normalize(glm::cross(camera.forward, camera.up));
    const glm::vec3 up = glm::cross(right, camera.forward);
    for (int i = 0; i < kRays * kRays; ++i) {
        const float x = 2 * static_cast<float>(i % kRays) / (kRays - 1) - 1;
        const float y = 2 * static_cast<float>(i / kRays) / (kRays - 1) - 1;
        const glm::vec3 to = camera.forward + tangent * (x * right + y * up);
        if (assets_->bvh.intersect(camera.position, glm::normalize(to), 0, 100)) return true;
    }
    return false;
}

void CameraRig::place(Settings& settings, const Settings& there, double timeS, bool follow) {
    try {
        const FrameCamera camera = chosenCamera(there, *assets_, timeS);
        controller_.set(camera, pivotInFront(camera));
        following_ = follow;
    } catch (const Error&) {
        settings.scene.camera = taken_;
        throw;
    }
    taken_ = settings.scene.camera;
}

void CameraRig::reset(Settings& settings, double timeS) {
    place(settings, settings, timeS, true);
    startsInRoom_ = isInRoom(camera().position);
}

// A camera chosen by name is taken as it is; of the others only what was changed.
void CameraRig::takeSettings(Settings& settings, double timeS) {
    CameraSettings& asked = settings.scene.camera;
    if (asked == taken_) return;
    if (asked.name != taken_.name) {
        CameraSettings named;
        named.name = asked.name;
        asked = named;
        reset(settings, timeS);
        return;
    }
    Settings there = filledIn(settings);
    const auto take = [&](auto member) {
        if (asked.*member != taken_.*member) there.scene.camera.*member = asked.*member;
    };
    take(&CameraSettings::position);
    take(&CameraSettings::target);
    take(&CameraSettings::up);
    take(&CameraSettings::fovDeg);
    place(settings, there, timeS, false);
}

void CameraRig::update(Settings& settings, double timeS, bool timeMoved, double seconds,
                       int pictureHeight, bool keysFree) {
    const CameraController before = controller_;
    const glm::vec3 stood = before.camera().position;
    const bool inRoom = isInRoom(stood);
    const auto moved = input_.update(controller_, seconds, pictureHeight, inRoom, keysFree);
    if (moved == CameraInput::Moved::yes) {
        moveWithin(stood, camera().position);
        // From outside no drag loses the scene.
        if (!inRoom && !hasInSight(camera()) && hasInSight(before.camera())) controller_ = before;
    }
    if (moved != CameraInput::Moved::no) leaveNamed(settings);
    takeSettings(settings, timeS);
    if (following_ && timeMoved && assets_->scene.animated()) reset(settings, timeS);
}

void CameraRig::frameScene(Settings& settings) {
    if (assets_->scene.empty()) return;
    const auto& [low, high] = bounds_;
    const glm::vec3 before = camera().position;
    controller_.frame(low, high);
    if (isInRoom(before)) {
        float back = glm::length(high - low);
        while (!moveWithin(before, before - camera().forward * back) && back > kFromWalls) {
            back /= 2;
        }
    }
    leaveNamed(settings);
}

void CameraRig::choose(Settings& settings, int step) {
    const int count = static_cast<int>(assets_->scene.cameras.size());
    if (count == 0) return;
    index_ = ((index_ + step) % count + count) % count;
    settings.scene.camera.name = std::to_string(index_);
}

void CameraRig::recall(Settings& settings, const Bookmark& bookmark, double timeS) {
    Settings there = settings;
    there.scene.camera.name.clear();
    useBookmark(there, bookmark);
    place(settings, there, timeS, false);
    leaveNamed(settings);
}

void CameraRig::leaveNamed(Settings& settings) {
    settings.scene.camera.name.clear();
    taken_.name.clear();
    following_ = false;
}

Settings CameraRig::filledIn(const Settings& settings) const {
    return withCamera(settings, camera(), assets_->scene.root);
}

FrameCamera CameraRig::at(const Settings& settings, double timeS) const {
    return following_ ? chosenCamera(settings, *assets_, timeS) : camera();
}

// The orbit's centre: what the middle of the picture shows.
float CameraRig::pivotInFront(const FrameCamera& camera) const {
    const auto hit = assets_->bvh.intersect(camera.position, camera.forward, 0, 2);
    return hit ? hit->t : 0.3f;
}

}  // namespace mv
