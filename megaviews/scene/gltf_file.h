#pragma once
// A glTF file taken apart into JSON and buffers, with everything checked that can be known before
// a single object is looked at: container, JSON syntax, version, required extensions. First half
// of the stage file -> Scene; the JSON is checked object by object in gltf_check.h.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/scene/gltf_report.h"

namespace mv {

struct GltfFile {
    std::filesystem::path folder;
    std::vector<std::uint8_t> bytes;  // the file as it is
    std::string hash;                 // of it
    Hash content;                     // of it and of all files read because it refers to them
    std::vector<std::string> files;   // those, without itself
    nlohmann::json json;
    std::optional<std::span<const std::uint8_t>> bin;  // GLB's BIN chunk, in `bytes`
    // Each exactly buffer.byteLength long but fallback buffers [EXT_meshopt_compression], whose
    // bytes nobody reads: they have one, and their stated length, else 0, is in fallbackBytes.
    std::vector<std::vector<std::uint8_t>> buffers;
    std::vector<std::uint64_t> fallbackBytes;

    void noteRead(const Resource& resource) {
        content.add(std::as_bytes(std::span(resource.bytes)));
        if (!resource.file.empty()) files.push_back(resource.file.string());
    }
};

// Reads .gltf or .glb; throws through `report`. Buffers are loaded too, from the BIN chunk, data
// URIs or files in the same folder or below it.
GltfFile readGltfFile(const std::string& path, GltfReport& report);

// What this program understands; anything else may be used by a file but not required.
bool extensionSupported(std::string_view name);

}  // namespace mv
