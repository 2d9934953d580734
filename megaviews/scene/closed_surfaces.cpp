#include "megaviews/scene/closed_surfaces.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

namespace mv {
namespace {

constexpr double kOpen = 0.1;  // of a part's area, what is left of the sum of its vectors

bool before(glm::vec3 a, glm::vec3 b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// For each position the first of those that are equal.
std::vector<std::uint32_t> firstOfEqual(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size()), first(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return before(positions[a], positions[b]); });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool equal = i > 0 && positions[order[i]] == positions[order[i - 1]];
        first[order[i]] = equal ? first[order[i - 1]] : order[i];
    }
    return first;
}

// Sets of numbers below a count, at first one each.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[find(a)] = find(b); }

  private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<bool> closedMaterials(const Scene& scene) {
    std::vector<std::uint32_t> triangles;
    std::vector<glm::vec3> corners;  // of those, three each
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (!scene.materials[scene.triangleMaterials[t]].tints()) continue;
        triangles.push_back(t);
        for (int k = 0; k < 3; ++k) corners.push_back(scene.positions[scene.triangles[t][k]]);
    }
    const std::vector<std::uint32_t> first = firstOfEqual(corners);
    DisjointSets parts(corners.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        parts.join(first[3 * i], first[3 * i + 1]);
        parts.join(first[3 * i], first[3 * i + 2]);
    }
    const auto vectorOf = [&](std::size_t i) {
        const glm::dvec3 a(corners[3 * i]);
        return glm::cross(glm::dvec3(corners[3 * i + 1]) - a, glm::dvec3(corners[3 * i + 2]) - a);
    };
    std::vector<glm::dvec3> sum(corners.size(), glm::dvec3(0));
    std::vector<double> area(corners.size(), 0.0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t part = parts.find(first[3 * i]);
        sum[part] += vectorOf(i);
        area[part] += glm::length(vectorOf(i));
    }
    std::vector<double> closed(scene.materials.size(), 0.0), all(scene.materials.size(), 0.0);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const std::uint32_t part = parts.find(first[3 * i]);
        const std::uint32_t material = scene.triangleMaterials[triangles[i]];
        const double own = glm::length(vectorOf(i));
        all[material] += own;
        if (glm::length(sum[part]) < kOpen * area[part]) closed[material] += own;
    }
    std::vector<bool> out(scene.materials.size());
    for (std::size_t m = 0; m < out.size(); ++m) out[m] = closed[m] > 0.5 * all[m];
    return out;
}

}  // namespace mv
