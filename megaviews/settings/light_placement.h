#pragma once
// Lights of the scene put elsewhere, as one setting says it: "0:1,2,3" puts light 0 at a place,
// "0:1,2,3:0,-1,0" also turns it, "1::0,-1,0" only turns light 1; several are separated by spaces.

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
    bool operator==(const LightPlacement&) const = default;
};

// Throws Error(ExitCode::usage), starting with `where`. A light named twice is an error.
std::vector<LightPlacement> parseLightPlacements(std::string_view text, std::string_view where);
std::string toText(const std::vector<LightPlacement>& placements);

}  // namespace mv
