#include "megaviews/hierarchy/scene_hierarchy.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <span>

#include "megaviews/core/error.h"
#include "megaviews/hierarchy/moving_surface.h"
#include "megaviews/hierarchy/sample_tree.h"
#include "megaviews/hierarchy/surface_piece.h"
#include "megaviews/hierarchy/surface_sampler.h"
#include "megaviews/hierarchy/surface_sums.h"
#include "megaviews/scene/rigged_scene.h"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/types.glsl"

namespace mv {
namespace {

// The tree is built in subtrees below this level, one task each, and joined above it.
constexpr std::uint32_t kSubtreeLevel = 4;
constexpr std::uint64_t kMaxNodes = 1ull << 28;  // what packChildren can address
constexpr std::size_t kTrianglesPerTask = 4096;
constexpr std::string_view kVoxelStage = "voxelise";

void refuseTooMany(std::uint64_t nodes) {
    if (nodes < kMaxNodes) return;
    throw Error(ExitCode::impossible,
                "the scene octree would exceed 2^28 nodes: take a smaller --scene-depth");
}

struct Cell {
    std::uint32_t key, level;
    double half() const { return 0.5 / static_cast<double>(1u << level); }
    glm::dvec3 center() const { return (glm::dvec3(mortonDecode(key)) + 0.5) * (2 * half()); }
    Cell child(std::uint32_t octant) const { return {key << 3 | octant, level + 1}; }
};

// Nodes of one level, Morton order.
struct LevelNodes {
    SceneNodes nodes;
    LargeVector<float> areas;
    LargeVector<std::uint32_t> keys;
    std::uint32_t size() const { return static_cast<std::uint32_t>(nodes.size()); }
    void add(const SurfaceSums& sums, Cell cell, std::uint32_t children) {
        nodes.push_back(sums.node(cell.level, children));
        areas.push_back(static_cast<float>(sums.area));
        keys.push_back(cell.key);
    }
};

// Descends from one cell with the pieces of surface inside it. Children are finished before their
// parent, in Morton order, so every level comes out sorted and no sort is needed; pieces keep the
// order of their triangles, which makes every sum run in (key, triangle) order.
class SubtreeBuilder {
  public:
    // remembered: null, or gets the pieces of each leaf.
    SubtreeBuilder(const Scene& scene, const SurfaceSampler& sampler, std::uint32_t leafLevel,
                   MovingSurface* remembered)
        : scene_(scene), sampler_(sampler), leafLevel_(leafLevel), remembered_(remembered) {}

    // False if nothing of the triangles is left in the cell.
    bool build(Cell cell, std::span<const std::uint32_t> triangles, SurfaceSums& sums) {
        std::vector<SurfacePiece> pieces;
        for (const std::uint32_t triangle : triangles) {
            pieces.push_back(SurfacePiece::whole(scene_, triangle));
            if (!clipToCell(pieces.back(), cell.center() - cell.half(),
                            cell.center() + cell.half()))
                pieces.pop_back();
        }
        return !pieces.empty() && visit(cell, pieces, sums);
    }
    std::array<LevelNodes, kTreeLevels>& levels() { return levels_; }

  private:
    bool visit(Cell cell, const std::vector<SurfacePiece>& pieces, SurfaceSums& sums) {
        if (cell.level == leafLevel_) return leaf(cell, pieces, sums);
        std::array<std::vector<SurfacePiece>, 8>& inside = pieces_[cell.level];
        for (std::vector<SurfacePiece>& p : inside) p.clear();
        for (const SurfacePiece& p : pieces) cutUp(p, cell.center(), inside);

        const std::uint32_t firstChild = levels_[cell.level + 1].size();
        std::array<SurfaceSums, 8> children;
        std::uint32_t count = 0;
        for (std::uint32_t octant = 0; octant < 8; ++octant)
            if (!inside[octant].empty() &&
                visit(cell.child(octant), inside[octant], children[count]))
                ++count;
        if (count == 0) return false;
        sums = SurfaceSums::ofChildren(std::span(children).first(count));
        levels_[cell.level].add(sums, cell, packChildren(firstChild, count));
        return true;
    }

