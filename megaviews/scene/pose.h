#pragma once
// Where nodes stand at a time: keyframe sampling (step, linear, cubic spline) and world matrices.
// Serves loading (geometry stands in its pose of one time) and every frame (lights and cameras).

#include <span>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

// Between which keys a time lies: before the first and after the last the ends hold.
struct KeySpan {
    std::size_t from = 0, to = 0;
    double u = 0;        // 0 at `from`, 1 at `to`
    double seconds = 0;  // between the two
};
KeySpan findKeys(std::span<const double> times,
                 double time);  // times not empty, none below that before

// Weights of the four values that a cubic spline blends [glTF 2.0, appendix C].
struct HermiteWeights {
    double from, outTangent, to, inTangent;
};
HermiteWeights hermiteWeights(const KeySpan& keys);

// The time inside [0, duration) that an endless loop is at; 0 for a still animation.
double loopTime(double timeS, double duration);

glm::dmat4 localMatrix(const Node& node);
// A channel's value; rotations are unit quaternions (x, y, z, w).
glm::dvec4 sampleChannel(const AnimationChannel& channel, double time);
// `time` as it is, no looping. Parents stand before their children. No animation: null.
std::vector<glm::dmat4> worldMatrices(std::span<const Node> nodes, const Animation* animation,
                                      double time);

}  // namespace mv
