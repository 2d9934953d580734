#include "app/common/scene_report.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "app/common/run_statistics.h"
#include "megaviews/measure/metrics.h"
#include "megaviews/scene/rigged_scene.h"
#include "megaviews/settings/actions.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

Json vectorJson(glm::dvec3 v) { return Json::array({v.x, v.y, v.z}); }

std::string nameOrNumber(const std::string& name, std::size_t index) {
    return name.empty() ? std::to_string(index) : name;
}

std::size_t movingTriangles(const Scene& scene) {
    return scene.moving ? scene.triangles.size() - scene.moving->triangle : 0;
}

Json describe(const SceneAssets& assets, const Settings& settings) {
    const Scene& scene = assets.scene;
    const auto [low, high] = assets.bounds();
    std::size_t emissive = 0, masked = 0;
    for (const Material& material : scene.materials) {
        emissive += material.emits();
        masked += material.rayCutoff() > 0;
    }
    Json cameras = Json::array(), lights = Json::array(), animations = Json::array();
    for (const PosedCamera& camera : scene.camerasAt(settings.scene.timeS, assets.animation)) {
        cameras.push_back({{"name", nameOrNumber(camera.camera.name, cameras.size())},
                           {"position", vectorJson(camera.position)},
                           {"forward", vectorJson(camera.forward)},
                           {"isDefault", camera.camera.isDefault}});
    }
    for (const PosedLight& light : scene.lightsAt(settings.scene.timeS, assets.animation)) {
        lights.push_back({{"name", nameOrNumber(light.light.name, lights.size())},
                          {"type", lightTypeName(light.light.type)},
                          {"position", vectorJson(light.position)},
                          {"isDefault", light.light.isDefault}});
    }
    for (const Animation& animation : scene.animations) {
        animations.push_back({{"name", nameOrNumber(animation.name, animations.size())},
                              {"duration", animation.duration},
                              {"channels", animation.channels.size()}});
    }
    return {{"name", scene.name},
            {"hash", scene.hash},
            {"triangles", scene.triangles.size()},
            {"vertices", scene.positions.size()},
            {"materials",
             {{"count", scene.materials.size()}, {"emissive", emissive}, {"masked", masked}}},
            {"textures", scene.textures.size()},
            {"images", scene.images.size()},
            {"bounds",
             {{"min", vectorJson(scene.root.worldFromRoot(low))},
              {"max", vectorJson(scene.root.worldFromRoot(high))}}},
            {"cameras", cameras},
            {"lights", lights},
            {"animations", animations},
            {"animated", scene.animated() || scene.moving != nullptr},
            {"movingTriangles", movingTriangles(scene)},
            {"fileScenes", scene.fileScenes},
            {"variants", scene.variants},
            {"extensions", scene.extensions},
            {"ignored", scene.ignored},
            {"notes", scene.notes},
            {"warnings", scene.warnings}};
}

}  // namespace

const char* lightTypeName(LightType type) {
    switch (type) {
        case LightType::point:
            return "point";
        case LightType::spot:
            return "spot";
        case LightType::directional:
            return "directional";
    }
    return "";
}

std::string infoJson(const SceneAssets& assets, const Settings& settings) {
    const Json out = {{"schema", kStatisticsSchema},
                      {"program", programJson()},
                      {"scene", describe(assets, settings)},
                      {"settings", toJson(settings)}};
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string infoText(const SceneAssets& assets, const Settings& settings) {
    const Scene& scene = assets.scene;
    const Json d = describe(assets, settings);
    std::ostringstream out;
    out.exceptions(std::ios::badbit);  // or a lack of memory would end the text silently
    out << "scene       " << scene.name << "\n"
        << "hash        " << scene.hash << "\n"
        << "triangles   " << scene.triangles.size()
        << (scene.moving ? ", of which " + std::to_string(movingTriangles(scene)) + " move" : "")
        << "\n"
        << "vertices    " << scene.positions.size() << "\n"
        << "materials   " << d["materials"]["count"] << " (" << d["materials"]["emissive"]
        << " emissive, " << d["materials"]["masked"] << " masked)\n"
        << "textures    " << scene.textures.size() << " of " << scene.images.size() << " images\n"
        << "bounds      " << d["bounds"]["min"].dump() << " to " << d["bounds"]["max"].dump()
        << "\n";
    for (const auto& [title, key] :
         {std::pair{"camera      ", "cameras"}, std::pair{"light       ", "lights"},
          std::pair{"animation   ", "animations"}}) {
        for (const Json& entry : d[key]) {
            out << title << entry["name"].get<std::string>();
            if (entry.contains("type")) out << ", " << entry["type"].get<std::string>();
            if (entry.contains("position")) out << " at " << entry["position"].dump();
            if (entry.contains("duration")) out << ", " << entry["duration"].dump() << " s";
            out << (entry.value("isDefault", false) ? " (placed by default)\n" : "\n");
        }
    }
    for (std::size_t i = 0; i < scene.fileScenes.size(); ++i) {
        out << "file scene  " << i << ", " << scene.fileScenes[i] << "\n";
    }
    for (std::size_t i = 0; i < scene.variants.size(); ++i) {
        out << "variant     " << i << ", " << scene.variants[i] << "\n";
    }
    for (const std::string& name : scene.extensions) out << "extension   " << name << "\n";
    for (const std::string& name : scene.ignored) out << "not used    " << name << "\n";
    for (const std::string& note : scene.notes) out << "note        " << note << "\n";
    for (const std::string& warning : scene.warnings) out << "warning     " << warning << "\n";
    out << "\nsettings\n";
    for (const SettingInfo& setting : settingsTable()) {
        std::string key(setting.key);
        key.resize(18, ' ');
        out << "  " << key << toText(settings, setting)
            << (hasDefault(settings, setting) ? "" : "  *") << "\n";
    }
    out << "  * not the default\n";
    return out.str();
}

std::string listText(const std::string& kind, const SceneAssets* assets) {
    std::string out;
    if (kind == "methods" || kind == "views") {
        const SettingInfo& setting = *findSetting(kind == "methods" ? "method" : "view");
        for (const std::string_view name : std::get<ChoiceField>(setting.field).names) {
            out.append(name).append("\n");
        }
        return out;
    }
    if (kind == "presets") {
        for (const PresetInfo& preset : presetsTable()) out.append(preset.name).append("\n");
        return out;
    }
    if (kind == "actions") {
        for (const ActionInfo& action : actionsTable()) out.append(idOf(action)).append("\n");
        return out;
    }
    if (kind == "metrics") {
        for (const MetricInfo& info : metricsTable()) out.append(info.name).append("\n");
        return out;
    }
    const Scene& scene = assets->scene;
    if (kind == "cameras") {
        for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
            out.append(nameOrNumber(scene.cameras[i].name, i)).append("\n");
        }
    } else {
        for (std::size_t i = 0; i < scene.animations.size(); ++i) {
            out.append(nameOrNumber(scene.animations[i].name, i)).append("\n");
        }
    }
    return out;
}

}  // namespace mv