    static void cutUp(const SurfacePiece& piece, glm::dvec3 center,
                      std::array<std::vector<SurfacePiece>, 8>& inside) {
        SurfacePiece xs[2], ys[2], zs[2];
        const SurfacePiece *atX[2], *atY[2], *atZ[2];
        cut(piece, 0, center.x, xs, atX);
        for (std::size_t x = 0; x < 2; ++x) {
            if (!atX[x]) continue;
            cut(*atX[x], 1, center.y, ys, atY);
            for (std::size_t y = 0; y < 2; ++y) {
                if (!atY[y]) continue;
                cut(*atY[y], 2, center.z, zs, atZ);
                for (std::size_t z = 0; z < 2; ++z)
                    if (atZ[z]) inside[x + 2 * y + 4 * z].push_back(*atZ[z]);
            }
        }
    }

    bool leaf(Cell cell, const std::vector<SurfacePiece>& pieces, SurfaceSums& sums) {
        fragments_.clear();
        for (const SurfacePiece& p : pieces) addFragment(p);
        if (fragments_.empty()) return false;
        sums = SurfaceSums::ofFragments(fragments_);
        levels_[cell.level].add(sums, cell, 0);
        return true;
    }

    void addFragment(const SurfacePiece& piece) {
        const glm::dvec3 centroid = piece.centroid();
        const double coverage = sampler_.coverage(piece, centroid);
        if (coverage <= 0) return;
        if (remembered_) remember(piece, coverage);
        const glm::uvec3 c = scene_.triangles[piece.triangle];
        const glm::dvec3 a(scene_.positions[c.x]);
        Fragment& f = fragments_.emplace_back();
        f.lo = piece.lo;
        f.hi = piece.hi;
        f.centroid = centroid;
        f.faceNormal = glm::normalize(glm::cross(glm::dvec3(scene_.positions[c.y]) - a,
                                                 glm::dvec3(scene_.positions[c.z]) - a));
        f.area = piece.area() * coverage;
    }

    void remember(const SurfacePiece& piece, double coverage) {
        MovingSurface& to = *remembered_;
        if (fragments_.empty()) to.pieces.push_back(static_cast<std::uint32_t>(to.all.size()));
        to.all.push_back({piece.triangle, static_cast<std::uint32_t>(to.corners.size()),
                          piece.count, static_cast<float>(coverage)});
        const CornerWeights weights(scene_, piece.triangle);
        for (std::size_t i = 0; i < piece.count; ++i) {
            to.corners.emplace_back(weights.at(piece.corners[i]));
        }
    }

    const Scene& scene_;
    const SurfaceSampler& sampler_;
    const std::uint32_t leafLevel_;
    MovingSurface* const remembered_;
    std::array<LevelNodes, kTreeLevels> levels_;
    // What lies in the children of the cell being visited on each level.
    std::array<std::array<std::vector<SurfacePiece>, 8>, kTreeLevels> pieces_;
    std::vector<Fragment> fragments_;
};

// The triangles whose boxes meet each cell of a level, in triangle order.
struct CellLists {
    std::vector<std::uint32_t> keys;   // of the cells that have any, ascending
    std::vector<std::uint32_t> begin;  // into triangles, one more than keys
    std::vector<std::uint32_t> triangles;
};

struct TriangleRange {
    std::size_t first, end;
};

CellLists distribute(const Scene& scene, TriangleRange range, std::uint32_t level) {
    // Cells of every triangle, a block of triangles a task.
    struct Block {
        std::vector<std::uint32_t> keys, triangles;
    };
    const std::size_t n = range.end - range.first;
    const double cells = static_cast<double>(1u << level);
    std::vector<Block> blocks((n + kTrianglesPerTask - 1) / kTrianglesPerTask);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
        Block& block = blocks[b];
        const std::size_t end = std::min(n, (b + 1) * kTrianglesPerTask);
        for (std::size_t i = b * kTrianglesPerTask; i < end; ++i) {
            const auto triangle = static_cast<std::uint32_t>(range.first + i);
            const SurfacePiece t = SurfacePiece::whole(scene, triangle);
            if (!hasSurface(t)) continue;
            const glm::uvec3 lo(glm::clamp(t.lo * cells, 0.0, cells - 1));
            const glm::uvec3 hi(glm::clamp(t.hi * cells, 0.0, cells - 1));
            for (std::uint32_t z = lo.z; z <= hi.z; ++z)
                for (std::uint32_t y = lo.y; y <= hi.y; ++y)
                    for (std::uint32_t x = lo.x; x <= hi.x; ++x)
                        block.keys.push_back(mortonEncode(x, y, z));
            block.triangles.resize(block.keys.size(), triangle);
        }
    });

