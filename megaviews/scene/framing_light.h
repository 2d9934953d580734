#pragma once
// The light of a scene that has none (framing.h).

#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/framing_probe.h"

namespace mv::framing {

// Do the file's lamps, or what glows where it has none, light the inside of something closed? Then
// `surroundings` keeps the places that they light.
bool isLitWithin(const TriangleBvh& bvh, Surroundings& surroundings);

// Does light of the file's own, of its lights or of what glows, get to what is seen from the places
// of `surroundings`? True where it has none: light is placed for them.
bool lightReaches(const TriangleBvh& bvh, const Surroundings& surroundings);

// Those of the points that a light of the file's own reaches.
std::vector<SurfacePoint> litSurfaces(const TriangleBvh& bvh,
                                      const std::vector<SurfacePoint>& points);

// Do emissive surfaces light the scene? Those of an interior do, unless its surfaces would get next
// to nothing; in the open, where at least half of what does not emit, in sight of the file's own
// viewer if it has one, gets a twentieth of a placed sun's irradiance from them, as far as `bvh`
// knows what they emit. So a model with a glowing dial is shown by daylight, and a stage by its
// lamps.
bool emissionLights(const TriangleBvh& bvh, const Surroundings& surroundings,
                    const std::optional<Viewer>& viewer);

// Adds a sun or a lamp, with a slow closed animation if the scene has none of its own, and says
// so, and `why`, in Scene::notes. `surroundings` may be those of an empty scene.
void placeLight(Scene& scene, const TriangleBvh& bvh, const Surroundings& surroundings,
                const Viewer& viewer, const std::string& why);

}  // namespace mv::framing
