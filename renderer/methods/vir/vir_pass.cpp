#include "renderer/methods/vir/vir_pass.h"

#include <algorithm>
#include <cassert>
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

gl::Program makeProgram(const char* label, const char* file, bool masks = false) {
    return gl::Program(label, {std::string("methods/vir/") + file},
                       {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
                        {"MV_BVH_MASKS", masks ? "1" : "0"}});
}

std::uint32_t divideUp(std::uint32_t n, std::uint32_t by) { return (n + by - 1) / by; }

}  // namespace

struct VirPass::Frame {
    const BvhTables& scene;
    const GpuViewHierarchy& views;
    const VirOptions& options;
    std::uint32_t triangles() const { return scene.triangleCount(); }
};

std::uint64_t VirPass::bytes() const {
    return groupLevels_.bytes() + counts_.bytes() + firsts_.bytes() + batchPoints_.bytes() +
           clusters_.bytes();
}

void VirPass::render(const BvhTables& scene, const GpuViewHierarchy& views,
                     const VirOptions& options, std::uint64_t mostPoints,
                     std::uint64_t gpuMemoryBytes, gl::Profiler& profiler, GpuViewMaps& out,
                     MethodStatistics& statistics) {
    assert(views.flat && views.leafCount == views.aliveCount);
    const std::uint64_t texels =
        mapWords(MapStore{static_cast<uint>(options.viewRes)}, views.aliveCount);
    checkFinalMaps({views.aliveCount, options.viewRes}, gpuMemoryBytes);
    if (mostPoints > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ExitCode::impossible,
                    "vir may have to make " + std::to_string(mostPoints) +
                        " points at once, and counts to 4294967295: lower --vir-density or "
                        "--view-res");
    }
    out.present = out.fused = true;
    out.viewRes = options.viewRes;
    out.mapCount = views.aliveCount;
    out.texels.ensure("view maps", std::max<std::uint64_t>(texels, 4));
    out.texels.fill(0, texels, kNone);
    statistics = {};
    statistics.passes.passes = 1;
    statistics.maps = out.mapCount;
    statistics.mapBytes = out.texels.bytes();
    statistics.predictedMapBytes = 4 * texels;
    if (scene.triangleCount() == 0 || views.aliveCount == 0) return;

    makePrograms(scene.masks());
    const Frame frame{scene, views, options};
    {
        const gl::PassScope scope(profiler, Stage::makePoints);
        findLevels(frame);
    }
    for (std::uint32_t level = 0; level < kVirLevels; ++level) {
        std::uint32_t total = 0;
        {
            const gl::PassScope scope(profiler, Stage::makePoints);
            total = countPoints(frame, level);
        }
        statistics.points += total;
        for (std::uint32_t first = 0; first < total; first += std::min(batch_, total - first)) {
            const std::uint32_t count = std::min(batch_, total - first);
            {
                const gl::PassScope scope(profiler, Stage::makePoints);
                makePoints(frame, level, first, count);
            }
            const gl::PassScope scope(profiler, Stage::splatPoints);
            splat(frame, level, count, out);
            profiler.report(Stage::splatPoints,
                            (level + static_cast<double>(first + count) / total) / kVirLevels);
        }
    }
}

void VirPass::makePrograms(bool masks) {
    if (!levels_) {
        levels_ = makeProgram("levels of triangles", "vir_levels.comp");
        count_ = makeProgram("count points", "vir_count.comp");
        splat_ = makeProgram("splat points", "vir_splat.comp");
    }
    if (!points_[masks]) points_[masks] = makeProgram("make points", "vir_points.comp", masks);
}

void VirPass::findLevels(const Frame& frame) {
    const std::uint32_t groups = divideUp(frame.triangles(), kVirGroup);
    groupLevels_.ensure("levels of triangles", groups);
    groupLevels_.fill(0, groups, 0);
    frame.scene.bind(levels_);
    frame.views.sortedViews.bindTexels(kUnitSortedViews);
    groupLevels_.bindStorage(kBlockGroupLevels);
    levels_.set("triangleCount", frame.triangles());
    const std::uint32_t views = frame.views.aliveCount;
    for (std::uint32_t first = 0; first < views; first += std::min(kViewsEach, views - first)) {
        levels_.set("firstView", first);
        levels_.set("endView", first + std::min(kViewsEach, views - first));
        // Producers: the sort of the views, the fill, and the views before.
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
        levels_.dispatchInvocations(groups);
    }
}

std::uint32_t VirPass::countPoints(const Frame& frame, std::uint32_t level) {
    const std::uint32_t triangles = frame.triangles();
    counts_.ensure("points of triangles", triangles + 1);
    firsts_.ensure("first points of triangles", triangles + 1);
    frame.scene.bind(count_);
    groupLevels_.bindTexels(kUnitGroupLevels);
    counts_.bindStorage(kBlockPointCounts);
    count_.set("triangleCount", triangles);
    count_.set("level", level);
    count_.set("spacing", virSpacing(frame.options, level));
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the levels of the groups
    count_.dispatchInvocations(triangles + 1);
    sums_.exclusive(counts_, triangles + 1, firsts_);
    gl::barrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // producer: the sums
    return firsts_.read(triangles, 1).front();
}

void VirPass::makePoints(const Frame& frame, std::uint32_t level, std::uint32_t first,
                         std::uint32_t count) {
    gl::Program& program = points_[frame.scene.masks()];
    const std::uint32_t clusters = divideUp(count, kVirCluster);
    batchPoints_.ensure("points", count);
    clusters_.ensure("clusters of points", 2 * std::uint64_t{clusters});
    frame.scene.bind(program);
    firsts_.bindTexels(kUnitFirstPoints);
    batchPoints_.bindStorage(kBlockPoints);
    clusters_.bindStorage(kBlockClusters);
    program.set("triangleCount", frame.triangles());
    program.set("firstPoint", first);
    program.set("pointCount", count);
    program.set("spacing", virSpacing(frame.options, level));
    // Producers: the sums, and the splats of the batch before, which read what is written.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    program.dispatchInvocations(clusters);
}

void VirPass::splat(const Frame& frame, std::uint32_t level, std::uint32_t count,
                    const GpuViewMaps& out) {
    frame.scene.bind(splat_);
    frame.views.sortedViews.bindTexels(kUnitSortedViews);
    batchPoints_.bindTexels(kUnitSurfacePoints);
    clusters_.bindTexels(kUnitClusters);
    out.texels.bindStorage(kBlockMaps);
    const std::uint32_t across =
        divideUp(frame.views.aliveCount, static_cast<std::uint32_t>(gl::limits().workGroupSize));
    splat_.set("pointCount", count);
    splat_.set("groupsAcross", across);
    splat_.set("viewCount", frame.views.aliveCount);
    splat_.set("clustersEach", kClustersEach);
    splat_.set("viewRes", static_cast<uint>(frame.options.viewRes));
    splat_.set("spacing", virSpacing(frame.options, level));
    splat_.set("level", level);
    // Producers: the fill of the maps, and the points.
    gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    splat_.dispatchGroups(std::uint64_t{across} *
                          divideUp(divideUp(count, kVirCluster), kClustersEach));
    glFlush();  // a dispatch a command buffer: none runs into a driver's time limit
}

}  // namespace mv
