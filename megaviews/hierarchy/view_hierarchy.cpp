#include "megaviews/hierarchy/view_hierarchy.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "shaders/shared/cone.glsl"
#include "shaders/shared/morton.glsl"

namespace mv {
namespace {

vec3 axisOf(const ViewNode& n) { return {n.axisX, n.axisY, n.axisZ}; }

// Exact bounds of a node's views; the node itself keeps them rounded outwards.
struct Bounds {
    vec3 lo{kInfinity}, hi{-kInfinity};
    void add(const Bounds& b) {
        lo = min(lo, b.lo);
        hi = max(hi, b.hi);
    }
};

void setBox(ViewNode& node, vec3 center, vec3 half) {
    node.centerX = center.x;
    node.centerY = center.y;
    node.centerZ = center.z;
    node.halfX = half.x;
    node.halfY = half.y;
    node.halfZ = half.z;
}
void setTightBox(ViewNode& node, const Bounds& b) {
    const vec3 c(intervalCenter(b.lo.x, b.hi.x), intervalCenter(b.lo.y, b.hi.y),
                 intervalCenter(b.lo.z, b.hi.z));
    setBox(node, c,
           vec3(intervalHalf(b.lo.x, b.hi.x, c.x), intervalHalf(b.lo.y, b.hi.y, c.y),
                intervalHalf(b.lo.z, b.hi.z, c.z)));
}

// Cone of directions -> cone of everything the node sees: psi = theta + pi/2.
void setCone(ViewNode& node, vec3 axis, bool culls, float cosTheta, float sinTheta) {
    node.axisX = axis.x;
    node.axisY = axis.y;
    node.axisZ = axis.z;
    node.cosPsi = culls ? -sinTheta : -1.0f;
    node.sinPsi = culls ? cosTheta : 0.0f;
    if (!culls) node.flags |= kViewNodeNoCull;
}
void copyCone(ViewNode& node, const ViewNode& child) {
    setCone(node, axisOf(child), (child.flags & kViewNodeNoCull) == 0u, child.sinPsi,
            -child.cosPsi);
}
void setConeOfView(ViewNode& node, const View& view) {
    vec3 axis;
    const bool hemisphere = (view.flags & kViewOmnidirectional) == 0u;
    const bool culls = coneAxis(viewNormal(view), 1.0f, axis) && hemisphere;
    setCone(node, culls ? viewNormal(view) : axis, culls, 1.0f, 0.0f);
}

// Sums over the views of a leaf, or over a block of them.
struct ViewSums {
    Bounds bounds;
    vec3 normals{0};
    bool culls = true;
    vec3 axis{0, 0, 1};
    float cosTheta = 1, sinTheta = 0;

