#include "megaviews/scene/gltf_check.h"

#include <algorithm>
#include <array>
#include <unordered_set>

#include "megaviews/scene/gltf_check_looks.h"
#include "megaviews/scene/json_reader.h"

namespace mv {

namespace {

using Json = nlohmann::json;

// Elements of an accessor that no bytes in the file stand for.
constexpr std::uint64_t kMostZeroElements = std::uint64_t{1} << 22;

std::string element(const std::string& array, std::size_t i) {
    return array + "[" + std::to_string(i) + "]";
}

int componentBytes(int componentType) {
    switch (componentType) {
        case 5120:
        case 5121:
            return 1;
        case 5122:
        case 5123:
            return 2;
        case 5125:
        case 5126:
            return 4;
        default:
            return 0;
    }
}

class Checker {
  public:
    Checker(const GltfFile& file, GltfReport& report)
        : file_(file), root_(file.json, "JSON", report), report_(report) {}

    CheckedGltf run();

  private:
    // Applies `copy` to each object of a top-level array and stores what it returns.
    template <typename Copy>
    void copyEach(const char* key, Copy copy) {
        const Json& in = topArray(key);
        if (in.empty()) return;
        Json& out = result_.json[key] = Json::array();
        for (std::size_t i = 0; i < in.size(); ++i) {
            out.push_back(copy(JsonReader(in[i], element(key, i), report_)));
        }
    }
    const Json& topArray(const char* key) const {
        static const Json kNone = Json::array();
        const Json* value = root_.find(key);
        if (!value) return kNone;
        if (!value->is_array()) report_.fail(key, "it must be an array");
        return *value;
    }
    std::size_t count(const char* key) const { return topArray(key).size(); }

    Json bufferView(const JsonReader& in) const;
    void checkRange(const JsonReader& in, const char* viewKey, std::uint64_t count,
                    std::size_t elementBytes, bool mayStride) const;
    Json accessor(const JsonReader& in) const;
    Json mesh(const JsonReader& in) const;
    Json primitive(const JsonReader& in) const;
    Json node(const JsonReader& in, std::size_t index);
    Json scene(const JsonReader& in) const;
    Json skin(const JsonReader& in) const;
    Json animation(const JsonReader& in) const;
    void checkCycles(const std::vector<std::vector<std::size_t>>& children) const;
    void listIgnoredExtensions();

    // What an accessor is used for decides which types it may have.
    struct Use {
        const char* types;  // for the message
        std::array<const char*, 2> allowed;
        bool floatOnly = false;
    };
    const Json& usedAccessor(const JsonReader& in, const char* key, const Use& use) const;
    std::uint64_t accessorCount(const Json& accessor) const {
        return accessor["count"].get<std::uint64_t>();
    }

