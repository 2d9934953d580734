#include "megaviews/scene/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "megaviews/core/error.h"

namespace mv {

namespace {

// Whether saveScene() wrote a light that the program had placed.
bool isPlaced(const tinygltf::Light& in) {
    if (!in.extras.Has("megaviews")) return false;
    const tinygltf::Value& own = in.extras.Get("megaviews");
    return own.Has(kPlacedLight) && own.Get(kPlacedLight).IsBool() &&
           own.Get(kPlacedLight).Get<bool>();
}

Node makeNode(const tinygltf::Model& model, int fileNode, GltfReport& report) {
    const tinygltf::Node& in = model.nodes[static_cast<std::size_t>(fileNode)];
    Node out;
    if (in.matrix.size() == 16) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = in.matrix[static_cast<std::size_t>(i)];
        if (matrix[0].w != 0 || matrix[1].w != 0 || matrix[2].w != 0 || matrix[3].w != 1) {
            report.warn(nodePlace(model, fileNode) + ".matrix",
                        "its last row is not 0 0 0 1, which is taken instead");
            matrix[0].w = matrix[1].w = matrix[2].w = 0;
            matrix[3].w = 1;
        }
        out.matrix = matrix;
        return out;
    }
    const auto vec3 = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    if (!in.translation.empty()) out.translation = vec3(in.translation);
    if (!in.scale.empty()) out.scale = vec3(in.scale);
    if (!in.rotation.empty()) {
        out.rotation = glm::dquat(in.rotation[3], in.rotation[0], in.rotation[1], in.rotation[2]);
    }
    return out;
}

Interpolation interpolationOf(const std::string& name) {
    if (name == "STEP") return Interpolation::step;
    if (name == "CUBICSPLINE") return Interpolation::cubicSpline;
    return Interpolation::linear;
}

bool finite(const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// The nodes that a scene lists; without scenes, those that are nobody's children.
std::vector<int> rootNodes(const tinygltf::Model& model, int sceneIndex, GltfReport& report) {
    const auto scenes = static_cast<int>(model.scenes.size());
    if (sceneIndex >= scenes && !(sceneIndex == 0 && scenes == 0)) {
        throw Error(ExitCode::usage, report.file() + ": there is no scene " +
                                         std::to_string(sceneIndex) + "; the file has " +
                                         std::to_string(scenes));
    }
    if (scenes == 0) {
        std::vector<bool> isChild(model.nodes.size(), false);
        for (const tinygltf::Node& node : model.nodes) {
            for (const int child : node.children) isChild[static_cast<std::size_t>(child)] = true;
        }
        std::vector<int> roots;
        for (std::size_t i = 0; i < isChild.size(); ++i) {
            if (!isChild[i]) roots.push_back(static_cast<int>(i));
        }
        report.warn("scenes", roots.empty() ? "the file has no scene: there is nothing to draw"
                                            : "the file has no scene: all its nodes are drawn");
        return roots;
    }
    const int chosen = sceneIndex >= 0 ? sceneIndex : std::max(model.defaultScene, 0);
    const tinygltf::Scene& scene = model.scenes[static_cast<std::size_t>(chosen)];
    if (scene.nodes.empty()) {
        report.warn("scenes[" + std::to_string(chosen) + "]",
                    "the scene is empty: it has no nodes");
    }
    return scene.nodes;
}

void addAnimation(const tinygltf::Model& model, std::size_t index, Rig& rig, GltfReport& report) {
    const AccessorReader reader(model, report);
    const tinygltf::Animation& in = model.animations[index];
    Animation& out = rig.animations.emplace_back();
    std::vector<WeightChannel>& weights = rig.weightChannels.emplace_back();
    out.name = in.name;
    const std::string place = "animations[" + std::to_string(index) + "]";
    for (const tinygltf::AnimationChannel& channel : in.channels) {
        const tinygltf::AnimationSampler& sampler =
            in.samplers[static_cast<std::size_t>(channel.sampler)];
        const std::string samplerPlace =
            place + ".samplers[" + std::to_string(channel.sampler) + "]";
        std::vector<double> times = reader.scalars(sampler.input);
        // Two keys of one time are a jump.
        const bool ascending =
            std::adjacent_find(times.begin(), times.end(),
                               [](double a, double b) { return !(a <= b); }) == times.end();
        if (!ascending || !finite(times)) {
            report.warn(samplerPlace + ".input",
                        "its times do not ascend; the channel is left out");
            continue;
        }
        out.duration = std::max(out.duration, times.back());
        const int node = rig.rigNode[static_cast<std::size_t>(channel.target_node)];
        if (node < 0) continue;
        const Interpolation interpolation = interpolationOf(sampler.interpolation);
        if (channel.target_path == "weights") {
            std::vector<double> values = reader.scalars(sampler.output);
            if (!finite(values)) {
                report.warn(samplerPlace + ".output", "it is not finite; the channel is left out");
                continue;
            }
            weights.push_back({static_cast<std::size_t>(node), interpolation, std::move(times),
                               std::move(values)});
            continue;
        }
        if (rig.nodes[static_cast<std::size_t>(node)].matrix) {
            report.warn(nodePlace(model, channel.target_node),
                        "a node with a matrix cannot be animated; the channel is left out");
            continue;
        }
        std::vector<glm::dvec4> values = reader.vectors(sampler.output, glm::dvec4(0));
        if (!std::all_of(values.begin(), values.end(), [](const glm::dvec4& v) {
                return std::isfinite(v.x + v.y + v.z + v.w);
            })) {
            report.warn(samplerPlace + ".output", "it is not finite; the channel is left out");
            continue;
        }
        const AnimatedProperty property =
            channel.target_path == "translation" ? AnimatedProperty::translation
            : channel.target_path == "rotation"  ? AnimatedProperty::rotation
                                                 : AnimatedProperty::scale;
        out.channels.push_back(
            {node, property, interpolation, std::move(times), std::move(values)});
    }
    std::stable_sort(weights.begin(), weights.end(),
                     [](const auto& a, const auto& b) { return a.node < b.node; });
}

// Whether at least two animations move something, and no two of them the same.
bool moveDifferentThings(const Rig& rig) {
    constexpr int kWeights = -1;
    std::set<std::pair<std::size_t, int>> moved;  // nodes, and what of them
    std::size_t moving = 0;
    for (std::size_t i = 0; i < rig.animations.size(); ++i) {
        std::set<std::pair<std::size_t, int>> own;
        for (const AnimationChannel& channel : rig.animations[i].channels) {
            own.emplace(static_cast<std::size_t>(channel.node), static_cast<int>(channel.property));
        }
        for (const WeightChannel& channel : rig.weightChannels[i]) {
            own.emplace(channel.node, kWeights);
        }
        const std::size_t before = moved.size();
        moved.insert(own.begin(), own.end());
        if (moved.size() != before + own.size()) return false;
        moving += own.empty() ? 0 : 1;
    }
    return moving >= 2;
}

// As where each object brought an animation of its own: one more, for all of them at once.
void addAnimationsTogether(Rig& rig) {
    Animation all{.name = "all", .duration = 0, .channels = {}, .together = true};
    const bool named =
        std::ranges::find(rig.animations, all.name, &Animation::name) != rig.animations.end();
    if (named || !moveDifferentThings(rig)) return;
    std::vector<WeightChannel> weights;
    for (std::size_t i = 0; i < rig.animations.size(); ++i) {
        const Animation& one = rig.animations[i];
        all.duration = std::max(all.duration, one.duration);
        all.channels.insert(all.channels.end(), one.channels.begin(), one.channels.end());
        weights.insert(weights.end(), rig.weightChannels[i].begin(), rig.weightChannels[i].end());
    }
    std::ranges::stable_sort(weights, {}, &WeightChannel::node);
    rig.animations.push_back(std::move(all));
    rig.weightChannels.push_back(std::move(weights));
}

std::string orElse(const std::string& name, const std::string& otherwise) {
    return name.empty() ? otherwise : name;
}

}  // namespace

std::string nodePlace(const tinygltf::Model& model, int fileNode) {
    const std::string& name = model.nodes[static_cast<std::size_t>(fileNode)].name;
    return "nodes[" + std::to_string(fileNode) + "]" +
           (name.empty() ? "" : " (" + quote(name) + ")");
}

Rig buildRig(const tinygltf::Model& model, int sceneIndex, GltfReport& report) {
    Rig rig;
    const std::size_t count = model.nodes.size();
    std::vector<int> parents(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
        for (const int child : model.nodes[i].children) {
            parents[static_cast<std::size_t>(child)] = static_cast<int>(i);
        }
    }
    // What the scene draws: down from its roots, without recursion, as chains may be deep.
    std::vector<bool> drawn(count, false), kept(count, false);
    std::vector<int> open = rootNodes(model, sceneIndex, report);
    while (!open.empty()) {
        const auto node = static_cast<std::size_t>(open.back());
        open.pop_back();
        if (drawn[node]) continue;
        drawn[node] = true;
        open.insert(open.end(), model.nodes[node].children.begin(),
                    model.nodes[node].children.end());
    }
    // Kept are these, joints, and the ancestors of both.
    const auto keepUpwards = [&](int node) {
        for (; node >= 0 && !kept[static_cast<std::size_t>(node)];
             node = parents[static_cast<std::size_t>(node)]) {
            kept[static_cast<std::size_t>(node)] = true;
        }
    };
    for (std::size_t i = 0; i < count; ++i) {
        if (!drawn[i]) continue;
        keepUpwards(static_cast<int>(i));
        if (const int skin = model.nodes[i].skin; skin >= 0) {
            for (const int joint : model.skins[static_cast<std::size_t>(skin)].joints)
                keepUpwards(joint);
        }
    }
    rig.rigNode.assign(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
        if (kept[i] && parents[i] < 0) open.push_back(static_cast<int>(i));
    }
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
        const int fileNode = open.back();
        const auto f = static_cast<std::size_t>(fileNode);
        open.pop_back();
        rig.rigNode[f] = static_cast<int>(rig.nodes.size());
        Node node = makeNode(model, fileNode, report);
        node.parent = parents[f] >= 0 ? rig.rigNode[static_cast<std::size_t>(parents[f])] : -1;
        rig.nodes.push_back(std::move(node));
        rig.fileNode.push_back(fileNode);
        rig.inScene.push_back(drawn[f]);
        const std::vector<int>& children = model.nodes[f].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            if (kept[static_cast<std::size_t>(*child)]) open.push_back(*child);
        }
    }
    for (std::size_t i = 0; i < model.animations.size(); ++i) addAnimation(model, i, rig, report);
    addAnimationsTogether(rig);
    return rig;
}