    // Counting sort by cell; stable, so triangles stay in order.
    std::vector<std::uint32_t> at((std::size_t{1} << (3 * level)) + 1, 0);
    for (const Block& block : blocks)
        for (const std::uint32_t key : block.keys) ++at[key + 1];
    CellLists lists;
    for (std::uint32_t key = 0; key + 1 < at.size(); ++key) {
        if (at[key + 1] > 0) {
            lists.keys.push_back(key);
            lists.begin.push_back(at[key]);
        }
        at[key + 1] += at[key];
    }
    lists.begin.push_back(at.back());
    lists.triangles.resize(at.back());
    for (const Block& block : blocks)
        for (std::size_t i = 0; i < block.keys.size(); ++i)
            lists.triangles[at[block.keys[i]]++] = block.triangles[i];
    return lists;
}

// What a finished subtree leaves behind.
struct Subtree {
    Cell root{};
    bool present = false;
    SurfaceSums sums;
    std::array<LevelNodes, kTreeLevels> levels;
    MovingSurface remembered;
};

// Levels above the subtrees, in place: from the roots of one level to their parents.
void joinUpwards(std::vector<Subtree>& subtrees, std::uint32_t level,
                 std::array<LevelNodes, kTreeLevels>& top) {
    std::vector<std::pair<Cell, SurfaceSums>> row;
    for (const Subtree& s : subtrees)
        if (s.present) row.emplace_back(s.root, s.sums);
    for (std::uint32_t l = level; l-- > 0;) {
        std::vector<std::pair<Cell, SurfaceSums>> parents;
        for (std::size_t i = 0; i < row.size();) {
            const Cell cell{row[i].first.key >> 3, l};
            std::array<SurfaceSums, 8> children;
            std::uint32_t count = 0;
            const auto first = static_cast<std::uint32_t>(i);
            for (; i < row.size() && row[i].first.key >> 3 == cell.key; ++i)
                children[count++] = row[i].second;
            parents.emplace_back(cell, SurfaceSums::ofChildren(std::span(children).first(count)));
            top[l].add(parents.back().second, cell, packChildren(first, count));
        }
        row = std::move(parents);
    }
}

// Puts pieces of leaves behind others.
void append(const MovingSurface& from, MovingSurface& to) {
    const auto pieces = static_cast<std::uint32_t>(to.all.size());
    const auto corners = static_cast<std::uint32_t>(to.corners.size());
    for (const std::uint32_t first : from.pieces) to.pieces.push_back(pieces + first);
    for (MovingPiece piece : from.all) {
        piece.firstCorner += corners;
        to.all.push_back(piece);
    }
    to.corners.insert(to.corners.end(), from.corners.begin(), from.corners.end());
}

