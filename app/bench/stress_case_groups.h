#pragma once
// The groups that the stress cases come in, and what their tables share.

#include <cstdint>
#include <vector>

#include "app/bench/stress.h"
#include "app/bench/stress_scene.h"

namespace mv::stress {

inline constexpr std::uint32_t kUsualViews = 200;

// 64 x 48 pixels, 200 views, 8 levels.
Settings usual();
Input finished(World world, Settings settings = usual());
// A point of the room's air, uniform; some lie inside its furniture.
glm::dvec3 inRoom(std::uint32_t seed, std::uint32_t index);

void addScaleCases(std::vector<Case>& all);
void addViewCases(std::vector<Case>& all);
void addTriangleCases(std::vector<Case>& all);
void addLightCases(std::vector<Case>& all);
void addCameraCases(std::vector<Case>& all);
void addResolutionCases(std::vector<Case>& all);

// A scene with views of its own: place(root, set) adds them.
template <typename Place>
Input withViews(World world, const Place& place, Settings settings = usual()) {
    Input input = finished(std::move(world), settings);
    place(input.assets->scene.root, input.views.emplace());
    return input;
}

}  // namespace mv::stress
