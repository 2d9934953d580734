#include "megaviews/scene/rig.h"

#include <algorithm>

#include "megaviews/scene/pose.h"

namespace mv {

namespace {

const Animation* animationOf(const Rig& rig, int animation) {
    return animation < 0 ? nullptr : &rig.animations[static_cast<std::size_t>(animation)];
}

// The channels of a node.
std::span<const WeightChannel> weightChannelsOf(const Rig& rig, int animation, std::size_t node) {
    if (animation < 0) return {};
    const auto& channels = rig.weightChannels[static_cast<std::size_t>(animation)];
    // Not equal_range, whose subrange clang 14 does not compile with this standard library.
    return {std::ranges::lower_bound(channels, node, {}, &WeightChannel::node),
            std::ranges::upper_bound(channels, node, {}, &WeightChannel::node)};
}

// Writes those that the channel has values for.
void blend(const WeightChannel& channel, double time, std::vector<double>& weights) {
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const std::size_t perKey = channel.values.size() / channel.times.size() / (cubic ? 3 : 1);
    const KeySpan keys = findKeys(channel.times, time);
    for (std::size_t i = 0; i < std::min(weights.size(), perKey); ++i) {
        const auto at = [&](std::size_t key, std::size_t part) {
            return channel.values[(cubic ? 3 * key + part : key) * perKey + i];
        };
        if (cubic) {
            const HermiteWeights w = hermiteWeights(keys);
            weights[i] = w.from * at(keys.from, 1) + w.outTangent * at(keys.from, 2) +
                         w.to * at(keys.to, 1) + w.inTangent * at(keys.to, 0);
        } else if (channel.interpolation == Interpolation::step) {
            weights[i] = at(keys.from, 0);
        } else {
            weights[i] = glm::mix(at(keys.from, 0), at(keys.to, 0), keys.u);
        }
    }
}

// Whether a channel says something else at another time: exporters write many that never do.
template <typename Channel>
bool changes(const Channel& channel) {
    if (channel.times.size() < 2) return false;
    using Value = std::decay_t<decltype(channel.values[0])>;
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const std::size_t perKey = channel.values.size() / channel.times.size();
    const std::size_t first = cubic ? perKey / 3 : 0, end = cubic ? 2 * first : perKey;
    for (std::size_t i = 0; i < channel.times.size() * perKey; ++i) {
        const std::size_t part = i % perKey;
        const bool tangent = part < first || part >= end;
        if (channel.values[i] != (tangent ? Value(0) : channel.values[part])) return true;
    }
    return false;
}

}  // namespace

std::vector<Draw> drawsAt(const Rig& rig, std::span<const Primitive> primitives,
                          std::span<const Skin> skins, std::span<const RiggedDraw> draws,
                          PoseTime time) {
    const std::vector<glm::dmat4> world =
        worldMatrices(rig.nodes, animationOf(rig, time.animation), time.timeS);
    std::vector<std::shared_ptr<const std::vector<glm::dmat4>>> joints;
    for (const Skin& skin : skins) {
        auto matrices = std::make_shared<std::vector<glm::dmat4>>();
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            matrices->push_back(world[static_cast<std::size_t>(skin.joints[j])] *
                                skin.inverseBind[j]);
        }
        joints.push_back(std::move(matrices));
    }
    std::vector<Draw> posed;
    posed.reserve(draws.size());
    for (const RiggedDraw& draw : draws) {
        Draw& out = posed.emplace_back();
        out.primitive = &primitives[draw.primitive];
        out.worldFromModel = world[draw.node] * draw.instance;
        if (draw.skin >= 0) out.joints = joints[static_cast<std::size_t>(draw.skin)];
        out.morphWeights = draw.weights;
        if (draw.weights.empty()) continue;
        for (const WeightChannel& channel : weightChannelsOf(rig, time.animation, draw.node)) {
            blend(channel, time.timeS, out.morphWeights);
        }
    }
    return posed;
}

std::vector<bool> movingDraws(const Rig& rig, std::span<const Primitive> primitives,
                              std::span<const Skin> skins, std::span<const RiggedDraw> draws,
                              int animation) {
    std::vector<bool> moving(draws.size(), false);
    const Animation* chosen = animationOf(rig, animation);
    if (!chosen) return moving;
    std::vector<bool> moved(rig.nodes.size(), false);  // a node, or one above it
    for (const AnimationChannel& channel : chosen->channels) {
        if (changes(channel)) moved[static_cast<std::size_t>(channel.node)] = true;
    }
    for (std::size_t i = 0; i < rig.nodes.size(); ++i) {  // parents stand before their children
        const int parent = rig.nodes[i].parent;
        if (parent >= 0 && moved[static_cast<std::size_t>(parent)]) moved[i] = true;
    }
    for (std::size_t i = 0; i < draws.size(); ++i) {
        const RiggedDraw& draw = draws[i];
        const bool morphs = !draw.weights.empty() &&
                            std::ranges::any_of(weightChannelsOf(rig, animation, draw.node),
                                                changes<WeightChannel>);
        const bool skinned = draw.skin >= 0 && !primitives[draw.primitive].influences.empty();
        const bool carried =
            !skinned ? moved[draw.node]
                     : std::ranges::any_of(
                           skins[static_cast<std::size_t>(draw.skin)].joints,
                           [&](int joint) { return moved[static_cast<std::size_t>(joint)]; });
        moving[i] = morphs || carried;
    }
    return moving;
}

}  // namespace mv
