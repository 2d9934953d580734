#pragma once
// Where views are worth having, and which parts of the lights' emission lead there (Scene + lights
// + camera -> candidates -> ViewSet). A light path that ends where nobody looks is a wasted view:
// of a sun over wide ground nearly all are.

#include <cstdint>
#include <vector>

#include "megaviews/views/importance.h"
#include "megaviews/views/view_set.h"

namespace mv {

// Shares of the lights' emission by what a pilot's paths through them gave the points, mixed with
// shares by power, so that every path stays possible. The pilot's random numbers are its own: a
// probability never depends on the numbers that made the flux it divides.
struct ViewGuide {
    Importance importance;
    std::vector<float> cells;  // running shares, multiples of 2^-24: see vpl.glsl; empty: by power
    // Around most of the points: paths of light from far away start the denser the nearer they
    // pass.
    glm::vec3 region{0};
    float regionRadius = 0;
    std::uint32_t bits = 0;  // a light has 2^bits x 2^bits cells
    float aliveShare = 1;    // of the slots of the pilot's last round
};
ViewGuide makeViewGuide(const TriangleBvh& bvh, const Emitters& emitters,
                        const ImportanceCamera& camera, int bounces, std::uint32_t seed);

// How many slots to trace for `wanted` views: 4 each, up to 16 where most paths leave the scene.
std::uint64_t candidateCount(const ViewGuide& guide, std::uint64_t wanted);

// Turns candidates into about `wanted` views (the number itself is random, with a deviation below
// its root): those that are not kept become dead slots. Unbiased over `seed`. The CPU twin of
// renderer/passes/thin_views_pass.h. All candidates stay where no more than `wanted` are alive.
void thinViews(ViewSet& candidates, const Importance& importance, std::uint64_t wanted,
               std::uint32_t seed);

// How much what the old points call important has changed, 0 .. 1, without visibility: half the sum
// of the differences of shares over a few paths' views. The views stay where it is small, so that a
// camera that moves costs no new maps.
double importanceChange(const TriangleBvh& bvh, const Emitters& emitters,
                        const std::vector<ImportancePoint>& before,
                        const std::vector<ImportancePoint>& after, int bounces, std::uint32_t seed);

}  // namespace mv
