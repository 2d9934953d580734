// Emitters: what shines, how much, and how paths are shared out among it.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <optional>

#include "megaviews/core/error.h"
#include "megaviews/views/running_shares.h"
#include "megaviews/views/view_guide.h"
#include "megaviews/views/view_set.h"

namespace mv {

namespace {

double areaRoot(const BvhTriangle& t) {
    const glm::dvec3 a(t.ax, t.ay, t.az), b(t.bx, t.by, t.bz), c(t.cx, t.cy, t.cz);
    return 0.5 * glm::length(glm::cross(b - a, c - a));
}

// What a triangle's light and mask are looked up in, of its trace textures.
struct Lookup {
    const TraceTexture* image = nullptr;
    std::array<glm::dvec2, 3> corners;  // in texels
};

std::optional<Lookup> lookup(const Scene& scene, const BvhData& bvh, int texture,
                             const std::vector<glm::vec2>& uvs, std::uint32_t triangle) {
    if (texture < 0 || uvs.empty()) return std::nullopt;
    Lookup out{&bvh.textures[texture], {}};
    const glm::uvec3 corner = scene.triangles[triangle];
    const glm::dvec2 size(out.image->width, out.image->height);
    for (int i = 0; i < 3; ++i) out.corners[std::size_t(i)] = glm::dvec2(uvs[corner[i]]) * size;
    return out;
}

double texelsOf(const std::optional<Lookup>& of) {
    if (!of) return 0;
    const glm::dvec2 a = of->corners[1] - of->corners[0], b = of->corners[2] - of->corners[0];
    const double area = 0.5 * std::abs(a.x * b.y - a.y * b.x);
    return std::isfinite(area) ? area : 1;
}

// Of the texels around a triangle's corners and between them one is not black.
bool hasLight(const BvhData& bvh, const Lookup& of) {
    const auto& [a, b, c] = of.corners;
    const glm::dvec2 low = glm::floor(glm::min(a, glm::min(b, c))) - 1.0;
    const glm::dvec2 high = glm::ceil(glm::max(a, glm::max(b, c))) + 1.0;
    const int width = static_cast<int>(of.image->width),
              height = static_cast<int>(of.image->height);
    // Twice the image is all of it, however it is wrapped; so is what is too far away to count.
    const auto range = [](double from, double to, int size) {
        const bool whole = !(std::abs(from) < 1e9 && to - from < 2.0 * size);
        return whole ? std::array{0, 2 * size}
                     : std::array{static_cast<int>(from), static_cast<int>(to)};
    };
    const auto [x0, x1] = range(low.x, high.x, width);
    const auto [y0, y1] = range(low.y, high.y, height);
    for (int y = y0; y < y1; ++y) {
        const int row = bvhWrap(y, height, (of.image->wrap >> 2) & 3u) * width;
        for (int x = x0; x < x1; ++x) {
            const auto at =
                static_cast<std::uint32_t>(row + bvhWrap(x, width, of.image->wrap & 3u));
            if (bvhColourTexel(bvh, of.image->offset + at) & 0xFFFFFFu) return true;
        }
    }
    return false;
}

// Mean emission over a triangle: at a point in each of n * n congruent sub-triangles, of about a
// texel where that is not too many. Where none of them shines though some of it may, half a sample:
// it counts for little, but paths start there.
glm::dvec3 meanEmission(const Scene& scene, const BvhData& bvh, const Material& material,
                        std::uint32_t slot) {
    const BvhTriangle& t = bvh.triangles[slot];
    const std::optional<Lookup> base =
        lookup(scene, bvh, material.baseTexture, scene.uvs, t.triangle);
    const std::optional<Lookup> light =
        material.unlit
            ? base
            : lookup(scene, bvh, material.emissiveTexture, scene.emissiveUvs, t.triangle);
    if (light && !hasLight(bvh, *light)) return glm::dvec3(0);
    const bool masked = (t.material & kMaterialMask) != 0;
    const bool varies = masked || light || (material.unlit && !scene.colors.empty());
    const double texels = std::max(texelsOf(light), masked ? texelsOf(base) : 0);
    const int n =
        varies ? static_cast<int>(std::clamp(std::ceil(std::sqrt(texels)), 4.0, 64.0)) : 1;

    glm::dvec3 sum(0);
    std::uint32_t sample = 0;
    const auto add = [&](int i, int j, bool upper) {
        // At random, since textures repeat as regularly as any lattice.
        const vec4 r = random4(0, t.triangle, 0, sample++);
        const bool folded = r.x + r.y > 1;
        double a = folded ? 1 - r.x : r.x, b = folded ? 1 - r.y : r.y;
        if (upper) a = 1 - a, b = 1 - b;
        const auto u = static_cast<float>((i + a) / n), v = static_cast<float>((j + b) / n);
        if (masked && bvhMaskedOut(bvh, t.triangle, t.material & ~kMaterialMask, u, v)) return;
        const BvhSurface s = bvhSurface(bvh, slot, u, v);
        sum += glm::dvec3(s.emissionR, s.emissionG, s.emissionB);
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
            add(i, j, false);
            if (i + j + 1 < n) add(i, j, true);
        }
    }
    if (sum == glm::dvec3(0)) {
        sum = 0.5 * glm::dvec3(material.unlit ? glm::vec3(material.baseColor) : material.emission);
    }
    return sum / (double(n) * n);
}

// The area of the disc across the scene's bounding sphere.
double discM2(double edgeM, double radiusRoot) {
    return std::numbers::pi * std::pow(radiusRoot * edgeM, 2);
}

LightRecord skyRecord(const Sky& sky, double areaM2) {
    LightRecord r{};
    r.type = kLightSky;
    const auto area = static_cast<float>(areaM2);
    r.fluxR = sky.irradiance.x * area;
    r.fluxG = sky.irradiance.y * area;
    r.fluxB = sky.irradiance.z * area;
    return r;
}

LightRecord record(const PosedLight& posed, const RootCube& root, double radiusRoot,
                   double lightScale) {
    const Light& light = posed.light;
    LightRecord r{};
    const glm::vec3 position = root.rootFromWorld(posed.position);
    const glm::vec3 direction(posed.direction);
    const glm::dvec3 intensity = glm::dvec3(light.intensity) * lightScale;
    r.positionX = position.x;
    r.positionY = position.y;
    r.positionZ = position.z;
    r.directionX = direction.x;
    r.directionY = direction.y;
    r.directionZ = direction.z;
    r.intensityR = static_cast<float>(intensity.x);
    r.intensityG = static_cast<float>(intensity.y);
    r.intensityB = static_cast<float>(intensity.z);
    r.cosInner = 1;
    r.cosOuter = -1;
    double factor = 4 * std::numbers::pi;
    switch (light.type) {
        case LightType::point:
            r.type = kLightPoint;
            break;
        case LightType::spot:
            r.type = kLightSpot;
            r.cosOuter = static_cast<float>(std::cos(light.outerConeRad));
            r.cosInner = std::max(static_cast<float>(std::cos(light.innerConeRad)), r.cosOuter);
            factor = static_cast<double>(spotSolidAngle(r.cosInner, r.cosOuter));
            break;
        case LightType::directional:
            r.type = kLightDirectional;
            factor = discM2(root.edge, radiusRoot);
            break;
    }
    const glm::dvec3 flux = intensity * factor;
    r.fluxR = static_cast<float>(flux.x);
    r.fluxG = static_cast<float>(flux.y);
    r.fluxB = static_cast<float>(flux.z);
    return r;
}

}  // namespace

