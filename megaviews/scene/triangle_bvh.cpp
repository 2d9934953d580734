#include "megaviews/scene/triangle_bvh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <span>

#include "megaviews/scene/rigged_scene.h"
#include "megaviews/scene/triangle_pieces.h"

namespace mv {
namespace {

using Box = PieceBox;
using Item = TrianglePiece;  // partitions move these, so that each node reads contiguously

// Bounds of boxes and of centres over a range, and a histogram over bins an axis. Minimum,
// maximum and integer sums do not depend on how the range is cut, so neither does the tree.
struct Bounds {
    Box box, centres;
    void add(const Bounds& b) {
        box.add(b.box);
        centres.add(b.centres);
    }
};
constexpr std::size_t kBins = 16;
struct Histogram {
    std::array<std::array<Box, kBins>, 3> box;
    std::array<std::array<std::uint32_t, kBins>, 3> count{};
    void add(const Histogram& h) {
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < kBins; ++b) {
                box[a][b].add(h.box[a][b]);
                count[a][b] += h.count[a][b];
            }
    }
};

constexpr int kMaxDepth = 60;                    // edges from the root to a leaf
constexpr std::size_t kParallelRange = 1 << 15;  // ranges longer than this are read in parallel
constexpr std::size_t kParallelTask = 1 << 11;   // subtrees larger than this become tasks

template <class T, class Accumulate>
T reduceRange(std::size_t begin, std::size_t end, const Accumulate& accumulate) {
    T total;
    if (end - begin < kParallelRange) {
        for (std::size_t i = begin; i < end; ++i) accumulate(total, i);
        return total;
    }
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(begin, end, kParallelRange / 4), total,
        [&](const tbb::blocked_range<std::size_t>& r, T part) {
            for (std::size_t i = r.begin(); i < r.end(); ++i) accumulate(part, i);
            return part;
        },
        [](T a, const T& b) {
            a.add(b);
            return a;
        });
}

std::size_t binOf(float x, float low, float scale) {
    float b = (x - low) * scale;
    return b >= static_cast<float>(kBins - 1) ? kBins - 1 : static_cast<std::size_t>(b);
}

// Its planes' scale is a power of two, so that no multiple of it is rounded.
BvhNode emptyNode(const Box& box) {
    const glm::vec3 low = box.min - kBvhPadding;
    const glm::vec3 extent = box.max + kBvhPadding - low;
    glm::vec3 scale;
    for (int a = 0; a < 3; ++a) scale[a] = std::exp2(std::ceil(std::log2(extent[a] / 254.0f)));
    return {.originX = low.x,
            .originY = low.y,
            .originZ = low.z,
            .scaleX = scale.x,
            .child0 = kNone,
            .child1 = kNone,
            .child2 = kNone,
            .child3 = kNone,
            .lowX = 0,
            .lowY = 0,
            .lowZ = 0,
            .scaleY = scale.y,
            .highX = 0,
            .highY = 0,
            .highZ = 0,
            .scaleZ = scale.z};
}

// Child k of the node: its box, padded, in whole steps outwards.
void setChild(BvhNode& node, std::size_t k, const Box& box, std::uint32_t child) {
    const auto plane = [&](float x, float origin, float scale, bool up) {
        const float steps = (x - origin) / scale;
        const float whole = up ? std::ceil(steps) : std::floor(steps);
        return static_cast<std::uint32_t>(std::clamp(whole, 0.0f, 255.0f)) << (8 * k);
    };
    const glm::vec3 low = box.min - kBvhPadding, high = box.max + kBvhPadding;
    node.lowX |= plane(low.x, node.originX, node.scaleX, false);
    node.lowY |= plane(low.y, node.originY, node.scaleY, false);
    node.lowZ |= plane(low.z, node.originZ, node.scaleZ, false);
    node.highX |= plane(high.x, node.originX, node.scaleX, true);
    node.highY |= plane(high.y, node.originY, node.scaleY, true);
    node.highZ |= plane(high.z, node.originZ, node.scaleZ, true);
    std::uint32_t* const children[] = {&node.child0, &node.child1, &node.child2, &node.child3};
    *children[k] = child;
}

class Builder {
  public:
    Builder(std::vector<Item> items, const Progress& progress)
        : items_(std::move(items)), progress_(progress) {}

