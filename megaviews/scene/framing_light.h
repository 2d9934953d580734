#pragma once
// The light of a scene that has none (framing.h).

#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/framing_probe.h"

namespace mv::framing {

// Adds a sun or a lamp, with a slow closed animation if the scene has none of its own, and says
// so in Scene::notes. `surroundings` may be those of an empty scene.
void placeLight(Scene& scene, const TriangleBvh& bvh, const Surroundings& surroundings,
                const Viewer& viewer);

}  // namespace mv::framing