// remembered: null, or gets the pieces of all leaves, in their order.
SceneHierarchy buildTree(const Scene& scene, const TriangleBvh& bvh, TriangleRange triangles,
                         int levels, MovingSurface* remembered, const Progress& progress) {
    assert(levels >= 1 && levels <= static_cast<int>(kTreeLevels));
    assert(bvh.scene == &scene);
    const auto leafLevel = static_cast<std::uint32_t>(levels - 1);
    const std::uint32_t subtreeLevel = std::min(leafLevel, kSubtreeLevel);
    report(progress, kVoxelStage, 0);
    const CellLists lists = distribute(scene, triangles, subtreeLevel);

    // Subtrees, each in one task.
    const SurfaceSampler sampler(bvh);
    std::vector<Subtree> subtrees(lists.keys.size());
    std::atomic<std::uint64_t> nodeCount{0}, trianglesDone{0};
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, subtrees.size(), 1), [&](const auto& range) {
            for (std::size_t k = range.begin(); k < range.end(); ++k) {
                Subtree& subtree = subtrees[k];
                subtree.root = {lists.keys[k], subtreeLevel};
                SubtreeBuilder builder(scene, sampler, leafLevel,
                                       remembered ? &subtree.remembered : nullptr);
                const std::span<const std::uint32_t> inside(lists.triangles.data() + lists.begin[k],
                                                            lists.begin[k + 1] - lists.begin[k]);
                subtree.present = builder.build(subtree.root, inside, subtree.sums);
                subtree.levels = std::move(builder.levels());
                for (const LevelNodes& l : subtree.levels) nodeCount += l.size();
                refuseTooMany(nodeCount);
                // Some tens of reports: one whenever a fiftieth of the work is passed.
                const std::uint64_t before = trianglesDone.fetch_add(inside.size());
                const std::uint64_t after = before + inside.size(), all = lists.triangles.size();
                if (after * 50 / all != before * 50 / all)
                    report(progress, kVoxelStage,
                           static_cast<float>(after) / static_cast<float>(all));
            }
        });

    std::array<LevelNodes, kTreeLevels> top;
    joinUpwards(subtrees, subtreeLevel, top);

    // Level by level in one array: first the places, then the copies.
    for (const LevelNodes& l : top) nodeCount += l.size();
    refuseTooMany(nodeCount);

    SceneHierarchy h;
    h.levelBegin.push_back(0);
    if (nodeCount == 0) return h;
    h.levels = levels;
    std::vector<std::array<std::uint32_t, kTreeLevels + 1>> places(subtrees.size());
    std::uint32_t total = 0;
    for (std::uint32_t l = 0; l <= leafLevel; ++l) {
        total += top[l].size();
        for (std::size_t k = 0; k < subtrees.size(); ++k) {
            places[k][l] = total;
            total += subtrees[k].levels[l].size();
        }
        h.levelBegin.push_back(total);
    }
    h.nodes.resize(total);
    h.areas.resize(total);
    h.mortonKeys.resize(total);
    const auto place = [&](LevelNodes& from, std::uint32_t to, std::uint32_t childrenAt) {
        for (SceneNode& n : from.nodes)
            if (n.children)
                n.children =
                    packChildren(firstChildOf(n.children) + childrenAt, childCountOf(n.children));
        std::copy(from.nodes.begin(), from.nodes.end(), h.nodes.begin() + to);
        std::copy(from.areas.begin(), from.areas.end(), h.areas.begin() + to);
        std::copy(from.keys.begin(), from.keys.end(), h.mortonKeys.begin() + to);
        from = {};
    };
    for (std::uint32_t l = 0; l < subtreeLevel; ++l)
        place(top[l], h.levelBegin[l], h.levelBegin[l + 1]);
    tbb::parallel_for(std::size_t{0}, subtrees.size(), [&](std::size_t k) {
        for (std::uint32_t l = subtreeLevel; l <= leafLevel; ++l)
            place(subtrees[k].levels[l], places[k][l], l < leafLevel ? places[k][l + 1] : 0);
    });
    for (const Subtree& subtree : subtrees) {
        if (remembered) append(subtree.remembered, *remembered);
    }
    report(progress, kVoxelStage, 1);
    return h;
}