    // Nodes in the order of a depth-first walk in which `room` children may wait; `top` becomes the
    // box of them all.
    std::vector<BvhNode> build(Box& top, int room) {
        // A subtree of n items never needs more than 2n - 1 nodes: reserving that many for
        // each, holes included, gives every node a place that does not depend on timing.
        binary_.resize(2 * items_.size());
        subtree(0, 1, 0, items_.size(), 0);
        top = binary_[0].box;
        std::vector<BvhNode> nodes;
        widen(nodes, 0, room);
        return nodes;
    }
    const std::vector<Item>& items() const { return items_; }

  private:
    // A node of the binary tree: a leaf's items, or two children from `first`.
    struct Binary {
        Box box;
        std::uint32_t first = 0, count = 0;  // 0: not a leaf
        int height = 0;                      // edges to the lowest leaf
    };

    // Appends the node of four that stands for binary_[top] and what is below it, where `room`
    // children may wait in a walk; returns its number. The largest boxes are opened, as long as
    // there is room for a binary walk through each.
    std::uint32_t widen(std::vector<BvhNode>& nodes, std::uint32_t top, int room) {
        std::vector<std::uint32_t> children = {top};
        const auto worth = [&](std::uint32_t c) {
            return binary_[c].count > 0 ? -1.0f : binary_[c].box.halfArea();
        };
        while (children.size() < 4) {
            const auto widest = std::ranges::max_element(children, {}, worth);
            const std::uint32_t opened = *widest;
            if (binary_[opened].count > 0) break;
            std::vector<std::uint32_t> more = children;
            std::uint32_t& place = more[static_cast<std::size_t>(widest - children.begin())];
            place = binary_[opened].first;
            more.push_back(binary_[opened].first + 1);
            const int below = room - static_cast<int>(children.size());
            const bool fits = std::ranges::all_of(
                more, [&](std::uint32_t c) { return binary_[c].height <= below; });
            if (!fits && children.size() > 1) break;
            children = std::move(more);
        }
        const auto number = static_cast<std::uint32_t>(nodes.size());
        nodes.push_back({});
        BvhNode node = emptyNode(binary_[top].box);
        const int below = room - static_cast<int>(children.size()) + 1;
        for (std::size_t k = 0; k < children.size(); ++k) {
            const Binary& c = binary_[children[k]];
            const std::uint32_t first = c.count > 0 ? c.first : widen(nodes, children[k], below);
            setChild(node, k, c.box, first << 3 | c.count);
        }
        nodes[number] = node;
        return number;
    }

    // Fills binary_[node] and, from binary_[reserve], the 2n - 2 places of what is below it.
    void subtree(std::size_t node, std::size_t reserve, std::size_t begin, std::size_t end,
                 int depth) {
        std::size_t n = end - begin;
        Bounds bounds = reduceRange<Bounds>(begin, end, [&](Bounds& b, std::size_t i) {
            b.box.add(items_[i].box);
            b.centres.add(items_[i].centre());
        });
        Binary& out = binary_[node];
        out.box = bounds.box;
        std::size_t middle = split(begin, end, bounds, depth);
        if (middle == begin) {
            out.first = static_cast<std::uint32_t>(begin);
            out.count = static_cast<std::uint32_t>(n);
            done_ += n;
            return;
        }
        out.first = static_cast<std::uint32_t>(reserve);
        out.count = 0;
        std::size_t left = reserve, right = reserve + 1;
        std::size_t leftReserve = reserve + 2,
                    rightReserve = leftReserve + 2 * (middle - begin) - 2;
        auto first = [&] { subtree(left, leftReserve, begin, middle, depth + 1); };
        auto second = [&] { subtree(right, rightReserve, middle, end, depth + 1); };
        if (n >= kParallelTask) {
            tbb::parallel_invoke(first, second);
            if (n >= items_.size() / 16)
                report(progress_, "triangle hierarchy",
                       static_cast<float>(done_) / static_cast<float>(items_.size()));
        } else {
            first();
            second();
        }
        out.height = 1 + std::max(binary_[left].height, binary_[right].height);
    }

