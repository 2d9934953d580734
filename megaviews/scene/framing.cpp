#include "megaviews/scene/framing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/framing_light.h"
#include "megaviews/scene/framing_probe.h"
#include "megaviews/scene/rigged_scene.h"

namespace mv {
namespace {

using framing::Box;
using framing::FreePoint;
using framing::SurfacePoint;
using framing::Surroundings;
using framing::Viewer;

constexpr double kFovDeg = 55;  // vertical, interiors
constexpr double kObjectFovDeg = 38;
constexpr float kAspect = 1.45f;  // objects fit windows at least this wide
constexpr float kAbove = 0.36f;   // how steeply objects are looked down upon, a tangent
constexpr float kInto = 1.2f;     // how steeply into rooms that lack a roof

// What a picture from outside shows: the corners that have to fit, and places on the surface that
// should be seen.
struct Subject {
    std::vector<glm::vec3> corners;
    std::vector<SurfacePoint> surface;
    std::vector<SurfacePoint> lit;  // of those, what the file's own lights reach; none: no matter
    glm::vec3 front{0};             // where a backdrop faces; 0: there is none
};
constexpr int kSurfacePoints = 600;
constexpr float kFarthestWay = 12;  // that a picture follows, in diagonals of what it begins with
Subject everything(const TriangleBvh& bvh, const Surroundings& s) {
    Subject all;
    const Scene& scene = *bvh.scene;
    const Box standing{s.low, s.high};
    for (const glm::uvec3& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k) {
            const glm::vec3 p = scene.positions[triangle[k]];
            if (standing.contains(p)) all.corners.push_back(p);
        }
    // Wherever it will move, unless it flies away: fragments of an explosion.
    const bool follows = scene.moving && length3(scene.moving->max - scene.moving->min) <
                                             kFarthestWay * standing.diagonal();
    for (unsigned k = 0; follows && k < 8; ++k) {
        const glm::bvec3 high((k & 1) != 0, (k & 2) != 0, (k & 4) != 0);
        all.corners.push_back(glm::mix(scene.moving->min, scene.moving->max, high));
    }
    all.surface = framing::surfaceSamples(bvh, kSurfacePoints);
    all.lit = framing::litSurfaces(bvh, all.surface);
    return all;
}

// Where a wall at the end of the scene faces, all else being in front of it; 0: it is none.
glm::vec3 backdropNormal(const Scene& scene, std::uint32_t triangle, float behind) {
    const glm::uvec3 c = scene.triangles[triangle];
    const glm::vec3 a = scene.positions[c.x];
    const glm::vec3 n =
        normalizeOr(cross3(scene.positions[c.y] - a, scene.positions[c.z] - a), glm::vec3(0));
    const bool first = std::all_of(scene.positions.begin(), scene.positions.end(),
                                   [&](glm::vec3 p) { return dot3(p - a, n) >= -behind; });
    return first ? n : glm::vec3(0);
}

// What stands on a ground that dwarfs it, with some of the ground around: the triangles that are
// small beside the scene, if all of them together are, too, and nothing large but a backdrop
// reaches above them.
std::optional<Subject> whatStandsOnTheGround(const TriangleBvh& bvh) {
    constexpr float kSmallTriangle = 0.2f, kDwarfed = 0.35f, kAround = 1.35f, kBehind = 0.01f;
    const Scene& scene = *bvh.scene;
    std::vector<Box> boxes;
    Box whole;
    for (const glm::uvec3& triangle : scene.triangles) {
        Box box;
        for (int k = 0; k < 3; ++k) box.add(scene.positions[triangle[k]]);
        boxes.push_back(box);
        whole.add(box.low), whole.add(box.high);
    }
    const auto isSmall = [&](std::uint32_t triangle) {
        return boxes[triangle].diagonal() < kSmallTriangle * whole.diagonal();
    };
    Box small;
    Subject subject;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (!isSmall(i)) continue;
        small.add(boxes[i].low), small.add(boxes[i].high);
        for (int k = 0; k < 3; ++k)
            subject.corners.push_back(scene.positions[scene.triangles[i][k]]);
    }
    const glm::vec3 middle = (small.low + small.high) * 0.5f;
    if (subject.corners.empty() || small.diagonal() > kDwarfed * whole.diagonal()) return {};
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (isSmall(i) || boxes[i].high.y <= middle.y) continue;
        const glm::vec3 normal = backdropNormal(scene, i, kBehind * whole.diagonal());
        if (normal == glm::vec3(0)) return {};
        subject.front += normal * static_cast<float>(framing::areaOf(scene, i));
    }
    subject.front = normalizeOr(subject.front, glm::vec3(0));
    for (glm::vec3& p : subject.corners) p = middle + kAround * (p - middle);
    subject.surface = framing::surfaceSamples(
        bvh, kSurfacePoints, [&](std::uint32_t triangle) { return isSmall(triangle) ? 1 : 0; });
    subject.lit = framing::litSurfaces(bvh, subject.surface);
    return subject;
}

