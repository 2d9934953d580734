#include "megaviews/hierarchy/sample_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>

#include "megaviews/hierarchy/moving_surface.h"
#include "megaviews/hierarchy/surface_piece.h"
#include "megaviews/hierarchy/surface_sampler.h"
#include "megaviews/hierarchy/surface_sums.h"
#include "megaviews/scene/rigged_scene.h"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/types.glsl"

namespace mv {
namespace {

constexpr std::string_view kSampleStage = "sample surface";
constexpr std::uint32_t kSerialSamples = 4096;  // subtrees of so many are one task
constexpr double kCosSmooth = 0.999;            // between a corner's normal and its flat triangle

struct Corners {
    glm::dvec3 a, ab, ac;
};
Corners cornersOf(const Scene& scene, std::uint32_t triangle) {
    const glm::uvec3 c = scene.triangles[triangle];
    const glm::dvec3 a(scene.positions[c.x]);
    return {a, glm::dvec3(scene.positions[c.y]) - a, glm::dvec3(scene.positions[c.z]) - a};
}

// The triangles that have a surface, near ones in a row, and the running sum of their areas.
struct SurfaceOrder {
    std::vector<std::uint32_t> triangles;
    std::vector<double> areaTo;
    double cells = 0;  // what the surface meets of a grid, per cell's edge squared
    double area() const { return areaTo.empty() ? 0 : areaTo.back(); }
};

SurfaceOrder orderOf(const Scene& scene, std::size_t first, std::size_t end) {
    struct Placed {
        std::uint32_t key, triangle;
        double area;
    };
    std::vector<Placed> placed;
    SurfaceOrder order;
    for (std::size_t i = first; i < end; ++i) {
        const auto triangle = static_cast<std::uint32_t>(i);
        const SurfacePiece t = SurfacePiece::whole(scene, triangle);
        if (!hasSurface(t)) continue;
        placed.push_back({mortonKeyOf(glm::vec3(t.centroid())), triangle, t.area()});
        const Corners c = cornersOf(scene, triangle);
        const glm::dvec3 normal = glm::abs(glm::cross(c.ab, c.ac));
        order.cells += 0.5 * (normal.x + normal.y + normal.z);
    }
    std::stable_sort(placed.begin(), placed.end(),
                     [](const Placed& a, const Placed& b) { return a.key < b.key; });
    double sum = 0;
    for (const Placed& p : placed) {
        order.triangles.push_back(p.triangle);
        order.areaTo.push_back(sum += p.area);
    }
    return order;
}

// Point i of a sequence that is even in the unit square [Roberts 2018], carried over to a triangle
// without tearing it [Heitz 2019].
glm::dvec2 evenPoint(std::uint32_t i) {
    constexpr double kPlastic = 1.32471795724474602596;
    double x = 0.5 + i / kPlastic, y = 0.5 + i / (kPlastic * kPlastic);
    x -= std::floor(x);
    y -= std::floor(y);
    if (y > x) {
        x *= 0.5;
        y -= x;
    } else {
        y *= 0.5;
        x -= y;
    }
    return {x, y};
}

// `count` strata of equal area, a sample in each that no mask cuts out.
std::vector<TreeSample> sampleStrata(const Scene& scene, const SurfaceSampler& sampler,
                                     const SurfaceOrder& order, std::uint32_t count) {
    std::vector<TreeSample> points;
    points.reserve(count);
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double area = (i + 0.5) / count * order.area();
        while (at + 1 < order.triangles.size() && order.areaTo[at] < area) ++at;
        TreeSample point{};
        point.triangle = order.triangles[at];
        const glm::dvec2 weights = evenPoint(i);
        point.s = static_cast<float>(weights.x);
        point.t = static_cast<float>(weights.y);
        SurfacePiece piece;
        piece.triangle = point.triangle;
        piece.count = 0;  // sampled at the point alone
        if (sampler.coverage(piece, positionOf(scene, point)) > 0) points.push_back(point);
    }
    return points;
}

// Sorts points into the leaves of a complete binary tree. Each sequence is split at its median
// along the axis that leaves the two halves least volume [HREB11 §4.1]: of the balls about their
// boxes, since boxes of flat surfaces have none, and of a wall's would not tell halves from
// slivers.
class MedianSplits {
  public:
    MedianSplits(const Scene& scene, std::span<const TreeSample> points)
        : order_(points.size()), positions_(points.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        for (std::size_t i = 0; i < points.size(); ++i)
            positions_[i] = positionOf(scene, points[i]);
        split(order_);
    }
    const std::vector<std::uint32_t>& order() const { return order_; }

