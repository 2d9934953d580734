#include "megaviews/scene/framing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/framing_light.h"
#include "megaviews/scene/framing_probe.h"

namespace mv {
namespace {

using framing::FreePoint;
using framing::Surroundings;
using framing::Viewer;

constexpr double kFovDeg = 55;  // vertical, interiors
constexpr double kObjectFovDeg = 38;
constexpr float kAspect = 1.45f;  // objects fit windows at least this wide

// All around from outside: from `azimuth` (0 = +z, towards +x) and above, as close as everything
// fits.
Viewer outsideView(const Scene& scene, float azimuth) {
    Viewer v;
    constexpr float kElevation = 0.36f;
    v.forward =
        normalizeOr(glm::vec3(-std::sin(azimuth), -kElevation, -std::cos(azimuth)), {0, 0, -1});
    glm::vec3 right = normalizeOr(cross3(v.forward, {0, 1, 0}), {1, 0, 0});
    v.up = cross3(right, v.forward);
    v.position = glm::vec3(0.5f) - 2.0f * v.forward;
    if (scene.triangles.empty()) return v;
    // The camera that touches the geometry with all four sides of its pyramid: each side gives a
    // half-space for the apex; the vertical and the horizontal pair each fix a depth.
    float ty = 0.88f * static_cast<float>(std::tan(kObjectFovDeg * 3.14159265358979 / 360));
    float tx = ty * kAspect;
    float r = -kInfinity, l = -kInfinity, t = -kInfinity, b = -kInfinity, nearest = kInfinity;
    for (const glm::uvec3& triangle : scene.triangles)
        for (int k = 0; k < 3; ++k) {
            glm::vec3 p = scene.positions[triangle[k]];
            float x = dot3(p, right), y = dot3(p, v.up), z = dot3(p, v.forward);
            r = std::max(r, x - tx * z);
            l = std::max(l, -x - tx * z);
            t = std::max(t, y - ty * z);
            b = std::max(b, -y - ty * z);
            nearest = std::min(nearest, z);
        }
    float z = std::min(-(r + l) / (2 * tx), -(t + b) / (2 * ty));
    z = std::min(z, nearest - 0.02f);
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

// At eye height in the roomiest place, from one end of its longest free line along it.
Viewer insideView(const TriangleBvh& bvh, const Surroundings& s) {
    // The roomiest places, low ones first among equals: a nave rather than its galleries.
    std::vector<FreePoint> places = s.standing;
    auto worth = [&](const FreePoint& f) {
        return f.roominess * (1 - 0.3f * (f.floor - s.low.y) / (s.high.y - s.low.y));
    };
    std::stable_sort(places.begin(), places.end(),
                     [&](const FreePoint& a, const FreePoint& b) { return worth(a) > worth(b); });
    constexpr std::size_t kPlaces = 40;
    places.resize(std::min(places.size(), kPlaces));
    float roomiest = places.front().roominess;
    std::vector<Viewer> views;
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
                        Viewer v;
                        v.position = p;
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
                    std::min(0.0f, 2 * (f.clearance / s.eyeHeight - 0.5f));
    });
    auto best = std::max_element(scores.begin(), scores.end());
    return views[static_cast<std::size_t>(best - scores.begin())];
}

// Chooses the three-quarter view, of four, that shows most of the surface; glTF's front (+z) is
// preferred unless it hides a lot.
Viewer bestOutsideView(const TriangleBvh& bvh) {
    const Scene& scene = *bvh.scene;
    if (scene.triangles.empty()) return outsideView(scene, 0.53f);
    Viewer best;
    float most = -1;
    std::vector<framing::SurfacePoint> surface = framing::surfaceSamples(bvh, 600);
    for (float azimuth : {0.53f, -0.53f, kPi - 0.53f, kPi + 0.53f}) {
        Viewer v = outsideView(scene, azimuth);
        float seen = azimuth == 0.53f ? 0.12f : std::abs(azimuth) < 1 ? 0.06f : 0.0f;
        for (const framing::SurfacePoint& p : surface)
            if (dot3(v.position - p.position, p.normal) > 0 &&
                framing::clear(bvh, p.position, v.position))
                seen += 1 / static_cast<float>(surface.size());
        if (seen > most) most = seen, best = v;
    }
    return best;
}

bool emits(const Scene& scene) {
    for (std::uint32_t m : scene.triangleMaterials)
        if (scene.materials[m].emits()) return true;
    return false;
}

}  // namespace

void placeDefaults(Scene& scene, const TriangleBvh& bvh) {
    bool needsCamera = scene.cameras.empty();
    bool needsLight = scene.lights.empty() && !emits(scene);
    if (!needsCamera && !needsLight) return;

    Surroundings s;
    if (!scene.triangles.empty()) s = framing::survey(bvh);
    Viewer viewer;
    if (needsCamera) {
        bool inside = s.interior && !s.standing.empty();
        viewer = inside ? insideView(bvh, s) : bestOutsideView(bvh);
        glm::dvec3 from = scene.root.worldFromRoot(viewer.position);
        builtin::addCamera(scene, "default", from, from + glm::dvec3(viewer.forward),
                           inside ? kFovDeg : kObjectFovDeg);
        scene.cameras.back().isDefault = true;
        scene.notes.push_back(inside ? "no camera in the file: one was placed inside the building"
                                     : "no camera in the file: one was placed to show everything");
    } else {
        PosedCamera camera = scene.camerasAt(0, scene.animations.empty() ? -1 : 0).front();
        viewer.position = scene.root.rootFromWorld(camera.position);
        viewer.forward = glm::vec3(camera.forward);
        viewer.up = glm::vec3(camera.up);
    }
    if (needsLight) framing::placeLight(scene, bvh, s, viewer);
}

}  // namespace mv
