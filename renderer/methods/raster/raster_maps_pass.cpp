#include "renderer/methods/raster/raster_maps_pass.h"

#include <algorithm>
#include <array>

#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/gl/workarounds.h"
#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

// A triangle may cover every texel of every view: under Workaround::loopLimit an invocation takes
// fewer of them.
constexpr std::uint32_t kLimitedIterations = 60000, kUnlimitedIterations = 1u << 30;
// Views of one invocation, which fetches its triangle once for all of them.
constexpr std::uint32_t kMostViewsEach = 64;
constexpr std::uint64_t kFewestInvocations = 1 << 16;  // that keep a GPU busy

}  // namespace

struct RasterMapsPass::Impl {
    std::uint64_t pairsPerDispatch = kPairsPerDispatch;
    std::array<gl::Program, 2> programs;  // without and with alpha masks

    gl::Program& program(bool masks) {
        gl::Program& p = programs[masks ? 1 : 0];
        if (!p) {
            p = gl::Program("rasterise maps", {"methods/raster/raster_maps.comp"},
                            {{"MV_BVH_MASKS", masks ? "1" : "0"}});
        }
        return p;
    }
};

RasterMapsPass::RasterMapsPass(std::uint64_t pairsPerDispatch) : impl_(std::make_unique<Impl>()) {
    impl_->pairsPerDispatch = pairsPerDispatch;
}
RasterMapsPass::~RasterMapsPass() = default;

void RasterMapsPass::render(const BvhTables& scene, const GpuViewHierarchy& views, int mapRes,
                            std::uint64_t gpuMemoryBytes, gl::Profiler& profiler, GpuViewMaps& out,
                            MethodStatistics& statistics) {
    const auto res = static_cast<uint>(mapRes);
    const std::uint64_t texels = makeFlatMaps(views, mapRes, 0, gpuMemoryBytes, out, statistics);
    const gl::PassScope scope(profiler, Stage::rasterise);
    out.texels.fill(0, texels, kNone);
    if (scene.triangleCount() == 0 || views.aliveCount == 0) return;

    gl::Program& p = impl_->program(scene.masks());
    scene.bind(p);
    views.sortedViews.bindTexels(kUnitSortedViews);
    out.texels.bindStorage(kBlockMaps);
    const std::uint32_t triangles = scene.triangleCount();
    const auto groupSize = static_cast<std::uint32_t>(gl::limits().workGroupSize);
    const std::uint32_t across = (triangles + groupSize - 1) / groupSize;
    const std::uint32_t iterations =
        gl::isOn(gl::Workaround::loopLimit) ? kLimitedIterations : kUnlimitedIterations;
    const std::uint32_t rows = std::min(kMapFaces * res, iterations / res);
    const std::uint64_t wanted = std::uint64_t{triangles} * views.aliveCount / kFewestInvocations;
    const auto each = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        wanted, 1, std::clamp(iterations / (rows * res + 1), 1u, kMostViewsEach)));
    const std::uint64_t atOnce =
        std::max<std::uint64_t>(impl_->pairsPerDispatch / triangles / each, 1);
    p.set("triangleCount", triangles);
    p.set("groupsAcross", across);
    p.set("viewsEach", each);
    p.set("mapRes", res);
    for (std::uint32_t row = 0; row < kMapFaces * res; row += rows) {
        p.set("firstRow", row);
        p.set("endRow", std::min(row + rows, kMapFaces * res));
        for (std::uint64_t first = 0; first < views.aliveCount; first += atOnce * each) {
            const std::uint64_t end =
                std::min<std::uint64_t>(first + atOnce * each, views.aliveCount);
            p.set("firstView", static_cast<std::uint32_t>(first));
            p.set("endView", static_cast<std::uint32_t>(end));
            p.dispatchGroups(across * ((end - first + each - 1) / each));
            glFlush();  // a dispatch a command buffer: none runs into a driver's time limit
            profiler.report(Stage::rasterise,
                            (row + static_cast<double>(std::min(rows, kMapFaces * res - row)) *
                                       static_cast<double>(end) / views.aliveCount) /
                                (kMapFaces * res));
        }
    }
}

}  // namespace mv
