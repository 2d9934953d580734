#pragma once
// The light around the scene (EnvironmentSettings -> Sky): a table of radiance that light paths,
// shadow rays and the background read (shaders/shared/sky.glsl).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/settings/settings.h"
#include "shaders/shared/sky.glsl"

namespace mv {

// An image of the whole sphere by latitude and longitude: rows from the zenith down, the middle
// column towards +x, linear radiance in W/(m^2 sr).
struct EnvironmentImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> radiance;
    std::string hash;  // of the file
};

// What the sky of a frame is made from; of an image that its settings name it has the pixels.
struct Environment {
    EnvironmentSettings settings{.source = "none"};
    std::shared_ptr<const EnvironmentImage> image;
    bool operator==(const Environment&) const = default;
};

// Light of a sun at the scene: where it stands, and what it sends through a square across.
struct SunLight {
    glm::vec3 toSun{0, 1, 0};
    glm::vec3 irradiance{0};  // W/m^2
    bool operator==(const SunLight&) const = default;
};
// The brightest directional light, else the beam that was placed as one (framing.h).
std::optional<SunLight> sunOf(const Scene& scene, const std::vector<PosedLight>& lights);

struct SkyInput {
    Environment environment;
    std::optional<SunLight> sun;
    double lightScale = 1;
    bool operator==(const SkyInput&) const = default;
};

struct Sky {
    SkyInput input;
    std::uint32_t rows = 1;  // and twice as many columns
    std::vector<SkyTexel> texels;
    glm::vec3 irradiance{0};  // integral of radiance over the sphere, W/m^2
    // Share of the rays towards it that follow its power: how far that is from uniform, 0 .. 1.
    float tableShare = 0;
};

// Whether light that was placed because the file has none gives way to the environment.
bool replacesPlacedLight(const EnvironmentSettings& settings);

// Null where there is no sky: none is asked for, it is black, or auto in a scene without a placed
// sun. Throws Error(ExitCode::usage) for an image file that was not read.
std::shared_ptr<const Sky> makeSky(const Scene& scene, const std::vector<PosedLight>& lights,
                                   const Environment& environment, double lightScale,
                                   std::shared_ptr<const Sky> before = nullptr);

}  // namespace mv
