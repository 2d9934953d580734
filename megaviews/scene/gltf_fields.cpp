#include "megaviews/scene/gltf_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "megaviews/scene/scene.h"

namespace mv {

namespace {

using Json = nlohmann::json;

// ---------------------------------------------------------------- the table

enum class Kind {
    flag,
    integer,
    index,
    indices,
    number,
    numbers,
    word,
    name,
    map,
    object,
    objects
};

// What becomes of a value that is not as the table says.
enum class Rule {
    optional,  // an error; the field may be absent
    required,  // an error, and so is its absence
    lenient,   // left out with a warning, or clamped where it is but out of range
    needed,    // lenient; without it the object that it stands in is left out
};
using enum Rule;

struct Field {
    const char* key;
    Kind kind;
    Rule rule = optional;
    const char* of = "";  // what an index counts in; the choices for integers and words; none: any
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    std::size_t size = 0;  // of numbers; 0: any
    std::span<const Field> fields = {};
};

constexpr Field index(const char* key, const char* of, Rule rule = optional) {
    return {key, Kind::index, rule, of, 0};
}
constexpr Field indices(const char* key, const char* of) {
    return {key, Kind::indices, optional, of};
}
constexpr Field integer(const char* key, double low, double high, Rule rule = optional) {
    return {key, Kind::integer, rule, "", low, high};
}
constexpr Field choice(const char* key, Kind kind, const char* of, Rule rule) {
    return {key, kind, rule, of, 0};
}
constexpr Field numbers(const char* key, std::size_t size) {
    return {.key = key, .kind = Kind::numbers, .size = size};
}
// What only looks depend on is never an error.
constexpr Field number(const char* key, double low = -1e300, double high = 1e300) {
    return {key, Kind::number, lenient, "", low, high};
}
constexpr Field factor(const char* key, std::size_t size, double low, double high) {
    return {key, Kind::numbers, lenient, "", low, high, size};
}
constexpr Field object(const char* key, std::span<const Field> fields, Rule rule = optional) {
    return {.key = key, .kind = Kind::object, .rule = rule, .fields = fields};
}
constexpr Field objects(const char* key, std::span<const Field> fields, Rule rule = optional) {
    return {.key = key, .kind = Kind::objects, .rule = rule, .fields = fields};
}

constexpr double kMost = 9007199254740992.0;  // 2^53: integers up to it survive as a double
constexpr const char* kComponents = "5120 5121 5122 5123 5125 5126";
constexpr const char* kLights = "lights";      // of KHR_lights_punctual
constexpr const char* kVariants = "variants";  // of KHR_materials_variants
constexpr Field kName = {"name", Kind::name};

// Buffers and accessors.
constexpr Field kMeshoptView[] = {
    index("buffer", "buffers", required),
    integer("byteOffset", 0, kMost),
    integer("byteLength", 1, kMost, required),
    integer("byteStride", 1, 256, required),
    integer("count", 1, UINT32_MAX, required),
    choice("mode", Kind::word, "ATTRIBUTES TRIANGLES INDICES", required),
    choice("filter", Kind::word, "NONE OCTAHEDRAL QUATERNION EXPONENTIAL", optional)};
constexpr Field kViewExtensions[] = {object("EXT_meshopt_compression", kMeshoptView)};
constexpr Field kBufferView[] = {
    index("buffer", "buffers", required), integer("byteOffset", 0, kMost),
    integer("byteLength", 0, kMost, required), integer("byteStride", 4, 252),
    object("extensions", kViewExtensions)};
constexpr Field kSparsePart[] = {index("bufferView", "bufferViews", required),
                                 integer("byteOffset", 0, kMost)};
constexpr Field kSparseIndices[] = {
    kSparsePart[0], kSparsePart[1],
    choice("componentType", Kind::integer, "5121 5123 5125", required)};
constexpr Field kSparse[] = {integer("count", 1, UINT32_MAX, required),
                             object("indices", kSparseIndices, required),
                             object("values", kSparsePart, required)};
constexpr Field kAccessor[] = {
    choice("componentType", Kind::integer, kComponents, required),
    choice("type", Kind::word, "SCALAR VEC2 VEC3 VEC4 MAT2 MAT3 MAT4", required),
    integer("count", 0, UINT32_MAX, required),
    {"normalized", Kind::flag},
    index("bufferView", "bufferViews"),
    integer("byteOffset", 0, kMost),
    object("sparse", kSparse)};

// Meshes, nodes and what moves them.
constexpr Field kDracoPrimitive[] = {
    index("bufferView", "bufferViews", required),
    {.key = "attributes", .kind = Kind::map, .rule = required, .low = 0, .high = UINT32_MAX}};
constexpr Field kMapping[] = {index("material", "materials", lenient),
                              indices("variants", kVariants)};
constexpr Field kMappings[] = {objects("mappings", kMapping)};
constexpr Field kPrimitiveExtensions[] = {object("KHR_draco_mesh_compression", kDracoPrimitive),
                                          object("KHR_materials_variants", kMappings)};
constexpr Field kTarget[] = {index("POSITION", "accessors"), index("NORMAL", "accessors")};
constexpr Field kPrimitive[] = {
    integer("mode", 0, 6),         {"attributes", Kind::map, optional, "accessors"},
    index("indices", "accessors"), index("material", "materials", lenient),
    objects("targets", kTarget),   object("extensions", kPrimitiveExtensions)};
constexpr Field kMesh[] = {kName, objects("primitives", kPrimitive), numbers("weights", 0)};
constexpr Field kNodeLight[] = {index("light", kLights, required)};
constexpr Field kInstanceAttributes[] = {
    index("TRANSLATION", "accessors"), index("ROTATION", "accessors"), index("SCALE", "accessors")};
constexpr Field kInstances[] = {object("attributes", kInstanceAttributes)};
constexpr Field kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight),
                                     object("EXT_mesh_gpu_instancing", kInstances)};
