#include "scene/gltf_builder.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>

#include "megaviews/scene/rigged_scene.h"

namespace mv::testing {

namespace {

void appendBig32(Bytes& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void appendLittle32(Bytes& out, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = 0xffffffffu;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0xedb88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

void appendChunk(Bytes& out, const std::string& type, const Bytes& data) {
    appendBig32(out, static_cast<std::uint32_t>(data.size()));
    Bytes body(type.begin(), type.end());
    body.insert(body.end(), data.begin(), data.end());
    out.insert(out.end(), body.begin(), body.end());
    appendBig32(out, crc32(body));
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("megaviews-test-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryFolder::write(const std::string& name,
                                   std::span<const std::uint8_t> bytes) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream stream(path, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    return path.string();
}

std::string TemporaryFolder::write(const std::string& name, const std::string& text) const {
    return write(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k <= bytes.size() ? kAlphabet[(group >> (18 - 6 * k)) & 63] : '=';
        }
    }
    return text;
}

std::string dataUri(std::span<const std::uint8_t> bytes, const std::string& type) {
    return "data:" + type + ";base64," + base64(bytes);
}

Bytes pngHeader(int width, int height) {
    Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    Bytes header;
    appendBig32(header, static_cast<std::uint32_t>(width));
    appendBig32(header, static_cast<std::uint32_t>(height));
    header.insert(header.end(), {8, 6, 0, 0, 0});
    appendChunk(out, "IHDR", header);
    return out;
}

Bytes png(int width, int height, std::span<const std::uint8_t> rgba) {
    Bytes out = pngHeader(width, height);
    Bytes raw;  // filter 0 before every row
    const std::size_t row = 4 * static_cast<std::size_t>(width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        raw.push_back(0);
        for (std::size_t i = 0; i < row; ++i) raw.push_back(rgba[y * row + i]);
    }
    Bytes zlib = {0x78, 0x01};
    for (std::size_t at = 0; at < raw.size() || at == 0;) {
        const std::size_t length = std::min<std::size_t>(raw.size() - at, 65535);
        zlib.push_back(at + length == raw.size() ? 1 : 0);
        for (const std::size_t value : {length, ~length & 0xffffu}) {
            zlib.push_back(static_cast<std::uint8_t>(value & 255));
            zlib.push_back(static_cast<std::uint8_t>(value >> 8));
        }
        for (std::size_t i = 0; i < length; ++i) zlib.push_back(raw[at + i]);
        at += std::max<std::size_t>(length, 1);
    }
    std::uint32_t a = 1, b = 0;
    for (const std::uint8_t byte : raw) a = (a + byte) % 65521, b = (b + a) % 65521;
    appendBig32(zlib, b << 16 | a);
    appendChunk(out, "IDAT", zlib);
    appendChunk(out, "IEND", {});
    return out;
}

int GltfBuilder::accessor(int view, int componentType, const std::string& type, std::size_t count,
                          std::size_t byteOffset, bool normalized) {
    Json entry = {{"componentType", componentType}, {"type", type}, {"count", count}};
    if (view >= 0) entry["bufferView"] = view;
    if (byteOffset > 0) entry["byteOffset"] = byteOffset;
    if (normalized) entry["normalized"] = true;
    return add("accessors", entry);
}

int GltfBuilder::add(const std::string& array, Json entry) {
    json[array].push_back(std::move(entry));
    return static_cast<int>(json[array].size()) - 1;
}

Json& GltfBuilder::primitive(Json attributes, int indices, int mode) {
    Json entry = {{"attributes", std::move(attributes)}};
    if (indices >= 0) entry["indices"] = indices;
    if (mode != 4) entry["mode"] = mode;
    const int mesh = add("meshes", {{"primitives", Json::array({entry})}});
    node({{"mesh", mesh}});
    return json["meshes"].back()["primitives"][0];
}

Json& GltfBuilder::node(Json entry) {
    const int index = add("nodes", std::move(entry));
    json["scenes"][0]["nodes"].push_back(index);
    return json["nodes"].back();
}

int GltfBuilder::texture(std::span<const std::uint8_t> image, const std::string& type) {
    const int source = add("images", {{"uri", dataUri(image, type)}});
    return add("textures", {{"source", source}});
}

GltfBuilder GltfBuilder::square() {
    GltfBuilder b;
    b.json["scene"] = 0;
    const int position = b.positions({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    const int uv =
        b.accessor(std::vector<glm::vec2>{{0, 1}, {1, 1}, {1, 0}, {0, 0}}, kFloat, "VEC2", 4);
    const int index =
        b.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, kUnsignedShort, "SCALAR", 6);
    b.primitive({{"POSITION", position}, {"TEXCOORD_0", uv}}, index)["material"] = 0;
    b.add("materials", {{"pbrMetallicRoughness",
                         {{"baseColorFactor", {0.8, 0.3, 0.2, 1.0}}, {"metallicFactor", 0}}}});
    return b;
}

std::string GltfBuilder::gltfText() const {
    Json out = json;
    if (!binary.empty() && !out.contains("buffers")) {
        out["buffers"] = {{{"byteLength", binary.size()}, {"uri", dataUri(binary)}}};
    }
    return out.dump();
}

Bytes GltfBuilder::glb() const {
    Json out = json;
    if (!binary.empty() && !out.contains("buffers"))
        out["buffers"] = {{{"byteLength", binary.size()}}};
    return makeGlb(out.dump(), binary);
}

Bytes makeGlb(const std::string& jsonText, std::span<const std::uint8_t> binary,
              const std::string& magic, std::uint32_t version, int jsonExtra,
              std::int64_t binLength, std::int64_t total) {
    std::string text = jsonText;
    while (text.size() % 4 != 0) text += ' ';
    Bytes bin(binary.begin(), binary.end());
    while (bin.size() % 4 != 0) bin.push_back(0);
    Bytes out(magic.begin(), magic.end());
    const std::size_t length = 12 + 8 + text.size() + 8 + bin.size();
    appendLittle32(out, version);
    appendLittle32(
        out, static_cast<std::uint32_t>(total < 0 ? static_cast<std::int64_t>(length) : total));
    appendLittle32(out,
                   static_cast<std::uint32_t>(text.size()) + static_cast<std::uint32_t>(jsonExtra));
    out.insert(out.end(), {'J', 'S', 'O', 'N'});
    out.insert(out.end(), text.begin(), text.end());
    appendLittle32(out, static_cast<std::uint32_t>(
                            binLength < 0 ? static_cast<std::int64_t>(bin.size()) : binLength));
    out.insert(out.end(), {'B', 'I', 'N', 0});
    out.insert(out.end(), bin.begin(), bin.end());
    return out;
}

Scene loadJson(const GltfBuilder& builder, const LoadOptions& options) {
    const TemporaryFolder folder;
    return loadScene(folder.write("test.gltf", builder.gltfText()), options);
}

std::string inputError(const std::string& path, const LoadOptions& options) {
    try {
        loadScene(path, options);
    } catch (const Error& e) {
        return e.code == ExitCode::input ? e.what() : "";
    }
    return "";
}

bool anyContains(const std::vector<std::string>& sentences, const std::string& words) {
    for (const std::string& sentence : sentences) {
        if (sentence.find(words) != std::string::npos) return true;
    }
    return false;
}

glm::dvec3 corner(const Scene& scene, std::size_t triangle, int which) {
    return scene.root.worldFromRoot(scene.positions[scene.triangles[triangle][which]]);
}

glm::dvec3 areaVector(const Scene& scene, std::size_t triangle) {
    const glm::dvec3 a = corner(scene, triangle, 0);
    return 0.5 * glm::cross(corner(scene, triangle, 1) - a, corner(scene, triangle, 2) - a);
}

std::pair<glm::dvec3, glm::dvec3> worldBox(const Scene& scene) {
    glm::dvec3 min(1e300), max(-1e300);
    for (const glm::vec3& p : scene.positions) {
        min = glm::min(min, scene.root.worldFromRoot(p));
        max = glm::max(max, scene.root.worldFromRoot(p));
    }
    return {min, max};
}

std::string inconsistency(const Scene& scene) {
    const std::size_t vertices = scene.positions.size();
    if (!(scene.root.edge > 0) || !std::isfinite(scene.root.edge)) return "edge of the root cube";
    if (scene.materials.empty()) return "no material";
    if (scene.normals.size() != vertices) return "number of normals";
    if (!scene.colors.empty() && scene.colors.size() != vertices) return "number of colours";
    if (!scene.uvs.empty() && scene.uvs.size() != vertices) return "number of uvs";
    if (!scene.emissiveUvs.empty() && scene.emissiveUvs.size() != vertices) return "emissive uvs";
    if (scene.triangleMaterials.size() != scene.triangles.size()) return "number of materials";
    for (std::size_t i = 0; i < vertices; ++i) {
        for (int k = 0; k < 3; ++k) {
            if (!(scene.positions[i][k] >= 0 && scene.positions[i][k] <= 1)) {
                return "position " + std::to_string(i);
            }
        }
        if (!(std::abs(glm::length(scene.normals[i]) - 1) < 1e-4))
            return "normal " + std::to_string(i);
        if (!scene.uvs.empty() && !std::isfinite(scene.uvs[i].x + scene.uvs[i].y)) {
            return "uv " + std::to_string(i);
        }
        if (!scene.colors.empty() && !(scene.colors[i].x + scene.colors[i].w <= 2)) {
            return "colour " + std::to_string(i);
        }
    }
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (scene.triangles[t][k] >= vertices) return "triangle " + std::to_string(t);
        }
        // What moves keeps the triangles that have no area at this time.
        const bool stands = !scene.moving || t < scene.moving->triangle;
        if (stands && areaVector(scene, t) == glm::dvec3(0)) {
            return "area of triangle " + std::to_string(t);
        }
        if (scene.triangleMaterials[t] >= scene.materials.size()) return "material of triangle";
    }
    for (const std::uint32_t m : scene.triangleMaterials) {
        const Material& material = scene.materials[m];
        for (const int texture : {material.baseTexture, material.emissiveTexture}) {
            if (texture >= static_cast<int>(scene.textures.size())) return "texture of a material";
        }
        if (material.baseTexture >= 0 && scene.uvs.empty()) return "no uvs";
        if (material.emissiveTexture >= 0 && scene.emissiveUvs.empty()) return "no emissive uvs";
    }
    for (const Texture& texture : scene.textures) {
        if (texture.image < 0 || texture.image >= static_cast<int>(scene.images.size()))
            return "image";
    }
    for (const Image& image : scene.images) {
        if (image.rgba.size() != std::size_t{4} * static_cast<std::size_t>(image.width) *
                                     static_cast<std::size_t>(image.height) ||
            image.rgba.empty()) {
            return "pixels of an image";
        }
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (scene.nodes[i].parent >= static_cast<int>(i))
            return "parent of node " + std::to_string(i);
    }
    for (const PosedLight& light : scene.lightsAt(0.3, 0)) {
        if (!(std::abs(glm::length(light.direction) - 1) < 1e-9)) return "light direction";
    }
    for (const PosedCamera& camera : scene.camerasAt(0.3, 0)) {
        if (!(std::abs(glm::dot(camera.forward, camera.up)) < 1e-9)) return "camera axes";
        if (!(std::abs(glm::length(camera.up) - 1) < 1e-9)) return "camera up";
    }
    return "";
}

}  // namespace mv::testing