    // Orders items_[begin, end) so that the first child ends at the returned index; `begin` makes
    // a leaf. Binned SAH [Wald07] until only halving keeps the depth bound.
    std::size_t split(std::size_t begin, std::size_t end, const Bounds& bounds, int depth) {
        std::size_t n = end - begin;
        if (n == 1) return begin;
        glm::vec3 extent = bounds.centres.max - bounds.centres.min;
        int halvings = static_cast<int>(std::bit_width((n - 1) / kBvhLeafTriangles));
        bool flat = !(glm::max(extent.x, glm::max(extent.y, extent.z)) > 1e-12f);
        if (flat || depth + halvings + 1 >= kMaxDepth)
            return n <= kBvhLeafTriangles ? begin : halve(begin, end, extent);

        glm::vec3 low = bounds.centres.min;
        glm::vec3 scale;
        for (int a = 0; a < 3; ++a)
            scale[a] = extent[a] > 1e-12f ? static_cast<float>(kBins) / extent[a] : 0.0f;
        Histogram bins = reduceRange<Histogram>(begin, end, [&](Histogram& h, std::size_t i) {
            glm::vec3 c = items_[i].centre();
            for (std::size_t a = 0; a < 3; ++a) {
                auto k = static_cast<int>(a);
                std::size_t b = binOf(c[k], low[k], scale[k]);
                h.box[a][b].add(items_[i].box);
                ++h.count[a][b];
            }
        });

        float best = kInfinity;
        int bestAxis = 0;
        std::size_t bestBin = 0;
        for (std::size_t a = 0; a < 3; ++a) {
            std::array<float, kBins> rightCost{};
            Box box;
            std::uint32_t count = 0;
            for (std::size_t b = kBins - 1; b > 0; --b) {
                box.add(bins.box[a][b]);
                count += bins.count[a][b];
                rightCost[b] = count ? box.halfArea() * static_cast<float>(count) : kInfinity;
            }
            box = Box{};
            count = 0;
            for (std::size_t b = 1; b < kBins; ++b) {
                box.add(bins.box[a][b - 1]);
                count += bins.count[a][b - 1];
                if (count == 0 || rightCost[b] == kInfinity) continue;
                float cost = box.halfArea() * static_cast<float>(count) + rightCost[b];
                if (cost < best) {
                    best = cost;
                    bestAxis = static_cast<int>(a);
                    bestBin = b;
                }
            }
        }
        if (best == kInfinity) return n <= kBvhLeafTriangles ? begin : halve(begin, end, extent);
        // One step down costs about as much as one triangle.
        float area = bounds.box.halfArea();
        if (n <= kBvhLeafTriangles && best + area >= area * static_cast<float>(n)) return begin;
        auto it = std::partition(
            items_.begin() + static_cast<std::ptrdiff_t>(begin),
            items_.begin() + static_cast<std::ptrdiff_t>(end), [&](const Item& item) {
                return binOf(item.centre()[bestAxis], low[bestAxis], scale[bestAxis]) < bestBin;
            });
        return static_cast<std::size_t>(it - items_.begin());
    }

    std::size_t halve(std::size_t begin, std::size_t end, glm::vec3 extent) {
        int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        std::size_t middle = begin + (end - begin) / 2;
        auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](const Item& a, const Item& b) {
            float x = a.centre()[axis], y = b.centre()[axis];
            return x != y ? x < y : a.triangle < b.triangle;
        });
        return middle;
    }

    std::vector<Item> items_;
    std::vector<Binary> binary_;
    std::atomic<std::size_t> done_ = 0;
    const Progress& progress_;
};

// The longest edge of the box between an eighth and seven eighths of all corners along each axis:
// where most of a scene is, however far a ground or a backdrop goes on around it.
float edgeOfMost(const Scene& scene) {
    const std::size_t step = 1 + scene.triangles.size() / 32768;
    float edge = 0;
    std::vector<float> corners;
    for (int axis = 0; axis < 3; ++axis) {
        corners.clear();
        for (std::size_t i = 0; i < scene.triangles.size(); i += step)
            for (int k = 0; k < 3; ++k)
                corners.push_back(scene.positions[scene.triangles[i][k]][axis]);
        if (corners.empty()) return 1;
        const auto at = [&](std::size_t rank) {
            const auto place = corners.begin() + static_cast<std::ptrdiff_t>(rank);
            std::nth_element(corners.begin(), place, corners.end());
            return *place;
        };
        const std::size_t eighth = corners.size() / 8;
        edge = std::max(edge, at(corners.size() - 1 - eighth) - at(eighth));
    }
    return edge;
}