constexpr Field kNode[] = {kName,
                           numbers("matrix", 16),
                           numbers("translation", 3),
                           numbers("rotation", 4),
                           numbers("scale", 3),
                           numbers("weights", 0),
                           index("mesh", "meshes"),
                           index("skin", "skins"),
                           index("camera", "cameras"),
                           indices("children", "nodes"),
                           object("extensions", kNodeExtensions)};
constexpr Field kScene[] = {kName, indices("nodes", "nodes")};
constexpr Field kSkin[] = {indices("joints", "nodes"), index("inverseBindMatrices", "accessors")};
constexpr Field kSampling[] = {
    index("input", "accessors", required), index("output", "accessors", required),
    choice("interpolation", Kind::word, "LINEAR STEP CUBICSPLINE", optional)};
constexpr Field kChannelTarget[] = {index("node", "nodes"), {"path", Kind::word, required}};
constexpr Field kChannel[] = {integer("sampler", 0, INT32_MAX, required),
                              object("target", kChannelTarget, required)};
constexpr Field kAnimation[] = {kName, objects("samplers", kSampling),
                                objects("channels", kChannel)};

// Looks.
constexpr Field kTexCoord = integer("texCoord", 0, 63, lenient);
constexpr Field kUvTransform[] = {factor("offset", 2, -1e300, 1e300),
                                  factor("scale", 2, -1e300, 1e300), number("rotation"), kTexCoord};
constexpr Field kTextureExtensions[] = {object("KHR_texture_transform", kUvTransform, lenient)};
constexpr Field kTextureInfo[] = {index("index", "textures", needed), kTexCoord,
                                  object("extensions", kTextureExtensions, lenient)};
constexpr Field kPbr[] = {factor("baseColorFactor", 4, 0, 1), number("metallicFactor", 0, 1),
                          number("roughnessFactor", 0, 1),
                          object("baseColorTexture", kTextureInfo, lenient),
                          object("metallicRoughnessTexture", kTextureInfo, lenient)};
