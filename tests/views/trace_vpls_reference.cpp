#include "views/trace_vpls_reference.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace mv {

namespace {

using glm::dvec3;
constexpr double kLift = 0.02 / 1024;  // root-cube units

struct Ray {
    dvec3 origin{0}, direction{0}, flux{0};
};

class Tracer {
  public:
    Tracer(const EmbreeScene& embree, double timeS, int animation, double lightScale)
        : embree_(embree),
          scene_(*embree.bvh().scene),
          lights_(scene_.lightsAt(timeS, animation)),
          lightScale_(lightScale) {
        const TriangleBvh& bvh = embree.bvh();
        const double edge2 = scene_.root.edge * scene_.root.edge;
        for (std::size_t slot = 0; slot < bvh.triangles.size(); ++slot) {
            const BvhTriangle& t = bvh.triangles[slot];
            if (!bvh.isFirst(slot)) continue;
            if (!scene_.materials[t.material & ~kMaterialMask].emits()) continue;
            const glm::uvec3 k = scene_.triangles[t.triangle];
            const dvec3 a(scene_.positions[k.x]), b(scene_.positions[k.y]),
                c(scene_.positions[k.z]);
            emitters_.push_back(static_cast<std::uint32_t>(slot));
            totalAreaM2_ += 0.5 * glm::length(glm::cross(b - a, c - a)) * edge2;
            areaUpToM2_.push_back(totalAreaM2_);
        }
        center_ = dvec3(bvh.center);
        radius_ = static_cast<double>(bvh.radius);
    }

    bool hasSurfaces() const { return totalAreaM2_ > 0 && lightScale_ > 0; }
    bool empty() const { return lights_.empty() && !hasSurfaces(); }

    // A ray from an emissive surface, flux as if it were the only one.
    Ray fromSurface(std::mt19937_64& random, dvec3& normal) const {
        const auto found = std::upper_bound(areaUpToM2_.begin(), areaUpToM2_.end() - 1,
                                            uniform(random) * totalAreaM2_);
        const std::uint32_t slot = emitters_[static_cast<std::size_t>(found - areaUpToM2_.begin())];
        double u = uniform(random), v = uniform(random);
        if (u + v > 1) {
            u = 1 - u;
            v = 1 - v;
        }
        const TriangleBvh& bvh = embree_.bvh();
        const BvhTriangle& t = bvh.triangles[slot];
        RayHit point{0, t.triangle, slot, static_cast<float>(u), static_cast<float>(v)};
        const BvhSurface s = bvh.surface(point);
        const bool twoSided = (s.flags & kMaterialDoubleSided) != 0;
        normal = glm::normalize(dvec3(s.geometricX, s.geometricY, s.geometricZ));
        if (twoSided && uniform(random) < 0.5) normal = -normal;
        Ray ray;
        ray.origin = dvec3(s.positionX, s.positionY, s.positionZ) + normal * kLift;
        ray.flux = dvec3(s.emissionR, s.emissionG, s.emissionB) *
                   (std::numbers::pi * totalAreaM2_ * (twoSided ? 2 : 1) * lightScale_);
        if (s.alpha < embree_.bvh().materials[s.material].alphaCutoff) ray.flux = dvec3(0);
        ray.direction = cosine(normal, random);
        return ray;
    }

    // The first ray of a path, flux as if it were the only path. All sources are equally likely.
    Ray emit(std::mt19937_64& random) const {
        const std::size_t sources = lights_.size() + (hasSurfaces() ? 1 : 0);
        const auto choice = std::uniform_int_distribution<std::size_t>(0, sources - 1)(random);
        Ray ray;
        if (choice == lights_.size()) {
            dvec3 normal;
            ray = fromSurface(random, normal);
        } else {
            const PosedLight& posed = lights_[choice];
            const dvec3 intensity = dvec3(posed.light.intensity) * lightScale_;
            ray.origin = (posed.position - scene_.root.origin) / scene_.root.edge;
            if (posed.light.type == LightType::point) {
                ray.direction = uniformCone(posed.direction, -1, random);
                ray.flux = intensity * (4 * std::numbers::pi);
            } else if (posed.light.type == LightType::spot) {
                const double outer = std::cos(posed.light.outerConeRad);
                const double inner = std::cos(posed.light.innerConeRad);
                ray.direction = uniformCone(posed.direction, outer, random);
                const double c = glm::dot(ray.direction, posed.direction);
                const double ramp =
                    std::clamp((c - outer) / std::max(inner - outer, 1e-7), 0.0, 1.0);
                ray.flux = intensity * (2 * std::numbers::pi * (1 - outer) * ramp * ramp);
            } else {
                double x = 0, y = 0;
                do {
                    x = 2 * uniform(random) - 1;
                    y = 2 * uniform(random) - 1;
                } while (x * x + y * y > 1);
                dvec3 s, t;
                frame(posed.direction, s, t);
                ray.origin = center_ + radius_ * (x * s + y * t - 1.001 * posed.direction);
                ray.direction = posed.direction;
                ray.flux = intensity * (std::numbers::pi * std::pow(radius_ * scene_.root.edge, 2));
            }
        }
        ray.flux *= static_cast<double>(sources);
        return ray;
    }

