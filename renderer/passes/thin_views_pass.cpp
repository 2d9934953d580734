#include "renderer/passes/thin_views_pass.h"

#include <span>
#include <string>

#include "shaders/shared/bindings.glsl"

namespace mv {

void ThinViewsPass::thin(const Importance& by, std::uint64_t wanted, std::uint32_t seed,
                         gl::Profiler& profiler, GpuViews& candidates) {
    const gl::PassScope scope(profiler, Stage::chooseViews);
    const std::uint32_t blocks = (candidates.count + kImportanceBlock - 1) / kImportanceBlock;
    points_.ensure("importance points", std::max<std::size_t>(by.points.size(), 1));
    points_.write(0, by.points);
    places_.ensure("importance places",
                   std::max<std::size_t>(by.places.size(), 1) * sizeof(ImportancePlace));
    places_.write(0, std::span<const ImportancePlace>(by.places));
    importance_.ensure("importance of candidates", candidates.count * sizeof(float));
    sums_.ensure("sums of importance", blocks * sizeof(glm::vec4));
    totals_.ensure("totals of importance", sizeof(ImportanceTotals));

    points_.bindTexels(kUnitImportancePoints);
    places_.bindStorage(kBlockImportancePlaces);
    candidates.views.bindStorage(kBlockViews);
    importance_.bindStorage(kBlockImportance);
    sums_.bindStorage(kBlockImportanceSums);
    totals_.bindStorage(kBlockImportanceTotals);
    const auto run = [&](std::size_t stage, std::uint32_t invocations) {
        gl::Program& p = programs_[stage];
        if (!p) {
            p = gl::Program("choose views " + std::to_string(stage), {"passes/thin_views.comp"},
                            {{"MV_STAGE", std::to_string(stage)}});
        }
        const bool each = stage == 0 || stage == 5;
        const bool sums = stage == 2 || stage == 4;
        if (each || stage == 1 || stage == 3) p.set("count", candidates.count);
        if (!each) p.set("blocks", blocks);
        if (stage == 0) {
            p.set("pointCount", static_cast<std::uint32_t>(by.points.size()));
            p.set("placeCount", static_cast<std::uint32_t>(by.places.size()));
            p.set("distance", by.distance);
        }
        if (sums) p.set("wanted", static_cast<float>(wanted));
        if (stage == 5) p.set("seed", seed);
        if (sums) {
            p.dispatchGroups(1);
        } else {
            p.dispatchInvocations(invocations);
        }
    };
    run(0, candidates.count);
    run(1, blocks);
    run(2, 1);
    for (std::uint32_t round = 0; round < kImportanceRounds; ++round) {
        run(3, blocks);
        run(4, 1);
    }
    run(5, candidates.count);
}

std::uint64_t ThinViewsPass::bytes() const {
    return points_.bytes() + places_.bytes() + importance_.bytes() + sums_.bytes() +
           totals_.bytes();
}

}  // namespace mv
