#pragma once
// From a scene's name to everything a frame is rendered from: scene, triangle hierarchy, default
// camera and light, scene tree from the cache or built. Also the camera that settings ask for.

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"

namespace mv {

// Lives on the heap and does not move: the triangle hierarchy points to the scene.
struct SceneAssets {
    SceneAssets() = default;
    SceneAssets(const SceneAssets&) = delete;
    SceneAssets& operator=(const SceneAssets&) = delete;

    Scene scene;
    TriangleBvh bvh;
    SceneHierarchy hierarchy;  // levels = 0 if only the scene was asked for
    int animation = -1;        // the one that the settings ask for

    // Brings what moves to a time of the animation: vertices, triangle hierarchy and octree. Nobody
    // may read them meanwhile. Nothing happens where it stands there already.
    void pose(double timeS);

    // Box of all positions in root-cube units; both corners 0 for an empty scene.
    std::pair<glm::vec3, glm::vec3> bounds() const;
};

// The scene at scene.timeS, its triangle hierarchy, a default camera and light where the file
// has none, and the tree of scene.tree and scene.octreeDepth. cacheDirectory empty: no cache.
// Throws Error(ExitCode::input) for a bad file and Error(ExitCode::usage) for a camera or animation
// that the scene does not have.
std::unique_ptr<SceneAssets> loadAssets(const std::string& name, const Settings& settings,
                                        const std::filesystem::path& cacheDirectory,
                                        const Progress& progress = {});
// The same in two steps: everything but the octree, what moves in some pose; then the octree, and
// the pose of scene.timeS.
std::unique_ptr<SceneAssets> loadAssetsWithoutHierarchy(const std::string& name,
                                                        const Settings& settings,
                                                        const Progress& progress = {});
void buildHierarchy(SceneAssets& assets, const Settings& settings,
                    const std::filesystem::path& cacheDirectory, const Progress& progress = {});

// The scene's camera at a time with what the settings put in its place. Throws
// Error(ExitCode::usage) if they leave no direction to look in.
PosedCamera posedCamera(const SceneAssets& assets, const Settings& settings, double timeS);
// The scene's lights at a time, where Settings::scene.lights puts them; not yet scaled.
std::vector<PosedLight> posedLights(const SceneAssets& assets, const std::string& placements,
                                    double timeS);
FrameCamera chosenCamera(const Settings& settings, const SceneAssets& assets, double timeS);

}  // namespace mv
