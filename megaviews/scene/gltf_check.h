#pragma once
// The checked copy of a glTF document: every value that the loader goes by is verified and copied,
// packed data are unpacked (gltf_compressed.h), everything else is left behind, so that tinygltf
// and what follows it see no index out of range, no accessor past its buffer, no cycle and no value
// of the wrong type. What would change the geometry is an error; what only costs a material's looks
// is repaired with a warning.

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "megaviews/core/progress.h"
#include "megaviews/scene/gltf_file.h"

namespace mv {

struct CheckedGltf {
    // For tinygltf; buffer i has the uri "i", images are left out. Accessors without a buffer view
    // (all zeros, or sparse) name the last one, which stands for none.
    nlohmann::json json;
    std::set<std::string> ignored;     // material features and extensions that are left out
    std::set<std::string> extensions;  // that are read
};

// What packed data unpack to is appended to file.buffers.
CheckedGltf checkGltf(GltfFile& file, GltfReport& report, const Progress& progress);

// What types an attribute of a primitive may have, blanks between them; null for one that is not
// read: tangents, further colours, an application's own.
const char* attributeTypes(std::string_view name);

// Bytes of one element of an accessor, columns of small matrices padded as the standard says.
// componentType is GL's number (5120 ... 5126 but 5124), type "SCALAR" ... "MAT4".
std::size_t accessorElementBytes(int componentType, const std::string& type);

}  // namespace mv