  private:
    double volumeOf(std::span<const std::uint32_t> half) const {
        glm::dvec3 lo(1e300), hi(-1e300);
        for (const std::uint32_t i : half) {
            lo = glm::min(lo, positions_[i]);
            hi = glm::max(hi, positions_[i]);
        }
        const double diameter = glm::length(hi - lo);
        return diameter * diameter * diameter;
    }
    void halve(std::span<std::uint32_t> sequence, int axis) const {
        const auto middle = sequence.begin() + static_cast<std::ptrdiff_t>(sequence.size() / 2);
        std::nth_element(sequence.begin(), middle, sequence.end(),
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double pa = positions_[a][axis], pb = positions_[b][axis];
                             return pa != pb ? pa < pb : a < b;
                         });
    }
    void split(std::span<std::uint32_t> sequence) const {
        if (sequence.size() < 2) return;
        const std::size_t half = sequence.size() / 2;
        int best = 0;
        double least = 0;
        for (int axis = 0; axis < 3; ++axis) {
            halve(sequence, axis);
            const double volume = volumeOf(sequence.first(half)) + volumeOf(sequence.subspan(half));
            if (axis == 0 || volume < least) {
                best = axis;
                least = volume;
            }
        }
        if (best != 2) halve(sequence, best);
        if (sequence.size() > kSerialSamples) {
            tbb::parallel_invoke([&] { split(sequence.first(half)); },
                                 [&] { split(sequence.subspan(half)); });
        } else {
            split(sequence.first(half));
            split(sequence.subspan(half));
        }
    }

    std::vector<std::uint32_t> order_;
    std::vector<glm::dvec3> positions_;
};

// The tree over what stands or over what moves, inside the whole one.
struct Part {
    std::uint32_t firstPoint;
    std::uint32_t depth;                          // of its leaves, from its root
    std::uint32_t base;                           // level of its root
    const std::vector<std::uint32_t>* firstNode;  // by level of the whole tree
};

std::uint32_t depthFor(std::size_t points) {
    return static_cast<std::uint32_t>(std::bit_width(points)) - 1;
}

double discRadius(double area) { return kDiscScale * std::sqrt(area / std::numbers::pi); }

SurfaceSums leafSums(const Scene& scene, const TreeSample& point) {
    const Corners t = cornersOf(scene, point.triangle);
    const glm::dvec3 normal = glm::cross(t.ab, t.ac);
    const double twice = glm::length(normal);
    const glm::uvec3 c = scene.triangles[point.triangle];
    Fragment f{};
    f.centroid = positionOf(scene, point);
    f.faceNormal = twice > 0 ? normal / twice : glm::dvec3(0);
    f.area = double{point.share} * 0.5 * twice;
    // Clearances of kept cuts count on boxes inside the root cube (cut.glsl).
    const glm::dvec3 reach =
        discRadius(f.area) * glm::sqrt(glm::max(1.0 - f.faceNormal * f.faceNormal, 0.0));
    f.lo = glm::max(f.centroid - reach, glm::min(f.centroid, glm::dvec3(0)));
    f.hi = glm::min(f.centroid + reach, glm::max(f.centroid, glm::dvec3(1)));
    SurfaceSums sums = SurfaceSums::ofFragments(std::span(&f, 1));
    // The disc reaches over neighbours, which bend away from it where the triangle is shaded as
    // part of a curved surface.
    for (const std::uint32_t corner : {c.x, c.y, c.z}) {
        const glm::dvec3 n(scene.normals[corner]);
        sums.planar = sums.planar && std::abs(glm::dot(n, f.faceNormal)) > kCosSmooth;
    }
    return sums;
}

