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

// What a short ray from the receiver finds that the clamp has taken: as shaders/passes/
// near_field.comp. W / root-cube unit^2.
glm::dvec3 nearField(const EmbreeScene& embree, std::span<const View> views,
                     const std::vector<std::uint32_t>& order, const std::vector<float>& distances,
                     const Receiver& r, vec3 direction, const ExactGatherOptions& options) {
    const vec3 origin = r.position + r.normal * bvhLift(embree.bvh().data());
    const std::optional<RayHit> hit = embree.intersect(origin, direction, 0, kNearFieldReach);
    if (!hit) return glm::dvec3(0);
    const BvhSurface surface = embree.bvh().surface(*hit);
    vec3 facing(surface.geometricX, surface.geometricY, surface.geometricZ);
    if (dot3(facing, direction) > 0) facing = -facing;
    const vec3 place = origin + direction * hit->t;
    const vec3 between = origin + direction * (0.5f * hit->t);
    const float height = -0.5f * hit->t * dot3(direction, facing);
    const auto positionOf = [&](std::uint32_t i) {
        return vec3(views[i].positionX, views[i].positionY, views[i].positionZ);
    };
    const uint key = mortonKeyOf(place);
    const auto middle =
        std::lower_bound(order.begin(), order.end(), key,
                         [&](std::uint32_t i, uint k) { return mortonKeyOf(positionOf(i)) < k; });
    const auto from = middle - std::min<std::ptrdiff_t>(kNearFieldWindow, middle - order.begin());
    const auto to = middle + std::min<std::ptrdiff_t>(kNearFieldWindow, order.end() - middle);
    const vec3 emission = options.emissionScale * bvhEmissionSeen(surface, direction);
    const bool emits = luminance(emission) > 0;
    glm::dvec3 given(0);
    double weights = 0;
    for (auto at = from; at != to; ++at) {
        const View& v = views[*at];
        const vec3 way = positionOf(*at) - place;
        const float share = nearFieldShare(distances[*at], hit->t, dot3(way, way),
                                           vec3(v.normalX, v.normalY, v.normalZ), facing);
        if (!(share > 0)) continue;
        if (emits) {
            const double weight{luminance(vec3(v.fluxR, v.fluxG, v.fluxB)) * share};
            given += weight * glm::dvec3(nearFieldEmitted(emission, distances[*at], hit->t));
            weights += weight;
            continue;
        }
        const vec3 above = positionOf(*at) + vec3(v.normalX, v.normalY, v.normalZ) * height;
        if (options.visibility && embree.occluded(between, above - between, 0, 1)) continue;
        given += glm::dvec3(v.fluxR, v.fluxG, v.fluxB) * double{share};
    }
    const double edge = embree.bvh().scene->root.edge;
    if (emits) return weights > 0 ? given * (edge * edge / weights) : glm::dvec3(0);
    return given;
}

// W/m^2 that the sky sends to a receiver.
glm::dvec3 skyLight(const EmbreeScene& embree, const Sky& sky, const Receiver& r, int rays,
                    std::uint32_t seed, std::uint32_t pixel) {
    const vec3 lifted = r.position + r.normal * bvhLift(embree.bvh().data());
    const float shift = random4(seed, pixel, 0, kSkyPickDraw).x;
    glm::dvec3 sum(0);
    for (int k = 0; k < rays; ++k) {
        const vec4 x = random4(seed, pixel, static_cast<uint>(k), kSkyDraw);
        vec3 direction;
        const vec3 light =
            skyIrradiance(sky.texels.data(), sky.rows, sky.tableShare, r.normal, vec3(x),
                          glm::fract(shift + float(k) / float(rays)), direction);
        if (!(luminance(light) > 0) || embree.occluded(lifted, direction, 0, kInfinity)) continue;
        sum += glm::dvec3(light * broadGlossWeight(r.gloss, r.normal, direction));
    }
    return sum / double(rays);
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
    const std::vector<std::uint32_t> order =
        options.nearFieldRays > 0 ? alongMortonCurve(views) : std::vector<std::uint32_t>();
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
            const vec3 position(v.positionX, v.positionY, v.positionZ);
            const float term =
                gatherTerm(position - r.position, r.normal, vec3(v.normalX, v.normalY, v.normalZ),
                           v.flags == kViewOmnidirectional, distances[i], 0);
            if (!(term > 0)) continue;
            if (options.visibility && embree.occluded(lifted, position - lifted, 0, 1)) continue;
            const vec3 toLight = normalizeOr(position - r.position, r.normal);
            sum += double{term} * glm::dvec3(v.fluxR, v.fluxG, v.fluxB) *
                   glm::dvec3(broadGlossWeight(r.gloss, r.normal, toLight));
        }
        glm::dvec3 near(0);
        for (int ray = 0; ray < options.nearFieldRays; ++ray) {
            const auto x = static_cast<uint>(pixel % static_cast<std::size_t>(width));
            const auto y = static_cast<uint>(pixel / static_cast<std::size_t>(width));
            near +=
                nearField(embree, views, order, distances, r,
                          nearFieldDirection(r.normal, options.seed, x, y, static_cast<uint>(ray)),
                          options) /
                double(options.nearFieldRays);
        }
        sum += glm::dvec3(nearFieldAdded(vec3(near), vec3(sum)));
        sum *= perArea;
        if (options.sky) {
            sum += skyLight(embree, *options.sky, r, options.skyRays, options.seed,
                            static_cast<std::uint32_t>(pixel));
        }
        image.mean[pixel] = glm::vec3(sum);
    });
}

}  // namespace mv
