#include "megaviews/views/importance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "shaders/shared/morton.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv {
namespace {

// Dimensions of random4.
constexpr std::uint32_t kDrawPoint = 17;
constexpr std::uint32_t kDrawPlace = 19;

// The radical inverse to base 3, beside which that to base 2 spreads points evenly.
float inverse3(std::uint32_t i) {
    double x = 0, digit = 1.0 / 3;
    for (; i > 0; i /= 3, digit /= 3) x += digit * (i % 3);
    return static_cast<float>(x);
}
float inverse2(std::uint32_t i) {
    double x = 0, digit = 0.5;
    for (; i > 0; i /= 2, digit /= 2) x += digit * (i % 2);
    return static_cast<float>(x);
}

// Points are about so far apart.
float distanceBetween(const std::vector<ImportancePoint>& points) {
    const auto positionOf = [](const ImportancePoint& p) {
        return glm::vec3(p.positionX, p.positionY, p.positionZ);
    };
    const auto count = static_cast<float>(std::max<std::size_t>(points.size(), 1));
    glm::vec3 middle(0);
    for (const ImportancePoint& p : points) middle += positionOf(p) / count;
    float spread = 0;
    for (const ImportancePoint& p : points) spread += glm::distance(positionOf(p), middle) / count;
    return std::min(kImportanceDistance, kImportanceOfSpread * spread);
}

// Where a ray meets a surface, as the place of a view that lights where it came from.
std::optional<View> placeAlong(const TriangleBvh& bvh, glm::vec3 origin, glm::vec3 direction) {
    const std::optional<RayHit> hit = bvh.intersect(origin, direction, kNearPlane, kVplFar);
    if (!hit) return std::nullopt;
    const BvhSurface s = bvh.surface(*hit);
    glm::vec3 normal(s.geometricX, s.geometricY, s.geometricZ);
    if (glm::dot(normal, direction) > 0) normal = -normal;
    return vplAt({s.positionX, s.positionY, s.positionZ}, normal, {1, 1, 1}, 1, 0);
}

// The share of what a place would give the points that gets there, of a few of them; unset if it
// faces away from those.
std::optional<float> visibleFrom(const TriangleBvh& bvh, const View& place,
                                 const Importance& importance, std::size_t number) {
    constexpr std::size_t kAsked = 6;
    constexpr float kEnds = 1e-4f;  // of a ray, that do not count
    const std::vector<ImportancePoint>& points = importance.points;
    const glm::vec3 from(place.positionX, place.positionY, place.positionZ);
    float all = 0, visible = 0;
    for (std::size_t k = 0; k < std::min(kAsked, points.size()); ++k) {
        const ImportancePoint& to = points[(number + k * points.size() / kAsked) % points.size()];
        const float term = importanceTerm(place, to, importance.distance);
        if (!(term > 0)) continue;
        all += term;
        const glm::vec3 way = glm::vec3(to.positionX, to.positionY, to.positionZ) - from;
        if (!bvh.occluded(from, way, kEnds, 1 - kEnds)) visible += term;
    }
    if (!(all > 0)) return std::nullopt;
    return visible / all;
}

}  // namespace

std::vector<ImportancePoint> importancePoints(const TriangleBvh& bvh, const ImportanceCamera& from,
                                              std::uint32_t seed, int count) {
    constexpr int kHeight = 1024;
    const int width = std::max(1, static_cast<int>(std::lround(kHeight * from.aspect)));
    const vec4 shift = random4(seed, 0, 0, kDrawPoint);
    std::vector<ImportancePoint> points;
    for (int i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(i);
        const float x = glm::fract(inverse2(index) + shift.x);
        const float y = glm::fract(inverse3(index) + shift.y);
        const PickRay ray = rayThrough(from.camera, width, kHeight, x * static_cast<float>(width),
                                       y * static_cast<float>(kHeight), 0);
        const std::optional<View> met = placeAlong(bvh, ray.origin, ray.direction);
        if (!met) continue;
        points.push_back({.positionX = met->positionX,
                          .positionY = met->positionY,
                          .positionZ = met->positionZ,
                          .pad0 = 0,
                          .normalX = met->normalX,
                          .normalY = met->normalY,
                          .normalZ = met->normalZ,
                          .pad1 = 0});
    }
    return points;
}

Importance importanceOf(std::vector<ImportancePoint> points) {
    const float distance = distanceBetween(points);
    return {std::move(points), {}, distance};
}

float Importance::of(const View& view) const {
    if (view.flags == kViewDead || points.empty()) return 0;
    float sum = 0;
    for (const ImportancePoint& point : points) sum += importanceTerm(view, point, distance);
    const float unoccluded = viewLuminance(view) * (sum / static_cast<float>(points.size()));

    const uint key = mortonKeyOf(viewPosition(view));
    const auto at = std::lower_bound(places.begin(), places.end(), key,
                                     [](const ImportancePlace& p, uint k) { return p.key < k; });
    const auto low = static_cast<std::size_t>(at - places.begin());
    ImportanceVisible around{0, 0};
    const std::size_t end = std::min<std::size_t>(low + kImportanceWindow, places.size());
    for (std::size_t i = low - std::min<std::size_t>(low, kImportanceWindow); i < end; ++i) {
        around = withPlace(around, view, places[i], distance);
    }
    return unoccluded * visibleShare(around);
}

std::vector<ImportancePlace> placesAround(const TriangleBvh& bvh, const Importance& importance,
                                          const std::vector<View>& pilot) {
    constexpr std::size_t kOfPilot = 1024, kRaysOfPoint = 16;
    const std::vector<ImportancePoint>& points = importance.points;
    if (points.empty()) return {};
    std::vector<View> lit;
    for (const View& view : pilot) {
        if (view.flags != kViewDead) lit.push_back(view);
    }
    const std::size_t ofPilot = std::min(kOfPilot, lit.size());
    const std::size_t count = ofPilot + points.size() * kRaysOfPoint;
    std::vector<std::optional<ImportancePlace>> asked(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 16), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            std::optional<View> place;
            if (i < ofPilot) {
                place = lit[i * lit.size() / ofPilot];
            } else {
                const std::size_t ray = i - ofPilot;
                const ImportancePoint& p = points[ray / kRaysOfPoint];
                const vec4 r = random4(static_cast<std::uint32_t>(ray), 0, 0, kDrawPlace);
                const glm::vec3 normal(p.normalX, p.normalY, p.normalZ);
                place = placeAlong(bvh, glm::vec3(p.positionX, p.positionY, p.positionZ),
                                   cosineDirection(normal, r.x, r.y));
            }
            if (!place) continue;
            const std::optional<float> visible = visibleFrom(bvh, *place, importance, i);
            if (!visible) continue;
            const glm::vec3 at(place->positionX, place->positionY, place->positionZ);
            asked[i] = ImportancePlace{.positionX = at.x,
                                       .positionY = at.y,
                                       .positionZ = at.z,
                                       .key = mortonKeyOf(at),
                                       .normalX = place->normalX,
                                       .normalY = place->normalY,
                                       .normalZ = place->normalZ,
                                       .visible = *visible};
        }
    });
    std::vector<ImportancePlace> places;
    for (const auto& place : asked) {
        if (place) places.push_back(*place);
    }
    std::stable_sort(
        places.begin(), places.end(),
        [](const ImportancePlace& a, const ImportancePlace& b) { return a.key < b.key; });
    return places;
}

}  // namespace mv
