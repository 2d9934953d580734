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

constexpr float kHandleLength = 0.08f;  // of a light's direction, root-cube units

}  // namespace

void Session::startLoading(const std::string& scene, const Settings& settings) {
    restoring_.reset();
    loader_.start(scene, settings,
                  options_.useCache ? defaultCacheDirectory() : std::filesystem::path());
}

// The octree is built for one depth: another one is another load of the same scene, in the
// background, once the mouse has let go of the setting.
void Session::rebuildForDepth() {
    if (!assets_ || loader_.loading() || imgui_.editing()) return;
    if (settings_.sceneDepth != loadedDepth_) startLoading(scene_, settings_);
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
        if (assets_) settings_.sceneDepth = loadedDepth_;
    }
    if (!loader_.loading()) model_.loadingStage.clear();
}

void Session::cancelLoading() {
    loader_.cancel();
    restoring_.reset();
    if (assets_) settings_.sceneDepth = loadedDepth_;
}

// The old scene goes only when the new one stands on the GPU.
void Session::takeScene(std::unique_ptr<SceneAssets> assets) {
    const std::string& viewsFile = loader_.settings().viewsFile;
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
    scene_ = loader_.scene();
    loadedDepth_ = loader_.settings().sceneDepth;
    shown_ = false;
    instruments_.setScene(*assets_);
    interface_.forgetFrames();
    if (restoring_) {
        warnIfChanged(restoring_->sceneSha256, assets_->scene);
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
        setTime(settings_.timeS);
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
        const Settings defaults;
        state.settings.camera.clear();
        state.settings.cameraPosition.reset();
        state.settings.cameraTarget.reset();
        state.settings.cameraUp = defaults.cameraUp;
        state.settings.fovDeg.reset();
        state.settings.animation.clear();
        state.settings.timeS = 0;
        state.settings.viewsFile.clear();
        state.settings.lights.clear();
        state.settings.exposureEv.reset();
        state.settings.pickA = state.settings.pickB = -1;
        state.settings.stepScene = state.settings.stepView = 0;
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
        state.sceneSha256 = assets_->scene.sha256;
        state.settings = withCamera(settings_, controller_.camera(), assets_->scene.root);
    }
    state.settings.width = view_.width;
    state.settings.height = view_.height;
    state.settings.timeS = timeS_;
    if (!state.settings.exposureEv) state.settings.exposureEv = statistics_.exposureEv;
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
    model_.animationS =
        animation_ >= 0 ? scene.animations[static_cast<std::size_t>(animation_)].duration : 0;
    // Particles follow closed paths of their own.
    if (settings_.particles > 0) model_.animationS = std::max(model_.animationS, 60.0);
    model_.warnings = scene.warnings;
    host_.setTitle(scene.name + " - MegaViews");
}

// ---- lights

void Session::describeLights() {
    const auto placements = parseLightPlacements(settings_.lights, "lights");
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
    auto placements = parseLightPlacements(settings_.lights, "lights");
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
    settings_.lights = toText(placements);
}

// ---- camera

void Session::resetCamera() {
    try {
        const FrameCamera camera = chosenCamera(settings_, *assets_, timeS_);
        controller_.set(camera, pivotInFront(camera));
        shownCamera_ = settings_.camera;
        following_ = true;
    } catch (const Error& error) {
        settings_.camera = shownCamera_;
        fail(error);
    }
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
        state.bookmarksFor(scene_, assets_->scene.sha256)
            .cameras.at(static_cast<std::size_t>(index)) = bookmark;
    };
    store(userState_);
    updateUserState(userStateFile_, store);
    showUserState();
    toast(fmt::format("camera remembered under {}", index + 1));
}

void Session::recallBookmark(int index) {
    const SceneBookmarks* bookmarks =
        assets_ ? userState_.bookmarksOf(scene_, assets_->scene.sha256) : nullptr;
    if (!bookmarks || !bookmarks->cameras.at(static_cast<std::size_t>(index))) return;
    Settings there = settings_;
    there.camera.clear();
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
        assets_ ? userState_.bookmarksOf(scene_, assets_->scene.sha256) : nullptr;
    for (std::size_t i = 0; i < model_.bookmarks.size(); ++i) {
        model_.bookmarks[i] = bookmarks && bookmarks->cameras[i].has_value();
    }
}

void Session::leaveNamedCamera() {
    settings_.camera.clear();
    shownCamera_.clear();
    following_ = false;
}

void Session::chooseCamera(int step) {
    if (!assets_ || model_.cameras.empty()) return;
    const int count = static_cast<int>(model_.cameras.size());
    cameraIndex_ = ((cameraIndex_ + step) % count + count) % count;
    settings_.camera = std::to_string(cameraIndex_);
}

}  // namespace mv