// Levels of a tree over what moves that has not many more leaves than there may be: a surface meets
// about two cells for each of its area's squares.
int movingLevels(const Scene& scene, TriangleRange range, int levels) {
    double area = 0;
    for (std::size_t i = range.first; i < range.end; ++i) {
        area += SurfacePiece::whole(scene, static_cast<std::uint32_t>(i)).area();
    }
    while (levels > 1 && 2 * area * std::pow(4.0, levels - 1) > kMostMovingLeaves) --levels;
    return levels;
}

// Puts two trees under one root, level by level; `shift`: by how many levels the second's nodes
// stand lower than in their own tree. `begin` becomes where the second's nodes begin by level.
SceneHierarchy joined(const SceneHierarchy& a, const SceneHierarchy& b, int shift,
                      std::vector<std::uint32_t>& begin) {
    const auto at = [](const SceneHierarchy& h, int level) {
        return level < 0 ? 0u : h.levelBegin[static_cast<std::size_t>(std::min(level, h.levels))];
    };
    refuseTooMany(a.nodes.size() + b.nodes.size());
    SceneHierarchy h;
    h.levels = std::max(a.levels, b.levels + shift);
    h.levelBegin = {0, 1};
    h.nodes.resize(1);
    h.areas.resize(1);
    h.mortonKeys.resize(1);
    begin = {0};
    // Level 1 holds the roots of both, or the children of one that is only over them.
    const auto take = [&](const SceneHierarchy& from, int level, std::uint32_t childrenTo) {
        for (std::uint32_t i = at(from, level); i < at(from, level + 1); ++i) {
            SceneNode node = from.nodes[i];
            if (node.children) {
                node.children =
                    packChildren(firstChildOf(node.children) - at(from, level + 1) + childrenTo,
                                 childCountOf(node.children));
            }
            h.nodes.push_back(node);
            h.areas.push_back(from.areas[i]);
            h.mortonKeys.push_back(from.mortonKeys[i]);
        }
    };
    for (int level = 1; level < h.levels; ++level) {
        const std::uint32_t next = h.levelBegin.back() + (at(a, level + 1) - at(a, level)) +
                                   (at(b, level - shift + 1) - at(b, level - shift));
        take(a, level, next);
        begin.push_back(static_cast<std::uint32_t>(h.nodes.size()));
        take(b, level - shift, next + at(a, level + 2) - at(a, level + 1));
        h.levelBegin.push_back(next);
    }
    const std::span<const SceneNode> top = std::span(h.nodes).subspan(1, h.levelBegin[2] - 1);
    h.areas[0] = a.areas[0];
    h.nodes[0] = rootOver(top, packChildren(1, static_cast<std::uint32_t>(top.size())));
    return h;
}

}  // namespace

std::uint64_t SceneHierarchy::leafCount() const {
    return static_cast<std::uint64_t>(std::count_if(
        nodes.begin(), nodes.end(), [](const SceneNode& n) { return n.children == 0; }));
}

float SceneHierarchy::leafEdge() const {
    return samples ? 2 * samples->leafRadius : 1.0f / static_cast<float>(1u << (levels - 1));
}

std::span<const SceneNode> SceneHierarchy::nodesUnder(uint rules, SceneNodes& made) const {
    if (sceneTable(rules) == sceneTable(kCorrectedRules)) return nodes;
    if (made.empty()) made = nodesUnder(rules);
    return made;
}

SceneNodes SceneHierarchy::nodesUnder(uint rules) const {
    const bool boxes = hasRule(rules, kRuleBoxes), centroids = hasRule(rules, kRuleCentroid);
    SceneNodes out = samples && !boxes ? sphereNodes(*this) : nodes;
    if (boxes && centroids) return out;
    const auto change = [&](std::size_t i) {
        SceneNode& n = out[i];
        if (!boxes && !samples) {
            if (moving && i >= moving->begin[n.level]) {
                n.halfX = n.halfY = n.halfZ = std::max({n.halfX, n.halfY, n.halfZ});
            } else {
                const glm::vec3 c = cellCenter(mortonKeys[i], n.level);
                n.centerX = c.x;
                n.centerY = c.y;
                n.centerZ = c.z;
                n.halfX = n.halfY = n.halfZ = cellHalf(n.level);
            }
        }
        n.centroidX = centroids ? nodes[i].centroidX : n.centerX;
        n.centroidY = centroids ? nodes[i].centroidY : n.centerY;
        n.centroidZ = centroids ? nodes[i].centroidZ : n.centerZ;
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.size(), 1 << 14),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i) change(i);
                      });
    return out;
}

