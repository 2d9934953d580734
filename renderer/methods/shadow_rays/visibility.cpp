// Shadow rays: no maps, each of the gather's samples is a ray against the scene's triangles. Exact
// visibility at the price of rays: what maps and marches are to be measured against.

#include "renderer/visibility.h"

namespace mv {
namespace {

// Rounds that a ray is left at first, all lanes together; few need a tenth of it.
constexpr std::uint32_t kRayRounds = 4000;

class ShadowRays : public Visibility {
    void make(const VisibilityInput& input, const MethodSettings&, gl::Profiler&,
              MethodStatistics&) override {
        triangles_ = &input.scene.triangles;
    }
    std::optional<SampleVisibility> sample() const override { return shadowRaySample(*triangles_); }

    const BvhTables* triangles_ = nullptr;
};

}  // namespace

SampleVisibility shadowRaySample(const BvhTables& triangles) {
    return {"methods/shadow_rays/visible.glsl",
            {{"MV_BVH_MASKS", triangles.masks() ? "1" : "0"}},
            [&triangles](gl::Program& program) { triangles.bind(program); },
            kRayRounds,
            "a ray looks at too many triangles for this renderer's loops: take another method"};
}

template <>
std::unique_ptr<Visibility> makeVisibility<Method::shadowRays>(gl::Results) {
    return std::make_unique<ShadowRays>();
}

}  // namespace mv
