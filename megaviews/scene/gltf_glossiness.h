#pragma once
// Materials as glTF had them before metal and roughness [KHR_materials_pbrSpecularGlossiness, which
// Khronos has archived; many files of old still have nothing else]. Serves the first stage, file ->
// Scene.

#include <nlohmann/json.hpp>

namespace mv {

// Says the same by base colour, roughness, and a colour of gloss that an index of refraction of 0
// lets be any, wherever a material has neither colour nor texture for programs that do not know the
// extension. The texture of the gloss's colour stands there by its mean, as all of those do; what
// its alpha makes of the roughness, loadMaterials() takes from kGlossiness.
void translateGlossiness(nlohmann::json& checked);

inline constexpr const char* kGlossiness = "KHR_materials_pbrSpecularGlossiness";

}  // namespace mv
