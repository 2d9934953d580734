#pragma once
// The nodes of a glTF scene: the tree in an order that has parents first, its animations, what is
// to be drawn where, and the lights and cameras. Serves the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <vector>

#include "megaviews/scene/gltf_accessor.h"
#include "megaviews/scene/scene.h"

namespace mv {

// One animated property that Scene's channels do not know, needed for the pose at load only.
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

// sceneIndex < 0: the file's default scene.
Rig buildRig(const tinygltf::Model& model, int sceneIndex, GltfReport& report);

// Morph weights of a node at `time` of an animation (-1: none), as many as `count`.
std::vector<double> morphWeights(const tinygltf::Model& model, const Rig& rig, std::size_t node,
                                 int animation, double time, std::size_t count);

// Lights, cameras, the nodes they hang on and the animation of those, into `scene`.
void addLightsAndCameras(const tinygltf::Model& model, const Rig& rig, Scene& scene);

// Of a node in messages: nodes[3] ("lamp").
std::string nodePlace(const tinygltf::Model& model, int fileNode);

}  // namespace mv
