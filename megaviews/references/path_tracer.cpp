#include "megaviews/references/path_tracer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace mv {
namespace {

using glm::dvec3;

// `dimension` of random4: one draw each, kDraws a vertex.
enum Draw : uint { direction = 0, emitterPoint = 1, skyPoint = 2, kDraws = 3 };

// Embree and bvh.glsl differ by a few roundings in where a ray meets a triangle.
constexpr float kBeforeHit = 1 - 1e-5f;

class PathTracer {
  public:
    PathTracer(const EmbreeScene& embree, const Emitters& emitters, const PathTraceOptions& options)
        : embree_(embree),
          bvh_(embree.bvh().data(options.gloss)),
          emitters_(emitters),
          options_(options),
          edge_(embree.bvh().scene->root.edge),
          emissiveOfSlot_(embree.bvh().triangles.size(), kNone) {
        if (emitters.lightScale > 0) emissiveCount_ = emitters.emissiveCount();
        for (uint i = 0; i < emissiveCount_; ++i) {
            emissiveOfSlot_[emitters.surfaces->triangles[i].bvhSlot] = i;
        }
    }

    // The irradiance that one path finds.
    dvec3 sample(const Receiver& receiver, uint pixel, uint index) const {
        Vertex x;
        x.position = receiver.position + receiver.normal * lift_;
        x.normal = dvec3(receiver.normal);
        x.gloss = receiver.gloss;
        dvec3 throughput(std::numbers::pi);  // irradiance: radiance * cos / (cos / pi)
        dvec3 sum(0);
        for (int reflections = 0;; ++reflections) {
            // Light of emitters on this vertex: by a point on one of them, and below by the ray.
            sum += throughput * fromEmitters(x, pixel, index, reflections);
            sum += throughput * fromSky(x, pixel, index, reflections);
            if (reflections > 0) sum += throughput * fromLights(x);

            const vec4 r = draw(pixel, index, reflections, Draw::direction);
            const vec3 way = cosineDirection(vec3(x.normal), r.x, r.y);
            const auto hit = embree_.intersect(x.position, way, 0, kInfinity);
            const float end = hit ? hit->t * kBeforeHit : kInfinity;
            throughput *= tint(x.position, way, end);
            if (!hit) return sum + throughput * x.weight(dvec3(way)) * skyFound(x, dvec3(way));
            const BvhSurface s = bvhSurface(bvh_, hit->slot, hit->u, hit->v);
            throughput *= x.weight(dvec3(way));
            sum += throughput * emissionFound(x, dvec3(way), *hit, s);
            if (reflections == options_.bounces) return sum;

            // The surface on the side that the ray came from; light must reach that side.
            dvec3 geometric(s.geometricX, s.geometricY, s.geometricZ);
            dvec3 shading(s.shadingX, s.shadingY, s.shadingZ);
            if (glm::dot(geometric, dvec3(way)) > 0) {
                geometric = -geometric;
                shading = -shading;
            }
            throughput *= dvec3(s.albedoR, s.albedoG, s.albedoB) *
                          leaving(-dvec3(way), geometric, shading, reflections == 0);
            if (!(throughput.x > 0 || throughput.y > 0 || throughput.z > 0)) return sum;
            x.position = vec3(s.positionX, s.positionY, s.positionZ) + vec3(geometric) * lift_;
            x.normal = geometric;
            x.gloss = {};
        }
    }

  private:
    struct Vertex {
        vec3 position{0};  // lifted
        dvec3 normal{0};   // light arrives by the cosine from it
        BroadGloss gloss = {};

        // Of light from a direction, relative to a matt surface.
        dvec3 weight(dvec3 way) const {
            return dvec3(broadGlossWeight(gloss, vec3(normal), vec3(way)));
        }
    };

    vec4 draw(uint pixel, uint index, int vertex, Draw what) const {
        return random4(options_.seed ^ 0x9E3779B9u, pixel, index,
                       static_cast<uint>(vertex) * Draw::kDraws + what);
    }

    // By colour, the share of light that gets from `from` to `from + tMax way`.
    dvec3 passed(vec3 from, vec3 way, float tMax) const {
        return dvec3(embree_.passed(bvh_, from, way, 0, tMax));
    }
    // The same where nothing is in the way but what tints.
    dvec3 tint(vec3 from, vec3 way, float tMax) const {
        if ((bvh_.flags & kBvhTints) == 0u) return dvec3(1);
        return dvec3(bvhPassed(bvh_, from, way, 0, tMax));
    }