float liftOf(std::uint32_t doubled) { return std::ldexp(kLeastLift, static_cast<int>(doubled)); }

// How often bvhLift() doubles kLeastLift: to kVplOffset where most of a scene takes more than a
// 64th of its cube, and to that many times less where it takes less; then to the grid's step. A
// room with one finely meshed thing in it is no such scene: close sheets need the whole lift.
std::uint32_t doublingsOfLift(const Scene& scene) {
    const float most = std::min(64 * edgeOfMost(scene), 1.0f) * kVplOffset;
    std::uint32_t doubled = 0;
    while (liftOf(doubled) < most) ++doubled;
    while (doubled < kMostBvhLift && liftOf(doubled) < scene.positionStep) ++doubled;
    return doubled;
}

// Which optional arrays the functions of bvh.glsl may read.
std::uint32_t flagsOf(const Scene& scene) {
    std::uint32_t flags = scene.triangles.empty() ? kBvhEmpty : 0;
    if (!scene.colors.empty()) flags |= kBvhColors;
    if (!scene.uvs.empty() && !scene.textures.empty()) flags |= kBvhUvs;
    if (!scene.emissiveUvs.empty() && !scene.textures.empty()) flags |= kBvhEmissiveUvs;
    for (const Material& m : scene.materials) {
        if (m.rayCutoff() > 0) flags |= kBvhMasks;
        if (m.tints()) flags |= kBvhTints;
    }
    if (scene.needsFull()) flags |= kBvhGloss;
    return flags | doublingsOfLift(scene) << kBvhLiftBits;
}

// Four children at most.
template <typename Node>
auto childrenOf(Node& node) {
    return std::array{&node.child0, &node.child1, &node.child2, &node.child3};
}
bool isLeaf(std::uint32_t child) { return (child & 7u) != 0; }
std::uint32_t countOf(std::uint32_t child) { return child & 7u; }
std::uint32_t firstOf(std::uint32_t child) { return child >> 3; }

// Moves the numbers of nodes and triangles in a tree that is put behind another.
void shift(std::vector<BvhNode>& nodes, std::uint32_t byNodes, std::uint32_t byTriangles) {
    for (BvhNode& node : nodes) {
        for (std::uint32_t* child : childrenOf(node)) {
            if (*child == kNone) continue;
            *child += (isLeaf(*child) ? byTriangles : byNodes) << 3;
        }
    }
}

// A tree over some triangles, its numbers from 0. pieces: see trianglePieces().
struct Subtree {
    std::vector<BvhNode> nodes;
    std::vector<std::uint32_t> order;
    Box box;
};
Subtree buildSubtree(const Scene& scene, std::size_t first, std::size_t end, int room, float pieces,
                     const Progress& progress) {
    Subtree tree;
    if (first == end) return tree;
    Builder builder(trianglePieces(scene, first, end, pieces), progress);
    tree.nodes = builder.build(tree.box, room);
    for (const Item& item : builder.items()) tree.order.push_back(item.triangle);
    return tree;
}

// firstSlot: of `out`. Each triangle of `order` is one of a kind.
void writeTriangles(const Scene& scene, std::span<const std::uint32_t> order,
                    std::uint32_t firstSlot, std::span<BvhTriangle> out) {
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
        const std::uint32_t triangle = order[i];
        glm::uvec3 corner = scene.triangles[triangle];
        glm::vec3 a = scene.positions[corner.x];
        glm::vec3 b = scene.positions[corner.y];
        glm::vec3 c = scene.positions[corner.z];
        std::uint32_t material = scene.triangleMaterials[triangle];
        bool masked = scene.materials[material].rayCutoff() > 0;
        out[i] = {.ax = a.x,
                  .ay = a.y,
                  .az = a.z,
                  .triangle = triangle,
                  .bx = b.x,
                  .by = b.y,
                  .bz = b.z,
                  .material = material | (masked ? kMaterialMask : 0u),
                  .cx = c.x,
                  .cy = c.y,
                  .cz = c.z,
                  .slot = firstSlot + static_cast<std::uint32_t>(i)};
    });
}

