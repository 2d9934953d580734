#pragma once
// The checked copy of a glTF document: every value that the loader goes by is verified and copied,
// everything else is left behind, so that tinygltf and what follows it see no index out of range,
// no accessor past its buffer, no cycle and no value of the wrong type. What would change the
// geometry is an error; what only costs a material's looks is repaired with a warning.

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "megaviews/scene/gltf_file.h"

namespace mv {

struct CheckedGltf {
    // For tinygltf; buffer i has the uri "i", images are left out. Accessors without a buffer view
    // (all zeros, or sparse) name the last one, which stands for none.
    nlohmann::json json;
    std::set<std::string> ignored;     // material features and extensions that are left out
    std::set<std::string> extensions;  // that are read
};

CheckedGltf checkGltf(const GltfFile& file, GltfReport& report);

// Bytes of one element of an accessor, columns of small matrices padded as the standard says.
// componentType is GL's number (5120 ... 5126 but 5124), type "SCALAR" ... "MAT4".
std::size_t accessorElementBytes(int componentType, const std::string& type);

}  // namespace mv
