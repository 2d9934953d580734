#include "megaviews/scene/builtin_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>

namespace mv::builtin {
namespace {

double sineSmall(double a) {  // |a| <= pi/4
    double b = a * a;
    return a *
           (1 - b / 6 * (1 - b / 20 * (1 - b / 42 * (1 - b / 72 * (1 - b / 110 * (1 - b / 156))))));
}
double cosineSmall(double a) {
    double b = a * a;
    return 1 -
           b / 2 *
               (1 - b / 12 *
                        (1 - b / 30 * (1 - b / 56 * (1 - b / 90 * (1 - b / 132 * (1 - b / 182))))));
}

// The rotation that takes -z to `forward` and keeps y as far up as it can.
glm::dquat lookAlong(Vec forward) {
    Vec z = -unit(forward, {0, 0, -1});
    Vec up = z.y * z.y > 0.9999 ? Vec(0, 0, -1) : Vec(0, 1, 0);
    Vec x = unit(glm::cross(up, z));
    Vec y = glm::cross(z, x);
    double trace = x.x + y.y + z.z;
    glm::dquat q;
    if (trace > 0) {
        double s = 2 * std::sqrt(trace + 1);
        q = glm::dquat(s / 4, (y.z - z.y) / s, (z.x - x.z) / s, (x.y - y.x) / s);
    } else if (x.x > y.y && x.x > z.z) {
        double s = 2 * std::sqrt(1 + x.x - y.y - z.z);
        q = glm::dquat((y.z - z.y) / s, s / 4, (y.x + x.y) / s, (z.x + x.z) / s);
    } else if (y.y > z.z) {
        double s = 2 * std::sqrt(1 + y.y - x.x - z.z);
        q = glm::dquat((z.x - x.z) / s, (y.x + x.y) / s, s / 4, (z.y + y.z) / s);
    } else {
        double s = 2 * std::sqrt(1 + z.z - x.x - y.y);
        q = glm::dquat((x.y - y.x) / s, (z.x + x.z) / s, (z.y + y.z) / s, s / 4);
    }
    return q;
}

}  // namespace

double sinTurns(double turns) {
    double quarter = std::floor(4 * turns + 0.5);
    double a = (turns - quarter / 4) * 2 * std::numbers::pi;
    switch (static_cast<int>(quarter - 4 * std::floor(quarter / 4))) {
        case 0:
            return sineSmall(a);
        case 1:
            return cosineSmall(a);
        case 2:
            return -sineSmall(a);
        default:
            return -cosineSmall(a);
    }
}
double cosTurns(double turns) { return sinTurns(turns + 0.25); }

Vec unit(Vec v, Vec fallback) {
    double l = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return l > 1e-30 ? v / l : fallback;
}

glm::vec3 srgb(int r, int g, int b) {
    // The exponent 2.4 by square roots and products, x^2.4 = x^2 * x^0.4, with x^0.4 from Newton's
    // iteration on y^5 = x^2: std::pow is not the same everywhere.
    auto linear = [](int byte) {
        double s = byte / 255.0;
        if (s <= 0.04045) return static_cast<float>(s / 12.92);
        double x = (s + 0.055) / 1.055, y = 1;
        for (int i = 0; i < 60; ++i) y = (4 * y + x * x / (y * y * y * y)) / 5;
        return static_cast<float>(x * x * y);
    };
    return {linear(r), linear(g), linear(b)};
}

double Random::uniform(double low, double high) {
    state_ += 0x9E3779B97F4A7C15u;  // splitmix64
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    z ^= z >> 31;
    return low + (high - low) * (static_cast<double>(z >> 11) * 0x1p-53);
}

Vec Random::direction() {
    double y = uniform(-1, 1);
    double turns = uniform();
    double r = std::sqrt(std::max(0.0, 1 - y * y));
    return {r * cosTurns(turns), y, r * sinTurns(turns)};
}

Frame Frame::at(Vec origin, int quarterTurns) {
    Frame f{.origin = origin};
    for (int i = 0; i < (quarterTurns & 3); ++i) {
        Vec x = f.x;
        f.x = -f.z;
        f.z = x;
    }
    return f;
}

std::uint32_t MeshBuilder::addMaterial(const std::string& name, glm::vec3 color, bool doubleSided,
                                       glm::vec3 emission) {
    Material m;
    m.name = name;
    m.baseColor = glm::vec4(color, 1);
    m.doubleSided = doubleSided;
    m.emission = emission;
    scene_.materials.push_back(m);
    return static_cast<std::uint32_t>(scene_.materials.size() - 1);
}

std::uint32_t MeshBuilder::vertex(Vec p, Vec n) {
    world_.push_back(frame_.point(p));
    scene_.normals.push_back(glm::vec3(unit(frame_.vector(n))));
    scene_.colors.push_back(glm::vec4(tint_, 1));
    return static_cast<std::uint32_t>(world_.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    Vec n = glm::cross(world_[b] - world_[a], world_[c] - world_[a]);
    if (!(glm::dot(n, n) > 1e-22)) return;
    scene_.triangles.push_back({a, b, c});
    scene_.triangleMaterials.push_back(material_);
    if (node_ >= 0 || !nodes_.empty()) {
        nodes_.resize(scene_.triangles.size() - 1, -1);
        nodes_.push_back(node_);
    }
}

void MeshBuilder::quad(Vec a, Vec b, Vec c, Vec d) {
    Vec n = glm::cross(c - a, d - b);
    std::uint32_t i = vertex(a, n), j = vertex(b, n), k = vertex(c, n), l = vertex(d, n);
    triangle(i, j, k);
    triangle(i, k, l);
}

void MeshBuilder::flat(Vec a, Vec b, Vec c) {
    Vec n = glm::cross(b - a, c - a);
    std::uint32_t i = vertex(a, n), j = vertex(b, n), k = vertex(c, n);
    triangle(i, j, k);
}

void MeshBuilder::box(Vec a, Vec b, unsigned faces) {
    if (faces & 1) quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
    if (faces & 2) quad({b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z});
    if (faces & 4) quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
    if (faces & 8) quad({a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
    if (faces & 16) quad({b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z});
    if (faces & 32) quad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
}

void MeshBuilder::tile(Vec a, Vec b, double bevel) {
    Vec c(a.x + bevel, b.y, a.z + bevel), d(b.x - bevel, b.y, b.z - bevel);
    quad({c.x, c.y, d.z}, {d.x, c.y, d.z}, {d.x, c.y, c.z}, {c.x, c.y, c.z});
    quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {c.x, c.y, d.z}, {c.x, c.y, c.z});
    quad({b.x, a.y, b.z}, {b.x, a.y, a.z}, {d.x, c.y, c.z}, {d.x, c.y, d.z});
    quad({b.x, a.y, a.z}, {a.x, a.y, a.z}, {c.x, c.y, c.z}, {d.x, c.y, c.z});
    quad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {d.x, c.y, d.z}, {c.x, c.y, d.z});
}

void MeshBuilder::surface(int nu, int nv, bool closedU, bool closedV, const Point& point) {
    int cu = closedU ? nu : nu + 1, cv = closedV ? nv : nv + 1;
    auto at = [&](int i, int j) { return static_cast<std::size_t>((j % cv) * cu + i % cu); };
    std::size_t first = world_.size();
    for (int j = 0; j < cv; ++j)
        for (int i = 0; i < cu; ++i) vertex(point(i, j), {0, 1, 0});
    // Vertices of a row that has shrunk to a point share one normal through `slots_`.
    slots_.resize(world_.size() - first);
    for (std::size_t k = 0; k < slots_.size(); ++k) slots_[k] = static_cast<std::uint32_t>(k);
    for (int j = 0; j < cv; ++j) {
        bool point0 = true;
        for (int i = 1; i < cu && point0; ++i) {
            Vec d = world_[first + at(i, j)] - world_[first + at(0, j)];
            point0 = glm::dot(d, d) < 1e-20;
        }
        if (!point0) continue;
        for (int i = 1; i < cu; ++i) slots_[at(i, j)] = slots_[at(0, j)];
    }
    sums_.assign(slots_.size(), Vec(0));
    auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        Vec n = glm::cross(world_[first + b] - world_[first + a],
                           world_[first + c] - world_[first + a]);
        sums_[slots_[a]] += n;
        sums_[slots_[b]] += n;
        sums_[slots_[c]] += n;
        auto id = [&](std::size_t k) { return static_cast<std::uint32_t>(first) + slots_[k]; };
        triangle(id(a), id(b), id(c));
    };
    for (int j = 0; j < nv; ++j)
        for (int i = 0; i < nu; ++i) {
            std::size_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            add(a, b, c);
            add(a, c, d);
        }
    for (std::size_t k = 0; k < slots_.size(); ++k)
        scene_.normals[first + k] = glm::vec3(unit(sums_[slots_[k]]));
}

void MeshBuilder::lathe(const std::vector<glm::dvec2>& profile, int segments,
                        const Section& section) {
    auto same = [&](std::size_t i, std::size_t j) {
        glm::dvec2 d = profile[i] - profile[j];
        return glm::dot(d, d) < 1e-18;
    };
    for (std::size_t begin = 0; begin + 1 < profile.size();) {
        std::size_t end = begin + 1;
        while (end + 1 < profile.size() && !same(end, end + 1)) ++end;
        surface(segments, static_cast<int>(end - begin), true, false, [&](int i, int j) {
            glm::dvec2 p = profile[begin + static_cast<std::size_t>(j)];
            double turns = -static_cast<double>(i) / segments;
            double r = section ? section(p.x, p.y, turns) : p.x;
            return Vec(r * cosTurns(turns), p.y, r * sinTurns(turns));
        });
        begin = end + 1;
    }
}

void MeshBuilder::sweep(const std::vector<Vec>& path, Vec side,
                        const std::vector<glm::dvec2>& section) {
    assert(path.size() >= 2);
    std::vector<Vec> outs;
    for (std::size_t k = 0; k < path.size(); ++k) {
        Vec tangent = unit(path[std::min(k + 1, path.size() - 1)] - path[k > 0 ? k - 1 : 0]);
        outs.push_back(glm::cross(side, tangent));
    }
    sweep(path, outs, side, section);
}

void MeshBuilder::sweep(const std::vector<Vec>& path, const std::vector<Vec>& outs, Vec side,
                        const std::vector<glm::dvec2>& section) {
    assert(path.size() >= 2 && outs.size() == path.size());
    int n = static_cast<int>(path.size()) - 1;
    for (std::size_t e = 0; e < section.size(); ++e) {
        glm::dvec2 from = section[(e + 1) % section.size()], to = section[e];
        surface(1, n, false, false, [&](int i, int j) {
            auto k = static_cast<std::size_t>(j);
            glm::dvec2 s = i == 0 ? from : to;
            return path[k] + side * s.x + outs[k] * s.y;
        });
    }
}

// Primitives in the order in which node and material first occur.
RiggedScene MeshBuilder::takeRigged() {
    RiggedScene rigged;
    rigged.rig.nodes = scene_.nodes;
    rigged.rig.nodes.push_back({});  // what stands
    rigged.rig.animations = scene_.animations;
    rigged.rig.weightChannels.resize(scene_.animations.size());
    std::map<std::pair<int, std::uint32_t>, std::size_t> places;
    std::vector<std::vector<std::uint32_t>> slots;  // of each vertex in each primitive
    for (std::size_t t = 0; t < scene_.triangles.size(); ++t) {
        const std::uint32_t material = scene_.triangleMaterials[t];
        const auto [at, isNew] = places.try_emplace({nodes_[t], material}, places.size());
        if (isNew) {
            rigged.primitives.emplace_back().material = material;
            const std::size_t last = scene_.nodes.size();
            rigged.draws.push_back(
                {.primitive = at->second,
                 .node = nodes_[t] < 0 ? last : static_cast<std::size_t>(nodes_[t]),
                 .weights = {}});
            slots.emplace_back(world_.size(), UINT32_MAX);
        }
        Primitive& primitive = rigged.primitives[at->second];
        glm::uvec3& corners = primitive.triangles.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = scene_.triangles[t][k];
            std::uint32_t& slot = slots[at->second][vertex];
            if (slot == UINT32_MAX) {
                slot = static_cast<std::uint32_t>(primitive.positions.size());
                primitive.positions.push_back(world_[vertex]);
                primitive.normals.emplace_back(scene_.normals[vertex]);
                primitive.colors.push_back(scene_.colors[vertex]);
            }
            corners[k] = slot;
        }
    }
    scene_.normals.clear(), scene_.colors.clear();
    scene_.triangles.clear(), scene_.triangleMaterials.clear();
    return rigged;
}