    // What a reflection sends into a direction, relative to a Lambertian surface about the
    // geometric normal: VPLs shine by the cosine from their shading normal, and paths that a bent
    // normal would send below the surface are mirrored to above it. The last VPL, the one that
    // lights the receiver, is not mirrored: below its surface it is in shadow.
    static double leaving(dvec3 out, dvec3 geometric, dvec3 shading, bool lightsReceiver) {
        const double cosGeometric = glm::dot(geometric, out);
        if (!(cosGeometric > 0)) return 0;
        double sent = std::max(0.0, glm::dot(shading, out));
        if (!lightsReceiver) {
            sent += std::max(0.0, glm::dot(shading, out - 2 * cosGeometric * geometric));
        }
        return sent / cosGeometric;
    }

    // Sum over punctual lights of E / pi at the vertex.
    dvec3 fromLights(const Vertex& x) const {
        dvec3 sum(0);
        for (const LightRecord& light : emitters_.lights) {
            if (light.type == kLightSky) continue;  // fromSky(), skyFound()
            const dvec3 intensity(light.intensityR, light.intensityG, light.intensityB);
            const dvec3 axis(light.directionX, light.directionY, light.directionZ);
            if (light.type == kLightDirectional) {
                const double cosX = -glm::dot(axis, x.normal);
                if (!(cosX > 0)) continue;
                sum += intensity * cosX * passed(x.position, vec3(-axis), kInfinity);
                continue;
            }
            const vec3 position(light.positionX, light.positionY, light.positionZ);
            const dvec3 way = dvec3(position) - dvec3(x.position);
            const double r2 = glm::dot(way, way), r = std::sqrt(r2);
            const double cosX = glm::dot(way, x.normal) / r;
            if (!(cosX > 0)) continue;
            double falloff = 1;
            if (light.type == kLightSpot) {
                falloff = double{spotFalloff(static_cast<float>(-glm::dot(way, axis) / r),
                                             light.cosInner, light.cosOuter)};
            }
            if (!(falloff > 0)) continue;
            sum += intensity * (falloff * cosX / (r2 * edge_ * edge_)) *
                   passed(x.position, position - x.position, 1);
        }
        return sum / std::numbers::pi;
    }

    // Two ways find the same light by densities a and b over solid angle; this is the share of the
    // first [Veach and Guibas 1995, balance heuristic].
    static double balance(double a, double b) { return a / (a + b); }

    // Density over solid angle with which fromEmitters finds a point of a triangle.
    double emitterDensity(uint emitter, double distanceM2, double cosEmitter) const {
        const EmissiveTriangle& t = emitters_.surfaces->triangles[emitter];
        return double{t.probability} / double{t.areaM2} * distanceM2 / cosEmitter;
    }

    dvec3 radianceOf(const BvhSurface& s) const {
        return dvec3(s.emissionR, s.emissionG, s.emissionB) * double{emitters_.lightScale};
    }

    // E / pi of emissive surfaces at the vertex, from one point of one of them.
    dvec3 fromEmitters(const Vertex& x, uint pixel, uint index, int vertex) const {
        if (emissiveCount_ == 0) return dvec3(0);
        const vec4 r = draw(pixel, index, vertex, Draw::emitterPoint);
        const auto& triangles = emitters_.surfaces->triangles;
        const auto chosen = std::upper_bound(
            triangles.begin(), triangles.end() - 1, r.x,
            [](float share, const EmissiveTriangle& t) { return share < t.cumulative; });
        const float s = std::sqrt(r.y), u = s * (1 - r.z), v = s * r.z;
        if (maskedOut(chosen->bvhSlot, u, v)) return dvec3(0);
        const BvhSurface surface = bvhSurface(bvh_, chosen->bvhSlot, u, v);
        dvec3 normal(surface.geometricX, surface.geometricY, surface.geometricZ);
        const vec3 at(surface.positionX, surface.positionY, surface.positionZ);
        const dvec3 there = dvec3(at) - dvec3(x.position);
        if (glm::dot(normal, there) > 0) {
            if ((surface.flags & kMaterialDoubleSided) == 0u) return dvec3(0);
            normal = -normal;
        }
        const double r2 = glm::dot(there, there), distance = std::sqrt(r2);
        const double cosX = glm::dot(x.normal, there) / distance;
        const double cosE = -glm::dot(normal, there) / distance;
        if (!(cosX > 0) || !(cosE > 0)) return dvec3(0);
        const vec3 target = at + vec3(normal) * lift_;
        const dvec3 arrives = passed(x.position, target - x.position, 1);
        const auto emitter = static_cast<uint>(chosen - triangles.begin());
        const double density = emitterDensity(emitter, r2 * edge_ * edge_, cosE);
        return radianceOf(surface) * arrives * x.weight(there / distance) *
               (cosX / std::numbers::pi / density * balance(density, cosX / std::numbers::pi));
    }

