#pragma once
// What a file does not say: where to stand and what lights it. Interiors get a view inside the
// room, objects a three-quarter view; a scene without lights and emitters gets a sun or a lamp.

#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv {

// The beam that is placed as a sun for an interior stands so far from what it lights, edges of
// the root cube, that its rays are nearly parallel.
inline constexpr double kBeamDistance = 3;

// Adds a camera if the scene has none and a light if it has neither lights nor emissive surfaces;
// each addition is flagged isDefault and said in Scene::notes.
void placeDefaults(Scene& scene, const TriangleBvh& bvh);

}  // namespace mv