// Makes node i on level k of a part, and all below it.
SurfaceSums fit(SceneHierarchy& h, const SampleTree& tree, const Scene& scene, const Part& part,
                std::uint32_t k, std::uint32_t i) {
    const std::uint32_t level = part.base + k;
    const std::uint32_t at = (*part.firstNode)[level] + i;
    SurfaceSums sums;
    std::uint32_t children = 0;
    if (k == part.depth) {
        sums = leafSums(scene, tree.points[part.firstPoint + i]);
    } else {
        std::array<SurfaceSums, 2> below;
        const auto fitHalf = [&](std::uint32_t half) {
            below[half] = fit(h, tree, scene, part, k + 1, 2 * i + half);
        };
        if (kSerialSamples >> (part.depth - k) == 0) {
            tbb::parallel_invoke([&] { fitHalf(0); }, [&] { fitHalf(1); });
        } else {
            fitHalf(0);
            fitHalf(1);
        }
        sums = SurfaceSums::ofChildren(below);
        children = packChildren((*part.firstNode)[level + 1] + 2 * i, 2);
    }
    h.nodes[at] = sums.node(level, children);
    h.areas[at] = static_cast<float>(sums.area);
    return sums;
}

void fitRoot(SceneHierarchy& h) {
    h.nodes[0] = rootOver(std::span(h.nodes).subspan(1, 2), packChildren(1, 2));
}

// A part's points in the order of its leaves, behind those that are there.
void addPart(const Scene& scene, std::span<const TreeSample> points, SampleTree& tree) {
    const MedianSplits splits(scene, points);
    for (const std::uint32_t i : splits.order()) tree.points.push_back(points[i]);
}

std::uint32_t sampleCount(double cells, int levels, double most) {
    const double leaves = cells * std::pow(4.0, levels - 1);
    const double exponent = std::round(std::log2(std::clamp(leaves, 1.0, most)));
    return 1u << static_cast<std::uint32_t>(exponent);
}

struct Sphere {
    glm::dvec3 center;
    double radius;
};
// The smallest ball about two.
Sphere around(const Sphere& a, const Sphere& b) {
    const glm::dvec3 way = b.center - a.center;
    const double distance = glm::length(way);
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = 0.5 * (distance + a.radius + b.radius);
    return {a.center + way * ((radius - a.radius) / distance), radius};
}

// A node whose cube has the ball as its bounding ball.
SceneNode sphereNode(SceneNode n, const Sphere& s) {
    const glm::vec3 center(s.center);
    const double radius = s.radius + glm::length(s.center - glm::dvec3(center));
    n.centerX = n.centroidX = center.x;
    n.centerY = n.centroidY = center.y;
    n.centerZ = n.centroidZ = center.z;
    n.halfX = n.halfY = n.halfZ = std::nextafter(static_cast<float>(radius / std::numbers::sqrt3),
                                                 std::numeric_limits<float>::max());
    return n;
}

}  // namespace

glm::dvec3 positionOf(const Scene& scene, const TreeSample& point) {
    const Corners t = cornersOf(scene, point.triangle);
    return t.a + double{point.s} * t.ab + double{point.t} * t.ac;
}

std::vector<TreeSample> sampleSurface(const Scene& scene, const TriangleBvh& bvh,
                                      std::size_t firstTriangle, std::size_t endTriangle,
                                      std::uint32_t count) {
    const SurfaceOrder order = orderOf(scene, firstTriangle, endTriangle);
    if (order.triangles.empty() || count == 0) return {};
    const SurfaceSampler sampler(bvh);
    std::vector<TreeSample> points = sampleStrata(scene, sampler, order, count);
    // Masks cut samples out: more strata, until there are enough, and of these evenly many. The
    // surface that is left is what the strata found.
    std::uint64_t strata = count;
    const std::uint64_t most = std::uint64_t{count} * 64;
    while (points.size() < count && strata < most) {
        const auto found = static_cast<double>(std::max<std::size_t>(points.size(), 1));
        strata = static_cast<std::uint64_t>(
            std::min(std::ceil(1.02 * static_cast<double>(strata) * count / found) + 1,
                     static_cast<double>(most)));
        points = sampleStrata(scene, sampler, order, static_cast<std::uint32_t>(strata));
    }
    if (points.empty()) return {};
    const double area =
        order.area() * static_cast<double>(points.size()) / static_cast<double>(strata);
    std::vector<TreeSample> chosen(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        TreeSample& point = chosen[i] = points[std::uint64_t{i} * points.size() / count];
        const Corners t = cornersOf(scene, point.triangle);
        point.share =
            static_cast<float>(area / count / (0.5 * glm::length(glm::cross(t.ab, t.ac))));
    }
    return chosen;
}