    // Radiance of the surface that the vertex's ray found.
    dvec3 emissionFound(const Vertex& x, dvec3 way, const RayHit& hit, const BvhSurface& s) const {
        const uint emitter = emissiveOfSlot_[hit.slot];
        if (emitter == kNone) return dvec3(0);
        const double cosE = -glm::dot(dvec3(s.geometricX, s.geometricY, s.geometricZ), way);
        if (cosE == 0 || (cosE < 0 && (s.flags & kMaterialDoubleSided) == 0u)) return dvec3(0);
        const double cosX = glm::dot(x.normal, way);
        if (!(cosX > 0)) return dvec3(0);
        const double distanceM = double{hit.t} * edge_;
        const double density = emitterDensity(emitter, distanceM * distanceM, std::abs(cosE));
        return radianceOf(s) * balance(cosX / std::numbers::pi, density);
    }

    // E / pi of the sky at the vertex, from one direction drawn by its power.
    dvec3 fromSky(const Vertex& x, uint pixel, uint index, int vertex) const {
        if (!emitters_.sky) return dvec3(0);
        const vec4 r = draw(pixel, index, vertex, Draw::skyPoint);
        vec3 way, radiance;
        const double density{
            skySample(emitters_.skyTexels(), emitters_.sky->rows, r.x, r.y, r.z, way, radiance)};
        const double cosX = glm::dot(x.normal, dvec3(way));
        if (!(cosX > 0)) return dvec3(0);
        return dvec3(radiance) * passed(x.position, way, kInfinity) * x.weight(dvec3(way)) *
               (cosX / std::numbers::pi / density * balance(density, cosX / std::numbers::pi));
    }

    // Radiance of the sky in the direction of a ray that met nothing.
    dvec3 skyFound(const Vertex& x, dvec3 way) const {
        if (!emitters_.sky) return dvec3(0);
        const double cosX = glm::dot(x.normal, way);
        if (!(cosX > 0)) return dvec3(0);
        vec3 radiance;
        const double density{
            skyRadiance(emitters_.skyTexels(), emitters_.sky->rows, vec3(way), radiance)};
        return dvec3(radiance) * balance(cosX / std::numbers::pi, density);
    }

    bool maskedOut(uint slot, float u, float v) const {
        const BvhTriangle& t = bvh_.triangles[slot];
        return (t.material & kMaterialMask) != 0u &&
               bvhMaskedOut(bvh_, t.triangle, t.material & ~kMaterialMask, u, v);
    }

    const EmbreeScene& embree_;
    BvhData bvh_;
    float lift_ = bvhLift(bvh_);
    const Emitters& emitters_;
    PathTraceOptions options_;
    double edge_;
    uint emissiveCount_ = 0;
    std::vector<uint> emissiveOfSlot_;  // by slot of a triangle
};

}  // namespace

void pathTrace(const EmbreeScene& embree, const Emitters& emitters,
               std::span<const Receiver> receivers, int width, int height,
               const PathTraceOptions& options, IrradianceImage& image, const Progress& progress) {
    assert(receivers.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    assert(options.samples >= 1 && options.bounces >= 1);
    if (image.width != width || image.height != height || image.mean.size() != receivers.size() ||
        image.variance.size() != receivers.size()) {
        image = {width, height, 0, {}, {}};
        image.mean.assign(receivers.size(), glm::vec3(0));
        image.variance = image.mean;
    }
    const PathTracer tracer(embree, emitters, options);
    forEachPixel(image, "path tracing", progress, [&](std::size_t pixel) {
        if (receivers[pixel].normal == glm::vec3(0)) return;
        // Welford's running mean and sum of squared deviations.
        dvec3 mean(0), squares(0);
        for (uint i = 0; i < options.samples; ++i) {
            const dvec3 e = tracer.sample(receivers[pixel], static_cast<uint>(pixel), i);
            const dvec3 off = e - mean;
            mean += off / static_cast<double>(i + 1);
            squares += off * (e - mean);
        }
        const auto n = static_cast<double>(options.samples);
        image.mean[pixel] = glm::vec3(mean);
        image.variance[pixel] = glm::vec3(squares / (n * std::max(n - 1, 1.0)));
    });
}

}  // namespace mv
