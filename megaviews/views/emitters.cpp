// Emitters: what shines, how much, and how paths are shared out among it.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

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

// Sub-triangles along a side so that about every texel of the emitting texture is met.
int samplesASide(const Scene& scene, const BvhData& bvh, const Material& material,
                 std::uint32_t triangle) {
    const bool unlitTexture = material.unlit && material.baseTexture >= 0 && !scene.uvs.empty();
    const bool emissiveTexture = material.emissiveTexture >= 0 && !scene.emissiveUvs.empty();
    const bool masked = material.rayCutoff() > 0;
    if (!unlitTexture && !emissiveTexture) return masked || !scene.colors.empty() ? 4 : 1;
    const auto texels = [&](int texture, const std::vector<glm::vec2>& uvs) {
        const TraceTexture& image = bvh.textures[texture];
        const glm::uvec3 corner = scene.triangles[triangle];
        const glm::dvec2 size(image.width, image.height);
        const glm::dvec2 a = glm::dvec2(uvs[corner.y] - uvs[corner.x]) * size;
        const glm::dvec2 b = glm::dvec2(uvs[corner.z] - uvs[corner.x]) * size;
        return 0.5 * std::abs(a.x * b.y - a.y * b.x);
    };
    double count = 0;
    if (unlitTexture) count = texels(material.baseTexture, scene.uvs);
    if (emissiveTexture) {
        count = std::max(count, texels(material.emissiveTexture, scene.emissiveUvs));
    }
    return std::isfinite(count)
               ? static_cast<int>(std::clamp(std::ceil(std::sqrt(count)), 2.0, 64.0))
               : 2;
}

// Mean emission over a triangle: at the centroids of n * n congruent sub-triangles.
glm::dvec3 meanEmission(const BvhData& bvh, std::uint32_t slot, int n) {
    glm::dvec3 sum(0);
    const BvhTriangle& t = bvh.triangles[slot];
    const auto add = [&](double u, double v) {
        const auto uf = static_cast<float>(u / n), vf = static_cast<float>(v / n);
        if ((t.material & kMaterialMask) &&
            bvhMaskedOut(bvh, t.triangle, t.material & ~kMaterialMask, uf, vf)) {
            return;
        }
        const BvhSurface s = bvhSurface(bvh, slot, uf, vf);
        sum += glm::dvec3(s.emissionR, s.emissionG, s.emissionB);
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; i + j < n; ++j) {
            add(i + 1.0 / 3, j + 1.0 / 3);
            if (i + j + 1 < n) add(i + 2.0 / 3, j + 2.0 / 3);
        }
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
            const int n = samplesASide(scene, data, material, t.triangle);
            const double sides = material.doubleSided ? 2 : 1;
            fluxes[i] = meanEmission(data, slots[i], n) *
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
