// View-independent rasterisation [Marrs17]: points made of the triangles each frame, for all views
// at once.

#include "renderer/visibility.h"

#include "renderer/methods/vir/vir_pass.h"

namespace mv {
namespace {

class VirVisibility : public Visibility {
    MethodSettings read(const MethodSettings& settings) const override {
        MethodSettings out = Visibility::read(settings);
        out.vir = settings.vir;
        return out;
    }
    void make(const VisibilityInput& input, const MethodSettings& settings, gl::Profiler& profiler,
              MethodStatistics& statistics) override {
        useHierarchy(input, kCorrectedRules, true, profiler);
        const VirOptions options{settings.maps.resolution,
                                 static_cast<float>(settings.vir.density)};
        pass_.render({.scene = input.scene.triangles,
                      .views = hierarchy(),
                      .options = options,
                      .mostPoints = virMostPoints(input.scene.bvh, options),
                      .gpuMemoryBytes = bytesOf(settings.maps)},
                     profiler, maps_, statistics);
    }
    std::vector<MemoryUse> memory() const override { return {{"points", pass_.bytes(), 0}}; }
    VirPass pass_;
};

}  // namespace

template <>
std::unique_ptr<Visibility> makeVisibility<Method::vir>(gl::Results) {
    return std::make_unique<VirVisibility>();
}

}  // namespace mv