constexpr Field kNormalTexture[] = {kTextureInfo[0], kTextureInfo[1], kTextureInfo[2],
                                    number("scale")};
constexpr Field kStrength[] = {number("emissiveStrength", 0, 1e9)};
constexpr Field kTransmissionFields[] = {number("transmissionFactor", 0, 1),
                                         object("transmissionTexture", kTextureInfo, lenient)};
constexpr Field kVolumeFields[] = {number("thicknessFactor", 0), number("attenuationDistance", 0),
                                   factor("attenuationColor", 3, 0, 1),
                                   object("thicknessTexture", kTextureInfo, lenient)};
constexpr Field kIor[] = {number("ior", 0)};
constexpr Field kSpecularFields[] = {number("specularFactor", 0, 1),
                                     factor("specularColorFactor", 3, 0, 1e6),
                                     object("specularTexture", kTextureInfo, lenient),
                                     object("specularColorTexture", kTextureInfo, lenient)};
constexpr Field kClearcoatFields[] = {number("clearcoatFactor", 0, 1),
                                      number("clearcoatRoughnessFactor", 0, 1),
                                      object("clearcoatTexture", kTextureInfo, lenient),
                                      object("clearcoatRoughnessTexture", kTextureInfo, lenient),
                                      object("clearcoatNormalTexture", kNormalTexture, lenient)};
constexpr Field kGlossinessFields[] = {
    factor("diffuseFactor", 4, 0, 1), object("diffuseTexture", kTextureInfo, lenient),
    factor("specularFactor", 3, 0, 1), number("glossinessFactor", 0, 1),
    object("specularGlossinessTexture", kTextureInfo, lenient)};
constexpr Field kMaterialExtensions[] = {
    object("KHR_materials_pbrSpecularGlossiness", kGlossinessFields, lenient),
    object("KHR_materials_clearcoat", kClearcoatFields, lenient),
    object("KHR_materials_unlit", {}, lenient),
    object("KHR_materials_emissive_strength", kStrength, lenient),
    object("KHR_materials_transmission", kTransmissionFields, lenient),
    object("KHR_materials_volume", kVolumeFields, lenient),
    object("KHR_materials_ior", kIor, lenient),
    object("KHR_materials_specular", kSpecularFields, lenient)};
constexpr Field kMaterial[] = {kName,
                               object("pbrMetallicRoughness", kPbr, lenient),
                               object("normalTexture", kNormalTexture, lenient),
                               factor("emissiveFactor", 3, 0, 1e6),
                               object("emissiveTexture", kTextureInfo, lenient),
                               choice("alphaMode", Kind::word, "OPAQUE MASK BLEND", lenient),
                               number("alphaCutoff", 0),
                               {"doubleSided", Kind::flag, lenient},
                               object("extensions", kMaterialExtensions, lenient)};
constexpr Field kWebp[] = {index("source", "images", lenient)};
constexpr Field kTextureSources[] = {object("EXT_texture_webp", kWebp, lenient)};
constexpr Field kTexture[] = {index("source", "images", lenient),
                              index("sampler", "samplers", lenient),
                              object("extensions", kTextureSources, lenient)};
constexpr const char* kWraps = "10497 33071 33648";
constexpr Field kSampler[] = {choice("wrapS", Kind::integer, kWraps, lenient),
                              choice("wrapT", Kind::integer, kWraps, lenient),
                              choice("magFilter", Kind::integer, "9728 9729", lenient)};
constexpr Field kPerspective[] = {number("yfov")};
constexpr Field kOrthographic[] = {number("ymag")};
constexpr Field kCamera[] = {kName, choice("type", Kind::word, "perspective orthographic", lenient),
                             object("perspective", kPerspective, lenient),
                             object("orthographic", kOrthographic, lenient)};
