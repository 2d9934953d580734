#pragma once
// From a rig and what is drawn on it to the triangles of a Scene: poses, morphs, skins and
// instances in double, finds the root cube, writes root-cube floats. What an animation moves comes
// last in the arrays and keeps its rig, so that it can be posed anew for every frame (poseScene); a
// scene in which nothing does keeps none of it.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/scene/rig.h"

namespace mv {

struct RiggedScene {
    Rig rig;
    std::vector<Primitive> primitives;
    std::vector<Skin> skins;
    std::vector<RiggedDraw> draws;
};

// What poseScene() needs; immutable.
struct MovingGeometry {
    RiggedScene rigged;  // of its draws, those that move
    int animation = 0;
    double durationS = 0;
    std::vector<double> referenceS;          // of each draw: when trees are built of it
    std::vector<glm::uvec2> first;           // vertex and triangle of each draw in the scene
    std::uint32_t vertex = 0, triangle = 0;  // the first that move
    glm::vec3 min{0}, max{0};                // box over the whole animation, root-cube units
    std::string contentHash;                 // of the scene whatever the time
};

// Counts of what could not be drawn.
struct LeftOut {
    std::size_t notFinite = 0, flat = 0, badNormals = 0;
};

// Fills the geometry arrays and the root cube of `scene`, posed at `time`. Scene::contentHash is
// that of the file. The cube holds what moves at all times of the animation, found at 16 to 128 of
// them: what leaves it between is held at its faces. A triangle of what moves stays even where it
// has no area.
// `stated` is the cube that the file names, if it does: it is taken where it fits the geometry, so
// that what was computed in it comes back bit by bit.
LeftOut assembleGeometry(RiggedScene rigged, PoseTime time, double durationS,
                         const std::optional<RootCube>& stated, Scene& scene,
                         const Progress& progress);

// Moves what moves to where it stands at a time of the animation, endlessly looped: positions,
// normals, the winding of triangles, which a transform may turn inside out, Scene::contentHash and
// poseNumber. False if it stands there already, or nothing moves.
// A triangle hierarchy and an octree of the scene follow by their refit().
bool poseScene(Scene& scene, double timeS);

// Moves what moves to where trees are built of it: all to the time at which its surface is largest,
// but what is small then, such as one of two things shown in turn, to a time of its own.
void poseForTrees(Scene& scene);

}  // namespace mv