void MeshBuilder::finish() {
    assert(!world_.empty());
    if (!nodes_.empty()) {
        nodes_.resize(scene_.triangles.size(), -1);
        scene_.contentHash = scene_.hash;
        assembleGeometry(takeRigged(), {.animation = 0, .timeS = 0},
                         scene_.animations.front().duration, std::nullopt, scene_, {});
        return;
    }
    Vec low = world_[0], high = world_[0];
    for (const Vec& p : world_) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    scene_.root = RootCube::around(low, high);
    scene_.positions.reserve(world_.size());
    for (const Vec& p : world_) scene_.positions.push_back(scene_.root.rootFromWorld(p));
    bool white = std::all_of(scene_.colors.begin(), scene_.colors.end(),
                             [](glm::vec4 c) { return c == glm::vec4(1); });
    if (white) scene_.colors.clear();
    world_.clear();
}

int addNode(Scene& scene, Vec from, Vec to) {
    Node node;
    node.translation = from;
    node.rotation = lookAlong(to - from);
    scene.nodes.push_back(node);
    return static_cast<int>(scene.nodes.size() - 1);
}

void addCamera(Scene& scene, const std::string& name, Vec from, Vec to, double yfovDeg) {
    Camera camera;
    camera.name = name;
    camera.node = addNode(scene, from, to);
    camera.yfovRad = yfovDeg * 2 * std::numbers::pi / 360;
    scene.cameras.push_back(camera);
}