constexpr Field kSpot[] = {number("innerConeAngle"), number("outerConeAngle")};
constexpr Field kOwnOfLight[] = {{kPlacedLight, Kind::flag, lenient}};  // of saveScene()
constexpr Field kLightExtras[] = {object("megaviews", kOwnOfLight, lenient)};
constexpr Field kLight[] = {kName,
                            object("extras", kLightExtras, lenient),
                            {"type", Kind::word, lenient},
                            number("intensity", 0, 1e12),
                            factor("color", 3, 0, 1e6),
                            object("spot", kSpot, lenient)};
constexpr Field kPunctual[] = {objects(kLights, kLight)};
constexpr Field kVariant[] = {kName};
constexpr Field kVariantNames[] = {objects(kVariants, kVariant)};
constexpr Field kDocumentExtensions[] = {object("KHR_lights_punctual", kPunctual),
                                         object("KHR_materials_variants", kVariantNames)};

constexpr Field kDocument[] = {objects("bufferViews", kBufferView),
                               objects("accessors", kAccessor),
                               objects("meshes", kMesh),
                               objects("nodes", kNode),
                               objects("scenes", kScene),
                               index("scene", "scenes"),
                               objects("skins", kSkin),
                               objects("animations", kAnimation),
                               objects("materials", kMaterial, lenient),
                               objects("textures", kTexture, lenient),
                               objects("samplers", kSampler, lenient),
                               objects("cameras", kCamera, lenient),
                               object("extensions", kDocumentExtensions)};

// ---------------------------------------------------------------- the copy

// "bufferViews" -> "buffer view".
std::string nounOf(std::string_view array) {
    if (array == "meshes") return "mesh";
    if (array == "bufferViews") return "buffer view";
    return std::string(array.substr(0, array.size() - 1));
}

class Copier {
  public:
    Copier(const Json& document, GltfReport& report) : document_(document), report_(report) {}

    // Nothing if a needed field is missing. `isDocument`: places have no dot before their keys.
    std::optional<Json> object(const Json& in, std::span<const Field> fields,
                               const std::string& place) {
        Json out = Json::object();
        for (const Field& field : fields) {
            const auto it = in.find(field.key);
            const std::string at = place.empty() ? field.key : place + "." + field.key;
            std::optional<Json> copy;
            if (it != in.end()) {
                copy = value(*it, field, at);
            } else if (field.rule == required || field.rule == needed) {
                wrong(field, at, "it is missing");
            }
            if (copy) {
                out[field.key] = std::move(*copy);
            } else if (field.rule == needed) {
                return std::nullopt;
            } else if (field.kind == Kind::objects || field.kind == Kind::indices) {
                out[field.key] = Json::array();
            } else if (field.kind == Kind::map) {
                out[field.key] = Json::object();
            }
        }
        return out;
    }

  private:
    std::nullopt_t wrong(const Field& field, const std::string& place, const std::string& reason) {
        if (field.rule == optional || field.rule == required) report_.fail(place, reason);
        report_.warn(place, reason + (field.rule == needed ? "; drawn without it"
                                                           : "; the default is taken"));
        return std::nullopt;
    }

    std::size_t count(std::string_view array) const {
        const Json::json_pointer path((array == kLights     ? "/extensions/KHR_lights_punctual/"
                                       : array == kVariants ? "/extensions/KHR_materials_variants/"
                                                            : "/") +
                                      std::string(array));
        return document_.contains(path) && document_.at(path).is_array() ? document_.at(path).size()
                                                                         : 0;
    }

    std::optional<Json> integerValue(const Json& in, const Field& field, const std::string& place) {
        const double number = in.is_number() ? in.get<double>() : 0.5;
        if (!(std::abs(number) <= kMost) || number != std::floor(number)) {
            return wrong(field, place, "it must be an integer, not " + printable(in.dump()));
        }
        const auto integer = static_cast<std::int64_t>(number);
        const std::string text = std::to_string(integer);
        if (number < 0) return wrong(field, place, "it is negative (" + text + ")");
        if (field.kind == Kind::integer && *field.of && !isOneOf(text, field.of)) {
            return wrong(field, place, text + " is none of " + field.of);
        }
        if (number < field.low || number > field.high) {
            return wrong(field, place, "it is " + text + ", which is out of range");
        }
        if (field.kind != Kind::integer && *field.of) {
            const std::size_t limit = count(field.of);
            if (static_cast<std::uint64_t>(integer) >= limit) {
                return wrong(field, place,
                             "it refers to " + nounOf(field.of) + " " + text +
                                 ", but the file has " + std::to_string(limit));
            }
        }
        return Json(static_cast<std::uint64_t>(integer));
    }

