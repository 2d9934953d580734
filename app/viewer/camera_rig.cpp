#include "app/viewer/camera_rig.h"

#include "app/common/state.h"
#include "megaviews/core/error.h"

namespace mv {

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

void CameraRig::reset(Settings& settings, double timeS) { place(settings, settings, timeS, true); }

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
                       int pictureHeight) {
    if (input_.update(controller_, seconds, pictureHeight)) leaveNamed(settings);
    takeSettings(settings, timeS);
    if (following_ && timeMoved && assets_->scene.animated()) reset(settings, timeS);
}

void CameraRig::frameScene(Settings& settings) {
    if (assets_->scene.empty()) return;
    const auto [low, high] = assets_->bounds();
    controller_.frame(low, high);
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
