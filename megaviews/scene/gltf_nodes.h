#pragma once
// The nodes of a glTF scene: the tree in an order that has parents first, its animations, what is
// to be drawn where, and the lights and cameras. Serves the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <vector>

#include "megaviews/scene/gltf_accessor.h"
#include "megaviews/scene/rig.h"

namespace mv {

// sceneIndex < 0: the file's default scene.
Rig buildRig(const tinygltf::Model& model, int sceneIndex, GltfReport& report);

// Weights of a node's morph targets where no animation says otherwise, as many as `count`.
std::vector<double> restWeights(const tinygltf::Model& model, const Rig& rig, std::size_t node,
                                std::size_t count);

// Lights, cameras, the nodes they hang on and the animation of those, into `scene`.
void addLightsAndCameras(const tinygltf::Model& model, const Rig& rig, Scene& scene);

// Messages name a node so: nodes[3] ("lamp").
std::string nodePlace(const tinygltf::Model& model, int fileNode);

}  // namespace mv
