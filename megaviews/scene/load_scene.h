#pragma once
// The one way to get a Scene: from a glTF/GLB file or by the name of one of our own.

#include <string>

#include "megaviews/core/progress.h"
#include "megaviews/scene/scene.h"

namespace mv {

struct LoadOptions {
    double timeS = 0;       // the pose of skins, morphs and animated geometry
    std::string animation;  // name, number, "none"; empty: Scene::defaultAnimation()
    std::string variant;    // of the materials: name or number; empty = the file's own materials
    int sceneIndex = -1;    // of several in the file; -1 = the file's default
    // Materials of the file whose surfaces are left out, when it is read a second time for that:
    // its warnings were logged.
    std::vector<std::uint32_t> without;
    Progress progress;
};

// nameOrPath is "builtin:cornell|atrium|cathedral|hairball|door" or a path. Everything is
// validated; cameras and lights are those of the file, defaults come from placeDefaults
// (framing.h), which needs the triangle BVH. Throws Error(ExitCode::input) with file, place and
// reason, or Error(ExitCode::usage) for a scene, animation or variant that the file does not have;
// what can be lived with ends in Scene::warnings. Equal files and options give equal bytes.
Scene loadScene(const std::string& nameOrPath, const LoadOptions& options = {});

Scene loadGltf(const std::string& path, const LoadOptions& options);
std::vector<std::string> builtinNames();  // "builtin:cornell", ...
Scene makeBuiltin(const std::string& name, const LoadOptions& options);

// The index that a --animation, --camera or --variant argument means. An empty animation is
// Scene::defaultAnimation(); "none" = -1. Empty variant = -1. Throws Error(ExitCode::usage) listing
// the choices.
int findAnimation(const Scene& scene, const std::string& nameOrNumber);
int findCamera(const Scene& scene, const std::string& nameOrNumber);
int findVariant(const Scene& scene, const std::string& nameOrNumber);

}  // namespace mv