std::vector<double> restWeights(const tinygltf::Model& model, const Rig& rig, std::size_t node,
                                std::size_t count) {
    const tinygltf::Node& fileNode = model.nodes[static_cast<std::size_t>(rig.fileNode[node])];
    std::vector<double> weights = fileNode.weights;
    if (weights.empty() && fileNode.mesh >= 0) {
        weights = model.meshes[static_cast<std::size_t>(fileNode.mesh)].weights;
    }
    weights.resize(count, 0.0);
    return weights;
}

void addLightsAndCameras(const tinygltf::Model& model, const Rig& rig, Scene& scene) {
    std::vector<int> sceneNode(rig.nodes.size(), -1);
    // Copies a node and its ancestors, those first.
    const auto keep = [&](std::size_t node) {
        std::vector<std::size_t> chain;
        for (int n = static_cast<int>(node); n >= 0 && sceneNode[static_cast<std::size_t>(n)] < 0;
             n = rig.nodes[static_cast<std::size_t>(n)].parent) {
            chain.push_back(static_cast<std::size_t>(n));
        }
        for (auto n = chain.rbegin(); n != chain.rend(); ++n) {
            sceneNode[*n] = static_cast<int>(scene.nodes.size());
            Node copy = rig.nodes[*n];
            if (copy.parent >= 0) copy.parent = sceneNode[static_cast<std::size_t>(copy.parent)];
            scene.nodes.push_back(std::move(copy));
        }
        return sceneNode[node];
    };
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) {
        if (!rig.inScene[i]) continue;
        const tinygltf::Node& node = model.nodes[static_cast<std::size_t>(rig.fileNode[i])];
        if (node.camera >= 0) {
            const tinygltf::Camera& in = model.cameras[static_cast<std::size_t>(node.camera)];
            Camera out;
            out.name = orElse(in.name,
                              orElse(node.name, "camera " + std::to_string(scene.cameras.size())));
            out.node = keep(i);
            if (in.type == "orthographic") {
                out.orthoHalfHeight = in.orthographic.ymag;
            } else {
                out.yfovRad = in.perspective.yfov;
            }
            scene.cameras.push_back(std::move(out));
        }
        const auto extension = node.extensions.find("KHR_lights_punctual");
        if (extension == node.extensions.end()) continue;
        const auto index =
            static_cast<std::size_t>(extension->second.Get("light").GetNumberAsInt());
        const tinygltf::Light& in = model.lights[index];
        Light out;
        out.name =
            orElse(in.name, orElse(node.name, "light " + std::to_string(scene.lights.size())));
        out.type = in.type == "directional" ? LightType::directional
                   : in.type == "spot"      ? LightType::spot
                                            : LightType::point;
        out.intensity = glm::vec3(glm::dvec3(in.color[0], in.color[1], in.color[2]) * in.intensity);
        if (out.intensity == glm::vec3(0)) continue;  // switched off
        if (out.type == LightType::spot) {
            out.innerConeRad = in.spot.innerConeAngle;
            out.outerConeRad = in.spot.outerConeAngle;
        }
        out.isDefault = isPlaced(in);
        out.node = keep(i);
        scene.lights.push_back(std::move(out));
    }
    for (const Animation& in : rig.animations) {
        Animation& out = scene.animations.emplace_back();
        out.name = orElse(in.name, "animation " + std::to_string(scene.animations.size() - 1));
        out.duration = in.duration;
        out.together = in.together;
        for (const AnimationChannel& channel : in.channels) {
            const int node = sceneNode[static_cast<std::size_t>(channel.node)];
            if (node < 0) continue;
            out.channels.push_back(channel);
            out.channels.back().node = node;
        }
    }
}

}  // namespace mv