// Where pieces of a triangle stand in several slots, the first is that of all.
void mendSlots(std::span<BvhTriangle> slots, std::size_t triangles) {
    std::vector<std::uint32_t> first(triangles, kNone);
    for (BvhTriangle& t : slots) {
        std::uint32_t& known = first[t.triangle];
        if (known == kNone) known = t.slot;
        t.slot = known;
    }
}

// A root over two trees.
BvhNode rootOver(const Box& a, std::uint32_t nodeA, const Box& b, std::uint32_t nodeB) {
    Box both = a;
    both.add(b);
    BvhNode root = emptyNode(both);
    setChild(root, 0, a, nodeA << 3);
    setChild(root, 1, b, nodeB << 3);
    return root;
}

// What a node's planes hold, a little more than what they were made of.
Box boxOf(const BvhNode& node) {
    Box box;
    box.min = {node.originX, node.originY, node.originZ};
    const std::uint32_t high[] = {node.highX, node.highY, node.highZ};
    const float scale[] = {node.scaleX, node.scaleY, node.scaleZ};
    for (int a = 0; a < 3; ++a) {
        std::uint32_t most = 0;
        for (int k = 0; k < 4; ++k) most = std::max(most, (high[a] >> (8 * k)) & 255u);
        box.max[a] = box.min[a] + scale[a] * static_cast<float>(most);
    }
    return box;
}

// Gives nodes, from `first` on, the boxes of the triangles as they stand, from the leaves up:
// children stand behind their parents. Returns the cost of a walk: the sum of the areas of the
// boxes, that of the first being 1.
float fitNodes(std::vector<BvhNode>& nodes, std::size_t first,
               std::span<const BvhTriangle> triangles, Box& top) {
    std::vector<Box> boxes(nodes.size() - first);
    double areas = 0;
    for (std::size_t n = nodes.size(); n-- > first;) {
        std::array<Box, 4> childBoxes;
        Box& box = boxes[n - first];
        const auto children = childrenOf(nodes[n]);
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t child = *children[k];
            if (child == kNone) continue;
            if (isLeaf(child)) {
                for (const BvhTriangle& t : triangles.subspan(firstOf(child), countOf(child))) {
                    childBoxes[k].add({t.ax, t.ay, t.az});
                    childBoxes[k].add({t.bx, t.by, t.bz});
                    childBoxes[k].add({t.cx, t.cy, t.cz});
                }
            } else {
                childBoxes[k] = boxes[firstOf(child) - first];
            }
            box.add(childBoxes[k]);
        }
        BvhNode fitted = emptyNode(box);
        for (std::size_t k = 0; k < 4; ++k) {
            if (*children[k] != kNone) setChild(fitted, k, childBoxes[k], *children[k]);
        }
        nodes[n] = fitted;
        areas += static_cast<double>(box.halfArea());
    }
    top = boxes.front();
    const auto whole = static_cast<double>(top.halfArea());
    return whole > 0 ? static_cast<float>(areas / whole) : 0.0f;
}

}  // namespace

float rayLift(const Scene& scene) { return liftOf(doublingsOfLift(scene)); }

