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

double number(const nlohmann::json& json, double low, double high) {
    const double value = json.get<double>();
    if (!(value >= low && value <= high)) refuse(json.dump() + " is out of range");
    return value;
}

int whole(const nlohmann::json& json, int low, int high) {
    return static_cast<int>(number(json, low, high));
}

std::array<double, 3> vector(const nlohmann::json& json) {
    if (!json.is_array() || json.size() != 3) refuse(json.dump() + " is not three numbers");
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = number(json[i], -1e18, 1e18);
    return out;
}

Bookmark bookmarkFrom(const nlohmann::json& json) {
    Bookmark bookmark{vector(json.at("position")), vector(json.at("target")), vector(json.at("up")),
                      std::nullopt};
    if (json.contains("fov")) bookmark.fovDeg = number(json.at("fov"), 1, 179);
    // What no camera can be made of would come back as an error when it is recalled.
    Settings settings;
    useBookmark(settings, bookmark);
    validate(settings);
    return bookmark;
}

UserState stateFrom(const nlohmann::json& json) {
    if (json.at("schema") != kSchema)
        refuse("schema " + json.at("schema").dump() + " is not known");
    UserState state;
    state.recent = json.value("recent", state.recent);
    std::erase(state.recent, std::string());
    if (state.recent.size() > kRecentFiles) state.recent.resize(kRecentFiles);
    for (const auto& entry : json.value("bookmarks", nlohmann::json::array())) {
        SceneBookmarks scene;
        scene.scene = entry.at("scene").get<std::string>();
        scene.sceneHash = entry.value("sceneHash", entry.value("sceneSha256", ""));
        for (std::size_t i = 0; i < kBookmarks; ++i) {
            const std::string key = std::to_string(i + 1);
            const auto& cameras = entry.at("cameras");
            if (cameras.contains(key)) scene.cameras[i] = bookmarkFrom(cameras.at(key));
        }
        state.bookmarks.push_back(std::move(scene));
    }
    if (json.contains("window")) {
        const auto& w = json.at("window");
        state.window = WindowPlace{whole(w.at("x"), -kFarthestPixel, kFarthestPixel),
                                   whole(w.at("y"), -kFarthestPixel, kFarthestPixel),
                                   whole(w.at("width"), 1, kFarthestPixel),
                                   whole(w.at("height"), 1, kFarthestPixel)};
    }
    if (json.contains("uiScale")) {
        state.uiScale = number(json.at("uiScale"), kSmallestScale, kLargestScale);
    }
    state.panel = json.value("panel", "");
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
    } catch (const nlohmann::json::exception& reason) {
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
