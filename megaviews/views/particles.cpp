// Glowing particles: every axis of a path is a sum of three sines whose frequencies are whole
// numbers of turns a period, so that paths are closed and smooth.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "megaviews/scene/rigged_scene.h"
#include "megaviews/views/view_set.h"

namespace mv {

namespace {

constexpr float kLeastExtent = 0.1f;  // of the box, root-cube units: room to move in a flat scene

// Fully saturated colours of hue h in [0, 1), a fifth of white added; the mean of the channels
// is 1.
glm::dvec3 colorOfHue(double h) {
    glm::dvec3 c;
    for (int i = 0; i < 3; ++i) {
        const double x = 6 * (h + (3 - i) / 3.0);  // red, green, blue a third of a turn apart
        c[i] = std::clamp(std::abs(std::fmod(x, 6.0) - 3) - 1, 0.0, 1.0);
    }
    c += 0.2;
    return c * 3.0 / (c.x + c.y + c.z);
}

// A particle's offset along one axis at phase t in [0, 1): within [-1, 1].
double wave(std::uint32_t seed, std::uint32_t particle, std::uint32_t axis, double t) {
    const glm::vec4 phases = random4(seed, particle, axis, 2);
    constexpr std::array<double, 3> kAmplitudes = {0.6, 0.27, 0.13};
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double angle = (k + 1) * t + static_cast<double>(phases[k]);
        sum += kAmplitudes[static_cast<std::size_t>(k)] * std::sin(2 * std::numbers::pi * angle);
    }
    return sum;
}

View particle(const SceneBounds& box, std::uint32_t seed, std::uint32_t k, double timeS,
              double fluxW) {
    const glm::vec4 place = random4(seed, k, 0, 0);
    const glm::vec4 traits = random4(seed, k, 0, 1);
    // Once round in 20 to 60 s, over up to a sixth of the box, less beside its walls.
    const double period = 20 + 40 * static_cast<double>(traits.x);
    const double turns = timeS / period;
    const double t = turns - std::floor(turns);

    View view{};
    std::array<float, 3> position{};
    for (int axis = 0; axis < 3; ++axis) {
        const double low = static_cast<double>(box.min[axis]);
        const double high = static_cast<double>(box.max[axis]);
        const double center = low + (high - low) * static_cast<double>(place[axis]);
        const double room = std::min(center - low, high - center);
        const double reach = std::min(room, (high - low) / 6);
        const double x = center + reach * wave(seed, k, static_cast<std::uint32_t>(axis), t);
        position[static_cast<std::size_t>(axis)] =
            std::clamp(static_cast<float>(x), box.min[axis], box.max[axis]);
    }
    const glm::dvec3 flux = colorOfHue(static_cast<double>(traits.y)) * fluxW;
    view.positionX = position[0];
    view.positionY = position[1];
    view.positionZ = position[2];
    view.flags = kViewOmnidirectional;
    view.fluxR = static_cast<float>(flux.x);
    view.fluxG = static_cast<float>(flux.y);
    view.fluxB = static_cast<float>(flux.z);
    view.slot = k;
    return view;
}

}  // namespace

SceneBounds sceneBounds(const Scene& scene) {
    if (scene.triangles.empty()) return {};
    using Range = tbb::blocked_range<std::size_t>;
    const std::size_t standing = scene.moving ? scene.moving->triangle : scene.triangles.size();
    const SceneBounds moving = scene.moving
                                   ? SceneBounds{scene.moving->min, scene.moving->max}
                                   : SceneBounds{glm::vec3(kInfinity), glm::vec3(-kInfinity)};
    return tbb::parallel_reduce(
        Range(0, standing, 4096), moving,
        [&](const Range& range, SceneBounds b) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                for (int k = 0; k < 3; ++k) {
                    const glm::vec3 p = scene.positions[scene.triangles[i][k]];
                    b = {glm::min(b.min, p), glm::max(b.max, p)};
                }
            }
            return b;
        },
        [](const SceneBounds& a, const SceneBounds& b) {
            return SceneBounds{glm::min(a.min, b.min), glm::max(a.max, b.max)};
        });
}

ViewSet makeParticles(const SceneBounds& bounds, std::uint64_t count, std::uint32_t seed,
                      double timeS, double powerW) {
    // A flat scene lends its particles some room, inside the root cube.
    SceneBounds box = bounds;
    for (int axis = 0; axis < 3; ++axis) {
        const float center = 0.5f * (box.min[axis] + box.max[axis]);
        if (box.max[axis] - box.min[axis] >= kLeastExtent) continue;
        box.min[axis] = std::max(center - 0.5f * kLeastExtent, 0.0f);
        box.max[axis] = std::min(center + 0.5f * kLeastExtent, 1.0f);
    }
    ViewSet set;
    set.views.resize(count);
    const double fluxW = count ? powerW / static_cast<double>(count) : 0;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024), [&](const auto& range) {
        for (std::size_t k = range.begin(); k < range.end(); ++k) {
            set.views[k] = particle(box, seed, static_cast<std::uint32_t>(k), timeS, fluxW);
        }
    });
    return set;
}

ViewSet makeParticles(const Scene& scene, std::uint64_t count, std::uint32_t seed, double timeS,
                      double powerW) {
    return makeParticles(sceneBounds(scene), count, seed, timeS, powerW);
}

}  // namespace mv
