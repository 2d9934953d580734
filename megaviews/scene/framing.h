#pragma once
// What a file does not say: where to stand and what lights it. Interiors, and rooms with windows
// that light gets into, get a view inside the room, rooms that lack a wall one through it, rooms
// that lack a roof one from above, objects and buildings of which little is seen from within a
// three-quarter view, without most of a ground or a backdrop that dwarfs them or crumbs far away; a
// scene without lights gets a sun or a lamp, unless what glows lights it.

#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"

namespace mv {

// The beam that is placed as a sun for an interior stands so far from what it lights, edges of
// the root cube, that its rays are nearly parallel.
inline constexpr double kBeamDistance = 3;

// Adds a camera if the scene has none and a light if it has no lights and its emissive surfaces do
// not light it (framing::emissionLights()); each addition is flagged isDefault and said in
// Scene::notes.
void placeDefaults(Scene& scene, const TriangleBvh& bvh);

}  // namespace mv