// From outside: from `azimuth` (0 = +z, towards +x) and `above`, as close as the subject fits.
Viewer outsideView(const std::vector<glm::vec3>& corners, float azimuth, float above) {
    Viewer v;
    v.forward = normalizeOr(glm::vec3(-std::sin(azimuth), -above, -std::cos(azimuth)), {0, 0, -1});
    glm::vec3 right = normalizeOr(cross3(v.forward, {0, 1, 0}), {1, 0, 0});
    v.up = cross3(right, v.forward);
    v.position = glm::vec3(0.5f) - 2.0f * v.forward;
    if (corners.empty()) return v;
    // The camera that touches the geometry with all four sides of its pyramid: each side gives a
    // half-space for the apex; the vertical and the horizontal pair each fix a depth.
    float ty = 0.88f * static_cast<float>(std::tan(kObjectFovDeg * 3.14159265358979 / 360));
    float tx = ty * kAspect;
    float r = -kInfinity, l = -kInfinity, t = -kInfinity, b = -kInfinity, nearest = kInfinity;
    Box bounds;
    for (const glm::vec3& p : corners) {
        bounds.add(p);
        float x = dot3(p, right), y = dot3(p, v.up), z = dot3(p, v.forward);
        r = std::max(r, x - tx * z);
        l = std::max(l, -x - tx * z);
        t = std::max(t, y - ty * z);
        b = std::max(b, -y - ty * z);
        nearest = std::min(nearest, z);
    }
    float z = std::min(-(r + l) / (2 * tx), -(t + b) / (2 * ty));
    z = std::min(z, nearest - 0.02f * std::min(1.0f, bounds.diagonal()));
    v.position = right * ((r - l) / 2) + v.up * ((t - b) / 2) + v.forward * z;
    return v;
}

// How good a picture an interior view makes: far sights of varied depth, little sky, nothing in
// the way, no backs of surfaces. Around -1 .. 1.
float viewScore(const TriangleBvh& bvh, const Viewer& v, float scale) {
    constexpr int kX = 20, kY = 12;
    glm::vec3 right = cross3(v.forward, v.up);
    auto t = static_cast<float>(std::tan(kFovDeg * 3.14159265358979 / 360));
    float logs = 0, squares = 0, near = 0, sky = 0, back = 0;
    int hits = 0;
    for (int j = 0; j < kY; ++j)
        for (int i = 0; i < kX; ++i) {
            float x = (2 * (static_cast<float>(i) + 0.5f) / kX - 1) * t * 16 / 9;
            float y = (2 * (static_cast<float>(j) + 0.5f) / kY - 1) * t;
            glm::vec3 d = normalizeOr(v.forward + right * x + v.up * y, v.forward);
            auto hit = bvh.intersect(v.position, d, 1e-6f, 4);
            if (!hit) {
                ++sky;
                continue;
            }
            ++hits;
            if (bvh.isBack(*hit, d)) ++back;
            near += std::clamp(1.25f - 5 * hit->t / scale, 0.0f, 1.0f);
            float depth = std::log(std::max(hit->t / scale, 1e-3f));
            logs += depth;
            squares += depth * depth;
        }
    if (hits == 0) return -10;
    constexpr float kRays = kX * kY;
    float mean = logs / static_cast<float>(hits);
    float spread = std::sqrt(std::max(0.0f, squares / static_cast<float>(hits) - mean * mean));
    return 0.6f * mean + 0.3f * spread - 3 * near / kRays - 1.5f * sky / kRays - 3 * back / kRays;
}

