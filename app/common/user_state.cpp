#include "app/common/user_state.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/common/output_names.h"
#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"
#include "megaviews/core/strict_json.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchema = 1;
constexpr int kFarthestPixel = 65536;
constexpr double kSmallestScale = 0.25, kLargestScale = 8;

[[noreturn]] void refuse(const std::string& reason) { throw Error(ExitCode::input, reason); }

// ---------------------------------------------------------------- writing

Json toJson(const Bookmark& bookmark) {
    Json out = {{"position", bookmark.position}, {"target", bookmark.target}, {"up", bookmark.up}};
    if (bookmark.fovDeg) out["fov"] = *bookmark.fovDeg;
    return out;
}

Json toJson(const UserState& state) {
    Json bookmarks = Json::array();
    for (const SceneBookmarks& scene : state.bookmarks) {
        Json cameras = Json::object();
        for (std::size_t i = 0; i < kBookmarks; ++i) {
            if (scene.cameras[i]) cameras[std::to_string(i + 1)] = toJson(*scene.cameras[i]);
        }
        if (cameras.empty()) continue;
        bookmarks.push_back({{"scene", scene.scene},
                             {"sceneHash", scene.sceneHash},
                             {"cameras", std::move(cameras)}});
    }
    Json out = {{"schema", kSchema}, {"recent", state.recent}, {"bookmarks", bookmarks}};
    if (state.window) {
        const WindowPlace& w = *state.window;
        out["window"] = {{"x", w.x}, {"y", w.y}, {"width", w.width}, {"height", w.height}};
    }
    if (state.uiScale) out["uiScale"] = *state.uiScale;
    out["panel"] = state.panel;
    return out;
}

// ---------------------------------------------------------------- reading

using Value = nlohmann::json;

void require(bool right, const std::string& key, const Value& value, const char* kind) {
    if (!right) refuse(key + ": " + value.dump() + " is not " + kind);
}

const Value& member(const Value& object, const std::string& of, const std::string& key) {
    require(object.is_object(), of, object, "an object");
    if (!object.contains(key)) refuse(of + ": '" + key + "' is missing");
    return object.at(key);
}

double number(const Value& value, const std::string& key, double low, double high) {
    require(value.is_number(), key, value, "a number");
    const double number = value.get<double>();
    if (!(number >= low && number <= high)) refuse(key + ": " + value.dump() + " is out of range");
    return number;
}

std::string text(const Value& value, const std::string& key) {
    require(value.is_string(), key, value, "a text");
    return value.get<std::string>();
}

std::array<double, 3> vector(const Value& bookmark, const std::string& of, const std::string& key) {
    const Value& value = member(bookmark, of, key);
    require(value.is_array() && value.size() == 3, key, value, "three numbers");
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = number(value[i], key, -1e18, 1e18);
    return out;
}

Bookmark bookmarkFrom(const Value& json, const std::string& of) {
    Bookmark bookmark{vector(json, of, "position"), vector(json, of, "target"),
                      vector(json, of, "up"), std::nullopt};
    if (json.contains("fov")) bookmark.fovDeg = number(json.at("fov"), "fov", 1, 179);
    // What no camera can be made of would come back as an error when it is recalled.
    Settings settings;
    useBookmark(settings, bookmark);
    validate(settings);
    return bookmark;
}

SceneBookmarks bookmarksFrom(const Value& entry) {
    SceneBookmarks scene;
    scene.scene = text(member(entry, "bookmarks", "scene"), "scene");
    for (const char* key : {"sceneSha256", "sceneHash"}) {
        if (entry.contains(key)) scene.sceneHash = text(entry.at(key), key);
    }
    const Value& cameras = member(entry, "bookmarks", "cameras");
    require(cameras.is_object(), "cameras", cameras, "an object");
    for (std::size_t i = 0; i < kBookmarks; ++i) {
        const std::string key = std::to_string(i + 1);
        if (cameras.contains(key)) scene.cameras[i] = bookmarkFrom(cameras.at(key), key);
    }
    return scene;
}

WindowPlace windowFrom(const Value& json) {
    const auto whole = [&](const char* key, int low) {
        return static_cast<int>(number(member(json, "window", key), key, low, kFarthestPixel));
    };
    return {whole("x", -kFarthestPixel), whole("y", -kFarthestPixel), whole("width", 1),
            whole("height", 1)};
}

