#pragma once
// What is read back of a gather, for whoever asks what lights a pixel and what culling is worth.

#include <cstdint>
#include <glm/glm.hpp>

namespace mv {

// A view that one pixel gathered, all samples of it together.
struct GatheredSample {
    std::uint32_t slot = 0;
    glm::vec3 position{0};      // of the view, root-cube units
    glm::vec3 irradiance{0};    // as it enters the pixel's sum, W/m^2: of its visible samples
    glm::vec3 unoccluded{0};    // what it would be if all of them were visible
    std::uint32_t samples = 0;  // how often it was drawn
    std::uint32_t visible = 0;  // for how many of those its map let the light through
};

// How much work culling leaves to a set of samples, and what the clamp takes.
struct GatherShares {
    std::uint32_t receivers = 0;  // lists of views in use
    // Means over pixels, of the living views: those that the pixel's list keeps, and those that the
    // pixel and they face each other, which no list can go without for long: the ideal.
    double kept = 1, facing = 1;
    double runs = 0;  // of neighbouring views that a pixel's list is made of, a mean
    double clampedEnergy =
        0;  // of the luminance that reaches pixels, the share that the clamp takes
};

}  // namespace mv
