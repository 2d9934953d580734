#include "megaviews/scene/framing_probe.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

namespace mv::framing {
namespace {

constexpr float kFar = 4;     // no ray within the root cube is longer
constexpr int kColumns = 28;  // places tried along x and z
constexpr int kStoreys = 12;  // surfaces followed downwards in one column
constexpr float kEnclosed = 0.8f, kInSolid = 0.35f;

struct Seen {
    float t;
    bool back;
};
std::optional<Seen> look(const TriangleBvh& bvh, glm::vec3 from, glm::vec3 direction) {
    auto hit = bvh.intersect(from, direction, 1e-6f, kFar);
    if (!hit) return std::nullopt;
    return Seen{hit->t, bvh.isBack(*hit, direction)};
}

// At a position on a triangle.
SurfacePoint frontOf(const Scene& scene, std::uint32_t triangle, glm::vec3 position) {
    const glm::uvec3 corner = scene.triangles[triangle];
    const glm::vec3 a = scene.positions[corner.x];
    const glm::vec3 n = normalizeOr(
        cross3(scene.positions[corner.y] - a, scene.positions[corner.z] - a), glm::vec3(0, 1, 0));
    return {position + n * kOff, n, triangle};
}

// Share of directions from the front of a surface that escape.
float openness(const TriangleBvh& bvh, const SurfacePoint& front) {
    static const std::vector<glm::vec3> directions = sphereDirections(32);
    int up = 0, free = 0;
    for (glm::vec3 d : directions) {
        if (dot3(d, front.normal) <= 0.1f) continue;
        ++up;
        if (!bvh.occluded(front.position, d, 0, kFar)) ++free;
    }
    return up ? static_cast<float>(free) / static_cast<float>(up) : 0;
}

// Of points spread evenly by area on the fronts of surfaces.
float opennessOf(const TriangleBvh& bvh) {
    const std::vector<SurfacePoint> samples = surfaceSamples(bvh, 768);
    if (samples.empty()) return 1;
    std::vector<float> escaped(samples.size());
    tbb::parallel_for(std::size_t{0}, samples.size(),
                      [&](std::size_t s) { escaped[s] = openness(bvh, samples[s]); });
    return std::accumulate(escaped.begin(), escaped.end(), 0.0f) /
           static_cast<float>(samples.size());
}

// Of the fronts that are in sight all around, also those of surfaces whose backs are; what is in
// sight beyond all surfaces is open.
float opennessAround(const TriangleBvh& bvh, glm::vec3 position) {
    static const std::vector<glm::vec3> directions = sphereDirections(64);
    float sum = 0;
    for (glm::vec3 d : directions) {
        const auto hit = bvh.intersect(position, d, 1e-6f, kFar);
        sum += hit ? openness(bvh, frontOf(*bvh.scene, hit->triangle, position + d * hit->t)) : 1;
    }
    return sum / static_cast<float>(directions.size());
}

// Whether what lies below is wide and level enough to stand on: no ledge, cloth or lamp.
bool isFloor(const TriangleBvh& bvh, const FreePoint& point, float eyeHeight) {
    constexpr int kAround = 6;
    int level = 0;
    for (int i = 0; i < kAround; ++i) {
        float a = 2 * kPi * static_cast<float>(i) / kAround;
        glm::vec3 p = point.position + 0.35f * eyeHeight * glm::vec3(std::cos(a), 0, std::sin(a));
        auto below = look(bvh, p, {0, -1, 0});
        level += below && std::abs(p.y - below->t - point.floor) < 0.12f * eyeHeight;
    }
    return level >= kAround - 1;
}

// What is open to the outside is no interior: the less so, the smaller its rooms are beside the
// whole, for machines and cars are hollow, too; and least what nobody could stand in, unless it is
// a flat without a roof. Chosen on 30 rooms and buildings and 7 hollow things.
float mostOpenOfInteriors(const Surroundings& s) {
    constexpr float kOpen = 0.4f, kClosed = 0.22f, kBesideRooms = 4, kSky = 0.5f;
    float roominess = 0;
    std::size_t roofless = 0;
    for (const FreePoint& place : s.standing) {
        roominess += place.roominess;
        roofless += place.sky > kSky;
    }
    if (!s.fitsPeople && 2 * roofless < s.standing.size()) return kClosed;
    roominess /= static_cast<float>(std::max<std::size_t>(s.standing.size(), 1));
    return std::min(kOpen, kBesideRooms * roominess);
}

}  // namespace

std::vector<glm::vec3> sphereDirections(int n) {
    std::vector<glm::vec3> out;
    for (int i = 0; i < n; ++i) {
        float y = 1 - (2 * static_cast<float>(i) + 1) / static_cast<float>(n);
        float r = std::sqrt(std::max(0.0f, 1 - y * y));
        float phi = 2.39996323f * static_cast<float>(i);  // the golden angle
        out.emplace_back(r * std::cos(phi), y, r * std::sin(phi));
    }
    return out;
}

double areaOf(const Scene& scene, std::uint32_t triangle) {
    const glm::uvec3 c = scene.triangles[triangle];
    return 0.5 * static_cast<double>(length3(cross3(scene.positions[c.y] - scene.positions[c.x],
                                                    scene.positions[c.z] - scene.positions[c.x])));
}

std::vector<SurfacePoint> surfaceSamples(
    const TriangleBvh& bvh, int count,
    const std::function<double(std::uint32_t triangle)>& weightOf) {
    const Scene& scene = *bvh.scene;
    std::vector<double> cumulative(scene.triangles.size());
    double area = 0;
    for (std::uint32_t i = 0; i < cumulative.size(); ++i) {
        area += areaOf(scene, i) * (weightOf ? weightOf(i) : 1);
        cumulative[i] = area;
    }
    std::vector<SurfacePoint> out;
    for (int s = 0; area > 0 && s < count; ++s) {
        double at = area * (s + 0.5) / count;
        auto it = std::lower_bound(cumulative.begin(), cumulative.end() - 1, at);
        const auto triangle = static_cast<std::uint32_t>(it - cumulative.begin());
        glm::uvec3 corner = scene.triangles[triangle];
        glm::vec3 a = scene.positions[corner.x], b = scene.positions[corner.y],
                  c = scene.positions[corner.z];
        // Anywhere on the triangle, by the golden ratio in two directions.
        float u = 0.6180340f * static_cast<float>(s), v = 0.7548777f * static_cast<float>(s);
        u -= std::floor(u);
        v -= std::floor(v);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        out.push_back(frontOf(scene, triangle, a + (b - a) * u + (c - a) * v));
    }
    return out;
}

bool clear(const TriangleBvh& bvh, glm::vec3 a, glm::vec3 b) {
    return !bvh.occluded(a, b - a, 1e-4f, 1 - 1e-4f);
}

FreePoint probe(const TriangleBvh& bvh, glm::vec3 position) {
    static const std::vector<glm::vec3> directions = sphereDirections(64);
    FreePoint point{.position = position};
    point.clearance = kFar;
    int hits = 0, backs = 0, level = 0, levelHits = 0, up = 0, open = 0;
    float sum = 0;
    for (glm::vec3 d : directions) {
        auto seen = look(bvh, position, d);
        bool isLevel = std::abs(d.y) < 0.35f;
        level += isLevel;
        up += d.y > 0.35f;
        if (!seen) {
            open += d.y > 0.35f;
            sum += 0.5f;
            continue;
        }
        ++hits;
        levelHits += isLevel;
        backs += seen->back;
        sum += seen->t;
        point.clearance = std::min(point.clearance, seen->t);
    }
    point.roominess = sum / static_cast<float>(directions.size());
    point.enclosure = static_cast<float>(levelHits) / static_cast<float>(std::max(level, 1));
    point.sky = static_cast<float>(open) / static_cast<float>(std::max(up, 1));
    point.inside = hits ? static_cast<float>(backs) / static_cast<float>(hits) : 0;
    auto below = look(bvh, position, {0, -1, 0});
    auto above = look(bvh, position, {0, 1, 0});
    if (below) point.clearance = std::min(point.clearance, below->t);
    if (above) point.clearance = std::min(point.clearance, above->t);
    point.floor = below ? position.y - below->t : -kFar;
    point.ceiling = above ? position.y + above->t : kFar;
    return point;
}

bool isEnclosed(const FreePoint& point) {
    return point.enclosure >= kEnclosed && point.inside < kInSolid;
}

bool isRoofed(const FreePoint& point) {
    constexpr float kRoofless = 0.5f;
    return point.sky < kRoofless;
}

bool isInRoom(const FreePoint& point) { return isEnclosed(point) && isRoofed(point); }

namespace {

// See Surroundings::low.
Box boundsOf(const TriangleBvh& bvh) {
    constexpr int kSamples = 600;
    constexpr float kDwarfs = 4;
    const Scene& scene = *bvh.scene;
    const auto boundsWhere = [&](const auto& counts) {
        Box box;
        for (const glm::uvec3& triangle : scene.triangles)
            for (int k = 0; k < 3; ++k) {
                const glm::vec3 p = scene.positions[triangle[k]];
                if (counts(p)) box.add(p);
            }
        return box;
    };
    const Box whole = boundsWhere([](glm::vec3) { return true; });
    const std::vector<SurfacePoint> samples = surfaceSamples(bvh, kSamples);
    if (samples.empty()) return whole;
    const std::size_t beyond = samples.size() / 100;  // a hundredth at each side may be astray
    Box near;
    std::vector<float> along(samples.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::transform(samples.begin(), samples.end(), along.begin(),
                       [&](const SurfacePoint& s) { return s.position[axis]; });
        std::sort(along.begin(), along.end());
        near.low[axis] = along[beyond];
        near.high[axis] = along[along.size() - 1 - beyond];
    }
    const glm::vec3 reach(near.diagonal());
    near = {near.low - reach, near.high + reach};
    const Box main = boundsWhere([&](glm::vec3 p) { return near.contains(p); });
    return whole.diagonal() > kDwarfs * main.diagonal() ? main : whole;
}

}  // namespace

Surroundings survey(const TriangleBvh& bvh) {
    Surroundings s;
    const Scene& scene = *bvh.scene;
    const Box bounds = boundsOf(bvh);
    s.low = bounds.low;
    s.high = bounds.high;
    glm::vec3 size = s.high - s.low;
    // A file in metres if it is as high as a building; otherwise a person is a share of it.
    double metres = static_cast<double>(size.y) * scene.root.edge;
    s.fitsPeople = metres > 1.9 && metres < 120;
    s.eyeHeight = s.fitsPeople ? static_cast<float>(1.7 / scene.root.edge) : 0.4f * size.y;
    s.eyeHeight = std::min(s.eyeHeight, 0.6f * size.y);

    // Columns: every gap between surfaces that a person fits into is a place.
    constexpr std::size_t kCount = std::size_t{kColumns} * kColumns;
    std::vector<std::vector<FreePoint>> found(kCount);
    tbb::parallel_for(std::size_t{0}, kCount, [&](std::size_t c) {
        float u = (static_cast<float>(c % kColumns) + 0.5f) / kColumns;
        float v = (static_cast<float>(c / kColumns) + 0.5f) / kColumns;
        glm::vec3 p(s.low.x + u * size.x, s.high.y + 0.01f, s.low.z + v * size.z);
        float ceiling = p.y;
        for (int k = 0; k < kStoreys; ++k) {
            auto seen = look(bvh, p, {0, -1, 0});
            if (!seen) break;
            float floor = p.y - seen->t;
            if (ceiling - floor > 1.15f * s.eyeHeight) {
                FreePoint point = probe(bvh, {p.x, floor + s.eyeHeight, p.z});
                point.ceiling = std::min(point.ceiling, s.high.y);
                if (isEnclosed(point) && point.clearance > 0.12f * s.eyeHeight &&
                    isFloor(bvh, point, s.eyeHeight))
                    found[c].push_back(point);
            }
            ceiling = floor;
            p.y = floor - 1e-4f;
        }
    });
    std::size_t columns = 0;
    for (const std::vector<FreePoint>& f : found) {
        columns += !f.empty();
        s.standing.insert(s.standing.end(), f.begin(), f.end());
    }
    s.enclosedShare = static_cast<float>(columns) / static_cast<float>(kCount);
    s.openness = opennessOf(bvh);
    s.interior = s.hasRooms() && s.openness < mostOpenOfInteriors(s);
    return s;
}

// About half of a building's surface is the outside of its walls, or more where there is a terrace
// or a yard, so what counts is what is seen from within. A room has to be large beside the whole,
// also by where one can stand in it: a machine has its hollows, too. And what has no opening at all
// is a block or a box. Chosen on 8 rooms and 14 other things that have closed places.
bool hasRoomWithWindows(const TriangleBvh& bvh, Surroundings& s) {
    constexpr float kClosed = 0.2f, kSealed = 1e-3f, kBesideWhole = 0.16f, kOfColumns = 0.05f;
    if (!s.fitsPeople || !s.hasRooms()) return false;
    const glm::vec3 size = s.high - s.low;
    const float roomy = kBesideWhole * std::max({size.x, size.y, size.z});
    std::vector<FreePoint> places;
    std::copy_if(s.standing.begin(), s.standing.end(), std::back_inserter(places),
                 [&](const FreePoint& place) { return place.roominess >= roomy; });
    std::vector<float> open(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(),
                      [&](std::size_t i) { open[i] = opennessAround(bvh, places[i].position); });
    std::vector<FreePoint> closed;
    float sum = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (open[i] >= kClosed) continue;
        closed.push_back(places[i]);
        sum += open[i];
    }
    const auto count = static_cast<float>(closed.size());
    if (count < kOfColumns * kColumns * kColumns || sum <= kSealed * count) return false;
    s.standing = std::move(closed);
    return true;
}

