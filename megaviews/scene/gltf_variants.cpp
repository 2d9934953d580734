#include "megaviews/scene/gltf_variants.h"

#include <algorithm>

namespace mv {

std::vector<std::string> variantNames(const nlohmann::json& checked) {
    const nlohmann::json::json_pointer place("/extensions/KHR_materials_variants/variants");
    std::vector<std::string> names;
    if (!checked.contains(place)) return names;
    for (const nlohmann::json& variant : checked[place]) {
        const std::string name = variant.value("name", "");
        names.push_back(name.empty() ? "variant " + std::to_string(names.size()) : name);
    }
    return names;
}

void applyVariant(nlohmann::json& checked, std::size_t variant) {
    const nlohmann::json::json_pointer place("/extensions/KHR_materials_variants/mappings");
    for (nlohmann::json& mesh : checked["meshes"]) {
        for (nlohmann::json& primitive : mesh["primitives"]) {
            if (!primitive.contains(place)) continue;
            for (const nlohmann::json& mapping : primitive[place]) {
                const nlohmann::json& variants = mapping["variants"];
                const bool isOf =
                    std::find(variants.begin(), variants.end(), variant) != variants.end();
                if (!isOf || !mapping.contains("material")) continue;
                primitive["material"] = nlohmann::json(mapping["material"]);
                break;
            }
        }
    }
}

}  // namespace mv
