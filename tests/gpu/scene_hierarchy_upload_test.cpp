#include "renderer/passes/scene_hierarchy_upload.h"

#include <cstring>

#include "gl/gl_fixture.h"
#include "hierarchy/test_scenes.h"

namespace mv {
namespace {

bool sameBytes(const auto& a, const auto& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

class SceneHierarchyUpload : public GlTest {};

TEST_F(SceneHierarchyUpload, holdsTheNodesOfTheRules) {
    const Scene scene = test::randomTriangles(20, 4);
    const SceneHierarchy h = SceneHierarchy::build(scene, TriangleBvh::build(scene), 6);
    for (const uint rules : {kPublishedRules, kCorrectedRules}) {
        const GpuSceneHierarchy gpu = uploadSceneHierarchy(h, rules);
        EXPECT_EQ(gpu.levels, 6);
        EXPECT_EQ(gpu.levelBegin, h.levelBegin);
        ASSERT_EQ(gpu.nodeCount, h.nodes.size());
        EXPECT_TRUE(sameBytes(gpu.nodes.read(0, gpu.nodeCount), h.nodesUnder(rules)));
    }
    expectNoGlErrors();
}

TEST_F(SceneHierarchyUpload, takesAnEmptyScene) {
    Scene scene;
    scene.materials.emplace_back();
    const SceneHierarchy h = SceneHierarchy::build(scene, TriangleBvh::build(scene), 11);
    const GpuSceneHierarchy gpu = uploadSceneHierarchy(h, kCorrectedRules);
    EXPECT_EQ(gpu.nodeCount, 0u);
    EXPECT_EQ(gpu.levels, 0);
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
