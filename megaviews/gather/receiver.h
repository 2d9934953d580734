#pragma once
// A point that light is gathered at: one texel of the G-buffer, or any other place. And a picture
// of what arrives there.

#include <vector>

#include <glm/glm.hpp>

#include "shaders/shared/microfacet.glsl"

namespace mv {

struct Receiver {
    glm::vec3 position{0};  // root-cube units
    glm::vec3 normal{0};    // unit
    BroadGloss gloss = {};  // none
    // Of its triangle, on the camera's side; 0: as `normal`.
    glm::vec3 plane{0};
    glm::vec3 facing() const { return plane == glm::vec3(0) ? normal : plane; }
};

// Irradiance E in W/m^2, everything but albedo / pi, as the gather's; where there is broad gloss,
// each direction's by broadGlossWeight(). Rows as the receivers' were,
// so bottom first for a G-buffer. A pixel without a surface is 0.
struct IrradianceImage {
    int width = 0, height = 0;
    int rowsDone = 0;                 // the first rows hold values, those after them 0
    std::vector<glm::vec3> mean;      // width * height
    std::vector<glm::vec3> variance;  // of the mean; empty where there is none to estimate

    bool done() const { return rowsDone == height; }
};

}  // namespace mv
