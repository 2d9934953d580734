#pragma once
// The scenes made by code, one function each; makeBuiltin (load_scene.h) names them. Each fills
// geometry, materials, an animated light and at least one camera; world units are metres.

#include "megaviews/scene/scene.h"

namespace mv::builtin {

void makeCornell(Scene& scene);    // the box of Goral et al. with its two blocks
void makeAtrium(Scene& scene);     // two-storey colonnade round an open court
void makeCathedral(Scene& scene);  // nave and aisles under pointed vaults
void makeHairball(Scene& scene);   // a ball of thin curved tubes in a room
void makeDoor(Scene& scene);       // a dark room, lit through a door that opens and closes

}  // namespace mv::builtin