// The roomiest places, low ones first among equals: a nave rather than its galleries.
std::vector<FreePoint> roomiestPlaces(const Surroundings& s) {
    constexpr std::size_t kPlaces = 40;
    std::vector<FreePoint> places = s.standing;
    auto worth = [&](const FreePoint& f) {
        return f.roominess * (1 - 0.3f * (f.floor - s.low.y) / (s.high.y - s.low.y));
    };
    std::stable_sort(places.begin(), places.end(),
                     [&](const FreePoint& a, const FreePoint& b) { return worth(a) > worth(b); });
    places.resize(std::min(places.size(), kPlaces));
    return places;
}

// At eye height in the roomiest place, from one end of its longest free line along it.
Viewer insideView(const TriangleBvh& bvh, const Surroundings& s) {
    constexpr float kOutOfRoom = 2;
    const std::vector<FreePoint> places = roomiestPlaces(s);
    float roomiest = places.front().roominess;
    struct View : Viewer {
        bool roofed = false;  // the place that it is to show
    };
    std::vector<View> views;
    for (const FreePoint& f : places) {
        // The free line through this place that is longest, backwards and forwards together.
        constexpr int kLines = 24;
        glm::vec3 axis(1, 0, 0);
        float best = -1, ahead = 0, behind = 0;
        for (int k = 0; k < kLines; ++k) {
            float a = kPi * static_cast<float>(k) / kLines;
            glm::vec3 d(std::cos(a), 0, std::sin(a));
            auto length = [&](glm::vec3 along) {
                auto hit = bvh.intersect(f.position, along, 1e-6f, 2);
                return hit ? hit->t : 0.0f;  // out of the building: not a wall to stand at
            };
            float fore = length(d), aft = length(-d);
            if (fore + aft > best) best = fore + aft, axis = d, ahead = fore, behind = aft;
        }
        for (float sign : {1.0f, -1.0f}) {
            float back = sign > 0 ? behind : ahead;
            for (float inset : {0.82f, 0.6f}) {
                glm::vec3 p = f.position - sign * axis * (inset * back);
                for (float yaw : {-0.14f, 0.14f})
                    for (float pitch : {0.0f, 0.09f, 0.17f}) {
                        View v;
                        v.position = p;
                        v.roofed = framing::isRoofed(f);
                        float c = std::cos(yaw), n = std::sin(yaw);
                        glm::vec3 d = sign * axis;
                        d = {c * d.x + n * d.z, 0, -n * d.x + c * d.z};
                        v.forward = normalizeOr(d + glm::vec3(0, std::tan(pitch), 0), d);
                        v.up = normalizeOr(glm::vec3(0, 1, 0) - v.forward * v.forward.y, {0, 1, 0});
                        views.push_back(v);
                    }
            }
        }
    }
    std::vector<float> scores(views.size());
    tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t i) {
        FreePoint f = framing::probe(bvh, views[i].position);
        scores[i] = viewScore(bvh, views[i], 2 * roomiest) -
                    0.4f * (views[i].position.y - s.low.y) / (s.high.y - s.low.y) +
                    std::min(0.0f, 2 * (f.clearance / s.eyeHeight - 0.5f)) -
                    (views[i].roofed && !framing::isRoofed(f) ? kOutOfRoom : 0);
    });
    auto best = std::max_element(scores.begin(), scores.end());
    return views[static_cast<std::size_t>(best - scores.begin())];
}