SceneHierarchy SceneHierarchy::build(const Scene& scene, const TriangleBvh& bvh, int levels,
                                     const Progress& progress) {
    const std::size_t end = scene.moving ? scene.moving->triangle : scene.triangles.size();
    return buildTree(scene, bvh, {0, end}, levels, nullptr, progress);
}

void SceneHierarchy::joinMoving(const Scene& scene, const TriangleBvh& bvh, int wanted) {
    if (!scene.moving) return;
    const TriangleRange range{scene.moving->triangle, scene.triangles.size()};
    auto surface = std::make_shared<MovingSurface>();
    int depth = movingLevels(scene, range, wanted);
    SceneHierarchy tree = buildTree(scene, bvh, range, depth, surface.get(), {});
    if (tree.nodes.empty()) return;
    if (levels == 0) {
        *this = std::move(tree);
        surface->begin.assign(levelBegin.begin(), levelBegin.end() - 1);
    } else {
        // Its root hangs a level below that of all, or is left out where it has one child.
        int shift = depth > 1 && childCountOf(tree.nodes[0].children) == 1 ? 0 : 1;
        if (shift == 1 && depth == wanted && depth > 1) {
            *surface = {};
            tree = buildTree(scene, bvh, range, --depth, surface.get(), {});
        }
        if (levels == 1) {  // a root that is a leaf hangs beside it
            SceneHierarchy lower;
            lower.levels = 2;
            lower.levelBegin = {0, 1, 2};
            for (int i = 0; i < 2; ++i) {
                lower.nodes.push_back(nodes[0]);
                lower.areas.push_back(areas[0]);
                lower.mortonKeys.push_back(0);
            }
            *this = std::move(lower);
        }
        std::vector<std::uint32_t> begin;
        *this = joined(*this, tree, shift, begin);
        surface->begin = std::move(begin);
    }
    surface->pieces.push_back(static_cast<std::uint32_t>(surface->all.size()));
    moving = std::move(surface);
    refit(scene);
}

void SceneHierarchy::refit(const Scene& scene) {
    if (!moving) return;
    if (samples) {
        refitSampleTree(*this, scene);
        return;
    }
    std::vector<SurfaceSums> below, sums;
    for (std::size_t level = moving->begin.size(); level-- > 0;) {
        const std::uint32_t first = moving->begin[level], end = levelBegin[level + 1];
        const bool aboveAll = level == 0 && levels > 1 && moving->begin[1] > levelBegin[1];
        if (aboveAll) {
            const std::span top = std::span(nodes).subspan(1, childCountOf(nodes[0].children));
            nodes[0] = rootOver(top, nodes[0].children);
            break;
        }
        sums.resize(end - first);
        tbb::parallel_for(std::uint32_t{0}, end - first, [&](std::uint32_t i) {
            const std::uint32_t children = nodes[first + i].children;
            if (children == 0) {  // all on the lowest level, in the order of their pieces
                sums[i] = moving->sumsOf(scene, i);
            } else {
                const std::uint32_t child = firstChildOf(children) - moving->begin[level + 1];
                sums[i] = SurfaceSums::ofChildren(
                    std::span(below).subspan(child, childCountOf(children)));
            }
            nodes[first + i] = sums[i].node(static_cast<std::uint32_t>(level), children);
            areas[first + i] = static_cast<float>(sums[i].area);
        });
        std::swap(below, sums);
    }
}

}  // namespace mv
