// Octree rays: no maps, each of the gather's samples marches the scene octree
// (shaders/shared/march.glsl).

#include "renderer/methods/rays/visibility.h"

#include "megaviews/methods/rays/march_tree.h"
#include "renderer/passes/scene_hierarchy_upload.h"
#include "renderer/visibility.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

// What a march is left at first. Few need more: measured up to 1700 at 11 levels.
constexpr std::uint32_t kMarchSteps = 3300;

class MarchedVisibility : public Visibility {
    void make(const VisibilityInput& input, const MethodSettings&, gl::Profiler& profiler,
              MethodStatistics&) override {
        if (tree_ && pose_ == input.scene.poseNumber()) return;
        pose_ = input.scene.poseNumber();
        const gl::PassScope scope(profiler, Stage::marchTree);
        tree_ = uploadMarchTree(input.scene.hierarchy);
    }
    std::optional<SampleVisibility> sample() const override { return marchedSample(*tree_); }
    std::vector<MemoryUse> memory() const override {
        return {{"march tree", tree_ ? tree_->nodes.bytes() : 0, 0}};
    }

    std::optional<GpuMarchTree> tree_;
    std::uint64_t pose_ = 0;  // that it was made of
};

}  // namespace

GpuMarchTree uploadMarchTree(const SceneHierarchy& h) {
    checkTexels(h, 1);
    const MarchTree tree = MarchTree::build(h);
    GpuMarchTree out;
    out.nodes = {"march nodes", tree.nodes};
    out.nodeCount = static_cast<std::uint32_t>(tree.nodes.size());
    out.leafEdge = tree.leafEdge;
    return out;
}

SampleVisibility marchedSample(const GpuMarchTree& tree) {
    return {"methods/rays/visible.glsl",
            {},
            [&tree](gl::Program& program) {
                tree.nodes.bindTexels(kUnitMarchNodes);
                program.set("marchCount", tree.nodeCount);
                program.set("marchLeafEdge", tree.leafEdge);
            },
            kMarchSteps,
            "a ray looks at too many nodes of the scene octree: take a smaller --scene-depth"};
}

template <>
std::unique_ptr<Visibility> makeVisibility<Method::rays>(gl::Results) {
    return std::make_unique<MarchedVisibility>();
}

}  // namespace mv