    const GltfFile& file_;
    JsonReader root_;
    GltfReport& report_;
    CheckedGltf result_;
    std::vector<std::int64_t> parents_;
    std::vector<std::vector<std::size_t>> children_;
};

Json Checker::bufferView(const JsonReader& in) const {
    const std::size_t buffer = in.requireIndex("buffer", file_.buffers.size(), "buffer");
    const std::uint64_t offset = in.count("byteOffset").value_or(0);
    const std::uint64_t length = in.requireCount("byteLength");
    const std::uint64_t available = file_.buffers[buffer].size();
    if (offset > available || length > available - offset) {
        report_.fail(in.place(), std::to_string(length) + " bytes from offset " +
                                     std::to_string(offset) + " run past the end of buffers[" +
                                     std::to_string(buffer) + "], which holds " +
                                     std::to_string(available));
    }
    if (length == 0) in.fail("byteLength", "it is 0");
    Json out = {{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", length}};
    if (const auto stride = in.count("byteStride")) {
        if (*stride < 4 || *stride > 252 || *stride % 4 != 0) {
            in.fail("byteStride", "it is " + std::to_string(*stride) +
                                      "; it must be a multiple of 4 from 4 to 252");
        }
        out["byteStride"] = *stride;
    }
    return out;
}

// `in` names a buffer view and an offset; `count` elements of it must lie inside.
void Checker::checkRange(const JsonReader& in, const char* viewKey, std::uint64_t elements,
                         std::size_t elementBytes, bool mayStride) const {
    const std::size_t view = in.requireIndex(viewKey, count("bufferViews"), "buffer view");
    const Json& checked = result_.json["bufferViews"][view];
    const std::uint64_t length = checked["byteLength"].get<std::uint64_t>();
    const std::uint64_t stride =
        mayStride ? checked.value("byteStride", std::uint64_t{elementBytes}) : elementBytes;
    const std::uint64_t offset = in.count("byteOffset").value_or(0);
    if (stride < elementBytes) {
        report_.fail(in.place(), "its elements take " + std::to_string(elementBytes) +
                                     " bytes, the byteStride of bufferViews[" +
                                     std::to_string(view) + "] is " + std::to_string(stride));
    }
    // No overflow: both factors are below 2^32, checked by the caller for the first.
    const std::uint64_t needed = elements == 0 ? 0 : (elements - 1) * stride + elementBytes;
    if (offset > length || needed > length - offset) {
        report_.fail(in.place(), "count " + std::to_string(elements) + " needs " +
                                     std::to_string(needed) + " bytes from offset " +
                                     std::to_string(offset) + ", bufferViews[" +
                                     std::to_string(view) + "] holds " + std::to_string(length));
    }
}

Json Checker::accessor(const JsonReader& in) const {
    const std::uint64_t componentType = in.requireCount("componentType");
    if (componentType > 5126 || componentBytes(static_cast<int>(componentType)) == 0) {
        in.fail("componentType", std::to_string(componentType) + " is no component type of glTF");
    }
    const auto type = in.text("type");
    if (!type) in.fail("type", "it is missing");
    const std::size_t bytes = accessorElementBytes(static_cast<int>(componentType), *type);
    if (bytes == 0) in.fail("type", quote(*type) + " is no type of glTF");
    const std::uint64_t elements = in.requireCount("count");
    if (elements == 0) in.fail("count", "it is 0");
    if (elements > UINT32_MAX) {
        in.fail("count", std::to_string(elements) + " elements are more than any file may have");
    }
    Json out = {{"componentType", componentType}, {"type", *type}, {"count", elements}};
    if (const Json* normalized = in.find("normalized")) {
        if (!normalized->is_boolean()) in.fail("normalized", "it must be true or false");
        out["normalized"] = *normalized;
    }
    if (in.find("bufferView")) {
        checkRange(in, "bufferView", elements, bytes, true);
        out["bufferView"] = in.requireIndex("bufferView", count("bufferViews"), "buffer view");
        out["byteOffset"] = in.count("byteOffset").value_or(0);
    } else {
        if (elements > kMostZeroElements) {
            report_.fail(in.place(),
                         "count " + std::to_string(elements) + " without a buffer view; at most " +
                             std::to_string(kMostZeroElements) + " zeros are supported");
        }
        out["bufferView"] = count("bufferViews");
    }
    if (in.find("sparse")) {
        const JsonReader sparse = in.object("sparse");
        const std::uint64_t replaced = sparse.requireCount("count");
        if (replaced == 0 || replaced > elements) {
            sparse.fail("count", "it is " + std::to_string(replaced) + ", the accessor has " +
                                     std::to_string(elements) + " elements");
        }
        const JsonReader indices = sparse.object("indices"), values = sparse.object("values");
        const std::uint64_t indexType = indices.requireCount("componentType");
        if (indexType != 5121 && indexType != 5123 && indexType != 5125) {
            indices.fail("componentType", "it must be 5121, 5123 or 5125");
        }
        checkRange(indices, "bufferView", replaced,
                   static_cast<std::size_t>(componentBytes(static_cast<int>(indexType))), false);
        checkRange(values, "bufferView", replaced, bytes, false);
        const auto part = [&](const JsonReader& reader) {
            return Json{{"bufferView", *reader.count("bufferView")},
                        {"byteOffset", reader.count("byteOffset").value_or(0)}};
        };
        out["sparse"] = {{"count", replaced}, {"indices", part(indices)}, {"values", part(values)}};
        out["sparse"]["indices"]["componentType"] = indexType;
    }
    return out;
}

// The checked accessor that in[key] names, of a type that `use` allows.
const Json& Checker::usedAccessor(const JsonReader& in, const char* key, const Use& use) const {
    const std::size_t index = in.requireIndex(key, count("accessors"), "accessor");
    const Json& accessor = result_.json["accessors"][index];
    const auto& type = accessor["type"].get_ref<const std::string&>();
    const bool typeOk = type == use.allowed[0] || (use.allowed[1] && type == use.allowed[1]);
    if (!typeOk || (use.floatOnly && accessor["componentType"] != 5126)) {
        in.fail(key, "it must be " + std::string(use.types) + ", but " +
                         element("accessors", index) + " is " + type + " of component type " +
                         accessor["componentType"].dump());
    }
    return accessor;
}

Json Checker::primitive(const JsonReader& in) const {
    Json out = Json::object();
    const std::uint64_t mode = in.count("mode").value_or(4);
    if (mode > 6) in.fail("mode", std::to_string(mode) + " is no primitive mode");
    out["mode"] = mode;

    const JsonReader attributes = in.object("attributes");
    Json& outAttributes = out["attributes"] = Json::object();
    const bool quantised =
        std::any_of(topArray("extensionsUsed").begin(), topArray("extensionsUsed").end(),
                    [](const Json& name) { return name == "KHR_mesh_quantization"; });
    const Use position = {"VEC3 of floats", {"VEC3", nullptr}, !quantised};
    std::optional<std::uint64_t> vertices;
    if (attributes.find("POSITION")) {
        const Json& accessor = usedAccessor(attributes, "POSITION", position);
        vertices = accessorCount(accessor);
        if (accessor["bufferView"] == count("bufferViews") && !accessor.contains("sparse") &&
            in.hasExtension("KHR_draco_mesh_compression")) {
            in.fail("extensions",
                    "the mesh exists only as KHR_draco_mesh_compression, which this "
                    "program does not support");
        }
    }
    for (const auto& [name, value] : attributes.json().items()) {
        const auto numbered = [&](std::string_view prefix) {
            return name.size() == prefix.size() + 1 && name.starts_with(prefix) &&
                   name.back() >= '0' && name.back() <= '7';
        };
        Use use{};
        if (name == "POSITION") {
            use = position;
        } else if (name == "NORMAL") {
            use = {"VEC3", {"VEC3", nullptr}};
        } else if (name == "COLOR_0") {
            use = {"VEC3 or VEC4", {"VEC3", "VEC4"}};
        } else if (numbered("TEXCOORD_")) {
            use = {"VEC2", {"VEC2", nullptr}};
        } else if (numbered("JOINTS_") || numbered("WEIGHTS_")) {
            use = {"VEC4", {"VEC4", nullptr}};
        } else {
            continue;  // tangents, further colours, an application's own
        }
        const Json& accessor = usedAccessor(attributes, name.c_str(), use);
        if (vertices && accessorCount(accessor) != *vertices) {
            attributes.fail(name.c_str(), "it has " + std::to_string(accessorCount(accessor)) +
                                              " elements, POSITION has " +
                                              std::to_string(*vertices));
        }
        outAttributes[name] = *integerValue(value);
    }
    if (in.find("indices")) {
        const Json& accessor = usedAccessor(in, "indices", {"SCALAR", {"SCALAR", nullptr}});
        const int type = accessor["componentType"].get<int>();
        if (type != 5121 && type != 5123 && type != 5125) {
            in.fail("indices", "indices must be unsigned bytes, shorts or ints");
        }
        out["indices"] = *in.count("indices");
    }
    if (const Json* material = in.find("material")) {
        const auto index = integerValue(*material);
        if (index && *index >= 0 && static_cast<std::uint64_t>(*index) < count("materials")) {
            out["material"] = *index;
        } else {
            in.warn("material", "it refers to material " + printable(material->dump()) +
                                    ", but the file has " + std::to_string(count("materials")) +
                                    "; the default material is taken");
        }
    }
    const Json& targets = in.array("targets");
    for (std::size_t i = 0; i < targets.size(); ++i) {
        const JsonReader target(targets[i], element(in.at("targets"), i), report_);
        Json outTarget = Json::object();
        for (const char* name : {"POSITION", "NORMAL"}) {
            if (!target.find(name)) continue;
            const Json& accessor = usedAccessor(target, name, {"VEC3", {"VEC3", nullptr}});
            if (vertices && accessorCount(accessor) != *vertices) {
                target.fail(name, "it has " + std::to_string(accessorCount(accessor)) +
                                      " elements, the mesh has " + std::to_string(*vertices));
            }
            outTarget[name] = *target.count(name);
        }
        out["targets"].push_back(std::move(outTarget));
    }
    return out;
}

Json Checker::mesh(const JsonReader& in) const {
    Json out = {{"primitives", Json::array()}};
    if (std::string name = in.name(); !name.empty()) out["name"] = std::move(name);
    const Json& primitives = in.array("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        out["primitives"].push_back(
            primitive(JsonReader(primitives[i], element(in.at("primitives"), i), report_)));
    }
    if (auto weights = in.numbers("weights", 0)) out["weights"] = std::move(*weights);
    return out;
}

Json Checker::node(const JsonReader& in, std::size_t index) {
    Json out = Json::object();
    if (std::string name = in.name(); !name.empty()) out["name"] = std::move(name);
    if (auto matrix = in.numbers("matrix", 16)) {
        out["matrix"] = std::move(*matrix);
    } else {
        if (auto values = in.numbers("translation", 3)) out["translation"] = std::move(*values);
        if (auto values = in.numbers("rotation", 4)) out["rotation"] = std::move(*values);
        if (auto values = in.numbers("scale", 3)) out["scale"] = std::move(*values);
    }
    if (const auto mesh = in.index("mesh", count("meshes"), "mesh")) out["mesh"] = *mesh;
    if (const auto skin = in.index("skin", count("skins"), "skin")) out["skin"] = *skin;
    if (const auto camera = in.index("camera", count("cameras"), "camera")) out["camera"] = *camera;
    if (auto weights = in.numbers("weights", 0)) out["weights"] = std::move(*weights);

    const Json& children = in.array("children");
    for (std::size_t i = 0; i < children.size(); ++i) {
        const std::string place = element(in.at("children"), i);
        const auto child = integerValue(children[i]);
        if (!child || *child < 0 || static_cast<std::uint64_t>(*child) >= count("nodes")) {
            report_.fail(place, "it refers to node " + printable(children[i].dump()) +
                                    ", but the file has " + std::to_string(count("nodes")));
        }
        const auto c = static_cast<std::size_t>(*child);
        children_[index].push_back(c);
        if (parents_[c] >= 0) {
            report_.warn(place, "node " + std::to_string(c) + " is already a child of node " +
                                    std::to_string(parents_[c]) + "; it is drawn there only");
            continue;
        }
        parents_[c] = static_cast<std::int64_t>(index);
        out["children"].push_back(c);
    }

    if (in.hasExtension("KHR_lights_punctual")) {
        const std::size_t lights = punctualLights(file_.json, report_).size();
        out["extensions"]["KHR_lights_punctual"]["light"] =
            in.extension("KHR_lights_punctual").requireIndex("light", lights, "light");
    }
    if (in.hasExtension("EXT_mesh_gpu_instancing")) {
        const JsonReader attributes = in.extension("EXT_mesh_gpu_instancing").object("attributes");
        std::optional<std::uint64_t> instances;
        for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
            if (!attributes.find(name)) continue;
            const bool rotation = name[0] == 'R';
            const Json& accessor =
                usedAccessor(attributes, name,
                             rotation ? Use{"VEC4", {"VEC4", nullptr}}
                                      : Use{"VEC3 of floats", {"VEC3", nullptr}, true});
            if (instances && accessorCount(accessor) != *instances) {
                attributes.fail(name, "it has " + std::to_string(accessorCount(accessor)) +
                                          " elements, other attributes of the instances have " +
                                          std::to_string(*instances));
            }
            instances = accessorCount(accessor);
            out["extensions"]["EXT_mesh_gpu_instancing"]["attributes"][name] =
                *attributes.count(name);
        }
    }
    return out;
}

// Repeatedly removes nodes that nobody is the parent of; what is left contains a cycle.
void Checker::checkCycles(const std::vector<std::vector<std::size_t>>& children) const {
    std::vector<std::size_t> incoming(children.size(), 0), free;
    for (const auto& list : children) {
        for (const std::size_t child : list) ++incoming[child];
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
        if (incoming[i] == 0) free.push_back(i);
    }
    std::size_t removed = 0;
    while (!free.empty()) {
        const std::size_t node = free.back();
        free.pop_back();
        ++removed;
        for (const std::size_t child : children[node]) {
            if (--incoming[child] == 0) free.push_back(child);
        }
    }
    if (removed == children.size()) return;

    // Walk down among the nodes that are left until one comes up again.
    std::vector<std::size_t> left;
    std::vector<std::size_t> seenAt(children.size(), SIZE_MAX), path;
    std::size_t node = 0;
    const auto isLeft = [&](std::size_t i) { return incoming[i] > 0; };
    while (!isLeft(node)) ++node;
    // A left node may hang below a cycle with only removed children: go up instead, to a parent.
    std::vector<std::size_t> parentLeft(children.size(), SIZE_MAX);
    for (std::size_t i = 0; i < children.size(); ++i) {
        if (!isLeft(i)) continue;
        for (const std::size_t child : children[i]) {
            if (isLeft(child)) parentLeft[child] = i;
        }
    }
    while (seenAt[node] == SIZE_MAX) {
        seenAt[node] = path.size();
        path.push_back(node);
        node = parentLeft[node];
    }
    std::string cycle = std::to_string(node);
    std::size_t shown = 0;
    for (std::size_t i = path.size(); i-- > seenAt[node];) {
        if (++shown > 8) {
            cycle += " -> ...";
            break;
        }
        cycle += " -> " + std::to_string(path[i]);
    }
    report_.fail("nodes", "the nodes' children form a cycle: " + cycle);
}

Json Checker::scene(const JsonReader& in) const {
    Json out = {{"nodes", Json::array()}};
    if (std::string name = in.name(); !name.empty()) out["name"] = std::move(name);
    const Json& nodes = in.array("nodes");
    std::unordered_set<std::int64_t> seen;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto node = integerValue(nodes[i]);
        const std::string place = element(in.at("nodes"), i);
        if (!node || *node < 0 || static_cast<std::uint64_t>(*node) >= count("nodes")) {
            report_.fail(place, "it refers to node " + printable(nodes[i].dump()) +
                                    ", but the file has " + std::to_string(count("nodes")));
        }
        if (!seen.insert(*node).second) {
            report_.warn(place, "node " + std::to_string(*node) + " is listed twice; drawn once");
            continue;
        }
        out["nodes"].push_back(*node);
    }
    return out;
}

Json Checker::skin(const JsonReader& in) const {
    const Json& joints = in.array("joints");
    if (joints.empty()) in.fail("joints", "a skin needs at least one joint");
    Json out = {{"joints", Json::array()}};
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const auto joint = integerValue(joints[i]);
        if (!joint || *joint < 0 || static_cast<std::uint64_t>(*joint) >= count("nodes")) {
            report_.fail(element(in.at("joints"), i),
                         "it refers to node " + printable(joints[i].dump()) +
                             ", but the file has " + std::to_string(count("nodes")));
        }
        out["joints"].push_back(*joint);
    }
    if (in.find("inverseBindMatrices")) {
        const Json& accessor =
            usedAccessor(in, "inverseBindMatrices", {"MAT4 of floats", {"MAT4", nullptr}, true});
        if (accessorCount(accessor) < joints.size()) {
            in.fail("inverseBindMatrices", std::to_string(accessorCount(accessor)) +
                                               " matrices for " + std::to_string(joints.size()) +
                                               " joints");
        }
        out["inverseBindMatrices"] = *in.count("inverseBindMatrices");
    }
    return out;
}

