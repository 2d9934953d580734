// Octree rays: no maps, each of the gather's samples marches the scene octree
// (shaders/shared/march.glsl).

#include "renderer/visibility.h"
#include "renderer/passes/scene_hierarchy_upload.h"

namespace mv {
namespace {

class MarchedVisibility : public Visibility {
    MethodSettings read(const MethodSettings& settings) const override {
        MethodSettings out;
        out.method = settings.method;
        return out;
    }
    void make(const VisibilityInput& input, const MethodSettings&, gl::Profiler& profiler,
              MethodStatistics&) override {
        if (tree_) return;
        const gl::PassScope scope(profiler, Stage::marchTree);
        tree_ = uploadMarchTree(input.scene.hierarchy);
    }
    std::optional<SampleVisibility> sample() const override { return marchedSample(*tree_); }
    std::vector<MemoryUse> memory() const override {
        return {{"march tree", tree_ ? tree_->nodes.bytes() : 0, 0}};
    }

    std::optional<GpuMarchTree> tree_;
};

}  // namespace

template <>
std::unique_ptr<Visibility> makeVisibility<Method::rays>(gl::Results) {
    return std::make_unique<MarchedVisibility>();
}

}  // namespace mv