std::shared_ptr<const EmissiveSurfaces> makeEmissiveSurfaces(const Scene& scene,
                                                             const TriangleBvh& bvh) {
    auto surfaces = std::make_shared<EmissiveSurfaces>();
    std::vector<std::uint32_t> slots;
    for (std::size_t i = 0; i < bvh.triangles.size(); ++i) {
        const std::uint32_t material = bvh.triangles[i].material & ~kMaterialMask;
        if (bvh.isFirst(i) && scene.materials[material].emits()) {
            slots.push_back(static_cast<std::uint32_t>(i));
        }
    }
    surfaces->moves = bvh.moving && !slots.empty() && slots.back() >= bvh.moving->triangle;
    // In the scene's order, whatever the hierarchy's is.
    std::sort(slots.begin(), slots.end(), [&](std::uint32_t a, std::uint32_t b) {
        return bvh.triangles[a].triangle < bvh.triangles[b].triangle;
    });

    const BvhData data = bvh.data();
    const double worldAreaOfRoot = scene.root.edge * scene.root.edge;
    std::vector<glm::dvec3> fluxes(slots.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slots.size()), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const BvhTriangle& t = bvh.triangles[slots[i]];
            const Material& material = scene.materials[t.material & ~kMaterialMask];
            const double sides = material.doubleSided ? 2 : 1;
            fluxes[i] = meanEmission(scene, data, material, slots[i]) *
                        (std::numbers::pi * areaRoot(t) * worldAreaOfRoot * sides);
        }
    });

    glm::dvec3 total(0);
    std::vector<double> weights;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        if (!(weightOf(fluxes[i]) > 0)) continue;
        weights.push_back(weightOf(fluxes[i]));
        total += fluxes[i];
        const double area = areaRoot(bvh.triangles[slots[i]]) * worldAreaOfRoot;
        surfaces->triangles.push_back({slots[i], 0, 0, static_cast<float>(area)});
    }
    surfaces->fluxW = glm::vec3(total);
    const std::vector<float> shares = runningShares(weights);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        surfaces->triangles[i].cumulative = shares[i];
        surfaces->triangles[i].probability = i ? shares[i] - shares[i - 1] : shares[i];
    }
    return surfaces;
}

