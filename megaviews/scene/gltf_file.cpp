#include "megaviews/scene/gltf_file.h"

#include <utf8cpp/utf8.h>
#include <algorithm>
#include <cmath>

#include "megaviews/core/strict_json.h"
#include "megaviews/core/text.h"
#include "megaviews/scene/uri.h"

namespace mv {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostJsonBytes = std::size_t{1} << 30;

std::uint32_t readU32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{bytes[offset + i]} << (8 * i);
    return value;
}

std::string_view asText(std::span<const std::uint8_t> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The JSON text of a GLB; sets `file.bin`.
std::string_view openGlb(GltfFile& file, const GltfReport& report) {
    constexpr std::size_t kHeader = 12, kChunkHeader = 8;
    constexpr std::uint32_t kJson = 0x4e4f534a, kBin = 0x004e4942;
    const std::span<const std::uint8_t> bytes = file.bytes;
    if (bytes.size() >= 4 && asText(bytes.first(4)) != "glTF") {
        report.fail("", "this is not a GLB file: it begins with " + quote(asText(bytes.first(4))) +
                            " instead of \"glTF\"");
    }
    if (bytes.size() < kHeader) {
        report.fail("", "the GLB header is incomplete: the file has " +
                            std::to_string(bytes.size()) + " bytes, the header alone takes 12");
    }
    const std::uint32_t version = readU32(bytes, 4);
    if (version != 2) {
        report.fail("", "GLB container version " + std::to_string(version) +
                            "; only version 2 is supported");
    }
    const std::uint64_t stated = readU32(bytes, 8);
    if (stated > bytes.size()) {
        report.fail("", "the file is cut short: it has " + std::to_string(bytes.size()) +
                            " bytes, its header says " + std::to_string(stated));
    }
    const std::uint64_t end = stated;
    std::optional<std::span<const std::uint8_t>> json;
    std::uint64_t offset = kHeader;
    for (int chunk = 0; offset + kChunkHeader <= end; ++chunk) {
        const std::uint64_t length = readU32(bytes, offset);
        const std::uint32_t type = readU32(bytes, offset + 4);
        offset += kChunkHeader;
        const std::string place = "GLB chunk " + std::to_string(chunk) +
                                  (type == kJson  ? " (JSON)"
                                   : type == kBin ? " (BIN)"
                                                  : "");
        if (length > end - offset) {
            report.fail(place, "its length " + std::to_string(length) +
                                   " runs past the end of the file, " +
                                   std::to_string(end - offset) + " bytes on");
        }
        const auto content = bytes.subspan(offset, length);
        if (chunk == 0) {
            if (type != kJson) report.fail(place, "the first chunk must be JSON");
            json = content;
        } else if (type == kBin && !file.bin) {
            file.bin = content;
        }
        offset += length;
    }
    if (!json) report.fail("", "the GLB file has no JSON chunk");
    return asText(*json);
}

Json parseJson(std::string_view raw, GltfReport& report) {
    if (raw.size() > kMostJsonBytes)
        report.fail("JSON", "more than 1 GiB of JSON is not supported");
    if (raw.starts_with("\xef\xbb\xbf")) raw.remove_prefix(3);
    std::string text(raw);
    if (!utf8::is_valid(text)) {
        text = utf8::replace_invalid(text);
        report.warn("JSON", "not all of it is valid UTF-8; what is not is replaced by U+FFFD");
    }
    // The parser keeps its own stack, but what walks a document afterwards recurses.
    const auto checkDepth = [&](int depth, Json::parse_event_t, const Json&) {
        if (depth > kDeepestJson) {
            report.fail("JSON", "objects and arrays are nested deeper than " +
                                    std::to_string(kDeepestJson));
        }
        return true;
    };
    try {
        return Json::parse(text, checkDepth);
    } catch (const Json::exception& e) {
        report.fail("JSON", printable(withoutTag(e.what()), 400));
    }
}

void checkVersion(const Json& json, const GltfReport& report) {
    if (!json.is_object()) report.fail("JSON", "the top of a glTF file must be an object");
    const auto asset = json.find("asset");
    if (asset == json.end() || !asset->is_object()) {
        report.fail("asset", "it is missing, so this is not a glTF file");
    }
    for (const char* key : {"version", "minVersion"}) {
        const auto version = asset->find(key);
        const std::string place = std::string("asset.") + key;
        if (version == asset->end()) {
            if (std::string_view(key) == "version") report.fail(place, "it is missing");
            continue;
        }
        if (!version->is_string()) report.fail(place, "it must be a string such as \"2.0\"");
        const auto& text = version->get_ref<const std::string&>();
        const bool minimum = std::string_view(key) == "minVersion";
        if (minimum ? text != "2.0" : !text.starts_with("2.")) {
            report.fail(place, "version " + quote(text) + "; only glTF 2.x is supported");
        }
    }
}

void checkRequiredExtensions(const Json& json, const GltfReport& report) {
    const auto required = json.find("extensionsRequired");
    if (required == json.end()) return;
    if (!required->is_array()) report.fail("extensionsRequired", "it must be an array of strings");
    std::string missing;
    int count = 0;
    for (const Json& name : *required) {
        if (!name.is_string()) report.fail("extensionsRequired", "it must hold strings only");
        const auto& text = name.get_ref<const std::string&>();
        if (extensionSupported(text)) continue;
        missing += (count++ > 0 ? ", " : "") + printable(text);
    }
    if (count > 0) {
        report.fail("extensionsRequired",
                    "the file requires " +
                        std::string(count == 1 ? "the extension " : "extensions ") + missing +
                        ", which this program does not support; export it without");
    }
}

std::vector<std::uint8_t> loadBuffer(GltfFile& file, std::size_t index, const Json& buffer,
                                     const GltfReport& report) {
    const std::string place = "buffers[" + std::to_string(index) + "]";
    if (!buffer.is_object()) report.fail(place, "it must be an object");
    const auto length = buffer.find("byteLength");
    if (length == buffer.end() || !length->is_number()) {
        report.fail(place + ".byteLength", "it must be a number");
    }
    const double stated = length->get<double>();
    if (!(stated >= 1) || stated > 9e15 || stated != std::floor(stated)) {
        report.fail(place + ".byteLength", "it must be a positive integer, not " + length->dump());
    }
    const auto bytes = static_cast<std::uint64_t>(stated);
    const Json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
    const bool isFallback = buffer.contains(fallback) && buffer[fallback] == true;
    file.fallbackBytes.push_back(isFallback ? bytes : 0);
    if (isFallback) return {0};

    const auto uri = buffer.find("uri");
    if (uri == buffer.end()) {
        if (index != 0 || !file.bin) {
            report.fail(place, "it has no uri, and there is no BIN chunk that it could stand for");
        }
        if (bytes > file.bin->size()) {
            report.fail(place, "byteLength is " + std::to_string(bytes) +
                                   ", but the BIN chunk holds " + std::to_string(file.bin->size()) +
                                   " bytes");
        }
        return {file.bin->begin(), file.bin->begin() + static_cast<std::ptrdiff_t>(bytes)};
    }
    if (!uri->is_string()) report.fail(place + ".uri", "it must be a string");
    Resource resource = readUri(file.folder, uri->get_ref<const std::string&>(), bytes);
    if (!resource.ok()) report.fail(place, resource.error);
    resource.bytes.resize(bytes);
    file.noteRead(resource);
    return std::move(resource.bytes);
}

}  // namespace