    void add(const View& view) {
        bounds.add({viewPosition(view), viewPosition(view)});
        normals += viewNormal(view);
        culls = culls && (view.flags & kViewOmnidirectional) == 0u;
    }
    void add(const ViewSums& block) {
        bounds.add(block.bounds);
        normals += block.normals;
        culls = culls && block.culls;
    }
};

// Calls one of two functions for every block that lies in [begin, end) and every view in no such
// block, in order.
template <typename OnView, typename OnBlock>
void forViewsAndBlocks(std::uint32_t begin, std::uint32_t end, OnView onView, OnBlock onBlock) {
    for (std::uint32_t i = begin; i < end;) {
        const bool block = i % kViewBlock == 0 && i + kViewBlock <= end;
        block ? onBlock(i) : onView(i);
        i += block ? kViewBlock : 1;
    }
}

ViewSums sumBlock(const ViewHierarchy& h, std::uint32_t begin) {
    ViewSums s;
    const std::uint32_t end = begin + kViewBlock;
    for (std::uint32_t i = begin; i < end; ++i) s.add(h.sortedViews[i]);
    s.culls = coneAxis(s.normals, float(kViewBlock), s.axis) && s.culls;
    for (std::uint32_t i = begin; i < end && s.culls; ++i)
        s.culls =
            coneInclude(s.axis, viewNormal(h.sortedViews[i]), 1.0f, 0.0f, s.cosTheta, s.sinTheta);
    s.culls = s.culls && coneFinish(s.cosTheta, s.sinTheta);
    return s;
}

void finishLeaf(const ViewHierarchy& h, ViewNode& node, Bounds& bounds) {
    const std::uint32_t begin = node.firstView, end = begin + node.viewCount;
    ViewSums s;
    std::vector<ViewSums> blocks;
    forViewsAndBlocks(
        begin, end, [&](std::uint32_t i) { s.add(h.sortedViews[i]); },
        [&](std::uint32_t i) {
            blocks.push_back(sumBlock(h, i));
            s.add(blocks.back());
        });
    bounds = s.bounds;
    if (node.viewCount == 1) return setConeOfView(node, h.sortedViews[begin]);
    s.culls = coneAxis(s.normals, float(node.viewCount), s.axis) && s.culls;
    std::size_t block = 0;
    const auto include = [&](vec3 axis, float cosTheta, float sinTheta) {
        s.culls = s.culls && coneInclude(s.axis, axis, cosTheta, sinTheta, s.cosTheta, s.sinTheta);
    };
    forViewsAndBlocks(
        begin, end, [&](std::uint32_t i) { include(viewNormal(h.sortedViews[i]), 1, 0); },
        [&](std::uint32_t) {
            include(blocks[block].axis, blocks[block].cosTheta, blocks[block].sinTheta);
            ++block;
        });
    s.culls = s.culls && coneFinish(s.cosTheta, s.sinTheta);
    setCone(node, s.axis, s.culls, s.cosTheta, s.sinTheta);
}

void finishInner(const ViewHierarchy& h, const std::vector<Bounds>& allBounds, ViewNode& node,
                 Bounds& bounds) {
    const std::uint32_t first = firstChildOf(node.children);
    const std::uint32_t end = first + childCountOf(node.children);
    vec3 sum(0);
    bool culls = true;
    node.viewCount = 0;
    for (std::uint32_t c = first; c < end; ++c) {
        const ViewNode& child = h.nodes[c];
        bounds.add(allBounds[c]);
        sum += axisOf(child) * float(child.viewCount);
        node.viewCount += child.viewCount;
        culls = culls && (child.flags & kViewNodeNoCull) == 0u;
    }
    if (end == first + 1) return copyCone(node, h.nodes[first]);
    vec3 axis;
    culls = coneAxis(sum, float(node.viewCount), axis) && culls;
    float cosTheta = 1, sinTheta = 0;
    for (std::uint32_t c = first; c < end && culls; ++c) {
        const ViewNode& child = h.nodes[c];
        culls = coneInclude(axis, axisOf(child), child.sinPsi, -child.cosPsi, cosTheta, sinTheta);
    }
    culls = culls && coneFinish(cosTheta, sinTheta);
    setCone(node, axis, culls, cosTheta, sinTheta);
}

void sortViews(const std::vector<View>& views, ViewHierarchy& h) {
    std::vector<std::uint64_t> order;
    order.reserve(views.size());
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].flags != kViewDead)
            order.push_back(std::uint64_t{mortonKeyOf(viewPosition(views[i]))} << 32 | i);
    std::sort(order.begin(), order.end());
    h.sortedViews.reserve(order.size());
    h.mortonKeys.reserve(order.size());
    for (const std::uint64_t o : order) {
        h.sortedViews.push_back(views[o & 0xFFFFFFFFu]);
        h.mortonKeys.push_back(static_cast<std::uint32_t>(o >> 32));
    }
}

ViewHierarchy buildFlat(ViewHierarchy h) {
    const auto n = static_cast<std::uint32_t>(h.sortedViews.size());
    h.nodes.resize(n);
    h.mapOfNode.resize(n);
    h.leafOfView.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        ViewNode node{};
        node.flags = (kNone >> 1u) << 1u;
        node.firstView = i;
        node.viewCount = 1;
        setBox(node, viewPosition(h.sortedViews[i]), vec3(0));
        setConeOfView(node, h.sortedViews[i]);
        h.nodes[i] = node;
        h.mapOfNode[i] = h.leafOfView[i] = i;
    }
    h.levelBegin = {0, n};
    h.leafCount = n;
    return h;
}

// A node starts at `firstView`; children and view range end where the next node begins.
struct Start {
    std::uint32_t firstView, firstChild, parent;
    std::uint32_t leaf;  // its number; kNone: inner
};
using Starts = std::array<std::vector<Start>, kMortonLevels + 2>;  // by level

