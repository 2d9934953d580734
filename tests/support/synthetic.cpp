#include "support/synthetic.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "shaders/shared/surface.glsl"

namespace mv::testing {
namespace {

// What a voxel of any level knows while the tree is built.
struct Voxel {
    vec3 lo{2}, hi{-1};
    glm::dvec3 centroid{0}, normal{0};
    double area = 0, planar = 0;
};

std::uint64_t keyOf(vec3 p, int level) {
    const auto cell = [&](float x) {
        const float n = static_cast<float>(1 << level);
        return static_cast<std::uint64_t>(std::clamp(x * n, 0.0f, n - 1));
    };
    std::uint64_t key = 0;
    for (int bit = 0; bit < level; ++bit) {
        key |= ((cell(p.x) >> bit & 1) << 2 | (cell(p.y) >> bit & 1) << 1 | (cell(p.z) >> bit & 1))
               << (3 * bit);
    }
    return key;
}
vec3 cornerOf(std::uint64_t key, int level) {
    vec3 p(0);
    for (int bit = 0; bit < level; ++bit) {
        const float size = static_cast<float>(1 << bit) / static_cast<float>(1 << level);
        p.x += static_cast<float>(key >> (3 * bit + 2) & 1) * size;
        p.y += static_cast<float>(key >> (3 * bit + 1) & 1) * size;
        p.z += static_cast<float>(key >> (3 * bit) & 1) * size;
    }
    return p;
}

void merge(Voxel& a, const Voxel& b) {
    a.lo = min(a.lo, b.lo);
    a.hi = max(a.hi, b.hi);
    a.centroid += b.centroid;
    a.normal += glm::dot(a.normal, b.normal) < 0 ? -b.normal : b.normal;
    a.area += b.area;
}

Voxel voxelOf(const Patch& patch, std::uint64_t key, int level) {
    const vec3 corner = cornerOf(key, level);
    const float size = 1.0f / static_cast<float>(1 << level);
    const vec3 extent = abs(patch.du) + abs(patch.dv);
    Voxel v;
    v.lo = glm::clamp(patch.center - extent, corner, corner + size);
    v.hi = glm::clamp(patch.center + extent, corner, corner + size);
    const glm::dvec3 n = glm::cross(glm::dvec3(patch.du), glm::dvec3(patch.dv)) * 4.0;
    v.area = std::max(glm::length(n), 1e-12);
    v.centroid = glm::dvec3(patch.center) * v.area;
    v.normal = n;
    return v;
}

SceneNode nodeOf(const Voxel& voxel, std::uint32_t level) {
    SceneNode n{};
    const vec3 c = (voxel.lo + voxel.hi) * 0.5f;
    vec3 h = max(voxel.hi - c, c - voxel.lo);
    for (int a = 0; a < 3; ++a) {
        while (c[a] + h[a] < voxel.hi[a] || c[a] - h[a] > voxel.lo[a])
            h[a] = std::nextafter(h[a], 2.0f);
    }
    const vec3 g = glm::clamp(vec3(voxel.centroid / voxel.area), voxel.lo, voxel.hi);
    n.centerX = c.x, n.centerY = c.y, n.centerZ = c.z;
    n.halfX = h.x, n.halfY = h.y, n.halfZ = h.z;
    n.centroidX = g.x, n.centroidY = g.y, n.centroidZ = g.z;
    n.level = level;
    const double straight = glm::length(voxel.normal) / voxel.area;
    n.surface = packSurface(vec3(glm::normalize(voxel.normal + glm::dvec3(1e-30))), straight > 0.9);
    return n;
}

// A node of a voxel as rules see it.
SceneNode nodeUnder(uint rules, SceneNode n, std::uint64_t key) {
    if (!hasRule(rules, kRuleBoxes)) {
        const float half = 0.5f / static_cast<float>(1u << n.level);
        const vec3 c = cornerOf(key, static_cast<int>(n.level)) + half;
        n.centerX = c.x;
        n.centerY = c.y;
        n.centerZ = c.z;
        n.halfX = n.halfY = n.halfZ = half;
    }
    if (!hasRule(rules, kRuleCentroid)) {
        n.centroidX = n.centerX;
        n.centroidY = n.centerY;
        n.centroidZ = n.centerZ;
    }
    return n;
}

// A rectangle of patches no larger than half a voxel.
void addQuad(std::vector<Patch>& out, vec3 corner, vec3 a, vec3 b, int levels) {
    const float step = 0.5f / static_cast<float>(1 << (levels - 1));
    const int na = static_cast<int>(std::ceil(glm::length(a) / step));
    const int nb = static_cast<int>(std::ceil(glm::length(b) / step));
    const vec3 da = a / static_cast<float>(na), db = b / static_cast<float>(nb);
    for (int j = 0; j < nb; ++j) {
        for (int i = 0; i < na; ++i) {
            const vec3 c =
                corner + da * (static_cast<float>(i) + 0.5f) + db * (static_cast<float>(j) + 0.5f);
            out.push_back({c, da * 0.5f, db * 0.5f});
        }
    }
}

// A surface given by a function of (s, t) in [0,1]^2, cut into n x m patches.
template <typename F>
void addSurface(std::vector<Patch>& out, int n, int m, F&& point) {
    const float ds = 1.0f / static_cast<float>(n), dt = 1.0f / static_cast<float>(m);
    for (int j = 0; j < m; ++j) {
        for (int i = 0; i < n; ++i) {
            const float s = static_cast<float>(i) * ds, t = static_cast<float>(j) * dt;
            const vec3 a = point(s, t), b = point(s + ds, t), c = point(s, t + dt),
                       d = point(s + ds, t + dt);
            out.push_back(
                {(a + b + c + d) * 0.25f, (b + d - a - c) * 0.25f, (c + d - a - b) * 0.25f});
        }
    }
}

}  // namespace

std::vector<std::uint32_t> SyntheticScene::leaves() const {
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        if (childCountOf(nodes[i].children) == 0) result.push_back(i);
    return result;
}

SyntheticScene makeScene(const std::vector<Patch>& patches, int levels) {
    SyntheticScene scene;
    scene.patches = patches;
    scene.levels = levels;
    if (patches.empty()) return scene;

    std::vector<std::map<std::uint64_t, Voxel>> tree(static_cast<std::size_t>(levels));
    for (const Patch& patch : patches) {
        const std::uint64_t key = keyOf(patch.center, levels - 1);
        merge(tree.back()[key], voxelOf(patch, key, levels - 1));
    }
    for (std::size_t level = tree.size() - 1; level > 0; --level)
        for (const auto& [key, voxel] : tree[level]) merge(tree[level - 1][key >> 3], voxel);

    for (std::size_t level = 0; level < tree.size(); ++level) {
        scene.levelBegin.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
        std::size_t child = scene.nodes.size() + tree[level].size();
        auto next = level + 1 < tree.size() ? tree[level + 1].begin() : tree[level].end();
        for (const auto& [key, voxel] : tree[level]) {
            std::uint32_t count = 0;
            if (level + 1 < tree.size())
                for (; next != tree[level + 1].end() && next->first >> 3 == key; ++next) ++count;
            const std::uint32_t children =
                packChildren(count ? static_cast<std::uint32_t>(child) : 0, count);
            child += count;
            SceneNode node = nodeOf(voxel, static_cast<std::uint32_t>(level));
            node.children = children;
            scene.nodes.push_back(node);
            for (uint rules = 0; rules < kNodeTables; ++rules) {
                scene.tables[sceneTable(rules)].push_back(nodeUnder(rules, node, key));
            }
        }
    }
    scene.levelBegin.push_back(static_cast<std::uint32_t>(scene.nodes.size()));
    return scene;
}

SyntheticScene makeRoom(int levels) {
    std::vector<Patch> p;
    const float lo = 0.03f, hi = 0.97f, top = 0.6f;
    const float w = hi - lo, h = top - lo;
    addQuad(p, {lo, lo, lo}, {0, 0, w}, {w, 0, 0}, levels);   // floor
    addQuad(p, {lo, top, lo}, {w, 0, 0}, {0, 0, w}, levels);  // ceiling
    addQuad(p, {lo, lo, lo}, {0, h, 0}, {0, 0, w}, levels);
    addQuad(p, {hi, lo, lo}, {0, 0, w}, {0, h, 0}, levels);
    addQuad(p, {lo, lo, lo}, {w, 0, 0}, {0, h, 0}, levels);
    addQuad(p, {lo, lo, hi}, {0, h, 0}, {w, 0, 0}, levels);
    addQuad(p, {0.2f, 0.3f, 0.15f}, {0.25f, 0.15f, 0}, {0, 0, 0.3f}, levels);  // sloping panel
    const int n = 3 << (levels - 1);
    for (int k = 0; k < 4; ++k) {
        const float x = 0.2f + 0.2f * static_cast<float>(k);
        addSurface(p, n / 4, n, [=](float s, float t) {
            const float angle = 2 * kPi * s;
            return vec3(x + 0.04f * cos(angle), lo + h * t, 0.6f + 0.04f * sin(angle));
        });
    }
    addSurface(p, n, n, [=](float s, float t) {  // curtain
        return vec3(0.6f + 0.3f * s, 0.1f + 0.35f * t, 0.3f + 0.03f * sin(30 * s));
    });
    return makeScene(p, levels);
}

SyntheticScene makeFibres(int levels, int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<Patch> p;
    for (int k = 0; k < count; ++k) {
        const vec3 a(randomIn(random, 0.1f, 0.9f), randomIn(random, 0.1f, 0.9f),
                     randomIn(random, 0.1f, 0.9f));
        const vec3 d = randomDirection(random) * 0.1f;
        addSurface(p, 1, 1 << (levels - 1), [&](float s, float t) {
            return a + d * t + vec3(0, 0.002f * s, 0.001f * sin(9 * t));
        });
    }
    return makeScene(p, levels);
}

SyntheticScene makeEmptyScene() { return makeScene({}, 0); }

View makeView(vec3 position, vec3 normal, std::uint32_t slot, bool omnidirectional) {
    View v{};
    v.positionX = position.x, v.positionY = position.y, v.positionZ = position.z;
    v.flags = omnidirectional ? kViewOmnidirectional : kViewHemisphere;
    if (!omnidirectional) v.normalX = normal.x, v.normalY = normal.y, v.normalZ = normal.z;
    v.bounce = omnidirectional ? 0 : 1;
    v.fluxR = v.fluxG = v.fluxB = 1;
    v.slot = slot;
    return v;
}

std::vector<View> viewsOnSurfaces(const SyntheticScene& scene, std::size_t count,
                                  std::uint32_t seed) {
    std::mt19937 random(seed);
    const float lift = 0.02f / static_cast<float>(1 << (scene.levels - 1));
    std::vector<View> views;
    while (views.size() < count && !scene.patches.empty()) {
        const Patch& p = scene.patches[random() % scene.patches.size()];
        const vec3 n = normalizeOr(cross3(p.du, p.dv), vec3(0, 1, 0));
        const vec3 at = p.center + p.du * randomIn(random, -1, 1) + p.dv * randomIn(random, -1, 1);
        views.push_back(makeView(at + n * lift, n, static_cast<std::uint32_t>(views.size())));
    }
    return views;
}

std::vector<View> particlesInside(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<View> views;
    for (std::size_t i = 0; i < count; ++i) {
        const vec3 at(randomIn(random, 0.05f, 0.95f), randomIn(random, 0.05f, 0.55f),
                      randomIn(random, 0.05f, 0.95f));
        views.push_back(makeView(at, vec3(0), static_cast<std::uint32_t>(i), true));
    }
    return views;
}

vec3 randomDirection(std::mt19937& random) {
    for (;;) {
        const vec3 d(randomIn(random, -1, 1), randomIn(random, -1, 1), randomIn(random, -1, 1));
        const float l = length3(d);
        if (l > 0.05f && l <= 1) return d / l;
    }
}

float randomIn(std::mt19937& random, float low, float high) {
    // Not std::uniform_real_distribution: its values differ between standard libraries.
    return low + (high - low) * (static_cast<float>(random() >> 8) * (1.0f / 16777216.0f));
}

std::vector<View> viewsOfAllKinds(const SyntheticScene& scene, std::size_t count,
                                  std::uint32_t seed) {
    std::vector<View> views = viewsOnSurfaces(scene, count, seed);
    for (View view : particlesInside(count / 4, seed)) {
        view.slot += static_cast<std::uint32_t>(count);
        views.push_back(view);
    }
    return views;
}

void moveViews(std::vector<View>& views, float far, std::mt19937& random) {
    for (View& view : views) {
        const vec3 way = randomDirection(random) * randomIn(random, 0, far);
        view.positionX = glm::clamp(view.positionX + way.x, 0.0f, 1.0f);
        view.positionY = glm::clamp(view.positionY + way.y, 0.0f, 1.0f);
        view.positionZ = glm::clamp(view.positionZ + way.z, 0.0f, 1.0f);
        if (view.flags == kViewOmnidirectional) continue;
        const vec3 turned = glm::normalize(vec3(view.normalX, view.normalY, view.normalZ) +
                                           randomDirection(random) * far);
        view.normalX = turned.x;
        view.normalY = turned.y;
        view.normalZ = turned.z;
    }
}

double rayBox(glm::dvec3 ray, glm::dvec3 center, glm::dvec3 half) {
    double lo = 0, hi = INFINITY;
    for (int a = 0; a < 3; ++a) {
        if (std::abs(ray[a]) < 1e-300) {
            if (std::abs(center[a]) > half[a]) return -1;
            continue;
        }
        double t0 = (center[a] - half[a]) / ray[a], t1 = (center[a] + half[a]) / ray[a];
        if (t0 > t1) std::swap(t0, t1);
        lo = std::max(lo, t0);
        hi = std::min(hi, t1);
    }
    return lo <= hi ? lo : -1;
}

std::vector<std::uint32_t> lastSubtree(const SyntheticScene& scene) {
    const uint children = scene.nodes[0].children;
    std::uint32_t first = firstChildOf(children) + childCountOf(children) - 1;
    std::vector<std::uint32_t> begin = {0};
    for (std::size_t level = 1; level + 1 < scene.levelBegin.size(); ++level) {
        begin.push_back(first);
        const std::uint32_t end = scene.levelBegin[level + 1];
        while (first < end && childCountOf(scene.nodes[first].children) == 0) ++first;
        if (first < end) first = firstChildOf(scene.nodes[first].children);
    }
    return begin;
}

void moveSubtree(const SyntheticScene& scene, const std::vector<std::uint32_t>& begin,
                 std::mt19937& random, SceneNodes& nodes) {
    const vec3 way = randomDirection(random) * 0.05f;
    for (std::size_t level = 0; level < begin.size(); ++level) {
        for (std::uint32_t i = begin[level]; i < scene.levelBegin[level + 1]; ++i) {
            SceneNode& node = nodes[i];
            node.centerX += way.x, node.centerY += way.y, node.centerZ += way.z;
            node.centroidX += way.x, node.centroidY += way.y, node.centroidZ += way.z;
            node.halfX *= randomIn(random, 0.9f, 1.1f);
        }
    }
}

}  // namespace mv::testing
