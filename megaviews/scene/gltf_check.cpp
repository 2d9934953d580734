#include "megaviews/scene/gltf_check.h"

#include <algorithm>

#include "megaviews/scene/gltf_check_looks.h"
#include "megaviews/scene/gltf_checker.h"

namespace mv {

namespace {

using Json = nlohmann::json;

// Elements of an accessor that no bytes in the file stand for.
constexpr std::uint64_t kMostZeroElements = std::uint64_t{1} << 22;

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

}  // namespace

Json GltfChecker::bufferView(const JsonReader& in) const {
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
void GltfChecker::checkRange(const JsonReader& in, const char* viewKey, std::uint64_t elements,
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

Json GltfChecker::accessor(const JsonReader& in) const {
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
const Json& GltfChecker::usedAccessor(const JsonReader& in, const char* key, const Use& use) const {
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

Json GltfChecker::primitive(const JsonReader& in) const {
    Json out = Json::object();
    const std::uint64_t mode = in.count("mode").value_or(4);
    if (mode > 6) in.fail("mode", std::to_string(mode) + " is no primitive mode");
    out["mode"] = mode;

    const JsonReader attributes = in.object("attributes");
    Json& outAttributes = out["attributes"] = Json::object();
    const bool quantised = declares("KHR_mesh_quantization");
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
    for (const auto& attribute : attributes.json().items()) {
        const std::string& name = attribute.key();
        const auto numbered = [&name = name](std::string_view prefix) {
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
        outAttributes[name] = *integerValue(attribute.value());
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

Json GltfChecker::mesh(const JsonReader& in) const {
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

bool GltfChecker::declares(const char* extension) const {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        const Json& names = topArray(key);
        if (std::find(names.begin(), names.end(), extension) != names.end()) return true;
    }
    return false;
}

void GltfChecker::listIgnoredExtensions() {
    for (const Json& name : topArray("extensionsUsed")) {
        if (name.is_string() && !extensionSupported(name.get_ref<const std::string&>())) {
            result_.ignored.insert(printable(name.get_ref<const std::string&>()));
        }
    }
}

CheckedGltf GltfChecker::run() {
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
    return GltfChecker(file, report).run();
}

}  // namespace mv
