#pragma once
// Lights of the scene as the user has them, as one setting says it: LIGHT:position:direction:
// intensity:cone, of which what is empty or left out at the end stays the scene's. "0:1,2,3" puts
// light 0 at a place, "1::0,-1,0" turns light 1, "2:::0,0,0" puts light 2 out; several are
// separated by spaces.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace mv {

struct LightPlacement {
    int light = 0;                                   // index into Scene::lights
    std::optional<std::array<double, 3>> position;   // world units
    std::optional<std::array<double, 3>> direction;  // of its rays; any length but 0
    // W/sr of red, green and blue, W/m^2 of a directional light; not below 0.
    std::optional<std::array<double, 3>> intensity;
    // Half angles of a spot's full light and of its end, degrees: 0 <= inner <= outer <= 90.
    std::optional<std::array<double, 2>> cone;
    bool changesNothing() const { return !position && !direction && !intensity && !cone; }
    bool operator==(const LightPlacement&) const = default;
};

// Throws Error(ExitCode::usage), starting with `where`. A light named twice is an error.
std::vector<LightPlacement> parseLightPlacements(std::string_view text, std::string_view where);
std::string toText(const std::vector<LightPlacement>& placements);

}  // namespace mv
