#pragma once
// A point that light is gathered at: one texel of the G-buffer, or any other place.

#include <glm/glm.hpp>

namespace mv {

struct Receiver {
    glm::vec3 position{0};  // root-cube units
    glm::vec3 normal{0};    // unit
};

}  // namespace mv