Json Checker::animation(const JsonReader& in) const {
    Json out = {{"channels", Json::array()}, {"samplers", Json::array()}};
    if (std::string name = in.name(); !name.empty()) out["name"] = std::move(name);
    const Json& samplers = in.array("samplers");
    for (std::size_t i = 0; i < samplers.size(); ++i) {
        const JsonReader sampler(samplers[i], element(in.at("samplers"), i), report_);
        usedAccessor(sampler, "input", {"SCALAR of floats", {"SCALAR", nullptr}, true});
        sampler.requireIndex("output", count("accessors"), "accessor");
        const std::string interpolation = sampler.text("interpolation").value_or("LINEAR");
        if (interpolation != "LINEAR" && interpolation != "STEP" &&
            interpolation != "CUBICSPLINE") {
            sampler.fail("interpolation", quote(interpolation) + " is no interpolation of glTF");
        }
        out["samplers"].push_back({{"input", *sampler.count("input")},
                                   {"output", *sampler.count("output")},
                                   {"interpolation", interpolation}});
    }
    const Json& channels = in.array("channels");
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const JsonReader channel(channels[i], element(in.at("channels"), i), report_);
        const std::size_t s = channel.requireIndex("sampler", samplers.size(), "sampler");
        const JsonReader target = channel.object("target");
        const auto node = target.index("node", count("nodes"), "node");
        const auto path = target.text("path");
        if (!path) target.fail("path", "it is missing");
        const bool weights = *path == "weights";
        const bool known =
            weights || *path == "translation" || *path == "rotation" || *path == "scale";
        if (!node || !known) continue;  // aimed at by an extension
        const JsonReader sampler(samplers[s], element(in.at("samplers"), s), report_);
        const Json& input = usedAccessor(sampler, "input", {"SCALAR", {"SCALAR", nullptr}});
        const Json& output = usedAccessor(sampler, "output",
                                          weights               ? Use{"SCALAR", {"SCALAR", nullptr}}
                                          : *path == "rotation" ? Use{"VEC4", {"VEC4", nullptr}}
                                                                : Use{"VEC3", {"VEC3", nullptr}});
        const std::uint64_t keys =
            accessorCount(input) *
            (sampler.text("interpolation").value_or("LINEAR") == "CUBICSPLINE" ? 3u : 1u);
        const std::uint64_t values = accessorCount(output);
        if (weights ? values % keys != 0 : values != keys) {
            sampler.fail("output", std::to_string(values) + " values do not fit " +
                                       std::to_string(accessorCount(input)) + " keys");
        }
        out["channels"].push_back({{"sampler", s}, {"target", {{"node", *node}, {"path", *path}}}});
    }
    return out;
}

