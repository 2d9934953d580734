#pragma once
// What a glTF document may hold, as a table of fields, and the copy of a document that holds only
// that. The copy has every value of the right type and every index inside its array; whatever
// depends on more than one value is left to gltf_check.h.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "megaviews/scene/gltf_report.h"

namespace mv {

// The copy of a document. Arrays of it exist even where the document has none.
nlohmann::json copyGltfFields(const nlohmann::json& document, GltfReport& report);

// "accessors[3]".
inline std::string element(const std::string& array, std::size_t i) {
    return array + "[" + std::to_string(i) + "]";
}

// Whether `words`, blanks between them, hold `word`.
bool isOneOf(std::string_view word, std::string_view words);

}  // namespace mv