SceneHierarchy buildSampleTree(const Scene& scene, const TriangleBvh& bvh, int levels,
                               const Progress& progress) {
    assert(levels >= 1 && levels <= static_cast<int>(kTreeLevels));
    assert(bvh.scene == &scene);
    report(progress, kSampleStage, 0);
    SceneHierarchy h;
    h.levelBegin = {0};
    auto tree = std::make_shared<SampleTree>();
    const std::size_t end = scene.triangles.size();
    const std::size_t firstMoving = scene.moving ? scene.moving->triangle : end;
    const auto add = [&](std::size_t first, std::size_t last, double most) {
        const double cells = orderOf(scene, first, last).cells;
        if (!(cells > 0)) return;
        addPart(scene, sampleSurface(scene, bvh, first, last, sampleCount(cells, levels, most)),
                *tree);
    };
    add(0, firstMoving, kMostSamples);
    tree->standing = static_cast<std::uint32_t>(tree->points.size());
    report(progress, kSampleStage, 0.7f);
    add(firstMoving, end, kMostMovingLeaves);
    const auto moving = static_cast<std::uint32_t>(tree->points.size()) - tree->standing;
    if (tree->points.empty()) return h;

    // Both trees hang below a root; one alone is the whole.
    const bool both = tree->standing > 0 && moving > 0;
    const std::uint32_t base = both ? 1 : 0;
    const std::uint32_t depth =
        std::max(depthFor(std::max(tree->standing, 1u)), depthFor(std::max(moving, 1u)));
    h.levels = static_cast<int>(base + depth + 1);
    assert(h.levels <= static_cast<int>(kSceneLevels));
    const auto nodesOf = [&](std::uint32_t points, std::uint32_t level) {
        if (points == 0 || level < base || level - base > depthFor(points)) return 0u;
        return 1u << (level - base);
    };
    std::vector<std::uint32_t> movingBegin;
    for (std::uint32_t level = 0; level < base + depth + 1; ++level) {
        const std::uint32_t standing = nodesOf(tree->standing, level);
        const std::uint32_t top = both && level == 0 ? 1 : 0;
        if (moving > 0 && level <= base + depthFor(moving)) {
            movingBegin.push_back(h.levelBegin.back() + standing);
        }
        h.levelBegin.push_back(h.levelBegin.back() + top + standing + nodesOf(moving, level));
    }
    h.nodes.resize(h.levelBegin.back());
    h.areas.resize(h.levelBegin.back());
    if (moving > 0) {
        auto surface = std::make_shared<MovingSurface>();
        surface->begin = std::move(movingBegin);
        h.moving = std::move(surface);
    }
    if (tree->standing > 0) {
        fit(h, *tree, scene, {0, depthFor(tree->standing), base, &h.levelBegin}, 0, 0);
    }
    h.samples = tree;
    refitSampleTree(h, scene);
    if (both) h.areas[0] = h.areas[1];
    for (std::size_t i = 0; i < h.nodes.size(); ++i) {
        if (h.nodes[i].children != 0) continue;
        tree->leafRadius =
            std::max(tree->leafRadius, static_cast<float>(discRadius(double{h.areas[i]})));
    }
    report(progress, kSampleStage, 1);
    return h;
}

void refitSampleTree(SceneHierarchy& h, const Scene& scene) {
    if (!h.moving) return;
    const SampleTree& tree = *h.samples;
    const std::uint32_t base = tree.standing > 0 ? 1 : 0;
    const std::size_t points = tree.points.size() - tree.standing;
    fit(h, tree, scene, {tree.standing, depthFor(points), base, &h.moving->begin}, 0, 0);
    if (base > 0) fitRoot(h);
}

SceneNodes sphereNodes(const SceneHierarchy& h) {
    SceneNodes nodes(h.nodes);
    std::vector<Sphere> spheres(nodes.size());
    for (std::size_t level = static_cast<std::size_t>(h.levels); level-- > 0;) {
        tbb::parallel_for(h.levelBegin[level], h.levelBegin[level + 1], [&](std::uint32_t i) {
            SceneNode& n = nodes[i];
            if (n.children == 0) {
                spheres[i] = {{n.centroidX, n.centroidY, n.centroidZ},
                              discRadius(double{h.areas[i]})};
            } else {
                const std::uint32_t first = firstChildOf(n.children);
                spheres[i] = around(spheres[first], spheres[first + 1]);
            }
            n = sphereNode(n, spheres[i]);
        });
    }
    return nodes;
}

}  // namespace mv
