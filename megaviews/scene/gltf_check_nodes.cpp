// The half of the check of glTF documents that is about nodes, scenes, skins and animations.
#include <unordered_set>

#include "megaviews/scene/gltf_check_looks.h"
#include "megaviews/scene/gltf_checker.h"

namespace mv {

using Json = nlohmann::json;

Json GltfChecker::node(const JsonReader& in, std::size_t index) {
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
void GltfChecker::checkCycles(const std::vector<std::vector<std::size_t>>& children) const {
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

Json GltfChecker::scene(const JsonReader& in) const {
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

Json GltfChecker::skin(const JsonReader& in) const {
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

Json GltfChecker::animation(const JsonReader& in) const {
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

}  // namespace mv
