#pragma once
// The material variants of a glTF file [KHR_materials_variants]: a primitive may name another
// material for each. Serves the first stage, file -> Scene.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mv {

// Of a checked document; those without a name are called by their number.
std::vector<std::string> variantNames(const nlohmann::json& checked);

// Gives every primitive that has a material for the variant that material.
void applyVariant(nlohmann::json& checked, std::size_t variant);

}  // namespace mv
