#pragma once
// A scene as a frame shows it, as one binary glTF 2.0 file (Scene -> file): --save-scene. Geometry
// stands in its pose, lights and camera where they are at one moment; nothing is animated. Other
// programs so get the very scene of a picture, made by code or not, with the light that this
// program placed; loadScene() gets the same triangles back, bit by bit.

#include <filesystem>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

struct SceneToSave {
    const Scene& scene;              // geometry, materials and images alone are taken from it
    std::vector<PosedLight> lights;  // world units
    PosedCamera camera;              // world units; the file's only one
    double aspect = 1;               // of its picture, width over height; > 0
    double lightScale = 1;           // multiplies lights and emission; >= 0
};

// Writes a GLB: one mesh in root-cube units under a node that takes it to world units, a primitive
// for each run of triangles of one material; Lambertian metallic-roughness materials, alpha masks,
// KHR_materials_emissive_strength and KHR_materials_unlit; textures as embedded PNG with their
// wrap modes, coordinates as they are after KHR_texture_transform; KHR_lights_punctual with W/sr
// written as candela and W/m^2 as lux, as the loader reads them; a perspective or orthographic
// camera. `lightScale` cannot reach unlit materials, for which glTF has no strength, and a light
// or an emission that it makes 0 is left out. `asset.extras` holds the root cube, which the loader
// takes so that positions keep their bits; normals may differ in the last. An empty scene is a
// file without a mesh.
//
// Throws Error(ExitCode::output), naming the file: it cannot be written, or would be larger than
// the 4 GiB that a GLB can be. Nothing is left behind then.
void saveScene(const std::filesystem::path& file, const SceneToSave& saved);

}  // namespace mv
