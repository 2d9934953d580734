#pragma once
// Makes small glTF files in a folder of their own, for the tests of the loader: a document that a
// test completes or breaks, binary data behind it, images as uncompressed PNG.

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/core/error.h"
#include "megaviews/scene/load_scene.h"

namespace mv::testing {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

inline constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                     kUnsignedInt = 5125, kFloat = 5126;

// A folder that goes when the test does.
class TemporaryFolder {
  public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::string write(const std::string& name, std::span<const std::uint8_t> bytes) const;
    std::string write(const std::string& name, const std::string& text) const;

  private:
    std::filesystem::path path_;
};

std::string base64(std::span<const std::uint8_t> bytes);
std::string dataUri(std::span<const std::uint8_t> bytes,
                    const std::string& type = "application/octet-stream");

// RGBA8, not compressed; valid.
Bytes png(int width, int height, std::span<const std::uint8_t> rgba);
// Header of an image of any size, no pixels.
Bytes pngHeader(int width, int height);

class GltfBuilder {
  public:
    Json json = {{"asset", {{"version", "2.0"}}}};
    Bytes binary;

    // Appends data, aligned to four bytes, as a buffer view; returns its number.
    template <typename T>
    int view(const std::vector<T>& values, int byteStride = 0) {
        while (binary.size() % 4 != 0) binary.push_back(0);
        const std::size_t offset = binary.size(), bytes = values.size() * sizeof(T);
        binary.resize(offset + bytes);
        if (bytes > 0) std::memcpy(binary.data() + offset, values.data(), bytes);
        Json entry = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
        if (byteStride > 0) entry["byteStride"] = byteStride;
        return add("bufferViews", entry);
    }
    int accessor(int view, int componentType, const std::string& type, std::size_t count,
                 std::size_t byteOffset = 0, bool normalized = false);
    // View and accessor in one, tightly packed.
    template <typename T>
    int accessor(const std::vector<T>& values, int componentType, const std::string& type,
                 std::size_t count, bool normalized = false) {
        return accessor(view(values), componentType, type, count, 0, normalized);
    }
    int positions(const std::vector<glm::vec3>& values) {
        return accessor(values, kFloat, "VEC3", values.size());
    }
    // Appends to a top-level array; returns the entry's number.
    int add(const std::string& array, Json entry);
    // A mesh of one primitive with these attributes, on a node of its own in scene 0.
    Json& primitive(Json attributes, int indices = -1, int mode = 4);
    Json& node(Json entry);  // in scene 0
    int texture(std::span<const std::uint8_t> image, const std::string& type = "image/png");

    // The unit square of two triangles, indexed, with texture coordinates and a red material.
    static GltfBuilder square();

    // The first mesh's first primitive.
    Json& primitive() { return json["meshes"][0]["primitives"][0]; }

    std::string gltfText() const;  // buffer as a data URI
    Bytes glb() const;
};

// The parts of a GLB, to be put together wrongly.
Bytes makeGlb(const std::string& jsonText, std::span<const std::uint8_t> binary,
              const std::string& magic = "glTF", std::uint32_t version = 2, int jsonExtra = 0,
              std::int64_t binLength = -1, std::int64_t total = -1);

Scene loadJson(const GltfBuilder& builder, const LoadOptions& options = {});
// The message of the Error(ExitCode::input) that loading throws; empty if it throws none.
std::string inputError(const std::string& path, const LoadOptions& options = {});
bool anyContains(const std::vector<std::string>& sentences, const std::string& words);

// Area vector (half the cross product) of a triangle in world units.
glm::dvec3 areaVector(const Scene& scene, std::size_t triangle);
// World position of a corner of a triangle.
glm::dvec3 corner(const Scene& scene, std::size_t triangle, int corner);
std::pair<glm::dvec3, glm::dvec3> worldBox(const Scene& scene);
// All that downstream relies on: indices in range, finite values, unit normals, optional arrays of
// the right length, positions inside the root cube. Returns what is wrong, or "".
std::string inconsistency(const Scene& scene);

}  // namespace mv::testing
