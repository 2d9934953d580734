#include "megaviews/references/exact_gather.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <vector>

#include "megaviews/views/view_spacing.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/near_field.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv {

namespace {

// What short rays find that the clamp has taken: as shaders/passes/near_field.comp, by the same
// numbers.
class NearField {
  public:
    NearField(const EmbreeScene& embree, std::span<const View> views,
              const std::vector<float>& distances, const ExactGatherOptions& options)
        : embree_(embree), views_(views), distances_(distances), options_(options) {
        if (options.nearFieldRays == 0) return;
        order_ = alongMortonCurve(views);
        least_ = leastClampDistance(views, order_);
    }

    // Of no views the clamp takes nothing.
    bool isNeeded() const { return !order_.empty(); }
    // W/m^2: what the receiver of a pixel, which lies at (x, y), gets by its n-th ray.
    glm::dvec3 light(const Receiver& r, uint x, uint y, uint n) const {
        const vec4 numbers = nearFieldNumbers(options_.seed, x, y, n);
        const vec3 direction = nearFieldDirection(r.normal, numbers, x, y, n);
        if (dot3(direction, r.facing()) <= 0) return glm::dvec3(0);
        const vec3 origin = r.position + r.facing() * lift();
        const std::optional<RayHit> hit = embree_.intersect(origin, direction, 0, kNearFieldReach);
        if (!hit) return glm::dvec3(0);
        const BvhSurface met =
            bvhSurface(embree_.bvh().data(options_.gloss), hit->slot, hit->u, hit->v);
        vec3 facing = normalizeOr(vec3(met.geometricX, met.geometricY, met.geometricZ), -direction);
        if (dot3(facing, direction) > 0) facing = -facing;
        const vec3 place(met.positionX, met.positionY, met.positionZ);
        const float share = nearFieldTaken(clampDistanceAt(place, facing), hit->t);
        if (!(share > 0)) return glm::dvec3(0);
        const vec3 given = lightOf(place + facing * lift(), facing, x, y, n, numbers) *
                           vec3(met.albedoR, met.albedoG, met.albedoB);
        const vec3 emitted = kPi * options_.emissionScale * bvhEmissionSeen(met, direction);
        return glm::dvec3(share * (given + emitted));
    }

  private:
    float lift() const { return bvhLift(embree_.bvh().data()); }

    float clampDistanceAt(vec3 place, vec3 facing) const {
        if (options_.clampDistance) return *options_.clampDistance;
        const auto isBelow = [&](std::uint32_t i, uint key) {
            return mortonKeyOf(viewPosition(views_[i])) < key;
        };
        const uint key = mortonKeyOf(place);
        const auto middle = std::lower_bound(order_.begin(), order_.end(), key, isBelow);
        const auto inCell = std::lower_bound(middle, order_.end(), key + 1, isBelow) - middle;
        const std::ptrdiff_t window = kNearFieldWindow;
        const auto from = middle - std::min(window, middle - order_.begin());
        const auto to = middle + std::min(window, order_.end() - middle);
        NearestViews nearest = noNearestViews();
        for (auto at = from; at != to; ++at) {
            const vec3 way = viewPosition(views_[*at]) - place;
            nearest = withNearView(nearest, dot3(way, way), viewNormal(views_[*at]), facing);
        }
        return nearFieldClampDistance(nearest,
                                      crowdOf(kNearFieldWindow, static_cast<uint>(inCell), least_));
    }

    vec3 lightOf(vec3 place, vec3 normal, uint x, uint y, uint n, vec4 numbers) const {
        const auto edge = static_cast<float>(embree_.bvh().scene->root.edge);
        NearFieldLight light = noNearFieldLight(numbers.z);
        uint candidate = 0;
        vec3 way;
        for (const LightRecord& l : options_.lights) {
            const vec3 given = lightIrradiance(l, edge, place, normal, way);
            light = withLight(light, candidate++, given, way);
        }
        if (options_.sky) {
            const Sky& sky = *options_.sky;
            const vec4 r = random4(options_.seed, y << 16u | x, n, kNearFieldSkyDraw);
            for (uint k = 0; k < kNearFieldSky; ++k) {
                const vec3 given =
                    nearFieldSky(sky.texels.data(), sky.rows, sky.tableShare, normal, r, k, way);
                light = withLight(light, candidate++, given, way);
            }
        }
        const auto count = static_cast<uint>(order_.size());
        for (uint k = 0; count > 0 && k < kNearFieldViews; ++k) {
            const std::uint32_t i = order_[nearFieldView(k, numbers.w, count)];
            const View& v = views_[i];
            if (v.bounce >= static_cast<uint>(options_.bounces)) continue;
            way = viewPosition(v) - place;
            const float term = gatherTerm(way, normal, viewNormal(v), false, distances_[i], 0);
            const vec3 given = nearFieldOfView(viewFlux(v), term, count, edge);
            light = withLight(light, candidate++, given, way);
        }
        way = vec3(light.wayX, light.wayY, light.wayZ);
        if (light.choice.chosen == kNone) return vec3(0);
        const BvhData bvh = embree_.bvh().data(options_.gloss);
        return nearFieldGiven(light) * embree_.passed(bvh, place, way, 0, 1);
    }

