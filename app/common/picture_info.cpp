#include "app/common/picture_info.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/common/program_version.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/settings/statistics_table.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

std::array<double, 3> arrayOf(glm::dvec3 v) { return {v.x, v.y, v.z}; }

// Camera to world in the file's units, column by column, as glTF writes a node's matrix.
Json cameraMatrix(const FrameCamera& camera, const RootCube& root) {
    const glm::dvec3 position = root.worldFromRoot(camera.position);
    const glm::dvec3 forward(camera.forward), up(camera.up);
    const glm::dvec3 right = glm::cross(forward, up);
    Json out = Json::array();
    for (const glm::dvec3& column : {right, up, -forward}) {
        for (const double x : arrayOf(column)) out.push_back(x);
        out.push_back(0);
    }
    for (const double x : arrayOf(position)) out.push_back(x);
    out.push_back(1);
    return out;
}

// Names come from files and command lines and need not be UTF-8.
std::string dumped(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

State stateOf(const PictureInfo& info) {
    const Scene& scene = info.assets->scene;
    Settings settings = withCamera(info.settings, info.camera, scene.root);
    settings.scene.timeS = info.timeS;
    settings.display.exposureEv = info.statistics.exposureEv;
    // The samples that the picture has so far.
    settings.picture.accumulate = std::max(info.statistics.accumulatedFrames, 1);
    settings.picture.pixelSamples =
        std::min(settings.picture.pixelSamples, settings.picture.accumulate);
    return {.scene = scene.name,
            .sceneHash = inputHash(scene, info.viewsHash),
            .settings = settings,
            .playing = info.playing,
            .speed = info.speed};
}

std::vector<std::pair<std::string, std::string>> pictureMetadata(const PictureInfo& info) {
    const Scene& scene = info.assets->scene;
    const gl::Limits& limits = gl::limits();

    const State state = stateOf(info);
    const Settings& settings = state.settings;
    const Json statistics = toJson(info.statistics);
    Json methods = Json::array();
    for (const MethodStatistics& method : info.statistics.methods) {
        Json& kept = methods.emplace_back(toJson(method));
        // These depend on earlier frames: buffers are kept, and counts decide on passes.
        for (const char* other : {"memoryBytes", "prediction", "passes", "queuePeakPairs",
                                  "occupancy", "pairsPerLevel"}) {
            kept.erase(other);
        }
    }
    const auto text = [](const auto& value) { return dumped(Json(value)); };
    std::vector<std::pair<std::string, std::string>> metadata = {
        {"megaviews.program", "megaviews " + programVersion()},
        {"megaviews.commit", programCommit()},
        {"megaviews.scene", scene.name},
        {"megaviews.sceneHash", scene.hash},
        {"megaviews.method", std::string(nameOf(settings.side[0].method))},
        {"megaviews.compare",
         std::string(settings.compare ? nameOf(settings.side[1].method) : "off")},
        {"megaviews.settings", dumped(toJson(settings))},
        {std::string(kStateKey), toText(state)},
        {"megaviews.seed", text(settings.seed)},
        {"megaviews.frame", text(info.frame)},
        {"megaviews.time", text(info.timeS)},
        {"megaviews.resolution", toText(settings, *findSetting("resolution"))},
        {"megaviews.exposure", text(info.statistics.exposureEv)},
        {"megaviews.tonemap", std::string(nameOf(settings.display.toneMap))},
        {"megaviews.pixelSamples", text(settings.averagesPixels() ? settings.setsWanted() : 1)},
        {"megaviews.cameraMatrix", dumped(cameraMatrix(info.camera, scene.root))},
        {"megaviews.fov", text(glm::degrees(static_cast<double>(info.camera.yfovRad)))},
        {"megaviews.gl", limits.vendor + " | " + limits.renderer + " | " + limits.version},
        {"megaviews.views", dumped(statistics.at("views"))},
        {"megaviews.methods", dumped(methods)},
    };
    if (info.measured) {
        metadata.emplace_back("megaviews.reference", info.measured->reference);
        metadata.emplace_back("megaviews.metrics", dumped(toJson(*info.measured)));
    }
    return metadata;
}

}  // namespace mv