TriangleBvh TriangleBvh::build(const Scene& scene, const Progress& progress) {
    TriangleBvh bvh;
    bvh.scene = &scene;
    bvh.flags = flagsOf(scene);
    bvh.textures = makeTraceTextures(scene);
    bvh.materials = makeTraceMaterials(scene);
    for (const TraceMaterial& m : bvh.materials) {
        if (m.flags & kMaterialMirrors) bvh.flags |= kBvhMirrors;
    }
    if (scene.triangles.empty()) return bvh;
    assert(scene.triangles.size() < (std::size_t{1} << 28));

    report(progress, "triangle hierarchy", 0.0f);
    const std::size_t end = scene.triangles.size();
    const std::size_t standing = scene.moving ? scene.moving->triangle : end;
    const bool both = standing > 0 && standing < end;
    const int room = kBvhStack - (both ? 2 : 1);
    Subtree tree = buildSubtree(scene, 0, standing, room, kBvhPieces, progress);
    Box box = tree.box;
    if (standing < end) {
        Subtree moves = buildSubtree(scene, standing, end, room, 0, progress);
        auto moving = std::make_shared<Moving>();
        moving->node = static_cast<std::uint32_t>(tree.nodes.size() + (both ? 1 : 0));
        moving->triangle = static_cast<std::uint32_t>(tree.order.size());
        moving->order = moves.order;
        shift(moves.nodes, moving->node, moving->triangle);
        if (both) {
            shift(tree.nodes, 1, 0);
            tree.nodes.insert(tree.nodes.begin(), rootOver(tree.box, 1, moves.box, moving->node));
        }
        tree.nodes.insert(tree.nodes.end(), moves.nodes.begin(), moves.nodes.end());
        tree.order.insert(tree.order.end(), moves.order.begin(), moves.order.end());
        moving->nodes = std::move(moves.nodes);
        bvh.moving = std::move(moving);
        box.add(scene.moving->min);
        box.add(scene.moving->max);
    }
    bvh.nodes = std::move(tree.nodes);
    bvh.triangles.resize(tree.order.size());
    writeTriangles(scene, tree.order, 0, bvh.triangles);
    mendSlots(bvh.triangles, end);
    bvh.center = 0.5f * (box.min + box.max);
    bvh.radius = 0.5f * glm::length(box.max - box.min);
    if (bvh.moving) {
        auto moving = std::make_shared<Moving>(*bvh.moving);
        moving->cost = fitNodes(bvh.nodes, moving->node, bvh.triangles, box);
        bvh.moving = std::move(moving);
        bvh.refit();
    }
    report(progress, "triangle hierarchy", 1.0f);
    return bvh;
}

void TriangleBvh::refit() {
    if (!moving) return;
    const std::uint32_t first = moving->node;
    const std::span movingTriangles = std::span(triangles).subspan(moving->triangle);
    const auto take = [&](const std::vector<BvhNode>& tree, std::span<const std::uint32_t> order) {
        nodes.resize(first + tree.size());
        std::copy(tree.begin(), tree.end(), nodes.begin() + first);
        writeTriangles(*scene, order, moving->triangle, movingTriangles);
    };
    take(moving->nodes, moving->order);
    Box box;
    if (fitNodes(nodes, first, triangles, box) > kPoorBvh * moving->cost) {
        const int room = kBvhStack - (first > 0 ? 2 : 1);
        Subtree tree =
            buildSubtree(*scene, scene->moving->triangle, scene->triangles.size(), room, 0, {});
        shift(tree.nodes, first, moving->triangle);
        take(tree.nodes, tree.order);
        box = tree.box;
    }
    if (first > 0) nodes.front() = rootOver(boxOf(nodes[1]), 1, box, first);
}

BvhData TriangleBvh::data(bool gloss) const {
    BvhData d;
    d.flags = gloss ? flags : flags & ~kBvhOfGloss;
    if (nodes.empty()) return d;
    d.nodes = nodes.data();
    d.triangles = triangles.data();
    d.indices = scene->triangles.data();
    d.normals = scene->normals.data();
    d.colors = scene->colors.data();
    d.uvs = scene->uvs.data();
    d.emissiveUvs = scene->emissiveUvs.data();
    d.materials = materials.data();
    d.textures = textures.textures.data();
    d.texels = textures.texels.data();
    return d;
}

std::optional<RayHit> TriangleBvh::intersect(glm::vec3 origin, glm::vec3 direction, float tMin,
                                             float tMax) const {
    RayHit hit;
    hit.slot = bvhIntersect(data(), origin, direction, tMin, tMax, false, hit.t, hit.u, hit.v);
    if (hit.slot == kNone) return std::nullopt;
    hit.triangle = triangles[hit.slot].triangle;
    return hit;
}

bool TriangleBvh::occluded(glm::vec3 origin, glm::vec3 direction, float tMin, float tMax) const {
    return bvhOccluded(data(), origin, direction, tMin, tMax);
}

BvhSurface TriangleBvh::surface(const RayHit& hit) const {
    return bvhSurface(data(), hit.slot, hit.u, hit.v);
}

bool TriangleBvh::isBack(const RayHit& hit, glm::vec3 direction) const {
    const BvhTriangle& t = triangles[hit.slot];
    const glm::vec3 a(t.ax, t.ay, t.az), b(t.bx, t.by, t.bz), c(t.cx, t.cy, t.cz);
    const bool doubleSided = materials[t.material & ~kMaterialMask].flags & kMaterialDoubleSided;
    return !doubleSided && dot3(cross3(b - a, c - a), direction) > 0;
}

}  // namespace mv
