#pragma once
// Materials, textures and images of a checked glTF model as a Scene has them: base colour, metal
// and roughness, normal map, emission and alpha mask. Serves the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/scene/gltf_file.h"
#include "megaviews/scene/scene.h"

namespace mv {

// Which texture coordinates a texture of a material is looked up at.
struct UvSource {
    int set = 0;  // TEXCOORD_set
    // uv' = matrix * uv + offset [KHR_texture_transform]
    glm::dmat2 matrix{1};
    glm::dvec2 offset{0};
    bool operator==(const UvSource&) const = default;
};
struct MaterialUvs {
    // Nothing: no such texture. `base` is that of all but emissive textures.
    std::optional<UvSource> base, emissive;
};

// Fills scene.materials (one a glTF material and, last, the default one), textures and images with
// what is used. Returns the texture coordinates of each material.
std::vector<MaterialUvs> loadMaterials(const tinygltf::Model& model, GltfFile& file, Scene& scene,
                                       GltfReport& report, const Progress& progress);

}  // namespace mv