bool extensionSupported(std::string_view name) {
    constexpr std::string_view kSupported[] = {"KHR_mesh_quantization",
                                               "KHR_texture_transform",
                                               "KHR_materials_emissive_strength",
                                               "KHR_materials_unlit",
                                               "KHR_lights_punctual",
                                               "EXT_mesh_gpu_instancing",
                                               "KHR_draco_mesh_compression",
                                               "EXT_texture_webp",
                                               "EXT_meshopt_compression",
                                               "KHR_materials_variants",
                                               "KHR_materials_ior",
                                               "KHR_materials_specular",
                                               "KHR_materials_transmission",
                                               "KHR_materials_volume",
                                               "KHR_materials_clearcoat",
                                               "KHR_materials_pbrSpecularGlossiness"};
    return std::find(std::begin(kSupported), std::end(kSupported), name) != std::end(kSupported);
}

GltfFile readGltfFile(const std::string& path, GltfReport& report) {
    Resource resource = readRegularFile(path);
    if (!resource.ok()) report.fail("", resource.error);
    if (resource.bytes.empty()) report.fail("", "the file is empty");

    GltfFile file;
    file.folder = std::filesystem::path(path).parent_path();
    file.bytes = std::move(resource.bytes);
    file.hash = Hash().add(std::as_bytes(std::span(file.bytes))).hex();
    file.content.add(file.hash);

    const std::string extension = lowered(std::filesystem::path(path).extension().string());
    const bool glb = extension == ".glb" || asText(file.bytes).starts_with("glTF");
    if (!glb && extension != ".gltf") {
        const std::size_t first = asText(file.bytes).find_first_not_of(" \t\r\n\xef\xbb\xbf");
        if (first == std::string_view::npos || file.bytes[first] != '{') {
            report.fail("", "this is neither a glTF nor a GLB file");
        }
    }
    file.json = parseJson(glb ? openGlb(file, report) : asText(file.bytes), report);
    checkVersion(file.json, report);
    checkRequiredExtensions(file.json, report);

    if (const auto buffers = file.json.find("buffers"); buffers != file.json.end()) {
        if (!buffers->is_array()) report.fail("buffers", "it must be an array");
        for (std::size_t i = 0; i < buffers->size(); ++i) {
            file.buffers.push_back(loadBuffer(file, i, (*buffers)[i], report));
        }
    }
    return file;
}

}  // namespace mv
