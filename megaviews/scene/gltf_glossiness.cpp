#include "megaviews/scene/gltf_glossiness.h"

#include <utility>

namespace mv {
namespace {

using Json = nlohmann::json;

void move(Json& from, const char* key, Json& to, const char* toKey) {
    if (from.contains(key)) to[toKey] = std::move(from[key]);
}

}  // namespace

void translateGlossiness(Json& checked) {
    const Json::json_pointer place(std::string("/extensions/") + kGlossiness);
    for (Json& material : checked["materials"]) {
        if (!material.contains(place)) continue;
        const Json& metal = material["pbrMetallicRoughness"];
        const bool otherwise = metal.contains("baseColorTexture") ||
                               metal.contains("baseColorFactor") ||
                               metal.contains("metallicRoughnessTexture");
        if (otherwise) {
            material["extensions"].erase(kGlossiness);
            continue;
        }
        Json& gloss = material[place];
        Json base = {{"metallicFactor", 0}, {"roughnessFactor", 0}};
        move(gloss, "diffuseFactor", base, "baseColorFactor");
        move(gloss, "diffuseTexture", base, "baseColorTexture");
        Json colour = Json::object();
        move(gloss, "specularFactor", colour, "specularColorFactor");
        if (gloss.contains("specularGlossinessTexture")) {
            colour["specularColorTexture"] = Json(gloss["specularGlossinessTexture"]);
        }
        material["pbrMetallicRoughness"] = std::move(base);
        material["extensions"]["KHR_materials_ior"] = {{"ior", 0}};
        material["extensions"]["KHR_materials_specular"] = std::move(colour);
    }
}

}  // namespace mv