// Share of the points that one viewer of several sees; of surfaces with two sides, from either.
float seenShare(const TriangleBvh& bvh, const std::vector<SurfacePoint>& surface,
                const std::vector<glm::vec3>& viewers) {
    const auto isSeen = [&](const SurfacePoint& point, glm::vec3 viewer) {
        const auto material = bvh.scene->triangleMaterials[point.triangle];
        glm::vec3 p = point.position;
        const bool behind = dot3(viewer - p, point.normal) <= 0;
        if (behind && !bvh.scene->materials[material].doubleSided) return false;
        if (behind) p -= 2 * framing::kOff * point.normal;
        return framing::clear(bvh, p, viewer);
    };
    const auto seen = std::count_if(surface.begin(), surface.end(), [&](const SurfacePoint& p) {
        return std::any_of(viewers.begin(), viewers.end(),
                           [&](glm::vec3 viewer) { return isSeen(p, viewer); });
    });
    return static_cast<float>(seen) / static_cast<float>(std::max<std::size_t>(surface.size(), 1));
}

struct OutsideView {
    Viewer viewer;
    float seen = 0;  // share of the subject's surface
};
// The three-quarter view, of four, that shows most of the surface, and of what is lit of it, before
// the backdrop if there is one; glTF's front (+z) is preferred unless it hides a lot.
OutsideView threeQuarterView(const TriangleBvh& bvh, const Subject& subject, float above = kAbove) {
    constexpr float kLitWorth = 0.5f, kBackdropWorth = 0.5f;
    OutsideView best;
    float most = -1;
    for (float azimuth : {0.53f, -0.53f, kPi - 0.53f, kPi + 0.53f}) {
        const Viewer v = outsideView(subject.corners, azimuth, above);
        const float seen = seenShare(bvh, subject.surface, {v.position});
        const float preferred = azimuth == 0.53f ? 0.12f : std::abs(azimuth) < 1 ? 0.06f : 0.0f;
        const float lit = seenShare(bvh, subject.lit, {v.position});
        const float before = -dot3(v.forward, subject.front);
        const float worth = seen + preferred + kLitWorth * lit + kBackdropWorth * before;
        if (worth > most) most = worth, best = {v, seen};
    }
    return best;
}

struct Place {
    Viewer viewer;
    double fovDeg = 0;
    std::string where;    // "one was placed ..."
    bool outside = true;  // and the light is placed as for objects
};

Place objectPlace(const TriangleBvh& bvh, const Surroundings& s) {
    constexpr float kSeenEnough = 0.15f;  // no wall stands before it
    if (const std::optional<Subject> subject = whatStandsOnTheGround(bvh)) {
        const OutsideView view = threeQuarterView(bvh, *subject);
        if (view.seen >= kSeenEnough) {
            return {view.viewer, kObjectFovDeg, "near what stands on the ground"};
        }
    }
    return {threeQuarterView(bvh, everything(bvh, s)).viewer, kObjectFovDeg, "to show everything"};
}

// Before a room that lacks a wall, a stage or a box: level, from the side that shows most of it, if
// that is nearly all that can be seen of it.
std::optional<Place> stagePlace(const TriangleBvh& bvh, const Surroundings& s) {
    constexpr float kOpenSide = 0.6f;
    const Subject all = everything(bvh, s);
    OutsideView best;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Viewer v = outsideView(all.corners, 0.5f * kPi * static_cast<float>(quarter), 0);
        const float seen = seenShare(bvh, all.surface, {v.position});
        if (seen > best.seen) best = {v, seen};
    }
    if (best.seen < kOpenSide) return {};
    return Place{best.viewer, kObjectFovDeg, "before the open side of the room", false};
}

// Over rooms of one storey that lack a roof, the model of a flat: from above, where that shows a
// good part of them.
std::optional<Place> flatPlace(const TriangleBvh& bvh, const Surroundings& s) {
    constexpr float kStorey = 2.6f;  // times the eyes' height; a courtyard's walls are higher
    constexpr float kOpenAbove = 0.5f, kRoofless = 0.5f, kSeenEnough = 0.2f;
    if (s.high.y - s.low.y > kStorey * s.eyeHeight) return {};
    const auto open = std::count_if(s.standing.begin(), s.standing.end(),
                                    [](const FreePoint& f) { return f.sky > kOpenAbove; });
    if (static_cast<float>(open) < kRoofless * static_cast<float>(s.standing.size())) return {};
    const OutsideView view = threeQuarterView(bvh, everything(bvh, s), kInto);
    if (view.seen < kSeenEnough) return {};
    return Place{view.viewer, kObjectFovDeg, "above rooms that lack a roof"};
}

