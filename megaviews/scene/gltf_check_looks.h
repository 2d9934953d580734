#pragma once
// The part of the checked copy of a glTF document that only looks depend on: materials, textures,
// samplers, cameras, lights. Whatever is wrong here is repaired with a warning.

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "megaviews/scene/gltf_report.h"

namespace mv {

// Copies these arrays of `in` into `out`; features that are present and ignored go to `ignored`.
void copyCheckedLooks(const nlohmann::json& in, GltfReport& report, nlohmann::json& out,
                      std::set<std::string>& ignored);

// The lights of KHR_lights_punctual, or an empty array.
const nlohmann::json& punctualLights(const nlohmann::json& document, GltfReport& report);

}  // namespace mv
