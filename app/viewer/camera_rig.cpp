#include "app/viewer/camera_rig.h"

#include "app/common/state.h"
#include "megaviews/core/error.h"
#include "megaviews/scene/load_scene.h"

namespace mv {
namespace {

constexpr float kFromWalls = 0.002f;     // root-cube units that hands keep the camera from surfaces
constexpr float kSurrounded = 0.6f;      // share of all directions in which a room has walls
constexpr float kInSight = 0.2f;         // of what the scene's own camera shows of it
constexpr float kSmallestShare = 0.01f;  // of a movement that is cut short
constexpr float kFar = 100;              // root-cube units, as far as anybody goes

}  // namespace

void CameraRig::setScene(std::shared_ptr<const SceneAssets> assets) {
    assets_ = std::move(assets);
    bounds_ = assets_->bounds();
    index_ = 0;
}

// A room: in the bounds, with walls to see in most directions; a roof may be open. The back of a
// wall counts against it: who sees one has slipped out.
CameraRig::Place CameraRig::placeAt(glm::vec3 position) const {
    const auto& [low, high] = bounds_;
    Place place;
    place.clearance = kFar;
    int walls = 0, directions = 0;
    for (int i = 0; i < 27; ++i) {
        if (i == 13) continue;
        const glm::vec3 to = glm::normalize(glm::vec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        ++directions;
        const auto hit = assets_->bvh.intersect(position, to, 0, kFar);
        if (!hit) continue;
        place.clearance = std::min(place.clearance, hit->t);
        walls += assets_->bvh.isBack(*hit, to) ? -1 : 1;
    }
    place.inRoom = glm::all(glm::greaterThanEqual(position, low)) &&
                   glm::all(glm::lessThanEqual(position, high)) &&
                   static_cast<float>(walls) >= kSurrounded * static_cast<float>(directions);
    return place;
}

// How much of a picture shows the scene, of the largest square in its middle: windows are wider
// than high.
float CameraRig::shareInSight(const FrameCamera& camera) const {
    constexpr int kRays = 12;  // across
    int seen = 0;
    for (int i = 0; i < kRays * kRays; ++i) {
        const PickRay ray = rayThrough(camera, kRays, kRays, static_cast<float>(i % kRays) + 0.5f,
                                       static_cast<float>(i / kRays) + 0.5f, 0);
        float behind = 0;
        while (const auto hit = assets_->bvh.intersect(ray.origin, ray.direction, behind, kFar)) {
            if (!assets_->bvh.isBack(*hit, ray.direction)) {
                ++seen;
                break;
            }
            behind = hit->t;
        }
    }
    return static_cast<float>(seen) / (kRays * kRays);
}

bool CameraRig::isOutside() const { return startsInRoom_ && !placeAt(camera().position).inRoom; }

bool CameraRig::isClear(glm::vec3 from, glm::vec3 to) const {
    const float distance = glm::length(to - from);
    return distance == 0 || !assets_->bvh.intersect(from, (to - from) / distance, 0, distance);
}

// The one rule for hands: through no surface nor close to one, not out of the rooms that the scene
// began in, and never with less than a fifth in sight of what the scene's camera shows. What is not
// so already, because the camera flew or was put there, may not become worse. Of a movement that
// breaks the rule half is tried, a quarter and so on.
void CameraRig::move(const std::function<void(CameraController&, float share)>& change) {
    const CameraController before = controller_;
    const glm::vec3 stood = before.camera().position;
    const Place left = placeAt(stood);
    const float clearance = std::min(left.clearance, kFromWalls);
    const float inSight = std::min(shareInSight(before.camera()), leastInSight_);
    for (float share = 1; share > kSmallestShare; share /= 2) {
        change(controller_, share);
        const Place reached = placeAt(camera().position);
        if (isClear(stood, camera().position) && reached.clearance >= clearance &&
            (reached.inRoom || !left.inRoom || !startsInRoom_) &&
            shareInSight(camera()) >= inSight) {
            return;
        }
        controller_ = before;
    }
}

void CameraRig::place(Settings& settings, const Settings& there, double timeS, bool follow) {
    try {
        const FrameCamera camera = chosenCamera(there, *assets_, timeS);
        controller_.set(camera, pivotInFront(camera));
        following_ = follow;
    } catch (const Error&) {
        settings.camera = taken_;
        throw;
    }
    taken_ = settings.camera;
}

void CameraRig::reset(Settings& settings, double timeS) {
    place(settings, settings, timeS, true);
    startsInRoom_ = placeAt(camera().position).inRoom;
    leastInSight_ = kInSight * shareInSight(camera());
}

// A camera chosen by name is taken as it is; of the others only what was changed.
void CameraRig::takeSettings(Settings& settings, double timeS) {
    CameraSettings& asked = settings.camera;
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
        if (asked.*member != taken_.*member) there.camera.*member = asked.*member;
    };
    take(&CameraSettings::position);
    take(&CameraSettings::target);
    take(&CameraSettings::up);
    take(&CameraSettings::fovDeg);
    place(settings, there, timeS, false);
}

void CameraRig::update(Settings& settings, double timeS, bool timeMoved, double seconds,
                       int pictureHeight, bool keysFree) {
    const CameraMovement asked =
        input_.take(seconds, pictureHeight, placeAt(camera().position).inRoom, keysFree);
    controller_.scaleFlySpeed(asked.faster);
    if (asked.flies()) {
        asked.apply(controller_, 1);  // through walls too
    } else if (asked.moves()) {
        move([&](CameraController& camera, float share) { asked.apply(camera, share); });
    }
    if (asked.moves()) leaveNamed(settings);
    takeSettings(settings, timeS);
    if (following_ && timeMoved && assets_->scene.animated()) reset(settings, timeS);
}

void CameraRig::frameScene(Settings& settings) {
    if (assets_->scene.empty()) return;
    const glm::vec3 low = bounds_.first;
    const glm::vec3 high = bounds_.second;
    const glm::vec3 stood = camera().position;
    const auto frame = [&](CameraController& camera) { camera.frame(low, high); };
    if (startsInRoom_ && placeAt(stood).inRoom) {
        const glm::vec3 back = -glm::length(high - low) * camera().forward;
        move([&](CameraController& camera, float share) {
            frame(camera);
            camera.moveTo(stood + share * back);
        });
    } else {
        frame(controller_);
    }
    leaveNamed(settings);
}

void CameraRig::choose(Settings& settings, int step) {
    const int count = static_cast<int>(assets_->scene.cameras.size());
    if (count == 0) return;
    index_ = static_cast<int>(sceneCamera().value_or(static_cast<std::size_t>(index_)));
    index_ = ((index_ + step) % count + count) % count;
    settings.camera.name = std::to_string(index_);
}

std::optional<std::size_t> CameraRig::sceneCamera() const {
    CameraSettings named;
    named.name = taken_.name;
    if (!following_ || taken_ != named) return {};
    const int index = findCamera(assets_->scene, named.name);
    if (index < 0) return {};
    return static_cast<std::size_t>(index);
}

void CameraRig::recall(Settings& settings, const Bookmark& bookmark, double timeS) {
    Settings there = settings;
    there.camera.name.clear();
    useBookmark(there, bookmark);
    place(settings, there, timeS, false);
    leaveNamed(settings);
}

void CameraRig::returnTo(const FrameCamera& camera) {
    controller_.set(camera, pivotInFront(camera));
}

void CameraRig::leaveNamed(Settings& settings) {
    settings.camera.name.clear();
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
