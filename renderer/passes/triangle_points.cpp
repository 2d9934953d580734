#include "renderer/passes/triangle_points.h"

#include <algorithm>
#include <string>

#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

gl::Program makeProgram(const char* label, const char* file, bool masks) {
    return gl::Program(label, {std::string("passes/") + file},
                       {{"MV_BVH_MASKS", masks ? "1" : "0"}});
}

}  // namespace

std::uint32_t TrianglePoints::groupsOf(const BvhTables& scene) {
    return divideUp(scene.triangleCount(), kVirGroup);
}

std::uint32_t TrianglePoints::clustersOf(std::uint32_t points) {
    return divideUp(points, kVirCluster);
}

gl::TexelBuffer<std::uint32_t>& TrianglePoints::groupLevels(const BvhTables& scene) {
    groupLevels_.ensure("levels of triangles", groupsOf(scene));
    return groupLevels_;
}

std::uint32_t TrianglePoints::count(const BvhTables& scene, std::uint32_t level, float spacing) {
    if (!count_) count_ = makeProgram("count points", "triangle_points_count.comp", false);
    const std::uint32_t triangles = scene.triangleCount();
    counts_.ensure("points of triangles", triangles + 1);
    firsts_.ensure("first points of triangles", triangles + 1);
    scene.bind(count_);
    groupLevels_.bindTexels(kUnitGroupLevels);
    counts_.bindStorage(kBlockPointCounts);
    count_.set("triangleCount", triangles);
    count_.set("level", level);
    count_.set("spacing", spacing);
    count_.dispatchInvocations(triangles + 1);
    sums_.exclusive(counts_, triangles + 1, firsts_);
    spacing_ = spacing;
    return total_ = firsts_.read(triangles, 1).front();
}

std::uint32_t TrianglePoints::make(const BvhTables& scene, std::uint32_t first) {
    gl::Program& program = points_[scene.masks()];
    if (!program) program = makeProgram("make points", "triangle_points.comp", scene.masks());
    const std::uint32_t points = std::min(batch_, total_ - first);
    const std::uint32_t clusters = clustersOf(points);
    batchPoints_.ensure("points", points);
    clusters_.ensure("clusters of points", 2 * std::uint64_t{clusters});
    scene.bind(program);
    firsts_.bindTexels(kUnitFirstPoints);
    batchPoints_.bindStorage(kBlockPoints);
    clusters_.bindStorage(kBlockClusters);
    program.set("triangleCount", scene.triangleCount());
    program.set("firstPoint", first);
    program.set("pointCount", points);
    program.set("spacing", spacing_);
    program.dispatchInvocations(clusters);
    return points;
}

void TrianglePoints::bind() const {
    batchPoints_.bindTexels(kUnitSurfacePoints);
    clusters_.bindTexels(kUnitClusters);
}

std::uint64_t TrianglePoints::bytes() const {
    return groupLevels_.bytes() + counts_.bytes() + firsts_.bytes() + batchPoints_.bytes() +
           clusters_.bytes();
}

}  // namespace mv
