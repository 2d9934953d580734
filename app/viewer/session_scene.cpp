// Session: scenes, cameras and saved states.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/image_io.h"
#include "app/viewer/session.h"
#include "megaviews/io/ply.h"
#include "megaviews/settings/light_placement.h"
#include "megaviews/settings/settings_table.h"
#include "ui/format.h"

namespace mv {
namespace {

constexpr double kParticlesLoopS = 60;
constexpr float kHandleLength = 0.08f;  // of a light's direction, root-cube units

}  // namespace

void Session::startLoading(const std::string& scene, const Settings& settings) {
    restoring_.reset();
    loader_.start(scene, settings,
                  options_.useCache ? defaultCacheDirectory() : std::filesystem::path());
}

// Octree depth, animation and a file of views belong to the load: another one is another load of
// the same scene, in the background, once the mouse has let go of the setting.
void Session::reloadWhereNeeded() {
    if (!assets_ || loader_.loading() || imgui_.editing()) return;
    if (settings_.scene.octreeDepth == loaded_.scene.octreeDepth &&
        settings_.scene.animation == loaded_.scene.animation &&
        settings_.views.file == loaded_.views.file) {
        return;
    }
    startLoading(scene_, settings_);
}

void Session::keepLoaded() {
    if (!assets_) return;
    settings_.scene.octreeDepth = loaded_.scene.octreeDepth;
    settings_.scene.animation = loaded_.scene.animation;
    settings_.views.file = loaded_.views.file;
}

void Session::finishLoading() {
    const SceneLoader::Status status = loader_.status();
    model_.loadingStage = status.stage;
    model_.loadingFraction = status.fraction;
    try {
        if (auto assets = loader_.take()) takeScene(std::move(assets));
    } catch (const Error& error) {
        restoring_.reset();
        fail(error, assets_ ? "The scene on screen was kept." : "Open another scene.");
        keepLoaded();
    }
    if (!loader_.loading()) model_.loadingStage.clear();
}

void Session::cancelLoading() {
    loader_.cancel();
    restoring_.reset();
    keepLoaded();
}

// The old scene goes only when the new one stands on the GPU.
void Session::takeScene(std::unique_ptr<SceneAssets> assets) {
    const std::string& viewsFile = loader_.settings().views.file;
    std::optional<ViewSet> views;
    if (!viewsFile.empty()) {
        std::vector<std::string> warnings;
        views = loadViews(viewsFile, assets->scene.root, &warnings);
        for (const std::string& warning : warnings) spdlog::warn("{}", warning);
    }
    try {
        renderer_.setScene(assets->scene, assets->bvh, assets->hierarchy);
        renderer_.setViews(std::move(views));
    } catch (const Error&) {
        if (assets_) renderer_.setScene(assets_->scene, assets_->bvh, assets_->hierarchy);
        throw;
    }
    const bool sameScene = assets_ && scene_ == loader_.scene() && !restoring_;
    assets_ = std::move(assets);
    measuring_.setScene(assets_);
    scene_ = loader_.scene();
    loaded_ = loader_.settings();
    shown_ = false;
    instruments_.setScene(*assets_);
    interface_.forgetFrames();
    if (restoring_) {
        warnIfChanged(restoring_->sceneHash, assets_->scene);
        settings_ = noted_ = restoring_->settings;
        model_.playing = restoring_->playing;
        model_.speed = restoring_->speed;
        restoring_.reset();
    }
    describeScene();
    const auto noteRecent = [&](UserState& state) { state.noteRecent(scene_); };
    noteRecent(userState_);
    updateUserState(userStateFile_, noteRecent);
    showUserState();
    if (!sameScene) {
        undo_.clear();
        redo_.clear();
        startS_ = settings_.scene.timeS;
        setTime(startS_);
        resetCamera();
    }
}

// ---- states

// Opening a scene keeps what is about methods and pictures, and forgets what was about the scene.
void Session::openFile(const std::string& file) {
    try {
        if (isStateFile(file)) {
            restore(loadState(file, readPictureState));
            return;
        }
        State state;
        state.scene = file;
        state.settings = settings_;
        copySceneChoices(state.settings, {});
        state.settings.scene.lights.clear();
        state.settings.display.exposureEv.reset();
        state.settings.inspect.pickA.reset();
        state.settings.inspect.pickB.reset();
        state.settings.inspect.stepScene = state.settings.inspect.stepView = 0;
        state.playing = model_.playing;
        state.speed = model_.speed;
        restore(state);
    } catch (const Error& error) {
        fail(error, "The scene on screen was kept.");
    }
}

void Session::restore(const State& state) {
    startLoading(state.scene, state.settings);
    restoring_ = state;
}

State Session::state() const {
    State state;
    state.scene = scene_;
    state.settings = settings_;
    if (assets_) {
        state.sceneHash = assets_->scene.hash;
        state.settings = withCamera(settings_, controller_.camera(), assets_->scene.root);
    }
    state.settings.picture.width = view_.width;
    state.settings.picture.height = view_.height;
    state.settings.scene.timeS = timeS_;
    if (!state.settings.display.exposureEv)
        state.settings.display.exposureEv = statistics_.exposureEv;
    state.playing = model_.playing;
    state.speed = model_.speed;
    return state;
}

void Session::saveState(const std::string& file) const { mv::saveState(file, state()); }

void Session::describeScene() {
    const Scene& scene = assets_->scene;
    animation_ = assets_->animation;
    model_.sceneName = scene.name;
    model_.sceneSummary = ui::withThousands(scene.triangles.size()) + " triangles, " +
                          ui::withThousands(assets_->hierarchy.leafCount()) + " octree leaves";
    model_.cameras.clear();
    for (const Camera& camera : scene.cameras) model_.cameras.push_back(camera.name);
    model_.animations.clear();
    for (const Animation& animation : scene.animations) {
        model_.animations.push_back(animation.name);
    }
    model_.geometryStands = scene.geometryAnimated;
    model_.warnings = scene.warnings;
    host_.setTitle(scene.name + " - MegaViews");
}

// Particles follow closed paths of their own.
double Session::animationLengthS() const {
    const auto& animations = assets_->scene.animations;
    const double length =
        animation_ >= 0 ? animations[static_cast<std::size_t>(animation_)].duration : 0;
    return settings_.views.particles > 0 ? std::max(length, kParticlesLoopS) : length;
}

// ---- lights

void Session::describeLights() {
    // Closed, the panel only says how many there are.
    if (!model_.lightsOpen && model_.lights.size() == assets_->scene.lights.size()) return;
    const auto placements = parseLightPlacements(settings_.scene.lights, "lights");
    model_.lights.clear();
    for (const PosedLight& posed : assets_->scene.lightsAt(timeS_, animation_)) {
        ui::LightRow row;
        row.name = posed.light.name;
        row.kind = posed.light.type == LightType::point  ? "point"
                   : posed.light.type == LightType::spot ? "spot"
                                                         : "directional";
        row.hasPosition = posed.light.type != LightType::directional;
        row.hasDirection = posed.light.type != LightType::point;
        row.position = {posed.position.x, posed.position.y, posed.position.z};
        row.direction = {posed.direction.x, posed.direction.y, posed.direction.z};
        for (const LightPlacement& placement : placements) {
            if (placement.light != static_cast<int>(model_.lights.size())) continue;
            row.edited = true;
            if (placement.position) row.position = *placement.position;
            if (placement.direction) row.direction = *placement.direction;
        }
        if (model_.lightsOpen) placeHandles(row);
        model_.lights.push_back(std::move(row));
    }
}

// Where a light's handles are in the window. A light without a position has them where the camera
// looks at.
void Session::placeHandles(ui::LightRow& row) const {
    const auto [position, tip] = handlesOf(row);
    row.place = windowPosition(position);
    if (row.hasDirection) row.tip = windowPosition(tip);
}

std::pair<glm::vec3, glm::vec3> Session::handlesOf(const ui::LightRow& row) const {
    const RootCube& root = assets_->scene.root;
    const FrameCamera& camera = controller_.camera();
    const glm::vec3 place =
        row.hasPosition ? root.rootFromWorld({row.position[0], row.position[1], row.position[2]})
                        : camera.position + camera.forward * controller_.pivotDistance();
    const glm::dvec3 direction(row.direction[0], row.direction[1], row.direction[2]);
    return {place, place + kHandleLength * glm::vec3(direction)};
}

std::optional<std::array<float, 2>> Session::windowPosition(glm::vec3 point) const {
    const auto width = static_cast<float>(view_.width), height = static_cast<float>(view_.height);
    const glm::vec4 clip =
        controller_.camera().clipFromWorld(width / height) * glm::vec4(point, 1.0f);
    if (!(clip.w > 0)) return std::nullopt;
    const float x = 0.5f + 0.5f * clip.x / clip.w, y = 0.5f - 0.5f * clip.y / clip.w;
    if (x < 0 || x > 1 || y < 0 || y > 1) return std::nullopt;
    return std::array<float, 2>{static_cast<float>(view_.x) + x * width,
                                static_cast<float>(view_.y) + y * height};
}

// A handle that is dragged stays at its distance from the camera.
void Session::drag(const ui::LightDrag& drag) {
    if (!assets_ || drag.light >= model_.lights.size()) return;
    const ui::LightRow& row = model_.lights[drag.light];
    const auto [place, tip] = handlesOf(row);
    const FrameCamera& camera = controller_.camera();
    const PickRay ray =
        rayThrough(camera, view_.width, view_.height, drag.x - static_cast<float>(view_.x),
                   static_cast<float>(view_.y + view_.height) - drag.y, 1);
    const glm::vec3 grabbed = drag.tip ? tip : place;
    const float depth = glm::dot(grabbed - ray.origin, camera.forward);
    const glm::vec3 target =
        ray.origin + ray.direction * (depth / glm::dot(ray.direction, camera.forward));
    ui::LightEdit edit;
    edit.light = drag.light;
    if (drag.tip) {
        const glm::dvec3 d(target - place);
        if (!(glm::length(d) > 0)) return;
        const glm::dvec3 unit = glm::normalize(d);
        edit.direction = {unit.x, unit.y, unit.z};
    } else {
        const glm::dvec3 world = assets_->scene.root.worldFromRoot(target);
        edit.position = {world.x, world.y, world.z};
    }
    this->place(edit);
}

void Session::place(const ui::LightEdit& edit) {
    auto placements = parseLightPlacements(settings_.scene.lights, "lights");
    const int light = static_cast<int>(edit.light);
    auto found = std::find_if(placements.begin(), placements.end(),
                              [&](const LightPlacement& p) { return p.light == light; });
    if (edit.reset) {
        if (found != placements.end()) placements.erase(found);
    } else {
        if (found == placements.end()) {
            found = placements.insert(placements.end(), {light, std::nullopt, std::nullopt});
        }
        if (edit.position) found->position = edit.position;
        if (edit.direction && *edit.direction != std::array<double, 3>{0, 0, 0}) {
            found->direction = edit.direction;
        }
        if (!found->position && !found->direction) placements.erase(found);
    }
    settings_.scene.lights = toText(placements);
}

// ---- camera

// From the settings whole: the scene's camera, and what is put in its place.
void Session::resetCamera() {
    try {
        const FrameCamera camera = chosenCamera(settings_, *assets_, timeS_);
        controller_.set(camera, pivotInFront(camera));
        following_ = true;
    } catch (const Error& error) {
        settings_.scene.camera = cameraOf_.scene.camera;
        fail(error);
    }
    cameraOf_ = settings_;
}

// A camera chosen by name is taken as it is; of the others only what was changed.
void Session::takeCameraSettings() {
    Settings before = settings_;
    before.scene.camera = cameraOf_.scene.camera;
    if (before == settings_) return;
    const bool named = settings_.scene.camera.name != cameraOf_.scene.camera.name;
    if (named) {
        const std::string name = settings_.scene.camera.name;
        settings_.scene.camera = {};
        settings_.scene.camera.name = name;
        resetCamera();
        return;
    }
    try {
        Settings there = withCamera(settings_, controller_.camera(), assets_->scene.root);
        const CameraSettings &now = settings_.scene.camera, &last = cameraOf_.scene.camera;
        const auto take = [&](auto member) {
            if (now.*member != last.*member) there.scene.camera.*member = now.*member;
        };
        take(&CameraSettings::position);
        take(&CameraSettings::target);
        take(&CameraSettings::up);
        take(&CameraSettings::fovDeg);
        const FrameCamera camera = chosenCamera(there, *assets_, timeS_);
        controller_.set(camera, pivotInFront(camera));
        following_ = false;
    } catch (const Error& error) {
        settings_.scene.camera = cameraOf_.scene.camera;
        fail(error);
    }
    cameraOf_ = settings_;
}

// The orbit's centre: what the middle of the picture shows.
float Session::pivotInFront(const FrameCamera& camera) const {
    const auto hit = assets_->bvh.intersect(camera.position, camera.forward, 0, 2);
    return hit ? hit->t : 0.3f;
}

void Session::storeBookmark(int index) {
    if (!assets_) return;
    const Bookmark bookmark =
        bookmarkOf(withCamera(settings_, controller_.camera(), assets_->scene.root));
    const auto store = [&](UserState& state) {
        state.bookmarksFor(scene_, assets_->scene.hash)
            .cameras.at(static_cast<std::size_t>(index)) = bookmark;
    };
    store(userState_);
    updateUserState(userStateFile_, store);
    showUserState();
    toast(fmt::format("camera remembered under {}", index + 1));
}

void Session::recallBookmark(int index) {
    const SceneBookmarks* bookmarks =
        assets_ ? userState_.bookmarksOf(scene_, assets_->scene.hash) : nullptr;
    if (!bookmarks || !bookmarks->cameras.at(static_cast<std::size_t>(index))) return;
    Settings there = settings_;
    there.scene.camera.name.clear();
    useBookmark(there, *bookmarks->cameras.at(static_cast<std::size_t>(index)));
    const FrameCamera camera = chosenCamera(there, *assets_, timeS_);
    controller_.set(camera, pivotInFront(camera));
    leaveNamedCamera();
}

// Recent files and this scene's bookmarks, as the panels show them.
void Session::showUserState() {
    model_.recent.clear();
    for (const std::string& file : userState_.recent) {
        model_.recent.push_back({file, isThere(file)});
    }
    const SceneBookmarks* bookmarks =
        assets_ ? userState_.bookmarksOf(scene_, assets_->scene.hash) : nullptr;
    for (std::size_t i = 0; i < model_.bookmarks.size(); ++i) {
        model_.bookmarks[i] = bookmarks && bookmarks->cameras[i].has_value();
    }
}

void Session::leaveNamedCamera() {
    settings_.scene.camera.name.clear();
    cameraOf_.scene.camera.name.clear();
    following_ = false;
}

void Session::chooseCamera(int step) {
    if (!assets_ || model_.cameras.empty()) return;
    const int count = static_cast<int>(model_.cameras.size());
    cameraIndex_ = ((cameraIndex_ + step) % count + count) % count;
    settings_.scene.camera.name = std::to_string(cameraIndex_);
}

}  // namespace mv