int addMovingNode(Scene& scene, double durationS, const Path& path) {
    const auto [from, to] = path(0);
    const int node = addNode(scene, from, to);

    constexpr int kKeys = 96;
    AnimationChannel place, turn;
    place.node = turn.node = node;
    place.property = AnimatedProperty::translation;
    turn.property = AnimatedProperty::rotation;
    glm::dquat last = scene.nodes.back().rotation;
    for (int i = 0; i <= kKeys; ++i) {
        double turns = static_cast<double>(i) / kKeys;
        auto [p, target] = path(i == kKeys ? 0.0 : turns);
        glm::dquat q = lookAlong(target - p);
        if (glm::dot(q, last) < 0) q = -q;
        last = q;
        place.times.push_back(turns * durationS);
        place.values.push_back(glm::dvec4(p, 0));
        turn.times.push_back(turns * durationS);
        turn.values.push_back({q.x, q.y, q.z, q.w});
    }
    if (scene.animations.empty())
        scene.animations.push_back({.name = "light", .duration = 0, .channels = {}});
    Animation& animation = scene.animations.front();
    animation.duration = std::max(animation.duration, durationS);
    animation.channels.push_back(std::move(place));
    animation.channels.push_back(std::move(turn));
    return node;
}

void addMovingLight(Scene& scene, Light light, double durationS, const Path& path) {
    light.node = addMovingNode(scene, durationS, path);
    scene.lights.push_back(light);
    // A point light looks nowhere.
    if (light.type == LightType::point) scene.animations.front().channels.pop_back();
}

}  // namespace mv::builtin