std::vector<PosedLight> placedLights(const Scene& scene, double timeS, int animation,
                                     const std::vector<LightPlacement>& placements) {
    std::vector<PosedLight> lights = scene.lightsAt(timeS, animation);
    const auto vector = [](const std::array<double, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
    for (const LightPlacement& placement : placements) {
        const auto index = static_cast<std::size_t>(placement.light);
        if (index >= lights.size()) {
            throw Error(ExitCode::usage, "lights: the scene has no light " +
                                             std::to_string(placement.light) + "; it has " +
                                             std::to_string(lights.size()) + ", counted from 0");
        }
        PosedLight& posed = lights[index];
        if (placement.position) posed.position = vector(*placement.position);
        if (placement.direction) posed.direction = glm::normalize(vector(*placement.direction));
        if (placement.intensity) posed.light.intensity = glm::vec3(vector(*placement.intensity));
        if (placement.cone) {
            posed.light.innerConeRad = glm::radians((*placement.cone)[0]);
            posed.light.outerConeRad = glm::radians((*placement.cone)[1]);
        }
    }
    return lights;
}

Emitters makeEmitters(const Scene& scene, const TriangleBvh& bvh,
                      std::shared_ptr<const EmissiveSurfaces> surfaces, const Lighting& lighting,
                      std::shared_ptr<const Sky> before) {
    const double lightScale = lighting.scale;
    Emitters emitters;
    emitters.surfaces = std::move(surfaces);
    emitters.lightScale = static_cast<float>(lightScale);
    if (!bvh.nodes.empty()) {
        emitters.center = bvh.center;
        emitters.radius = std::max(bvh.radius, 1e-6f);
    }

    // Shares of the lights, then of all emissive surfaces together.
    std::vector<double> weights;
    const auto radius = static_cast<double>(emitters.radius);
    const auto add = [&](const LightRecord& r) {
        emitters.lights.push_back(r);
        weights.push_back(weightOf({r.fluxR, r.fluxG, r.fluxB}));
    };
    const std::vector<PosedLight> lights =
        placedLights(scene, lighting.timeS, lighting.animation, lighting.placements);
    for (const PosedLight& posed : lights) {
        const bool gone =
            posed.light.isDefault && replacesPlacedLight(lighting.environment.settings);
        add(record(posed, scene.root, radius, gone ? 0 : lightScale));
    }
    emitters.sky = makeSky(scene, lights, lighting.environment, lightScale, std::move(before));
    if (emitters.sky) {
        add(skyRecord(*emitters.sky, discM2(scene.root.edge, radius)));
        emitters.skyAreaM2 = static_cast<float>(discM2(scene.root.edge, radius));
    }
    const glm::dvec3 surfaceFlux =
        emitters.surfaces ? glm::dvec3(emitters.surfaces->fluxW) * lightScale : glm::dvec3(0);
    weights.push_back(weightOf(surfaceFlux));
    const std::vector<float> shares = runningShares(weights);
    for (std::size_t i = 0; i < emitters.lights.size(); ++i) {
        emitters.lights[i].cumulative = shares[i];
    }
    return emitters;
}

Emitters makeEmitters(const Scene& scene, const TriangleBvh& bvh, const Lighting& lighting) {
    return makeEmitters(scene, bvh, makeEmissiveSurfaces(scene, bvh), lighting);
}

glm::vec3 Emitters::fluxW() const {
    glm::dvec3 sum(0);
    for (const LightRecord& r : lights) sum += glm::dvec3(r.fluxR, r.fluxG, r.fluxB);
    if (surfaces) sum += glm::dvec3(surfaces->fluxW) * static_cast<double>(lightScale);
    return glm::vec3(sum);
}

bool Emitters::empty() const {
    const glm::vec3 flux = fluxW();
    return !(flux.x > 0 || flux.y > 0 || flux.z > 0);
}

VplSetup makeVplSetup(const Emitters& emitters, const VplOptions& options, const ViewGuide* guide) {
    assert(options.count <= (1ull << 31) && options.bounces >= 1);
    constexpr float kSmallestRegion = 1e-4f;  // of the scene: at most 13 discs
    VplSetup s{};
    s.count = static_cast<std::uint32_t>(options.count);
    s.bounces = static_cast<std::uint32_t>(options.bounces);
    s.seed = options.seed;
    s.lightCount = static_cast<std::uint32_t>(emitters.lights.size());
    s.emissionScale = emitters.lightScale;
    s.centerX = emitters.center.x;
    s.centerY = emitters.center.y;
    s.centerZ = emitters.center.z;
    s.radius = emitters.radius;
    if (emitters.sky) s.skyRows = emitters.sky->rows;
    s.skyAreaM2 = emitters.skyAreaM2;
    if (emitters.empty()) return s;  // no path starts: every slot is dead
    if (emitters.lightScale > 0) s.emissiveCount = emitters.emissiveCount();
    if (s.emissiveCount > 0) s.surfaceSlots = (s.count + 3) / 4;
    s.paths = (s.count - s.surfaceSlots + s.bounces - 1) / s.bounces;
    if (guide) {
        s.guideCells = static_cast<std::uint32_t>(guide->cells.size());
        s.guideBits = guide->bits;
        s.regionX = guide->region.x;
        s.regionY = guide->region.y;
        s.regionZ = guide->region.z;
        const float radius = guide->regionRadius;
        s.regionRadius = radius > 0 ? std::max(radius, kSmallestRegion * s.radius) : 0;
    }
    return s;
}

}  // namespace mv
