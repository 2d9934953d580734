#include "megaviews/scene/gltf_check.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <unordered_set>

#include "megaviews/scene/gltf_compressed.h"
#include "megaviews/scene/gltf_fields.h"

namespace mv {

namespace {

using Json = nlohmann::json;

// Elements of an accessor that no bytes in the file stand for.
constexpr std::uint64_t kMostZeroElements = std::uint64_t{1} << 22;

constexpr std::size_t componentBytes(int componentType) {
    constexpr std::array<std::size_t, 7> kBytes = {1, 1, 2, 2, 0, 4, 4};
    return kBytes[static_cast<std::size_t>(componentType - 5120)];
}

std::uint64_t number(const Json& object, const char* key, std::uint64_t otherwise = 0) {
    const auto it = object.find(key);
    return it == object.end() ? otherwise : it->get<std::uint64_t>();
}

// What depends on more than one value of the document. Types and indices are right already.
class Checker {
  public:
    Checker(GltfFile& file, GltfReport& report)
        : file_(file), report_(report), json_(copyGltfFields(file.json, report)) {}

    CheckedGltf run(const Progress& progress) {
        declaredExtensions();
        each("bufferViews", &Checker::bufferView);
        each("meshes", &Checker::emptyPrimitives);
        unpackCompressed(json_, file_, report_, progress);
        each("accessors", &Checker::accessor);
        each("meshes", &Checker::mesh);
        parents_.assign(json_["nodes"].size(), -1);
        each("nodes", &Checker::node);
        checkCycles();
        each("scenes", &Checker::scene);
        each("skins", &Checker::skin);
        each("animations", &Checker::animation);
        each("materials", &Checker::material);
        each("textures", &Checker::texture);
        each("cameras", &Checker::camera);
        const Json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        for (std::size_t i = 0; json_.contains(lights) && i < json_[lights].size(); ++i) {
            light(json_[lights][i], element("extensions.KHR_lights_punctual.lights", i));
        }

        json_["asset"] = {{"version", "2.0"}};
        for (std::size_t i = 0; i < file_.buffers.size(); ++i) {
            json_["buffers"].push_back(
                {{"byteLength", file_.buffers[i].size()}, {"uri", std::to_string(i)}});
        }
        // tinygltf wants indices to have a buffer view: the one for absent views must exist there.
        json_["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
        return {std::move(json_), std::move(ignored_), std::move(extensions_)};
    }

  private:
    using Check = void (Checker::*)(Json& in, const std::string& place, std::size_t i);
    void each(const char* array, Check check) {
        for (std::size_t i = 0; i < json_[array].size(); ++i) {
            (this->*check)(json_[array][i], element(array, i), i);
        }
    }

    void bufferView(Json& view, const std::string& place, std::size_t) {
        const auto buffer = view["buffer"].get<std::size_t>();
        const Json::json_pointer packed("/extensions/EXT_meshopt_compression");
        std::uint64_t available = file_.buffers[buffer].size();
        if (const std::uint64_t length = file_.fallbackBytes[buffer]; length > 0) {
            if (!view.contains(packed)) {
                report_.fail(place, "its bytes are those of " + element("buffers", buffer) +
                                        ", which has none: it is a fallback buffer");
            }
            available = length;
        }
        checkBytes(view, place, available);
        if (number(view, "byteStride") % 4 != 0) {
            report_.fail(place + ".byteStride",
                         "it is " + view["byteStride"].dump() + "; it must be a multiple of 4");
        }
        if (!view.contains(packed)) return;
        const auto from = view[packed]["buffer"].get<std::size_t>();
        const std::string inside = place + ".extensions.EXT_meshopt_compression";
        if (file_.fallbackBytes[from] > 0) {
            report_.fail(inside, element("buffers", from) + " is a fallback buffer");
        }
        checkBytes(view[packed], inside, file_.buffers[from].size());
    }

    // `part` names bytes of a buffer that has `available`.
    void checkBytes(const Json& part, const std::string& place, std::uint64_t available) {
        const std::uint64_t offset = number(part, "byteOffset"),
                            length = number(part, "byteLength");
        if (offset <= available && length <= available - offset) return;
        report_.fail(place, std::to_string(length) + " bytes from offset " +
                                std::to_string(offset) + " run past the end of " +
                                element("buffers", part["buffer"].get<std::size_t>()) +
                                ", which holds " + std::to_string(available));
    }

    // `part` names a buffer view and an offset; `elements` of it must lie inside.
    void checkRange(const Json& part, const std::string& place, std::uint64_t elements,
                    std::size_t elementBytes, bool mayStride) {
        const auto index = part["bufferView"].get<std::size_t>();
        const Json& view = json_["bufferViews"][index];
        const std::uint64_t length = number(view, "byteLength"),
                            offset = number(part, "byteOffset");
        const std::uint64_t stride =
            mayStride ? number(view, "byteStride", elementBytes) : elementBytes;
        if (stride < elementBytes) {
            report_.fail(place, "its elements take " + std::to_string(elementBytes) +
                                    " bytes, the byteStride of " + element("bufferViews", index) +
                                    " is " + std::to_string(stride));
        }
        // No overflow: the first factor is below 2^32, the second below 2^8.
        const std::uint64_t needed = (elements - 1) * stride + elementBytes;
        if (offset > length || needed > length - offset) {
            report_.fail(place, "count " + std::to_string(elements) + " needs " +
                                    std::to_string(needed) + " bytes from offset " +
                                    std::to_string(offset) + ", " + element("bufferViews", index) +
                                    " holds " + std::to_string(length));
        }
    }

    // Exporters leave such where they have cut away all triangles of a part: they draw nothing.
    void emptyPrimitives(Json& in, const std::string&, std::size_t) {
        const auto isEmpty = [&](const Json& owner, const char* key) {
            return owner.contains(key) &&
                   json_["accessors"][owner[key].get<std::size_t>()]["count"] == 0;
        };
        for (Json& primitive : in["primitives"]) {
            if (!isEmpty(primitive, "indices") && !isEmpty(primitive["attributes"], "POSITION")) {
                continue;
            }
            primitive["attributes"] = Json::object();
            primitive["targets"] = Json::array();
            primitive.erase("indices");
            primitive.erase("extensions");
        }
    }

    void accessor(Json& in, const std::string& place, std::size_t) {
        const std::uint64_t elements = number(in, "count");
        if (elements == 0) {  // Nothing may use it.
            in["bufferView"] = json_["bufferViews"].size();
            in.erase("byteOffset");
            in.erase("sparse");
            return;
        }
        const std::size_t bytes = accessorElementBytes(in["componentType"].get<int>(), in["type"]);
        if (in.contains("bufferView")) {
            checkRange(in, place, elements, bytes, true);
        } else {
            if (elements > kMostZeroElements) {
                report_.fail(place, "count " + std::to_string(elements) +
                                        " without a buffer view; at most " +
                                        std::to_string(kMostZeroElements) + " zeros are supported");
            }
            in["bufferView"] = json_["bufferViews"].size();
        }
        if (!in.contains("sparse")) return;
        const Json& sparse = in["sparse"];
        const std::uint64_t replaced = number(sparse, "count");
        if (replaced > elements) {
            report_.fail(place + ".sparse.count", "it is " + std::to_string(replaced) +
                                                      ", the accessor has " +
                                                      std::to_string(elements) + " elements");
        }
        checkRange(sparse["indices"], place + ".sparse.indices", replaced,
                   componentBytes(sparse["indices"]["componentType"].get<int>()), false);
        checkRange(sparse["values"], place + ".sparse.values", replaced, bytes, false);
    }

    // The accessor that `owner[key]` names; what it is used for decides which types it may have and
    // how many elements: `count` of them, if that is known, which are those of `whose`.
    const Json& use(const Json& owner, const std::string& key, const std::string& place,
                    const char* types, bool floats = false, std::optional<std::uint64_t> count = {},
                    const char* whose = "POSITION has") {
        const auto index = owner.at(key).get<std::size_t>();
        const Json& accessor = json_["accessors"][index];
        const auto& type = accessor["type"].get_ref<const std::string&>();
        if (!isOneOf(type, types) || (floats && accessor["componentType"] != 5126)) {
            report_.fail(place + "." + key,
                         "it must be " + std::string(types) + (floats ? " of floats" : "") +
                             ", but " + element("accessors", index) + " is " + type +
                             " of component type " + accessor["componentType"].dump());
        }
        if (number(accessor, "count") == 0) {
            report_.fail(place + "." + key, element("accessors", index) + " has no elements");
        }
        if (count && number(accessor, "count") != *count) {
            report_.fail(place + "." + key, "it has " + accessor["count"].dump() + " elements, " +
                                                whose + " " + std::to_string(*count));
        }
        return accessor;
    }

    void mesh(Json& in, const std::string& place, std::size_t) {
        for (std::size_t i = 0; i < in["primitives"].size(); ++i) {
            primitive(in["primitives"][i], element(place + ".primitives", i));
        }
    }

    void primitive(Json& in, const std::string& place) {
        Json& attributes = in["attributes"];
        const std::string inside = place + ".attributes";
        const bool onlyFloats = !quantised_;
        std::optional<std::uint64_t> vertices;
        if (attributes.contains("POSITION")) {
            const Json& position = use(attributes, "POSITION", inside, "VEC3", onlyFloats);
            vertices = number(position, "count");
        }
        for (auto it = attributes.begin(); it != attributes.end();) {
            const std::string& name = it.key();
            const char* types = attributeTypes(name);
            if (types) {
                const Json& accessor = use(attributes, name, inside, types, false, vertices);
                if (name.starts_with("JOINTS_")) integers(accessor, inside + '.' + name, "joints");
                ++it;
            } else {
                it = attributes.erase(it);
            }
        }
        if (in.contains("indices")) {
            integers(use(in, "indices", place, "SCALAR"), place + ".indices", "indices");
        }
        for (std::size_t i = 0; i < in["targets"].size(); ++i) {
            const Json& target = in["targets"][i];
            for (const auto& entry : target.items()) {
                use(target, entry.key(), element(place + ".targets", i), "VEC3", false, vertices);
            }
        }
    }

    void integers(const Json& accessor, const std::string& place, const std::string& what) {
        if (isOneOf(accessor["componentType"].dump(), "5121 5123 5125")) return;
        report_.fail(place, what + " must be unsigned bytes, shorts or ints");
    }

    // Each node hangs on one parent: the first that names it.
    void node(Json& in, const std::string& place, std::size_t self) {
        Json children = Json::array();
        for (std::size_t i = 0; i < in["children"].size(); ++i) {
            const auto child = in["children"][i].get<std::size_t>();
            if (parents_[child] >= 0) {
                report_.warn(element(place + ".children", i),
                             "node " + std::to_string(child) + " is already a child of node " +
                                 std::to_string(parents_[child]) + "; it is drawn there only");
                continue;
            }
            parents_[child] = static_cast<std::int64_t>(self);
            children.push_back(child);
        }
        in["children"] = std::move(children);
        const Json::json_pointer attributes("/extensions/EXT_mesh_gpu_instancing/attributes");
        if (!in.contains(attributes)) return;
        const Json& instances = in[attributes];
        std::optional<std::uint64_t> count;
        for (const auto& entry : instances.items()) {
            const bool rotation = entry.key() == "ROTATION";
            count = number(use(instances, entry.key(),
                               place + ".extensions.EXT_mesh_gpu_instancing.attributes",
                               rotation ? "VEC4" : "VEC3", !rotation, count,
                               "other attributes of the instances have"),
                           "count");
        }
    }

    // Walks up from every node until it meets a root or a node that it has seen.
    void checkCycles() const {
        std::vector<std::int64_t> seenFrom(parents_.size(), -1);
        for (std::size_t i = 0; i < parents_.size(); ++i) {
            const auto from = static_cast<std::int64_t>(i);
            std::int64_t node = from;
            const auto at = [](std::int64_t n) { return static_cast<std::size_t>(n); };
            for (; node >= 0 && seenFrom[at(node)] < 0; node = parents_[at(node)]) {
                seenFrom[at(node)] = from;
            }
            if (node < 0 || seenFrom[at(node)] != from) continue;
            std::string cycle = std::to_string(node);
            int shown = 0;
            for (std::int64_t up = parents_[at(node)];; up = parents_[at(up)]) {
                const bool cut = ++shown > 8;
                cycle = (cut ? "..." : std::to_string(up)) + " -> " + cycle;
                if (cut || up == node) break;
            }
            report_.fail("nodes", "the nodes' children form a cycle: " + cycle);
        }
    }

    void scene(Json& in, const std::string& place, std::size_t) {
        std::unordered_set<std::uint64_t> seen;
        Json nodes = Json::array();
        for (std::size_t i = 0; i < in["nodes"].size(); ++i) {
            const auto node = in["nodes"][i].get<std::uint64_t>();
            if (seen.insert(node).second) {
                nodes.push_back(node);
            } else {
                report_.warn(element(place + ".nodes", i),
                             "node " + std::to_string(node) + " is listed twice; drawn once");
            }
        }
        in["nodes"] = std::move(nodes);
    }

    void skin(Json& in, const std::string& place, std::size_t) {
        const std::size_t joints = in["joints"].size();
        if (joints == 0) report_.fail(place + ".joints", "a skin needs at least one joint");
        if (!in.contains("inverseBindMatrices")) return;
        const Json& matrices = use(in, "inverseBindMatrices", place, "MAT4", true);
        if (number(matrices, "count") < joints) {
            report_.fail(
                place + ".inverseBindMatrices",
                matrices["count"].dump() + " matrices for " + std::to_string(joints) + " joints");
        }
    }

    void animation(Json& in, const std::string& place, std::size_t) {
        const Json& samplers = in["samplers"];
        for (std::size_t i = 0; i < samplers.size(); ++i) {
            use(samplers[i], "input", element(place + ".samplers", i), "SCALAR", true);
        }
        Json channels = Json::array();
        for (std::size_t i = 0; i < in["channels"].size(); ++i) {
            const Json& channel = in["channels"][i];
            const Json& target = channel["target"];
            const auto s = channel["sampler"].get<std::size_t>();
            if (s >= samplers.size()) {
                report_.fail(element(place + ".channels", i) + ".sampler",
                             "it refers to sampler " + std::to_string(s) +
                                 ", but the animation has " + std::to_string(samplers.size()));
            }
            const auto& path = target["path"].get_ref<const std::string&>();
            if (!target.contains("node") || !isOneOf(path, "translation rotation scale weights")) {
                continue;  // aimed at by an extension
            }
            const Json& sampler = samplers[s];
            const std::string samplerPlace = element(place + ".samplers", s);
            const bool weights = path == "weights";
            const std::uint64_t keys =
                number(use(sampler, "input", samplerPlace, "SCALAR"), "count");
            const std::uint64_t values = number(use(sampler, "output", samplerPlace,
                                                    weights              ? "SCALAR"
                                                    : path == "rotation" ? "VEC4"
                                                                         : "VEC3"),
                                                "count");
            const std::uint64_t parts =
                keys * (sampler.value("interpolation", "LINEAR") == "CUBICSPLINE" ? 3u : 1u);
            if (weights ? values % parts != 0 : values != parts) {
                report_.fail(samplerPlace + ".output", std::to_string(values) +
                                                           " values do not fit " +
                                                           std::to_string(keys) + " keys");
            }
            channels.push_back(channel);
        }
        in["channels"] = std::move(channels);
    }

    // ------------------------------------------------------------ looks: repaired, never refused

    void material(Json& in, const std::string&, std::size_t i) {
        const Json& original = file_.json["materials"][i];
        if (original.contains("emissiveTexture") && !in.contains("emissiveTexture")) {
            in["emissiveFactor"] = {0.0, 0.0, 0.0};  // better dark than all of it aglow
        }
        if (original.contains("occlusionTexture")) ignored_.insert("occlusion maps");
    }

    // An image in WebP stands for that in another format, which the file may hold as well.
    void texture(Json& in, const std::string&, std::size_t) {
        const Json::json_pointer webp("/extensions/EXT_texture_webp/source");
        if (in.contains(webp)) in["source"] = Json(in[webp]);
        in.erase("extensions");
    }

    void camera(Json& in, const std::string& place, std::size_t) {
        if (in.value("type", "") == "orthographic") {
            double ymag = std::abs(in.value(Json::json_pointer("/orthographic/ymag"), 0.0));
            if (!(ymag > 0)) {
                report_.warn(place + ".orthographic.ymag", "it is zero or missing, 1 is taken");
                ymag = 1;
            }
            in["orthographic"] = {{"xmag", ymag}, {"ymag", ymag}, {"znear", 0.0}, {"zfar", 1.0}};
            return;
        }
        in["type"] = "perspective";
        double yfov = in.value(Json::json_pointer("/perspective/yfov"), 0.0);
        if (!(yfov > 1e-3 && yfov < std::numbers::pi - 1e-3)) {
            report_.warn(place + ".perspective.yfov", "it is not between 0 and pi; 0.9 is taken");
            yfov = 0.9;
        }
        in["perspective"] = {{"yfov", yfov}, {"znear", 0.1}};
    }

    void light(Json& in, const std::string& place) {
        const std::string type = in.value("type", "");
        const bool known = isOneOf(type, "point spot directional");
        if (!known) {
            report_.warn(place + ".type",
                         "it is none of point, spot, directional; the light is off");
            in["type"] = "point";
            in["intensity"] = 0.0;
        }
        if (!in.contains("color")) in["color"] = {1.0, 1.0, 1.0};
        if (type != "spot") return;
        constexpr double kQuarterPi = std::numbers::pi / 4, kHalfPi = std::numbers::pi / 2;
        double inner = in.value(Json::json_pointer("/spot/innerConeAngle"), 0.0);
        double outer = in.value(Json::json_pointer("/spot/outerConeAngle"), kQuarterPi);
        if (!(outer > 0 && outer <= kHalfPi + 1e-6 && inner >= 0 && inner <= outer)) {
            report_.warn(place + ".spot",
                         "0 <= innerConeAngle < outerConeAngle <= pi/2 does not hold; clamped");
            outer = outer > 0 ? std::min(outer, kHalfPi) : kQuarterPi;
            inner = std::clamp(inner, 0.0, outer);
        }
        in["spot"] = {{"innerConeAngle", inner}, {"outerConeAngle", std::min(outer, kHalfPi)}};
    }

    // ------------------------------------------------------------ extensions by name

    // What the file says that it uses or requires.
    void declaredExtensions() {
        for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
            const auto names = file_.json.find(key);
            if (names == file_.json.end()) continue;
            if (!names->is_array()) report_.fail(key, "it must be an array");
            for (const Json& name : *names) {
                if (!name.is_string()) continue;
                const auto& extension = name.get_ref<const std::string&>();
                quantised_ = quantised_ || extension == "KHR_mesh_quantization";
                (extensionSupported(extension) ? extensions_ : ignored_)
                    .insert(printable(extension));
            }
        }
    }

