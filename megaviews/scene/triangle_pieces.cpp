#include "megaviews/scene/triangle_pieces.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>

namespace mv {
namespace {

constexpr int kGridBits = 20;                   // levels of the octree whose planes cut
constexpr std::size_t kTrianglesAtOnce = 4096;  // of a task
constexpr int kSearchSteps = 16;

// The coarsest of the octree's planes that go through a box, across its longest edge if there are
// some as coarse. level: of the octree, 1 that of the root's halves; 0: none does.
struct CutPlane {
    int level = 0, axis = 0;
    float at = 0;
};
CutPlane cutPlane(const PieceBox& box) {
    constexpr float kCells = 1 << kGridBits;
    CutPlane best;
    for (int a = 0; a < 3; ++a) {
        // The first and last cell that the box reaches into; they differ first at the plane's bit.
        const auto low = static_cast<std::uint32_t>(std::clamp(box.min[a] * kCells, 0.0f, kCells));
        const auto high = static_cast<std::uint32_t>(
            std::clamp(std::ceil(box.max[a] * kCells) - 1, 0.0f, kCells));
        if (low >= high) continue;
        const int bit = static_cast<int>(std::bit_width(low ^ high)) - 1;
        const int level = kGridBits - bit;
        const bool longer = box.max[a] - box.min[a] > box.max[best.axis] - box.min[best.axis];
        if (best.level > 0 && (level > best.level || (level == best.level && !longer))) continue;
        best = {level, a, static_cast<float>(high >> bit << bit) / kCells};
    }
    return best;
}

// How much a cut of the triangle helps: what its box has more than the least that ever smaller
// boxes come to, and the more the larger the cell that the plane halves.
float worthOf(const Scene& scene, const TrianglePiece& piece) {
    const int level = cutPlane(piece.box).level;
    if (level == 0) return 0;
    const glm::uvec3 c = scene.triangles[piece.triangle];
    const glm::vec3 a = scene.positions[c.x];
    const glm::vec3 normal = glm::abs(cross3(scene.positions[c.y] - a, scene.positions[c.z] - a));
    const float nothing = 2 * piece.box.halfArea() - (normal.x + normal.y + normal.z);
    return nothing > 0 ? std::cbrt(std::ldexp(nothing, -level)) : 0.0f;
}

// What lies below and above a plane through a piece's box. Either is empty where rounding leaves
// nothing of it.
std::pair<TrianglePiece, TrianglePiece> cutPiece(const Scene& scene, const TrianglePiece& piece,
                                                 const CutPlane& plane) {
    const int axis = plane.axis;
    const float at = plane.at;
    PieceBox low, high;
    const glm::uvec3 corner = scene.triangles[piece.triangle];
    for (int k = 0; k < 3; ++k) {
        const glm::vec3 a = scene.positions[corner[k]];
        const glm::vec3 b = scene.positions[corner[(k + 1) % 3]];
        if (a[axis] <= at) low.add(a);
        if (a[axis] >= at) high.add(a);
        if (std::min(a[axis], b[axis]) < at && at < std::max(a[axis], b[axis])) {
            glm::vec3 between = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
            between[axis] = at;
            low.add(between);
            high.add(between);
        }
    }
    for (PieceBox* box : {&low, &high}) {
        box->min = glm::max(box->min, piece.box.min);
        box->max = glm::min(box->max, piece.box.max);
    }
    return {{low, piece.triangle}, {high, piece.triangle}};
}

// Cuts a piece so many times, or as often as there are planes.
void cutInto(const Scene& scene, const TrianglePiece& piece, std::size_t cuts,
             std::vector<TrianglePiece>& out) {
    const CutPlane plane = cuts > 0 ? cutPlane(piece.box) : CutPlane{};
    if (plane.level > 0) {
        const auto [low, high] = cutPiece(scene, piece, plane);
        if (!low.box.isEmpty() && !high.box.isEmpty()) {
            const auto longest = [](const PieceBox& box) {
                const glm::vec3 e = box.max - box.min;
                return std::max({e.x, e.y, e.z});
            };
            const float share = longest(low.box) / (longest(low.box) + longest(high.box));
            const auto ofLow =
                static_cast<std::size_t>(static_cast<float>(cuts - 1) * share + 0.5f);
            cutInto(scene, low, ofLow, out);
            cutInto(scene, high, cuts - 1 - ofLow, out);
            return;
        }
    }
    out.push_back(piece);
}

std::size_t cutsOf(double scale, float worth) {
    return static_cast<std::size_t>(scale * static_cast<double>(worth));
}

// The number of cuts a worth of 1 at which there are not more than `most`, nearly as many if they
// can be had.
double scaleOf(const std::vector<float>& worths, std::size_t most) {
    const tbb::blocked_range<std::size_t> all(0, worths.size(), kTrianglesAtOnce);
    const double sum = tbb::parallel_deterministic_reduce(
        all, 0.0,
        [&](const auto& range, double part) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
                part += static_cast<double>(worths[i]);
            }
            return part;
        },
        std::plus<>());
    if (!(sum > 0)) return 0;
    const auto cuts = [&](double scale) {
        return tbb::parallel_reduce(
            all, std::size_t{0},
            [&](const auto& range, std::size_t part) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) {
                    part += cutsOf(scale, worths[i]);
                }
                return part;
            },
            std::plus<>());
    };
    // Without rounding `low` would be it: rounding down loses less than a cut a triangle.
    double low = static_cast<double>(most) / sum;
    double high = static_cast<double>(most + worths.size()) / sum;
    for (int i = 0; i < kSearchSteps; ++i) {
        const double middle = 0.5 * (low + high);
        (cuts(middle) > most ? high : low) = middle;
    }
    return low;
}

}  // namespace

std::vector<TrianglePiece> trianglePieces(const Scene& scene, std::size_t first, std::size_t end,
                                          float share) {
    std::vector<TrianglePiece> whole(end - first);
    std::vector<float> worths(whole.size());
    tbb::parallel_for(std::size_t{0}, whole.size(), [&](std::size_t i) {
        const glm::uvec3 corner = scene.triangles[first + i];
        for (int k = 0; k < 3; ++k) whole[i].box.add(scene.positions[corner[k]]);
        whole[i].triangle = static_cast<std::uint32_t>(first + i);
        // What tints must not be met twice by one ray.
        const bool tints = scene.materials[scene.triangleMaterials[first + i]].tints();
        if (share > 0 && !tints) worths[i] = worthOf(scene, whole[i]);
    });
    const auto most = static_cast<std::size_t>(share * static_cast<float>(whole.size()));
    const double scale = most > 0 ? scaleOf(worths, most) : 0;
    if (!(scale > 0)) return whole;

    const std::size_t tasks = (whole.size() + kTrianglesAtOnce - 1) / kTrianglesAtOnce;
    std::vector<std::vector<TrianglePiece>> parts(tasks);
    tbb::parallel_for(std::size_t{0}, tasks, [&](std::size_t t) {
        const std::size_t begin = t * kTrianglesAtOnce;
        const std::size_t stop = std::min(begin + kTrianglesAtOnce, whole.size());
        for (std::size_t i = begin; i < stop; ++i) {
            cutInto(scene, whole[i], cutsOf(scale, worths[i]), parts[t]);
        }
    });
    std::vector<TrianglePiece> pieces;
    pieces.reserve(whole.size() + most);
    for (const auto& part : parts) pieces.insert(pieces.end(), part.begin(), part.end());
    return pieces;
}

}  // namespace mv
