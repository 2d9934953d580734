#pragma once
// A scene as a frame shows it, as one binary glTF 2.0 file (Scene -> file): --save-scene. Geometry
// stands in its pose, lights and cameras where they are at one moment; nothing is animated. Other
// programs so get the very scene of a picture, made by code or not, with the light that this
// program placed; loadScene() gets the same triangles back, bit by bit.

#include <filesystem>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

struct SceneToSave {
    const Scene& scene;                // geometry, materials and images alone are taken from it
    std::vector<PosedLight> lights;    // world units
    std::vector<PosedCamera> cameras;  // world units; the first is the picture's; names are UTF-8
    double aspect = 1;                 // of the picture, width over height; > 0
    double lightScale = 1;             // multiplies lights and emission; >= 0
};

// Writes a GLB: one mesh in root-cube units under a node that takes it to world units, a primitive
// for each run of triangles of one material; metallic-roughness materials with all that Material
// holds: factors and textures of colour, metal and roughness, normal maps, emission, alpha masks
// and blending, KHR_materials_ior, _specular, _transmission, _volume, _clearcoat,
// _emissive_strength and _unlit; textures as embedded PNG with their wrap modes, coordinates as
// they are after KHR_texture_transform; KHR_lights_punctual with W/sr written as candela and W/m^2
// as lux, as the loader reads them; perspective and orthographic cameras in the order given, each
// with the picture's aspect ratio. `lightScale` cannot reach unlit materials, for which glTF has no
// strength; a light or an emission that is 0 is left out. `asset.extras` holds the
// root cube, which the loader takes so that positions keep their bits; normals may differ in the
// last. An empty scene is a file without a mesh.
//
// Throws Error(ExitCode::output), naming the file: it cannot be written, or would be larger than
// the 4 GiB that a GLB can be. Nothing is left behind then.
void saveScene(const std::filesystem::path& file, const SceneToSave& saved);

}  // namespace mv
