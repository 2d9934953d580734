#pragma once
// What --info and --list print: the scene's contents and the settings in effect, without rendering.

#include <string>

#include "app/common/run_options.h"
#include "app/common/scene_assets.h"

namespace mv {

const char* lightTypeName(LightType type);  // "spot"

std::string infoText(const SceneAssets& assets, const Settings& settings);
std::string infoJson(const SceneAssets& assets, const Settings& settings);

// The names an option takes, one a line. kind: "cameras" or "animations" of the scene, "methods" or
// "views" of the program (assets may then be null).
std::string listText(const std::string& kind, const SceneAssets* assets);

}  // namespace mv
