#pragma once
// The whole state of a session as JSON: which scene, every setting with the camera filled in, and
// how the animation runs. Written by --save-state and into every picture, restored by --load-state
// from either; a restored state gives the same picture byte for byte.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/common/scene_assets.h"
#include "megaviews/settings/settings.h"

namespace mv {

inline constexpr int kStateSchema = 1;
// The name under which pictures carry their state.
inline constexpr std::string_view kStateKey = "megaviews.state";

// The range of the animation's speed.
constexpr double kSlowestPlay = 1.0 / 1024, kFastestPlay = 1024;

struct State {
    std::string scene = "builtin:atrium";  // builtin:NAME, or a file's absolute path
    std::string sceneHash;                 // inputHash() of what it was made of; empty: not known
    Settings settings;
    bool playing = false;
    double speed = 1;
    bool operator==(const State&) const = default;
};

// `settings` with the camera put into position, target, up and field of view: what
// chosenCamera() turns back into exactly this camera.
Settings withCamera(Settings settings, const FrameCamera& camera, const RootCube& root);

// Files become absolute: the state can be restored from any folder.
nlohmann::ordered_json toJson(const State& state);
// One line of ASCII.
std::string toText(const State& state);

// Throws Error(ExitCode::input) naming `where`, the place in it and the reason. What a state does
// not say has its default; what it says and is not known is refused.
State stateFromText(std::string_view text, std::string_view where);

// Gives the state's text out of a picture. Throws Error(ExitCode::input).
using ReadPictureState = std::function<std::string(const std::string& file)>;
// A state file, or, by its ending .png or .exr, a picture. Files that the state names relative to
// itself become absolute. Throws Error(ExitCode::input).
State loadState(const std::string& file, const ReadPictureState& readPicture);
// Throws Error(ExitCode::input) if the scene's file is not there; `file` is where the state is
// from.
void requireScene(const State& state, const std::string& file);
// Hashes a scene with all that its file refers to, and the file of views that lights it, if any.
std::string inputHash(const Scene& scene, const std::string& viewsHash);
// Warns if these are not what they were when the state was saved; nothing if the hash is empty.
void warnIfChanged(const std::string& sceneHash, const Scene& scene, const std::string& viewsHash);
// Throws Error(ExitCode::output).
void saveState(const std::string& file, const State& state);

// By its ending, whether the file is no scene but something loadState() reads.
bool isStateFile(const std::string& file);

}  // namespace mv
