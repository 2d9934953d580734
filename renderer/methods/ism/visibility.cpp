// Imperfect shadow maps [RGK08]: each view splats its own few of the scene's points, and holes are
// filled by coarser levels.

#include <algorithm>

#include "renderer/methods/ism/ism_pass.h"
#include "renderer/visibility.h"

namespace mv {
namespace {

// The surface's points are the same whatever views are drawn.
constexpr std::uint32_t kSurfacePointsSeed = 1;

class ImperfectVisibility : public Visibility {
    MethodSettings read(const MethodSettings& settings) const override {
        MethodSettings out = Visibility::read(settings);
        out.ism = settings.ism;
        return out;
    }
    bool drawsAtRandom() const override { return true; }
    void make(const VisibilityInput& input, const MethodSettings& settings, gl::Profiler& profiler,
              MethodStatistics& statistics) override {
        useHierarchy(input, kCorrectedRules, true, profiler);
        const auto count =
            static_cast<std::uint32_t>(std::max(settings.ism.pool, settings.ism.points));
        if (!points_ || points_->requested != count || pose_ != input.scene.poseNumber()) {
            pose_ = input.scene.poseNumber();
            points_.reset();
            points_ = upload(makeSurfacePoints(input.scene.bvh, count, kSurfacePointsSeed));
            points_->requested = count;
        }
        const IsmOptions options{.mapRes = settings.maps.resolution,
                                 .pointsPerView = static_cast<std::uint32_t>(settings.ism.points),
                                 .seed = input.seed};
        pass_.render(*points_, hierarchy(), options, bytesOf(settings.maps), profiler, maps_,
                     statistics);
    }
    std::vector<MemoryUse> memory() const override {
        return {{"surface points", points_ ? points_->points.bytes() : 0, 0}};
    }

    IsmPass pass_;
    std::optional<GpuSurfacePoints> points_;
    std::uint64_t pose_ = 0;  // that they were drawn in
};

}  // namespace

template <>
std::unique_ptr<Visibility> makeVisibility<Method::ism>(gl::Results) {
    return std::make_unique<ImperfectVisibility>();
}

}  // namespace mv