    std::optional<Json> numberArray(const Json& in, const Field& field, const std::string& place) {
        const bool fits = in.is_array() && (field.size == 0 || in.size() == field.size) &&
                          std::all_of(in.begin(), in.end(), [](const Json& entry) {
                              return entry.is_number() && std::isfinite(entry.get<double>());
                          });
        if (!fits) {
            return wrong(field, place,
                         "it must be an array of " +
                             (field.size > 0 ? std::to_string(field.size) + " " : std::string()) +
                             "finite numbers");
        }
        Json out = Json::array();
        bool clamped = false;
        for (const Json& entry : in) {
            out.push_back(std::clamp(entry.get<double>(), field.low, field.high));
            clamped = clamped || out.back() != entry;
        }
        if (clamped) report_.warn(place, "it is out of range and clamped");
        return out;
    }

    std::optional<Json> value(const Json& in, const Field& field, const std::string& place) {
        switch (field.kind) {
            case Kind::flag:
                return in.is_boolean() ? std::optional(in)
                                       : wrong(field, place, "it must be true or false");
            case Kind::integer:
            case Kind::index:
                return integerValue(in, field, place);
            case Kind::number: {
                Field one = field;
                one.size = 1;
                if (!in.is_number()) return wrong(field, place, "it must be a finite number");
                const auto numbers = numberArray(Json::array({in}), one, place);
                return numbers ? std::optional((*numbers)[0]) : std::nullopt;
            }
            case Kind::numbers:
                return numberArray(in, field, place);
            case Kind::word: {
                if (!in.is_string()) return wrong(field, place, "it must be a string");
                const auto& text = in.get_ref<const std::string&>();
                if (*field.of && !isOneOf(text, field.of)) {
                    return wrong(field, place, quote(text) + " is none of " + field.of);
                }
                return in;
            }
            case Kind::name:  // decoration: what is not a string is no name
                return in.is_string()
                           ? std::optional<Json>(printable(in.get_ref<const std::string&>()))
                           : std::nullopt;
            case Kind::object:
                if (!in.is_object()) return wrong(field, place, "it must be an object");
                return object(in, field.fields, place);
            case Kind::map: {
                if (!in.is_object()) return wrong(field, place, "it must be an object");
                Json out = Json::object();
                for (const auto& entry : in.items()) {
                    out[entry.key()] =
                        *integerValue(entry.value(), field, place + "." + printable(entry.key()));
                }
                return out;
            }
            case Kind::objects:
            case Kind::indices: {
                if (!in.is_array()) return wrong(field, place, "it must be an array");
                Json out = Json::array();
                for (std::size_t i = 0; i < in.size(); ++i) {
                    const std::string at = element(place, i);
                    if (field.kind == Kind::indices) {
                        out.push_back(*integerValue(in[i], field, at));
                        continue;
                    }
                    Field one = field;
                    one.kind = Kind::object;
                    out.push_back(value(in[i], one, at).value_or(Json::object()));
                }
                return out;
            }
        }
        return std::nullopt;
    }

    const Json& document_;
    GltfReport& report_;
};

}  // namespace

bool isOneOf(std::string_view word, std::string_view words) {
    while (!words.empty()) {
        const std::size_t end = std::min(words.find(' '), words.size());
        if (words.substr(0, end) == word) return true;
        words.remove_prefix(std::min(end + 1, words.size()));
    }
    return false;
}

Json copyGltfFields(const Json& document, GltfReport& report) {
    return *Copier(document, report).object(document, kDocument, "");
}

}  // namespace mv