    // The VPL at the end of the ray and the ray that leaves it.
    bool bounce(Ray& ray, std::mt19937_64& random, View& view) const {
        const auto hit =
            embree_.intersect(glm::vec3(ray.origin), glm::vec3(ray.direction), 0, kInfinity);
        if (!hit) return false;
        const BvhSurface s = embree_.bvh().surface(*hit);
        dvec3 geometric(s.geometricX, s.geometricY, s.geometricZ);
        dvec3 shading(s.shadingX, s.shadingY, s.shadingZ);
        if (glm::dot(geometric, ray.direction) > 0) {
            geometric = -geometric;
            shading = -shading;
        }
        ray.flux *= dvec3(s.albedoR, s.albedoG, s.albedoB);
        if (!(ray.flux.x > 0 || ray.flux.y > 0 || ray.flux.z > 0)) return false;
        ray.origin = dvec3(s.positionX, s.positionY, s.positionZ) + geometric * kLift;
        ray.direction = cosine(shading, random);
        const double below = glm::dot(ray.direction, geometric);
        if (below < 0) ray.direction -= 2 * below * geometric;
        write(ray.origin, shading, ray.flux, view);
        return true;
    }

    static void write(dvec3 position, dvec3 normal, dvec3 flux, View& view) {
        view.flags = kViewHemisphere;
        view.positionX = static_cast<float>(position.x);
        view.positionY = static_cast<float>(position.y);
        view.positionZ = static_cast<float>(position.z);
        view.normalX = static_cast<float>(normal.x);
        view.normalY = static_cast<float>(normal.y);
        view.normalZ = static_cast<float>(normal.z);
        view.fluxR = static_cast<float>(flux.x);
        view.fluxG = static_cast<float>(flux.y);
        view.fluxB = static_cast<float>(flux.z);
    }

  private:
    static double uniform(std::mt19937_64& random) {
        return std::uniform_real_distribution<double>(0, 1)(random);
    }
    static void frame(dvec3 n, dvec3& s, dvec3& t) {
        const dvec3 other = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        s = glm::normalize(glm::cross(n, other));
        t = glm::cross(n, s);
    }
    static dvec3 uniformCone(dvec3 axis, double cosAngle, std::mt19937_64& random) {
        const double z = 1 - uniform(random) * (1 - cosAngle);
        return around(axis, z, 2 * std::numbers::pi * uniform(random));
    }
    static dvec3 cosine(dvec3 n, std::mt19937_64& random) {
        const double z = std::sqrt(1 - uniform(random));
        return around(n, z, 2 * std::numbers::pi * uniform(random));
    }
    static dvec3 around(dvec3 axis, double z, double phi) {
        dvec3 s, t;
        frame(axis, s, t);
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        return r * std::cos(phi) * s + r * std::sin(phi) * t + z * axis;
    }

    const EmbreeScene& embree_;
    const Scene& scene_;
    std::vector<PosedLight> lights_;
    double lightScale_;
    std::vector<std::uint32_t> emitters_;  // slots of emissive triangles
    std::vector<double> areaUpToM2_;       // running sums
    double totalAreaM2_ = 0;
    dvec3 center_{0.5};
    double radius_ = 0.5;
};

}  // namespace

ViewSet traceVplsReference(const EmbreeScene& embree, double timeS, int animation,
                           double lightScale, const VplOptions& options) {
    const Tracer tracer(embree, timeS, animation, lightScale);
    const auto bounces = static_cast<std::uint64_t>(options.bounces);
    const std::uint64_t onSurfaces = tracer.hasSurfaces() ? (options.count + 3) / 4 : 0;
    const std::uint64_t paths = (options.count - onSurfaces + bounces - 1) / bounces;
    ViewSet set;
    set.views.assign(options.count, View{});
    if (tracer.empty()) return set;

    using Range = tbb::blocked_range<std::uint64_t>;
    const auto engine = [&](std::uint64_t path, std::uint64_t kind) {
        std::seed_seq seed{std::uint64_t{options.seed}, path, kind};
        return std::mt19937_64(seed);
    };
    tbb::parallel_for(Range(0, onSurfaces), [&](const Range& range) {
        for (std::uint64_t slot = range.begin(); slot < range.end(); ++slot) {
            std::mt19937_64 random = engine(slot, 1);
            dvec3 normal;
            const Ray ray = tracer.fromSurface(random, normal);
            if (ray.flux == dvec3(0)) continue;
            View& view = set.views[slot];
            Tracer::write(ray.origin, normal, ray.flux / static_cast<double>(onSurfaces), view);
            view.slot = static_cast<std::uint32_t>(slot);
        }
    });
    tbb::parallel_for(Range(0, paths), [&](const Range& range) {
        for (std::uint64_t path = range.begin(); path < range.end(); ++path) {
            std::mt19937_64 random = engine(path, 0);
            Ray ray = tracer.emit(random);
            ray.flux /= static_cast<double>(paths);
            for (std::uint64_t k = 0; k < bounces; ++k) {
                const std::uint64_t slot = onSurfaces + path * bounces + k;
                if (slot >= options.count || ray.flux == dvec3(0)) break;
                View& view = set.views[slot];
                if (!tracer.bounce(ray, random, view)) break;
                view.bounce = static_cast<std::uint32_t>(k + 1);
                view.slot = static_cast<std::uint32_t>(slot);
            }
        }
    });
    return set;
}

}  // namespace mv
