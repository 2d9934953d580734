#pragma once
// The class behind checkGltf (gltf_check.h), in a header of its own because its two halves, binary
// data and meshes, nodes and what moves them, stand in two files. Nobody else includes it.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/gltf_check.h"
#include "megaviews/scene/json_reader.h"

namespace mv {

// "accessors[3]".
inline std::string element(const std::string& array, std::size_t i) {
    return array + "[" + std::to_string(i) + "]";
}

class GltfChecker {
  public:
    GltfChecker(const GltfFile& file, GltfReport& report)
        : file_(file), root_(file.json, "JSON", report), report_(report) {}

    CheckedGltf run();

  private:
    // Applies `copy` to each object of a top-level array and stores what it returns.
    template <typename Copy>
    void copyEach(const char* key, Copy copy) {
        const nlohmann::json& in = topArray(key);
        if (in.empty()) return;
        nlohmann::json& out = result_.json[key] = nlohmann::json::array();
        for (std::size_t i = 0; i < in.size(); ++i) {
            out.push_back(copy(JsonReader(in[i], element(key, i), report_)));
        }
    }
    const nlohmann::json& topArray(const char* key) const {
        static const nlohmann::json kNone = nlohmann::json::array();
        const nlohmann::json* value = root_.find(key);
        if (!value) return kNone;
        if (!value->is_array()) report_.fail(key, "it must be an array");
        return *value;
    }
    std::size_t count(const char* key) const { return topArray(key).size(); }

    nlohmann::json bufferView(const JsonReader& in) const;
    void checkRange(const JsonReader& in, const char* viewKey, std::uint64_t count,
                    std::size_t elementBytes, bool mayStride) const;
    nlohmann::json accessor(const JsonReader& in) const;
    nlohmann::json mesh(const JsonReader& in) const;
    nlohmann::json primitive(const JsonReader& in) const;
    nlohmann::json node(const JsonReader& in, std::size_t index);
    nlohmann::json scene(const JsonReader& in) const;
    nlohmann::json skin(const JsonReader& in) const;
    nlohmann::json animation(const JsonReader& in) const;
    void checkCycles(const std::vector<std::vector<std::size_t>>& children) const;
    void listIgnoredExtensions();
    // Whether the file says that it uses (or requires) an extension.
    bool declares(const char* extension) const;

    // What an accessor is used for decides which types it may have.
    struct Use {
        const char* types;  // for the message
        std::array<const char*, 2> allowed;
        bool floatOnly = false;
    };
    const nlohmann::json& usedAccessor(const JsonReader& in, const char* key, const Use& use) const;
    std::uint64_t accessorCount(const nlohmann::json& accessor) const {
        return accessor["count"].get<std::uint64_t>();
    }

    const GltfFile& file_;
    JsonReader root_;
    GltfReport& report_;
    CheckedGltf result_;
    std::vector<std::int64_t> parents_;
    std::vector<std::vector<std::size_t>> children_;
};

}  // namespace mv