// A tower or a temple: from around it far more of it is seen than from the best places within.
bool isForLookingAt(const TriangleBvh& bvh, const Surroundings& s) {
    constexpr float kFarMore = 2, kAway = 1.5f;
    constexpr int kAround = 8;
    std::vector<glm::vec3> within, around;
    for (const FreePoint& place : roomiestPlaces(s)) within.push_back(place.position);
    for (int i = 0; i < kAround; ++i) {
        const float azimuth = 2 * kPi * static_cast<float>(i) / kAround;
        around.push_back(glm::vec3(0.5f) +
                         kAway * glm::vec3(std::sin(azimuth), kAbove, std::cos(azimuth)));
    }
    const std::vector<SurfacePoint> surface = framing::surfaceSamples(bvh, kSurfacePoints);
    return seenShare(bvh, surface, around) > kFarMore * seenShare(bvh, surface, within);
}

// Of a scene that is not the inside of a closed building.
std::optional<Place> openPlace(const TriangleBvh& bvh, const Surroundings& s) {
    if (!s.interior || s.standing.empty()) return objectPlace(bvh, s);
    if (const std::optional<Place> stage = stagePlace(bvh, s)) return *stage;
    if (!s.litWithin && isForLookingAt(bvh, s)) return objectPlace(bvh, s);
    return flatPlace(bvh, s);
}

bool emits(const Scene& scene) {
    for (std::uint32_t m : scene.triangleMaterials)
        if (scene.materials[m].emits()) return true;
    return false;
}

}  // namespace

void placeDefaults(Scene& scene, const TriangleBvh& bvh) {
    bool needsCamera = scene.cameras.empty();
    if (!needsCamera && !scene.lights.empty()) return;

    Surroundings s;
    if (!scene.triangles.empty()) s = framing::survey(bvh);
    const bool glows = emits(scene);
    Viewer viewer;
    bool standsInRoom = false;  // the file's own viewer
    if (needsCamera) {
        s.litWithin = framing::isLitWithin(bvh, s);
        if (!s.litWithin && !s.interior) {
            s.interior = framing::hasRoomWithWindows(bvh, s) && framing::lightReaches(bvh, s);
        }
    } else {
        PosedCamera camera = scene.camerasAt(0, scene.defaultAnimation()).front();
        viewer.position = scene.root.rootFromWorld(camera.position);
        viewer.forward = glm::vec3(camera.forward);
        viewer.up = glm::vec3(camera.up);
        standsInRoom = s.hasRooms() && framing::isInRoom(framing::probe(bvh, viewer.position));
    }
    if (s.litWithin || standsInRoom) s.interior = true;
    const bool needsLight =
        scene.lights.empty() &&
        !(glows &&
          framing::emissionLights(bvh, s, needsCamera ? std::nullopt : std::optional(viewer)));
    if (!needsCamera && !needsLight) return;

    const std::optional<Place> open = openPlace(bvh, s);
    if (needsCamera) {
        const Place place =
            open ? *open : Place{insideView(bvh, s), kFovDeg, "inside the building", false};
        viewer = place.viewer;
        glm::dvec3 from = scene.root.worldFromRoot(viewer.position);
        builtin::addCamera(scene, "default", from, from + glm::dvec3(viewer.forward), place.fovDeg);
        scene.cameras.back().isDefault = true;
        scene.notes.push_back("no camera in the file: one was placed " + place.where);
    }
    if (!needsLight) return;
    if (open && open->outside && !standsInRoom) s.interior = false;
    framing::placeLight(scene, bvh, s, viewer,
                        glows ? "no light in the file, and what glows lights little of it"
                              : "no light in the file");
}

}  // namespace mv
