#include "renderer/methods/vir/vir_pass.h"

#include <algorithm>
#include <limits>
#include <string>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

// Loops of an invocation must end in time: views that ask for levels, and clusters that are
// splatted, each of whose points may be as large as kVirReach lets it.
constexpr std::uint32_t kViewsEach = 1 << 15, kClustersEach = 5;

}  // namespace

void VirPass::render(const VirInput& input, gl::Profiler& profiler, GpuViewMaps& out,
                     MethodStatistics& statistics) {
    if (input.mostPoints > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ExitCode::impossible,
                    "vir may have to make " + std::to_string(input.mostPoints) +
                        " points at once, and counts to 4294967295: lower --vir-density or "
                        "--view-res");
    }
    const std::uint64_t texels =
        makeFlatMaps(input.views, input.options.mapRes, 0, input.gpuMemoryBytes, out, statistics);
    out.texels.fill(0, texels, kNone);
    if (input.scene.triangleCount() == 0 || input.views.aliveCount == 0) return;

    if (!levels_) {
        levels_ = gl::Program("levels of triangles", {"methods/vir/vir_levels.comp"});
        splat_ = gl::Program("splat points", {"methods/vir/vir_splat.comp"});
    }
    {
        const gl::PassScope scope(profiler, Stage::makePoints);
        findLevels(input);
    }
    for (std::uint32_t level = 0; level < kVirLevels; ++level) {
        std::uint32_t total = 0;
        {
            const gl::PassScope scope(profiler, Stage::makePoints);
            total = points_.count(input.scene, level, virSpacing(input.options, level));
        }
        statistics.points += total;
        for (std::uint32_t first = 0, count = 0; first < total; first += count) {
            {
                const gl::PassScope scope(profiler, Stage::makePoints);
                count = points_.make(input.scene, first);
            }
            const gl::PassScope scope(profiler, Stage::splatPoints);
            splat(input, level, count, out);
            profiler.report(Stage::splatPoints,
                            (level + static_cast<double>(first + count) / total) / kVirLevels);
        }
    }
}

void VirPass::findLevels(const VirInput& input) {
    const std::uint32_t groups = TrianglePoints::groupsOf(input.scene);
    gl::TexelBuffer<std::uint32_t>& groupLevels = points_.groupLevels(input.scene);
    groupLevels.fill(0, groups, 0);
    input.scene.bind(levels_);
    input.views.sortedViews.bindTexels(kUnitSortedViews);
    groupLevels.bindStorage(kBlockGroupLevels);
    levels_.set("triangleCount", input.scene.triangleCount());
    const std::uint32_t views = input.views.aliveCount;
    for (std::uint32_t first = 0; first < views; first += std::min(kViewsEach, views - first)) {
        levels_.set("firstView", first);
        levels_.set("endView", first + std::min(kViewsEach, views - first));
        levels_.dispatchInvocations(groups);
    }
}

void VirPass::splat(const VirInput& input, std::uint32_t level, std::uint32_t count,
                    const GpuViewMaps& out) {
    input.scene.bind(splat_);
    input.views.sortedViews.bindTexels(kUnitSortedViews);
    points_.bind();
    out.texels.bindStorage(kBlockMaps);
    const std::uint32_t across =
        divideUp(input.views.aliveCount, static_cast<std::uint32_t>(gl::limits().workGroupSize));
    splat_.set("pointCount", count);
    splat_.set("groupsAcross", across);
    splat_.set("viewCount", input.views.aliveCount);
    splat_.set("clustersEach", kClustersEach);
    splat_.set("mapRes", static_cast<uint>(input.options.mapRes));
    splat_.set("spacing", virSpacing(input.options, level));
    splat_.set("level", level);
    splat_.dispatchGroups(std::uint64_t{across} *
                          divideUp(TrianglePoints::clustersOf(count), kClustersEach));
    glFlush();  // a dispatch a command buffer: none runs into a driver's time limit
}

}  // namespace mv
