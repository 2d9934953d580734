#include "renderer/methods/ism/ism_pass.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kPointsEach = 64;  // of an invocation, whose loops must end in time

}  // namespace

GpuSurfacePoints upload(const SurfacePoints& points) {
    GpuSurfacePoints out;
    out.points = {"surface points", points.points};
    out.requested = out.count = static_cast<std::uint32_t>(points.points.size());
    out.area = points.area;
    return out;
}

void IsmPass::render(const GpuSurfacePoints& surface, const GpuViewHierarchy& views,
                     const IsmOptions& options, std::uint64_t gpuMemoryBytes,
                     gl::Profiler& profiler, GpuViewMaps& out, MethodStatistics& statistics) {
    assert(options.pointsPerView > 0);
    const MapStore store{static_cast<uint>(options.mapRes)};
    const std::uint64_t mipBytes = options.fill ? 4 * mipWords(store, views.aliveCount) : 0;
    const std::uint64_t texels =
        makeFlatMaps(views, options.mapRes, options.fill ? 4 * mipWords(store, 1) : 0,
                     gpuMemoryBytes, out, statistics);
    if (options.fill) mips_.ensure("coarser map levels", std::max<std::uint64_t>(mipBytes, 16));
    statistics.workingMapBytes = mips_.bytes();
    statistics.mapBytes += statistics.workingMapBytes;
    statistics.predictedWorkingMapBytes = mipBytes;
    {
        const gl::PassScope scope(profiler, Stage::splatPoints);
        out.texels.fill(0, texels, kNone);
        if (surface.count > 0 && views.aliveCount > 0) splat(surface, views, options, out);
    }
    if (!options.fill || surface.count == 0 || views.aliveCount == 0) return;
    const gl::PassScope scope(profiler, Stage::pullAndPush);
    fill(options, out);
}

void IsmPass::splat(const GpuSurfacePoints& surface, const GpuViewHierarchy& views,
                    const IsmOptions& options, const GpuViewMaps& out) {
    if (!splat_) splat_ = gl::Program("splat points", {"methods/ism/ism_splat.comp"});
    views.sortedViews.bindTexels(kUnitSortedViews);
    surface.points.bindTexels(kUnitSurfacePoints);
    out.texels.bindStorage(kBlockMaps);
    splat_.set("viewCount", views.aliveCount);
    splat_.set("pointsPerView", options.pointsPerView);
    splat_.set("pointsEach", kPointsEach);
    splat_.set("stratum", ismStratum(surface.count, options.pointsPerView));
    splat_.set("seed", options.seed);
    splat_.set("mapRes", static_cast<uint>(options.mapRes));
    splat_.set("radius", ismRadius(surface.area, options.pointsPerView));
    const std::uint64_t stretches = (options.pointsPerView + kPointsEach - 1) / kPointsEach;
    splat_.dispatchInvocations(stretches * views.aliveCount);
}

void IsmPass::fill(const IsmOptions& options, const GpuViewMaps& out) {
    if (!pull_) {
        pull_ = gl::Program("pull", {"methods/ism/ism_fill.comp"}, {{"MV_PUSH", "0"}});
        push_ = gl::Program("push", {"methods/ism/ism_fill.comp"}, {{"MV_PUSH", "1"}});
    }
    const auto res = static_cast<uint>(options.mapRes);
    const auto levels = static_cast<uint>(std::bit_width(res)) - 1;
    out.texels.bindStorage(kBlockMaps);
    mips_.bindStorage(kBlockMips);
    const auto run = [&](gl::Program& program, uint level) {
        program.set("viewCount", out.mapCount);
        program.set("mapRes", res);
        program.set("level", level);
        program.dispatchInvocations(std::uint64_t{mapTexels(res >> level)} * out.mapCount);
    };
    for (uint level = 1; level <= levels; ++level) run(pull_, level);
    for (uint level = levels; level-- > 0;) run(push_, level);
}

}  // namespace mv