    GltfFile& file_;
    GltfReport& report_;
    Json json_;
    std::set<std::string> ignored_, extensions_;
    bool quantised_ = false;
    std::vector<std::int64_t> parents_;  // of each node; -1: none
};

}  // namespace

std::size_t accessorElementBytes(int componentType, const std::string& type) {
    const std::size_t bytes = componentBytes(componentType);
    if (type == "SCALAR") return bytes;
    const auto n = static_cast<std::size_t>(type.back() - '0');
    return type.starts_with("VEC") ? n * bytes : n * ((n * bytes + 3) / 4 * 4);
}

const char* attributeTypes(std::string_view name) {
    const bool numbered = !name.empty() && name.back() >= '0' && name.back() <= '7';
    const std::string_view set = numbered ? name.substr(0, name.size() - 1) : name;
    if (name == "POSITION" || name == "NORMAL") return "VEC3";
    if (name == "COLOR_0") return "VEC3 VEC4";
    if (numbered && set == "TEXCOORD_") return "VEC2";
    if (numbered && (set == "JOINTS_" || set == "WEIGHTS_")) return "VEC4";
    return nullptr;
}

CheckedGltf checkGltf(GltfFile& file, GltfReport& report, const Progress& progress) {
    return Checker(file, report).run(progress);
}

}  // namespace mv
