#include "app/common/state.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/common/output_names.h"
#include "app/common/program_version.h"
#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"
#include "megaviews/core/strict_json.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kBuiltin = "builtin:";

std::array<double, 3> arrayOf(glm::dvec3 v) { return {v.x + 0.0, v.y + 0.0, v.z + 0.0}; }  // no -0

void nameImage(EnvironmentSettings& environment, const fs::path& folder) {
    if (environmentFile(environment).empty()) return;
    environment.source = absoluteName(environment.source, folder);
}

[[noreturn]] void refuse(std::string_view where, const std::string& reason) {
    throw Error(ExitCode::input, std::string(where) + ": " + reason);
}

const nlohmann::json& checked(const nlohmann::json& value, bool right, std::string_view where,
                              const std::string& key, const char* kind) {
    if (!right) refuse(where, key + ": " + value.dump() + " is not " + kind);
    return value;
}

State stateFromJson(const nlohmann::json& json, std::string_view where) {
    if (!json.is_object()) refuse(where, "not a state: it holds no JSON object");
    if (!json.contains("schema") || !json.contains("scene")) {
        refuse(where, "not a state of this program: it has no 'schema' and 'scene'");
    }
    State state;
    for (const auto& [key, value] : json.items()) {
        if (key == "schema") {
            if (value == kStateSchema) continue;
            refuse(where, "schema " + value.dump() + " is not known; this program reads " +
                              std::to_string(kStateSchema));
        } else if (key == "scene") {
            state.scene =
                checked(value, value.is_string(), where, key, "a name").get<std::string>();
            if (state.scene.empty()) refuse(where, "scene: is empty");
        } else if (key == "sceneHash" || key == "sceneSha256") {
            state.sceneHash =
                checked(value, value.is_string(), where, key, "a hash").get<std::string>();
            // An older state's SHA-256 of a file: nothing to compare it with.
            if (state.sceneHash.size() == 64) state.sceneHash.clear();
        } else if (key == "playing") {
            state.playing = checked(value, value.is_boolean(), where, key, "true or false");
        } else if (key == "speed") {
            state.speed = checked(value, value.is_number(), where, key, "a number");
            if (!(state.speed >= kSlowestPlay && state.speed <= kFastestPlay)) {
                refuse(where, "speed: " + value.dump() + " is outside 1/1024..1024");
            }
        } else if (key == "settings") {
            applyJson(state.settings, value, std::string(where) + ": settings");
        } else if (key != "program") {
            const std::vector<std::string> known = {"schema",   "program", "scene", "sceneHash",
                                                    "settings", "playing", "speed"};
            refuse(where, "unknown key '" + key + "'" + didYouMean(key, known));
        }
    }
    validate(state.settings);
    return state;
}

}  // namespace

Settings withCamera(Settings settings, const FrameCamera& camera, const RootCube& root) {
    // The target stands one root edge away: posedCamera() gets the direction back bit by bit.
    const glm::dvec3 position = root.worldFromRoot(camera.position);
    settings.camera.position = arrayOf(position);
    settings.camera.target = arrayOf(position + glm::dvec3(camera.forward) * root.edge);
    settings.camera.up = arrayOf(glm::dvec3(camera.up));
    if (!(camera.orthoHalfHeight > 0)) {
        settings.camera.fovDeg = glm::degrees(static_cast<double>(camera.yfovRad));
    }
    return settings;
}

Json toJson(const State& state) {
    Settings settings = state.settings;
    settings.views.file = absoluteName(settings.views.file, ".");
    nameImage(settings.scene.environment, ".");
    return {{"schema", kStateSchema},
            {"program", "megaviews " + programVersion()},
            {"scene", absoluteName(state.scene, ".")},
            {"sceneHash", state.sceneHash},
            {"settings", toJson(settings)},
            {"playing", state.playing},
            {"speed", state.speed}};
}

std::string toText(const State& state) {
    // ASCII, for text chunks of pictures; names need not be UTF-8.
    return toJson(state).dump(-1, ' ', true, Json::error_handler_t::replace);
}

State stateFromText(std::string_view text, std::string_view where) {
    try {
        return stateFromJson(parseStrictJson(text, where, ExitCode::input), where);
    } catch (const Error& error) {
        if (error.code == ExitCode::input) throw;
        // Whatever a setting says of its value; here it is a file that is wrong.
        const std::string what = error.what();
        throw Error(ExitCode::input,
                    what.starts_with(where) ? what : std::string(where) + ": settings: " + what);
    }
}

bool isStateFile(const std::string& file) {
    const std::string extension = extensionOf(file);
    return extension == ".json" || extension == ".png" || extension == ".exr";
}

State loadState(const std::string& file, const ReadPictureState& readPicture) {
    const std::string extension = extensionOf(file);
    std::string text;
    std::string where = file;
    if (extension == ".png" || extension == ".exr") {
        text = readPicture(file);
        where += ": state";
    } else {
        text = readTextFile(file, ExitCode::input);
    }
    State state = stateFromText(text, where);
    const fs::path folder = fs::path(file).parent_path();
    state.scene = absoluteName(state.scene, folder);
    state.settings.views.file = absoluteName(state.settings.views.file, folder);
    nameImage(state.settings.scene.environment, folder);
    return state;
}

void requireScene(const State& state, const std::string& file) {
    std::error_code unreadable;
    if (state.scene.starts_with(kBuiltin) || fs::exists(state.scene, unreadable)) return;
    refuse(file, "its scene '" + state.scene + "' is missing");
}

std::string inputHash(const Scene& scene, const std::string& viewsHash) {
    return viewsHash.empty() ? scene.hash : Hash().add(scene.hash).add(viewsHash).hex();
}

void warnIfChanged(const std::string& sceneHash, const Scene& scene, const std::string& viewsHash) {
    if (sceneHash.empty() || sceneHash == inputHash(scene, viewsHash)) return;
    spdlog::warn("{}: the scene{} changed since its state was saved", scene.name,
                 viewsHash.empty() ? " has" : " or the file of its views have");
}

void saveState(const std::string& file, const State& state) {
    OutputFile out(file);
    out.write(toJson(state).dump(2, ' ', true, Json::error_handler_t::replace) + "\n");
    out.commit();
}

}  // namespace mv