void Checker::listIgnoredExtensions() {
    for (const Json& name : topArray("extensionsUsed")) {
        if (name.is_string() && !extensionSupported(name.get_ref<const std::string&>())) {
            result_.ignored.insert(printable(name.get_ref<const std::string&>()));
        }
    }
}

CheckedGltf Checker::run() {
    result_.json = {{"asset", {{"version", "2.0"}}}};
    result_.absentView = static_cast<int>(count("bufferViews"));
    for (const char* key : {"nodes", "meshes", "accessors", "bufferViews", "materials"}) {
        if (count(key) > INT32_MAX / 2) report_.fail(key, "it has too many entries");
    }
    for (std::size_t i = 0; i < file_.buffers.size(); ++i) {
        result_.json["buffers"].push_back(
            {{"byteLength", file_.buffers[i].size()}, {"uri", std::to_string(i)}});
    }
    copyEach("bufferViews", [&](const JsonReader& in) { return bufferView(in); });
    copyEach("accessors", [&](const JsonReader& in) { return accessor(in); });
    copyEach("meshes", [&](const JsonReader& in) { return mesh(in); });

    parents_.assign(count("nodes"), -1);
    children_.resize(count("nodes"));
    std::size_t index = 0;
    copyEach("nodes", [&](const JsonReader& in) { return node(in, index++); });
    checkCycles(children_);
    copyEach("scenes", [&](const JsonReader& in) { return scene(in); });
    if (const auto scene = root_.index("scene", count("scenes"), "scene")) {
        result_.json["scene"] = *scene;
    }
    copyEach("skins", [&](const JsonReader& in) { return skin(in); });
    copyEach("animations", [&](const JsonReader& in) { return animation(in); });
    copyCheckedLooks(file_.json, report_, result_.json, result_.ignored);
    listIgnoredExtensions();

    // tinygltf wants indices to have a buffer view: the one for absent views must exist there.
    result_.json["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});
    return std::move(result_);
}

}  // namespace

std::size_t accessorElementBytes(int componentType, const std::string& type) {
    const auto bytes = static_cast<std::size_t>(componentBytes(componentType));
    const auto matrix = [&](std::size_t n) { return n * ((n * bytes + 3) / 4 * 4); };
    if (type == "SCALAR") return bytes;
    if (type == "VEC2") return 2 * bytes;
    if (type == "VEC3") return 3 * bytes;
    if (type == "VEC4") return 4 * bytes;
    if (type == "MAT2") return matrix(2);
    if (type == "MAT3") return matrix(3);
    if (type == "MAT4") return matrix(4);
    return 0;
}

CheckedGltf checkGltf(const GltfFile& file, GltfReport& report) {
    return Checker(file, report).run();
}

}  // namespace mv