UserState stateFrom(const Value& json) {
    const Value& schema = member(json, "the file", "schema");
    if (schema != kSchema) refuse("schema " + schema.dump() + " is not known");
    UserState state;
    for (const auto& [key, value] : json.items()) {
        if (key == "recent") {
            require(value.is_array(), key, value, "a list of files");
            for (const Value& file : value) state.recent.push_back(text(file, key));
        } else if (key == "bookmarks") {
            require(value.is_array(), key, value, "a list");
            for (const Value& entry : value) state.bookmarks.push_back(bookmarksFrom(entry));
        } else if (key == "window") {
            state.window = windowFrom(value);
        } else if (key == "uiScale") {
            state.uiScale = number(value, key, kSmallestScale, kLargestScale);
        } else if (key == "panel") {
            state.panel = text(value, key);
        }
    }
    std::erase(state.recent, std::string());
    if (state.recent.size() > kRecentFiles) state.recent.resize(kRecentFiles);
    return state;
}

// `broken` if there is a file that cannot be understood.
UserState load(const std::string& file, bool& broken) {
    broken = false;
    std::error_code error;
    if (file.empty() || !fs::exists(file, error)) return {};
    broken = true;
    try {
        const std::string text = readTextFile(file, ExitCode::input);
        UserState state = stateFrom(parseStrictJson(text, "the file", ExitCode::input));
        broken = false;
        return state;
    } catch (const Error& reason) {
        spdlog::warn("{} is ignored: {}", file, reason.what());
    }
    return {};
}

}  // namespace

Bookmark bookmarkOf(const Settings& withCamera) {
    const CameraSettings& camera = withCamera.camera;
    return {camera.position.value_or(Vector3{}), camera.target.value_or(Vector3{}), camera.up,
            camera.fovDeg};
}

void useBookmark(Settings& settings, const Bookmark& bookmark) {
    settings.camera.position = bookmark.position;
    settings.camera.target = bookmark.target;
    settings.camera.up = bookmark.up;
    settings.camera.fovDeg = bookmark.fovDeg;
}

void UserState::noteRecent(const std::string& file) {
    const std::string name = absoluteName(file);
    if (name.empty()) return;
    std::erase(recent, name);
    recent.insert(recent.begin(), name);
    if (recent.size() > kRecentFiles) recent.resize(kRecentFiles);
}

const SceneBookmarks* UserState::bookmarksOf(const std::string& scene,
                                             const std::string& hash) const {
    const std::string name = absoluteName(scene);
    auto it = std::find_if(bookmarks.begin(), bookmarks.end(),
                           [&](const SceneBookmarks& b) { return b.scene == name; });
    if (it == bookmarks.end() && !hash.empty()) {
        it = std::find_if(bookmarks.begin(), bookmarks.end(),
                          [&](const SceneBookmarks& b) { return b.sceneHash == hash; });
    }
    return it == bookmarks.end() ? nullptr : &*it;
}

SceneBookmarks& UserState::bookmarksFor(const std::string& scene, const std::string& hash) {
    SceneBookmarks entry;
    if (const SceneBookmarks* kept = bookmarksOf(scene, hash)) {
        entry = *kept;
        bookmarks.erase(bookmarks.begin() + (kept - bookmarks.data()));
    }
    entry.scene = absoluteName(scene);
    entry.sceneHash = hash;
    bookmarks.insert(bookmarks.begin(), std::move(entry));
    if (bookmarks.size() > kBookmarkedScenes) bookmarks.resize(kBookmarkedScenes);
    return bookmarks.front();
}

bool isThere(const std::string& recent) {
    std::error_code unreadable;
    return recent.starts_with("builtin:") || fs::is_regular_file(recent, unreadable);
}

std::string userStateFile() {
    // XDG Base Directory: a relative path is invalid and has to be ignored.
    const auto folder = [](const char* name) -> std::string {
        const char* value = std::getenv(name);
        return value && *value == '/' ? value : "";
    };
    std::string root = folder("XDG_STATE_HOME");
    if (root.empty()) {
        const std::string home = folder("HOME");
        if (home.empty()) return {};
        root = home + "/.local/state";
    }
    return root + "/megaviews/viewer.json";
}

UserState loadUserState(const std::string& file) {
    bool broken = false;
    return load(file, broken);
}

void updateUserState(const std::string& file, const std::function<void(UserState&)>& change) {
    if (file.empty()) return;
    bool broken = false;
    const UserState before = load(file, broken);
    UserState after = before;
    change(after);
    if (after == before && !broken) return;
    try {
        std::error_code error;
        fs::create_directories(fs::path(file).parent_path(), error);
        if (broken) fs::rename(file, file + ".broken", error);
        OutputFile out(file);
        out.write(toJson(after).dump(2, ' ', true, Json::error_handler_t::replace) + "\n");
        out.commit();
    } catch (const Error& reason) {
        spdlog::warn("what the window remembers is not kept: {}", reason.what());
    }
}

}  // namespace mv