    const EmbreeScene& embree_;
    std::span<const View> views_;
    const std::vector<float>& distances_;
    const ExactGatherOptions& options_;
    std::vector<std::uint32_t> order_;  // the views that live, along the Morton curve
    float least_ = 0;                   // leastClampDistance() of them
};

// W/m^2 that the sky sends to a receiver.
glm::dvec3 skyLight(const EmbreeScene& embree, const ExactGatherOptions& options, const Receiver& r,
                    std::uint32_t pixel) {
    const Sky& sky = *options.sky;
    const std::uint32_t seed = options.seed;
    const int rays = options.skyRays;
    const BvhData bvh = embree.bvh().data(options.gloss);
    const vec3 lifted = r.position + r.facing() * bvhLift(bvh);
    const float shift = random4(seed, pixel, 0, kSkyPickDraw).x;
    glm::dvec3 sum(0);
    for (int k = 0; k < rays; ++k) {
        const vec4 x = random4(seed, pixel, static_cast<uint>(k), kSkyDraw);
        vec3 direction;
        const vec3 light =
            skyIrradiance(sky.texels.data(), sky.rows, sky.tableShare, r.normal, vec3(x),
                          glm::fract(shift + float(k) / float(rays)), direction);
        if (!(luminance(light) > 0) || dot3(direction, r.facing()) <= 0) continue;
        sum += glm::dvec3(light * embree.passed(bvh, lifted, direction, 0, kInfinity) *
                          broadGlossWeight(r.gloss, r.normal, direction));
    }
    return sum / double(rays);
}

// What each receiver gets from near places before it is bounded; empty where none is asked for.
IrradianceImage nearFieldOf(const NearField& nearField, std::span<const Receiver> receivers,
                            int width, int height, const ExactGatherOptions& options,
                            const Progress& progress) {
    IrradianceImage image{width, height, 0, {}, {}};
    if (!nearField.isNeeded()) return image;
    image.mean.assign(receivers.size(), glm::vec3(0));
    forEachPixel(image, "near field", progress, [&](std::size_t pixel) {
        const Receiver& r = receivers[pixel];
        if (r.normal == glm::vec3(0)) return;
        const auto x = static_cast<uint>(pixel % static_cast<std::size_t>(width));
        const auto y = static_cast<uint>(pixel / static_cast<std::size_t>(width));
        glm::dvec3 sum(0);
        for (int ray = 0; ray < options.nearFieldRays; ++ray) {
            sum += nearField.light(r, x, y, static_cast<uint>(ray));
        }
        image.mean[pixel] = glm::vec3(sum / static_cast<double>(options.nearFieldRays));
    });
    return image;
}

// The mean power in each pixel's tile, over its surfaces.
std::vector<float> meansOfTiles(const IrradianceImage& near, std::span<const Receiver> receivers) {
    struct Tile {
        float power = 0;
        int surfaces = 0;
    };
    const auto width = static_cast<std::size_t>(near.width);
    const std::size_t across = width / kNearFieldTile + 1;
    const auto tileOf = [&](std::size_t pixel) {
        return pixel / width / kNearFieldTile * across + pixel % width / kNearFieldTile;
    };
    std::vector<Tile> tiles(near.mean.empty() ? 0 : tileOf(near.mean.size()) + across);
    for (std::size_t i = 0; i < near.mean.size(); ++i) {
        if (receivers[i].normal == glm::vec3(0)) continue;
        Tile& tile = tiles[tileOf(i)];
        tile.power += gatherPower(vec3(near.mean[i]));
        ++tile.surfaces;
    }
    std::vector<float> means(near.mean.size());
    for (std::size_t i = 0; i < means.size(); ++i) {
        const Tile& tile = tiles[tileOf(i)];
        means[i] = tile.power / static_cast<float>(std::max(tile.surfaces, 1));
    }
    return means;
}

}  // namespace

void exactGather(const EmbreeScene& embree, std::span<const View> views,
                 std::span<const Receiver> receivers, int width, int height,
                 const ExactGatherOptions& options, IrradianceImage& image,
                 const Progress& progress) {
    assert(receivers.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (image.width != width || image.height != height || image.mean.size() != receivers.size()) {
        image = {width, height, 0, {}, {}};
        image.mean.assign(receivers.size(), glm::vec3(0));
    }
    const std::vector<float> distances =
        options.clampDistance ? std::vector<float>(views.size(), *options.clampDistance)
                              : clampDistances(views);
    const IrradianceImage near = nearFieldOf(NearField(embree, views, distances, options),
                                             receivers, width, height, options, progress);
    const std::vector<float> around = meansOfTiles(near, receivers);
    const double edge = embree.bvh().scene->root.edge;
    const double perArea = 1 / (edge * edge);
    forEachPixel(image, "exact gather", progress, [&](std::size_t pixel) {
        const Receiver& r = receivers[pixel];
        if (r.normal == glm::vec3(0)) return;
        const vec3 lifted = r.position + r.normal * bvhLift(embree.bvh().data());
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < views.size(); ++i) {
            const View& v = views[i];
            if (v.flags == kViewDead) continue;
            const vec3 position = viewPosition(v);
            const float term = gatherTerm(position - r.position, r.normal, viewNormal(v),
                                          v.flags == kViewOmnidirectional, distances[i], 0);
            if (!(term > 0)) continue;
            if (options.visibility && embree.occluded(lifted, position - lifted, 0, 1)) continue;
            const vec3 toLight = normalizeOr(position - r.position, r.normal);
            sum += double{term} * glm::dvec3(viewFlux(v)) *
                   glm::dvec3(broadGlossWeight(r.gloss, r.normal, toLight));
        }
        sum *= perArea;
        if (!near.mean.empty()) {
            sum += glm::dvec3(nearFieldAdded(vec3(near.mean[pixel]), vec3(sum), around[pixel]));
        }
        if (options.sky && options.skyRays > 0) {
            sum += skyLight(embree, options, r, static_cast<std::uint32_t>(pixel));
        }
        image.mean[pixel] = glm::vec3(sum);
    });
}

}  // namespace mv