namespace {

struct Sight {
    glm::vec3 from, direction;
};
std::vector<SurfacePoint> surfacesAlong(const TriangleBvh& bvh, const std::vector<Sight>& sights) {
    std::vector<std::optional<SurfacePoint>> seen(sights.size());
    tbb::parallel_for(std::size_t{0}, seen.size(), [&](std::size_t i) {
        auto hit = bvh.intersect(sights[i].from, sights[i].direction, 1e-6f, kFar);
        if (!hit) return;
        BvhSurface f = bvh.surface(*hit);
        glm::vec3 n(f.geometricX, f.geometricY, f.geometricZ);
        if (dot3(n, sights[i].direction) > 0) n = -n;
        glm::vec3 p(f.positionX, f.positionY, f.positionZ);
        seen[i] = SurfacePoint{p + n * kOff, n, hit->triangle};
    });
    std::vector<SurfacePoint> out;
    for (const auto& s : seen)
        if (s) out.push_back(*s);
    return out;
}

}  // namespace

std::vector<SurfacePoint> visibleSurfaces(const TriangleBvh& bvh,
                                          const std::vector<glm::vec3>& points, int directions) {
    std::vector<Sight> sights;
    for (glm::vec3 p : points)
        for (glm::vec3 d : sphereDirections(directions)) sights.push_back({p, d});
    return surfacesAlong(bvh, sights);
}

std::vector<SurfacePoint> surfacesInView(const TriangleBvh& bvh, const Viewer& v) {
    constexpr int kX = 40, kY = 22;
    constexpr float kTan = 0.52f;
    glm::vec3 right = cross3(v.forward, v.up);
    std::vector<Sight> sights;
    for (int j = 0; j < kY; ++j)
        for (int i = 0; i < kX; ++i) {
            float x = (2 * (static_cast<float>(i) + 0.5f) / kX - 1) * kTan * 16 / 9;
            float y = (2 * (static_cast<float>(j) + 0.5f) / kY - 1) * kTan;
            sights.push_back(
                {v.position, normalizeOr(v.forward + right * x + v.up * y, v.forward)});
        }
    return surfacesAlong(bvh, sights);
}

}  // namespace mv::framing
