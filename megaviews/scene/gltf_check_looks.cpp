#include "megaviews/scene/gltf_check_looks.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "megaviews/scene/json_reader.h"

namespace mv {

namespace {

using Json = nlohmann::json;

std::string element(const char* array, std::size_t i) {
    return std::string(array) + "[" + std::to_string(i) + "]";
}

std::size_t arraySize(const Json& document, const char* key) {
    const auto it = document.find(key);
    return it != document.end() && it->is_array() ? it->size() : 0;
}

// An object, or an empty one with a warning.
JsonReader readLenient(const Json& value, const std::string& place, GltfReport& report) {
    static const Json kEmpty = Json::object();
    if (value.is_object()) return JsonReader(value, place, report);
    report.warn(place, "it is not an object, the default is taken");
    return JsonReader(kEmpty, place, report);
}

JsonReader childLenient(const JsonReader& parent, const char* key) {
    static const Json kEmpty = Json::object();
    const Json* value = parent.find(key);
    return value ? readLenient(*value, parent.at(key), parent.report())
                 : JsonReader(kEmpty, parent.at(key), parent.report());
}

JsonReader extensionLenient(const JsonReader& parent, const char* name) {
    return childLenient(childLenient(parent, "extensions"), name);
}

void addName(const JsonReader& in, Json& out) {
    if (std::string name = in.name(); !name.empty()) out["name"] = std::move(name);
}

// A factor in [0, highest].
std::optional<std::vector<double>> factor(const JsonReader& in, const char* key, std::size_t size,
                                          double highest) {
    auto values = in.numbersOrWarn(key, size);
    if (!values) return values;
    std::vector<double> clamped = *values;
    for (double& value : clamped) value = std::clamp(value, 0.0, highest);
    if (clamped != *values) in.warn(key, "it is out of range and clamped");
    return clamped;
}

// textureInfo with KHR_texture_transform; null if it is absent or refers to nothing.
Json textureInfo(const JsonReader& owner, const char* key, std::size_t textures) {
    if (!owner.find(key)) return nullptr;
    const JsonReader in = childLenient(owner, key);
    const auto index = in.find("index") ? integerValue(*in.find("index")) : std::nullopt;
    if (!index || *index < 0 || static_cast<std::uint64_t>(*index) >= textures) {
        in.warn("index", (index ? "it refers to texture " + std::to_string(*index) +
                                      ", but the file has " + std::to_string(textures)
                                : std::string("it is not a texture's number")) +
                             "; drawn without the texture");
        return nullptr;
    }
    Json out = {{"index", *index}};
    const auto texCoord = [&](const JsonReader& reader, Json& to) {
        const Json* value = reader.find("texCoord");
        if (!value) return;
        const auto set = integerValue(*value);
        if (set && *set >= 0 && *set < 64) {
            to["texCoord"] = *set;
        } else {
            reader.warn("texCoord", "it is not the number of a set of texture coordinates");
        }
    };
    texCoord(in, out);
    if (in.hasExtension("KHR_texture_transform")) {
        const JsonReader transform = extensionLenient(in, "KHR_texture_transform");
        Json checked = Json::object();
        for (const char* pair : {"offset", "scale"}) {
            if (auto values = transform.numbersOrWarn(pair, 2)) checked[pair] = *values;
        }
        if (auto rotation = transform.numberOrWarn("rotation")) checked["rotation"] = *rotation;
        texCoord(transform, checked);
        out["extensions"]["KHR_texture_transform"] = std::move(checked);
    }
    return out;
}

Json checkedMaterial(const JsonReader& in, std::size_t textures, std::set<std::string>& ignored) {
    Json out = Json::object();
    addName(in, out);
    const JsonReader pbr = childLenient(in, "pbrMetallicRoughness");
    Json& outPbr = out["pbrMetallicRoughness"] = Json::object();
    if (auto color = factor(pbr, "baseColorFactor", 4, 1.0)) outPbr["baseColorFactor"] = *color;
    if (Json info = textureInfo(pbr, "baseColorTexture", textures); !info.is_null()) {
        outPbr["baseColorTexture"] = std::move(info);
    }
    if (auto color = factor(in, "emissiveFactor", 3, 1e6)) out["emissiveFactor"] = *color;
    if (Json info = textureInfo(in, "emissiveTexture", textures); !info.is_null()) {
        out["emissiveTexture"] = std::move(info);
    } else if (in.find("emissiveTexture")) {
        out["emissiveFactor"] = {0.0, 0.0, 0.0};  // better dark than all of it aglow
    }

    if (const Json* mode = in.find("alphaMode")) {
        if (*mode == "OPAQUE" || *mode == "MASK" || *mode == "BLEND") {
            out["alphaMode"] = *mode;
        } else {
            in.warn("alphaMode", "it is none of OPAQUE, MASK, BLEND; OPAQUE is taken");
        }
    }
    if (auto cutoff = in.numberOrWarn("alphaCutoff")) out["alphaCutoff"] = std::max(*cutoff, 0.0);
    if (const Json* sided = in.find("doubleSided")) {
        if (sided->is_boolean()) {
            out["doubleSided"] = *sided;
        } else {
            in.warn("doubleSided", "it is not true or false, false is taken");
        }
    }

    Json extensions = Json::object();
    if (in.hasExtension("KHR_materials_unlit")) extensions["KHR_materials_unlit"] = Json::object();
    if (in.hasExtension("KHR_materials_emissive_strength")) {
        const JsonReader reader = extensionLenient(in, "KHR_materials_emissive_strength");
        if (auto strength = reader.numberOrWarn("emissiveStrength")) {
            if (*strength < 0) reader.warn("emissiveStrength", "it is negative, 0 is taken");
            extensions["KHR_materials_emissive_strength"]["emissiveStrength"] =
                std::clamp(*strength, 0.0, 1e9);
        }
    }
    if (in.hasExtension("KHR_materials_transmission")) {
        const JsonReader reader = extensionLenient(in, "KHR_materials_transmission");
        extensions["KHR_materials_transmission"]["transmissionFactor"] =
            reader.numberOrWarn("transmissionFactor").value_or(0.0);
    }
    if (!extensions.empty()) out["extensions"] = std::move(extensions);

    constexpr std::array<std::array<const char*, 2>, 2> kIgnored = {
        {{"normalTexture", "normal maps"}, {"occlusionTexture", "occlusion maps"}}};
    for (const auto& [key, words] : kIgnored) {
        if (in.find(key)) ignored.insert(words);
    }
    if (pbr.find("metallicRoughnessTexture")) ignored.insert("metallic-roughness maps");
    const Json* metallic = pbr.find("metallicFactor");
    if (!metallic || !metallic->is_number() || metallic->get<double>() > 0) {
        ignored.insert("metallic factors");
    }
    return out;
}

Json checkedTexture(const JsonReader& in, std::size_t images, std::size_t samplers) {
    Json out = Json::object();
    const auto index = [&](const char* key, std::size_t limit, const char* what) {
        const Json* value = in.find(key);
        if (!value) return;
        const auto number = integerValue(*value);
        if (number && *number >= 0 && static_cast<std::uint64_t>(*number) < limit) {
            out[key] = *number;
        } else {
            in.warn(key, "it refers to " + std::string(what) + " " + printable(value->dump()) +
                             ", but the file has " + std::to_string(limit));
        }
    };
    index("source", images, "image");
    index("sampler", samplers, "sampler");
    return out;
}

Json checkedSampler(const JsonReader& in) {
    Json out = Json::object();
    const auto oneOf = [&](const char* key, std::initializer_list<std::int64_t> allowed) {
        const Json* value = in.find(key);
        if (!value) return;
        const auto number = integerValue(*value);
        if (number && std::find(allowed.begin(), allowed.end(), *number) != allowed.end()) {
            out[key] = *number;
        } else {
            in.warn(key, "it is no value that the standard knows, the default is taken");
        }
    };
    oneOf("wrapS", {10497, 33071, 33648});
    oneOf("wrapT", {10497, 33071, 33648});
    oneOf("magFilter", {9728, 9729});
    return out;
}

Json checkedCamera(const JsonReader& in) {
    Json out = Json::object();
    addName(in, out);
    const Json* type = in.find("type");
    if (type && *type == "orthographic") {
        const JsonReader view = childLenient(in, "orthographic");
        double ymag = std::abs(view.numberOrWarn("ymag").value_or(0.0));
        if (!(ymag > 0)) {
            view.warn("ymag", "it is zero or missing, 1 is taken");
            ymag = 1;
        }
        out["type"] = "orthographic";
        out["orthographic"] = {{"xmag", ymag}, {"ymag", ymag}, {"znear", 0.0}, {"zfar", 1.0}};
        return out;
    }
    if (!type || *type != "perspective") {
        in.warn("type", "it is neither perspective nor orthographic; perspective is taken");
    }
    const JsonReader view = childLenient(in, "perspective");
    double yfov = view.numberOrWarn("yfov").value_or(0.0);
    if (!(yfov > 1e-3 && yfov < std::numbers::pi - 1e-3)) {
        view.warn("yfov", "it is not between 0 and pi; 0.9 is taken");
        yfov = 0.9;
    }
    out["type"] = "perspective";
    out["perspective"] = {{"yfov", yfov}, {"znear", 0.1}};
    return out;
}

Json checkedLight(const JsonReader& in) {
    Json out = Json::object();
    addName(in, out);
    const Json* type = in.find("type");
    const bool known = type && (*type == "point" || *type == "spot" || *type == "directional");
    if (!known) in.warn("type", "it is none of point, spot, directional; the light is off");
    out["type"] = known ? *type : Json("point");
    double intensity = in.numberOrWarn("intensity").value_or(1.0);
    if (intensity < 0) in.warn("intensity", "it is negative; the light is off");
    out["intensity"] = known ? std::clamp(intensity, 0.0, 1e12) : 0.0;
    out["color"] = factor(in, "color", 3, 1e6).value_or(std::vector<double>{1, 1, 1});
    if (known && *type == "spot") {
        constexpr double kQuarterPi = std::numbers::pi / 4, kHalfPi = std::numbers::pi / 2;
        const JsonReader spot = childLenient(in, "spot");
        double inner = spot.numberOrWarn("innerConeAngle").value_or(0.0);
        double outer = spot.numberOrWarn("outerConeAngle").value_or(kQuarterPi);
        if (!(outer > 0 && outer <= kHalfPi + 1e-6 && inner >= 0 && inner <= outer)) {
            in.warn("spot", "0 <= innerConeAngle < outerConeAngle <= pi/2 does not hold; clamped");
            outer = outer > 0 ? std::min(outer, kHalfPi) : kQuarterPi;
            inner = std::clamp(inner, 0.0, outer);
        }
        out["spot"] = {{"innerConeAngle", inner}, {"outerConeAngle", std::min(outer, kHalfPi)}};
    }
    return out;
}

}  // namespace

const Json& punctualLights(const Json& document, GltfReport& report) {
    static const Json kNone = Json::array();
    const auto extensions = document.find("extensions");
    if (extensions == document.end() || !extensions->is_object()) return kNone;
    const auto punctual = extensions->find("KHR_lights_punctual");
    if (punctual == extensions->end() || !punctual->is_object()) return kNone;
    const auto lights = punctual->find("lights");
    if (lights == punctual->end()) return kNone;
    if (!lights->is_array())
        report.fail("extensions.KHR_lights_punctual.lights", "it must be an array");
    return *lights;
}

void copyCheckedLooks(const Json& in, GltfReport& report, Json& out,
                      std::set<std::string>& ignored) {
    const auto each = [&](const char* key, auto&& copy) {
        const auto it = in.find(key);
        if (it == in.end()) return;
        if (!it->is_array()) {
            report.warn(key, "it is not an array and left out");
            return;
        }
        Json& to = out[key] = Json::array();
        for (std::size_t i = 0; i < it->size(); ++i) {
            to.push_back(copy(readLenient((*it)[i], element(key, i), report)));
        }
    };
    const std::size_t images = arraySize(in, "images"), samplers = arraySize(in, "samplers");
    const std::size_t textures = arraySize(in, "textures");
    each("materials",
         [&](const JsonReader& reader) { return checkedMaterial(reader, textures, ignored); });
    each("textures",
         [&](const JsonReader& reader) { return checkedTexture(reader, images, samplers); });
    each("samplers", [](const JsonReader& reader) { return checkedSampler(reader); });
    each("cameras", [](const JsonReader& reader) { return checkedCamera(reader); });

    const Json& lights = punctualLights(in, report);
    Json checked = Json::array();
    for (std::size_t i = 0; i < lights.size(); ++i) {
        checked.push_back(checkedLight(
            readLenient(lights[i], element("extensions.KHR_lights_punctual.lights", i), report)));
    }
    if (!checked.empty()) out["extensions"]["KHR_lights_punctual"]["lights"] = std::move(checked);
}

}  // namespace mv