// The level whose cells view i is the first to be in, as its predecessor in Morton order is not.
std::uint32_t firstLevel(const ViewHierarchy& h, std::uint32_t i, std::uint32_t leafLevel) {
    if (i == 0 || i == h.mortonKeys.size()) return 0;
    return firstDifferentLevel(h.mortonKeys[i - 1], h.mortonKeys[i], leafLevel);
}

// Where nodes start: view i opens the cells of levels s..e, the last of them a leaf. e is where it
// is alone, or the last level.
Starts findStarts(ViewHierarchy& h, std::uint32_t leafLevel, bool loneViews) {
    Starts starts;
    const auto sizeOf = [&](std::uint32_t level) {
        return static_cast<std::uint32_t>(starts[level].size());
    };
    for (std::uint32_t i = 0; i < h.sortedViews.size(); ++i) {
        const std::uint32_t s = firstLevel(h, i, leafLevel);
        if (s > leafLevel) continue;
        const std::uint32_t e =
            loneViews ? std::min(leafLevel, std::max(s, firstLevel(h, i + 1, leafLevel)))
                      : leafLevel;
        for (std::uint32_t l = s; l <= e; ++l) {
            starts[l].push_back(
                {i, sizeOf(l + 1), l ? sizeOf(l - 1) - 1 : 0, l == e ? h.leafCount : kNone});
        }
        ++h.leafCount;
    }
    return starts;
}

// Level by level in one array: all of the nodes but boxes, cones and how many views inner ones
// have.
void placeNodes(const Starts& starts, std::uint32_t leafLevel, ViewHierarchy& h) {
    const auto n = static_cast<std::uint32_t>(h.sortedViews.size());
    h.levelBegin.assign(leafLevel + 2, 0);
    for (std::uint32_t l = 0; l <= leafLevel; ++l)
        h.levelBegin[l + 1] = h.levelBegin[l] + static_cast<std::uint32_t>(starts[l].size());
    h.nodes.reserve(h.levelBegin.back());
    h.leafOfView.resize(n);
    for (std::uint32_t l = 0; l <= leafLevel; ++l) {
        for (std::size_t k = 0; k < starts[l].size(); ++k) {
            const Start& start = starts[l][k];
            ViewNode node{};
            node.level = l;
            node.firstView = start.firstView;
            const std::uint32_t parent = l ? h.levelBegin[l - 1] + start.parent : kNone >> 1u;
            node.flags = parent << 1u;
            if (start.leaf != kNone) {
                std::uint32_t end = start.firstView + 1;
                while (end < n && firstLevel(h, end, leafLevel) > leafLevel) ++end;
                node.viewCount = end - start.firstView;
                std::fill(h.leafOfView.begin() + start.firstView, h.leafOfView.begin() + end,
                          static_cast<std::uint32_t>(h.nodes.size()));
            } else {
                const std::size_t next =
                    k + 1 < starts[l].size() ? starts[l][k + 1].firstChild : starts[l + 1].size();
                node.children = packChildren(h.levelBegin[l + 1] + start.firstChild,
                                             static_cast<std::uint32_t>(next) - start.firstChild);
            }
            h.mapOfNode.push_back(start.leaf);
            h.nodes.push_back(node);
        }
    }
}

}  // namespace

ViewHierarchy ViewHierarchy::build(const std::vector<View>& views,
                                   const ViewHierarchyOptions& options) {
    assert(options.levels >= 1 && options.levels <= int(kMortonLevels) + 1);
    ViewHierarchy h;
    sortViews(views, h);
    if (options.flat) return buildFlat(std::move(h));
    const auto leafLevel = static_cast<std::uint32_t>(options.levels - 1);
    placeNodes(findStarts(h, leafLevel, hasRule(options.rules, kRuleLoneViews)), leafLevel, h);

    // Boxes and cones, children before parents.
    std::vector<Bounds> bounds(h.nodes.size());
    for (std::size_t k = h.nodes.size(); k-- > 0;) {
        ViewNode& node = h.nodes[k];
        if (node.children == 0)
            finishLeaf(h, node, bounds[k]);
        else
            finishInner(h, bounds, node, bounds[k]);
        if (!hasRule(options.rules, kRuleBoxes)) {
            const std::uint32_t key =
                h.mortonKeys[node.firstView] >> (3 * (kMortonLevels - node.level));
            setBox(node, cellCenter(key, node.level), vec3(cellHalf(node.level)));
        } else {
            setTightBox(node, bounds[k]);
        }
    }
    return h;
}

}  // namespace mv
