#pragma once
// A built-in scene as a binary tree over its samples, for tests that know a synthetic octree: the
// samples stand for its patches, so that views may be placed on them.

#include <string>

#include "megaviews/hierarchy/moving_surface.h"
#include "megaviews/hierarchy/sample_tree.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/scene/rigged_scene.h"
#include "support/synthetic.h"

namespace mv::testing {

// Stays where it is: the triangle hierarchy points to the scene.
class BinaryScene {
  public:
    explicit BinaryScene(const std::string& name, int levels)
        : scene_(makeBuiltin(name, {})),
          bvh_(TriangleBvh::build(scene_)),
          hierarchy_(buildSampleTree(scene_, bvh_, levels)) {
        take();
    }
    BinaryScene(const BinaryScene&) = delete;
    BinaryScene& operator=(const BinaryScene&) = delete;

    void pose(double timeS) {
        poseScene(scene_, timeS);
        bvh_.refit();
        hierarchy_.refit(scene_);
        take();
    }
    const SyntheticScene& tree() const { return tree_; }
    const SceneNodes& nodes(uint rules) const { return nodesOf(tree_, rules); }
    std::vector<std::uint32_t> movingBegin() const {
        return hierarchy_.moving ? hierarchy_.moving->begin : std::vector<std::uint32_t>();
    }

  private:
    void take() {
        tree_.nodes = hierarchy_.nodes;
        for (uint rules = 0; rules < kNodeTables; ++rules) {
            tree_.tables[sceneTable(rules)] = hierarchy_.nodesUnder(rules);
        }
        tree_.levelBegin = hierarchy_.levelBegin;
        tree_.levels = hierarchy_.levels;
        tree_.patches.clear();
        for (const TreeSample& point : hierarchy_.samples->points) {
            const glm::uvec3 c = scene_.triangles[point.triangle];
            const vec3 a = scene_.positions[c.x];
            tree_.patches.push_back({vec3(positionOf(scene_, point)),
                                     (scene_.positions[c.y] - a) * 0.01f,
                                     (scene_.positions[c.z] - a) * 0.01f});
        }
    }

    Scene scene_;
    TriangleBvh bvh_;
    SceneHierarchy hierarchy_;
    SyntheticScene tree_;
};

}  // namespace mv::testing
