#include "renderer/passes/sky_maps.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "megaviews/core/error.h"
#include "megaviews/methods/vir/point_maps.h"
#include "megaviews/views/sky_views.h"
#include "renderer/gl/context.h"
#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

// Of an invocation; each is a few texels wide, and loops must end in time.
constexpr std::uint32_t kPointsEach = 2048;

constexpr float kAround = 1.001f;  // of the ball that holds the scene: rounding

void checkMemory(std::uint64_t views, int res, std::uint64_t gpuMemoryBytes) {
    const auto side = static_cast<std::uint64_t>(res);
    const std::uint64_t bytes = 4 * views * side * side;
    const auto block =
        std::min(static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes),
                 4 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels));
    const std::uint64_t limit = std::min(gpuMemoryBytes, block);
    if (bytes <= limit) return;
    throw Error(
        ExitCode::impossible,
        std::to_string(views) + " sky maps of " + std::to_string(res) + "^2 texels need " +
            mebibytes(bytes) + ", and " +
            (block < gpuMemoryBytes ? "a buffer of this device holds " : "--gpu-memory allows ") +
            mebibytes(limit) + ": lower --sky-views or --sky-view-res");
}

}  // namespace

void SkyMaps::make(const BvhTables& scene, const TriangleBvh& bvh, const Sky& sky, int views,
                   int res, std::uint64_t gpuMemoryBytes, gl::Profiler& profiler) {
    const std::vector<SkyView> list = makeSkyViews(sky, views);
    viewCount_ = static_cast<std::uint32_t>(list.size());
    res_ = static_cast<std::uint32_t>(res);
    checkMemory(viewCount_, res, gpuMemoryBytes);
    centre_ = bvh.center;
    radius_ = std::max(bvh.radius, 1e-6f) * kAround;
    const std::uint64_t mostPoints = parallelMostPoints(bvh, radius_, res);
    if (mostPoints > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ExitCode::impossible, "sky maps may have to make " +
                                              std::to_string(mostPoints) +
                                              " points, and counts to 4294967295: lower "
                                              "--sky-view-res");
    }
    views_.ensure("sky views", std::max<std::uint64_t>(list.size(), 1));
    views_.write(0, list);
    const std::uint64_t texels = std::uint64_t{viewCount_} * res_ * res_;
    texels_.ensure("sky maps", std::max<std::uint64_t>(texels, 4));
    texels_.fill(0, texels, kNone);
    madePoints_ = 0;
    if (scene.triangleCount() == 0 || viewCount_ == 0) return;

    const gl::PassScope scope(profiler, Stage::skyMaps);
    const float spacing = parallelSpacing(radius_, res);
    points_.groupLevels(scene).fill(0, TrianglePoints::groupsOf(scene), 1);
    const std::uint32_t total = points_.count(scene, 0, spacing);
    madePoints_ = total;
    for (std::uint32_t first = 0, count = 0; first < total; first += count) {
        count = points_.make(scene, first);
        splat(scene, count, spacing);
        profiler.report(Stage::skyMaps, static_cast<double>(first + count) / total);
    }
}

void SkyMaps::splat(const BvhTables& scene, std::uint32_t count, float spacing) {
    if (!splat_) {
        splat_ = gl::Program("splat sky maps", {"passes/sky_splat.comp"});
    }
    scene.bind(splat_);
    points_.bind();
    views_.bindTexels(kUnitSkyViews);
    texels_.bindStorage(kBlockMaps);
    const std::uint32_t across =
        divideUp(viewCount_, static_cast<std::uint32_t>(gl::limits().workGroupSize));
    splat_.set("pointCount", count);
    splat_.set("groupsAcross", across);
    splat_.set("viewCount", viewCount_);
    splat_.set("pointsEach", kPointsEach);
    splat_.set("mapRes", res_);
    splat_.set("spacing", spacing);
    splat_.set("centre", centre_);
    splat_.set("radius", radius_);
    splat_.dispatchGroups(std::uint64_t{across} * divideUp(count, kPointsEach));
    glFlush();  // a dispatch a command buffer: none runs into a driver's time limit
}

void SkyMaps::bind(gl::Program& program) const {
    views_.bindTexels(kUnitSkyViews);
    texels_.bindTexels(kUnitSkyMaps);
    program.set("skyViewCount", viewCount_);
    program.set("skyMapRes", res_);
    program.set("skyCentre", centre_);
    program.set("skyRadius", radius_);
}

}  // namespace mv
