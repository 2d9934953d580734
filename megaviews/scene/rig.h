#pragma once
// What geometry is posed from: nodes and their animations, meshes in their bind pose, skins, and
// which mesh is drawn where. Made by the loader; kept with a scene for what of it moves
// (rigged_scene.h). Serves the first stage, file -> Scene, and every frame of what moves.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

// One animated property that Scene's channels do not know.
struct WeightChannel {
    std::size_t node = 0;  // in Rig's order
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times;
    std::vector<double> values;  // weights a key; cubicSpline: in-tangents, values, out-tangents
};

// All nodes of the file that its chosen scene reaches, and those that skins refer to.
struct Rig {
    std::vector<Node> nodes;
    std::vector<int> fileNode;  // parallel to nodes: index in the file
    std::vector<int> rigNode;   // file node -> index in nodes, -1 = absent
    std::vector<bool> inScene;  // parallel to nodes: drawn, or only a joint
    std::vector<Animation> animations;
    std::vector<std::vector<WeightChannel>> weightChannels;  // parallel to animations; by node
};

// One primitive of a mesh, kept once whatever number of nodes draws it: triangles wound alike,
// positions in double, attributes as a Scene has them.
struct Primitive {
    std::string place;  // meshes[0].primitives[1] ("name")
    std::vector<glm::dvec3> positions;
    double positionStep = 0;                  // of the grid that they lie on; 0: none
    std::vector<glm::dvec3> normals;          // empty: flat
    std::vector<glm::vec4> colors;            // optional
    std::vector<glm::vec2> uvs, emissiveUvs;  // transformed; empty: no such texture
    std::vector<glm::uvec3> triangles;
    std::uint32_t material = 0;

    struct Influences {  // JOINTS_n and WEIGHTS_n
        std::vector<glm::uvec4> joints;
        std::vector<glm::dvec4> weights;
    };
    std::vector<Influences> influences;
    struct MorphTarget {  // displacements; empty: none
        std::vector<glm::dvec3> positions, normals;
    };
    std::vector<MorphTarget> targets;

    std::size_t repeatedIndices = 0;  // triangles that a list drops for two equal indices
    std::size_t leftOverIndices = 0;  // that make no whole triangle
};

struct Skin {
    std::vector<int> joints;  // of the rig
    std::vector<glm::dmat4> inverseBind;
};

// A primitive on a node.
struct RiggedDraw {
    std::size_t primitive = 0;  // index
    std::size_t node = 0;       // of the rig
    glm::dmat4 instance{1};     // on the node
    int skin = -1;
    std::vector<double> weights;  // of morph targets where no animation says otherwise
};

// The pose that geometry stands in.
struct PoseTime {
    int animation = -1;
    double timeS = 0;  // inside the animation's duration
};

// One primitive at one place and time.
struct Draw {
    const Primitive* primitive = nullptr;
    glm::dmat4 worldFromModel{1};
    // Skin: world from bind pose, a joint each; null: none.
    std::shared_ptr<const std::vector<glm::dmat4>> joints;
    std::vector<double> morphWeights;
};

// All draws at a time, in their order; they point into `primitives`.
std::vector<Draw> drawsAt(const Rig& rig, std::span<const Primitive> primitives,
                          std::span<const Skin> skins, std::span<const RiggedDraw> draws,
                          PoseTime time);

// Which draws stand otherwise at another time of an animation (-1: none).
std::vector<bool> movingDraws(const Rig& rig, std::span<const Primitive> primitives,
                              std::span<const Skin> skins, std::span<const RiggedDraw> draws,
                              int animation);

}  // namespace mv
