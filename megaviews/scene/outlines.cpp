#include "megaviews/scene/outlines.h"

#include <algorithm>

#include "megaviews/scene/framing_probe.h"

namespace mv {
namespace {

constexpr float kReach = 0.02f;  // root-cube units
constexpr int kSamples = 400;
constexpr double kMostlyWrapped = 0.8;
constexpr double kOpen = 0.3;          // of the area, what is left of the sum of its vectors
constexpr double kLeastShare = 0.05;   // of the scene's area
constexpr std::size_t kFewest = 1000;  // triangles: single boards around things are none

// Sums over a material's triangles.
struct Extent {
    std::size_t triangles = 0;
    double area = 0;
    glm::dvec3 vectors{0};
    double volume = 0;  // that they enclose, if they are closed; below 0: inside out
};

std::vector<Extent> extents(const Scene& scene) {
    std::vector<Extent> all(scene.materials.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::uvec3& corner = scene.triangles[t];
        const glm::dvec3 a(scene.positions[corner.x] - 0.5f), b(scene.positions[corner.y] - 0.5f),
            c(scene.positions[corner.z] - 0.5f);
        Extent& extent = all[scene.triangleMaterials[t]];
        const glm::dvec3 vector = 0.5 * glm::cross(b - a, c - a);
        ++extent.triangles;
        extent.vectors += vector;
        extent.area += glm::length(vector);
        extent.volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    return all;
}

bool wrapsOthers(const TriangleBvh& bvh, std::uint32_t material) {
    const std::vector<std::uint32_t>& materials = bvh.scene->triangleMaterials;
    const auto samples = framing::surfaceSamples(
        bvh, kSamples, [&](std::uint32_t t) { return materials[t] == material ? 1.0 : 0.0; });
    const auto wrapped = std::count_if(samples.begin(), samples.end(), [&](const auto& sample) {
        const auto hit = bvh.intersect(sample.position, sample.normal, 0, kReach);
        return hit && !bvh.isBack(*hit, sample.normal) && materials[hit->triangle] != material;
    });
    return static_cast<double>(wrapped) > kMostlyWrapped * static_cast<double>(samples.size());
}

}  // namespace

std::vector<std::uint32_t> outlineMaterials(const TriangleBvh& bvh) {
    const Scene& scene = *bvh.scene;
    const std::vector<Extent> all = extents(scene);
    double area = 0;
    for (const Extent& extent : all) area += extent.area;
    std::vector<std::uint32_t> found;
    for (std::uint32_t m = 0; m < all.size(); ++m) {
        const Material& material = scene.materials[m];
        const Extent& extent = all[m];
        const bool insideOut = extent.triangles >= kFewest && extent.volume < 0 &&
                               extent.area > kLeastShare * area &&
                               glm::length(extent.vectors) < kOpen * extent.area;
        if (!insideOut || material.doubleSided || material.rayCutoff() > 0) continue;
        if (wrapsOthers(bvh, m)) found.push_back(m);
    }
    return found;
}

}  // namespace mv
