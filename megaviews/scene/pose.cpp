#include "megaviews/scene/pose.h"

#include <algorithm>
#include <cmath>

namespace mv {

namespace {

glm::dquat quaternion(glm::dvec4 xyzw) {
    const double length = glm::length(xyzw);
    if (!(length > 0) || !std::isfinite(length)) return {1, 0, 0, 0};
    xyzw /= length;
    return {xyzw.w, xyzw.x, xyzw.y, xyzw.z};
}

glm::dvec4 xyzw(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

}  // namespace

KeySpan findKeys(std::span<const double> times, double time) {
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return {};
    const auto last = times.size() - 1;
    if (after == times.end()) return {last, last, 0, 0};
    const auto to = static_cast<std::size_t>(after - times.begin());
    const double seconds = times[to] - times[to - 1];
    return {to - 1, to, (time - times[to - 1]) / seconds, seconds};
}

HermiteWeights hermiteWeights(const KeySpan& keys) {
    const double u = keys.u, u2 = u * u, u3 = u2 * u;
    return {2 * u3 - 3 * u2 + 1, keys.seconds * (u3 - 2 * u2 + u), 3 * u2 - 2 * u3,
            keys.seconds * (u3 - u2)};
}

double loopTime(double timeS, double duration) {
    if (!(duration > 0) || !std::isfinite(timeS)) return 0;
    const double inside = std::fmod(timeS, duration);
    return inside < 0 ? inside + duration : inside;
}

glm::dmat4 localMatrix(const Node& node) {
    if (node.matrix) return *node.matrix;
    glm::dmat4 matrix = glm::mat4_cast(quaternion(xyzw(node.rotation)));
    for (int axis = 0; axis < 3; ++axis) matrix[axis] *= node.scale[axis];
    matrix[3] = glm::dvec4(node.translation, 1);
    return matrix;
}

glm::dvec4 sampleChannel(const AnimationChannel& channel, double time) {
    const bool rotation = channel.property == AnimatedProperty::rotation;
    if (channel.times.empty()) return rotation ? glm::dvec4(0, 0, 0, 1) : glm::dvec4(0);
    const KeySpan keys = findKeys(channel.times, time);
    glm::dvec4 value;
    if (channel.interpolation == Interpolation::cubicSpline) {
        const auto at = [&](std::size_t key, std::size_t part) {
            return channel.values[3 * key + part];
        };
        const HermiteWeights w = hermiteWeights(keys);
        value = w.from * at(keys.from, 1) + w.outTangent * at(keys.from, 2) +
                w.to * at(keys.to, 1) + w.inTangent * at(keys.to, 0);
    } else {
        const glm::dvec4 from = channel.values[keys.from], to = channel.values[keys.to];
        if (channel.interpolation == Interpolation::step) {
            value = from;
        } else if (rotation) {
            return xyzw(glm::slerp(quaternion(from), quaternion(to), keys.u));
        } else {
            value = glm::mix(from, to, keys.u);
        }
    }
    return rotation ? xyzw(quaternion(value)) : value;
}

std::vector<glm::dmat4> worldMatrices(std::span<const Node> nodes, const Animation* animation,
                                      double time) {
    std::vector<Node> posed;
    if (animation && !animation->channels.empty()) {
        posed.assign(nodes.begin(), nodes.end());
        for (const AnimationChannel& channel : animation->channels) {
            Node& node = posed[static_cast<std::size_t>(channel.node)];
            const glm::dvec4 value = sampleChannel(channel, time);
            switch (channel.property) {
                case AnimatedProperty::translation:
                    node.translation = glm::dvec3(value);
                    break;
                case AnimatedProperty::rotation:
                    node.rotation = quaternion(value);
                    break;
                case AnimatedProperty::scale:
                    node.scale = glm::dvec3(value);
                    break;
            }
        }
        nodes = posed;
    }
    std::vector<glm::dmat4> world(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const glm::dmat4 local = localMatrix(nodes[i]);
        const int parent = nodes[i].parent;
        world[i] = parent >= 0 ? world[static_cast<std::size_t>(parent)] * local : local;
    }
    return world;
}

}  // namespace mv
