#include "megaviews/scene/framing_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "megaviews/scene/builtin_mesh.h"
#include "megaviews/scene/framing.h"
#include "shaders/shared/light.glsl"

namespace mv::framing {
namespace {

constexpr double kLoopS = 40;            // once around
constexpr float kSunShare = 0.03f;       // of the visible surfaces a sun must reach to be chosen
const glm::vec3 kSun(3.3f, 3.1f, 2.8f);  // W/m^2

// Of what does not emit, so much has to get at least that share of the sun's irradiance.
constexpr float kLitEnough = 0.5f, kShareOfSun = 0.05f;
// In a room, where light stays, all surfaces have to get that share of it in the mean: a candle is
// light enough, the dial of a radio is not.
constexpr float kShareInRooms = 5e-5f;

// At most `most` of some things, evenly from first to last.
template <class T>
std::vector<T> spread(const std::vector<T>& all, std::size_t most) {
    if (all.size() <= most) return all;
    std::vector<T> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * all.size() / most]);
    return some;
}

// Points from which the place is seen: the viewer, and free places along its sight and around it.
std::vector<glm::vec3> lookouts(const TriangleBvh& bvh, const Surroundings& s, const Viewer& v) {
    std::vector<glm::vec3> points = {v.position};
    for (const FreePoint& f : s.standing)
        if (clear(bvh, v.position, f.position)) points.push_back(f.position);
    return spread(points, 24);
}

// Share of the surfaces lit by a sun in direction `toSun`, weighted by cosine.
float sunShare(const TriangleBvh& bvh, const std::vector<SurfacePoint>& surfaces, glm::vec3 toSun) {
    float lit = 0;
    for (const SurfacePoint& p : surfaces) {
        float cosine = dot3(p.normal, toSun);
        if (cosine > 0 && !bvh.occluded(p.position, toSun, 0, 4)) lit += std::sqrt(cosine);
    }
    return surfaces.empty() ? 0 : lit / static_cast<float>(surfaces.size());
}

float lampShare(const TriangleBvh& bvh, const std::vector<SurfacePoint>& surfaces, glm::vec3 lamp) {
    float lit = 0;
    for (const SurfacePoint& p : surfaces)
        if (dot3(p.normal, lamp - p.position) > 0 && clear(bvh, p.position, lamp)) ++lit;
    return surfaces.empty() ? 0 : lit / static_cast<float>(surfaces.size());
}

glm::vec3 sunDirection(float azimuth, float elevation) {  // radians; azimuth from +z towards +x
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

void add(Scene& scene, Light light, const builtin::Path& path) {
    light.isDefault = true;
    if (scene.animations.empty()) {
        builtin::addMovingLight(scene, light, kLoopS, path);
        scene.animations.front().name = "default light";
        return;
    }
    // The file moves by itself: the light stays where it is best.
    auto [from, to] = path(0);
    light.node = builtin::addNode(scene, from, to);
    scene.lights.push_back(light);
}

void addSun(Scene& scene, float azimuth, float elevation, const std::string& why) {
    Light sun;
    sun.name = "default sun";
    sun.type = LightType::directional;
    sun.intensity = kSun;
    glm::dvec3 centre = scene.root.worldFromRoot(glm::vec3(0.5f));
    double edge = scene.root.edge;
    add(scene, sun, [=](double turns) {
        auto s = static_cast<float>(builtin::sinTurns(turns));
        auto c = static_cast<float>(builtin::cosTurns(turns));
        glm::dvec3 d(sunDirection(azimuth + 0.4f * s, elevation + 0.1f * (1 - c)));
        return std::pair(centre + d * edge, centre);
    });
    scene.notes.push_back(why +
                          ": a sun was placed above and to the left of the view, under a sky");
}

// How far a beam reaches around the middle of what a sun in its direction lights.
struct BeamWidth {
    float covers;  // share of what is sunlit
    float margin;  // times the distance of the farthest of that share
};
constexpr BeamWidth kThroughRoofs{0.95f, 1.25f};
// The edges of windows are in sight, so none of them is the cone's, although its rays part on their
// way from there, by as much as half.
constexpr BeamWidth kThroughWindows{1, 1.9f};

// Sunlight that falls into an interior: a spot so far away that its rays are nearly parallel, its
// cone just around what a sun in that direction lights. A sun would spend most light paths on the
// outside of the building.
void addSunbeam(Scene& scene, const TriangleBvh& bvh, const std::vector<SurfacePoint>& surfaces,
                BeamWidth width, float azimuth, float elevation, const std::string& why) {
    const glm::vec3 toSun = sunDirection(azimuth, elevation);
    std::vector<glm::vec3> lit;
    glm::vec3 target(0);
    for (const SurfacePoint& p : surfaces) {
        if (dot3(p.normal, toSun) <= 0 || bvh.occluded(p.position, toSun, 0, 4)) continue;
        lit.push_back(p.position);
        target += p.position;
    }
    target /= static_cast<float>(lit.size());
    std::vector<float> reach;  // from the beam's axis
    for (const glm::vec3& p : lit) reach.push_back(length3(cross3(p - target, toSun)));
    const auto covered = reach.begin() + static_cast<std::ptrdiff_t>(
                                             width.covers * static_cast<float>(reach.size() - 1));
    std::nth_element(reach.begin(), covered, reach.end());
    const float radius = std::clamp(width.margin * *covered, 0.02f, 0.7f);

    Light beam;
    beam.name = "default sun";
    beam.type = LightType::spot;
    beam.outerConeRad = std::atan2(radius, static_cast<float>(kBeamDistance));
    beam.innerConeRad = 0.8 * beam.outerConeRad;
    const double distanceM = kBeamDistance * scene.root.edge;
    beam.intensity = kSun * static_cast<float>(distanceM * distanceM);
    const glm::dvec3 aim = scene.root.worldFromRoot(target);
    add(scene, beam, [=](double turns) {
        const auto s = static_cast<float>(builtin::sinTurns(turns));
        const auto c = static_cast<float>(builtin::cosTurns(turns));
        const glm::dvec3 d(sunDirection(azimuth + 0.4f * s, elevation + 0.1f * (1 - c)));
        return std::pair(aim + d * distanceM, aim);
    });
    scene.notes.push_back(why +
                          ": a beam of sunlight was placed where it shines farthest into the "
                          "interior, and a sky around it");
}

struct Lamp {
    glm::vec3 position{0};
    float clearance = 0, roominess = 0, score = -1;
};

Lamp bestLamp(const TriangleBvh& bvh, const Surroundings& s, const Viewer& viewer,
              const std::vector<SurfacePoint>& surfaces) {
    // Heights between eye level and ceiling over every free place that the viewer could walk to.
    std::vector<Lamp> lamps;
    float roomiest = 0;
    for (const FreePoint& f : s.standing) roomiest = std::max(roomiest, f.roominess);
    for (const FreePoint& f : s.standing) {
        if (f.roominess < 0.4f * roomiest) continue;
        float height = f.ceiling - f.floor;
        for (float h : {0.5f, 0.62f, 0.74f, 0.84f}) {
            float y = std::min(f.floor + h * height, f.floor + 4.5f * s.eyeHeight);
            if (y > f.floor + 0.9f * s.eyeHeight)
                lamps.push_back({.position = {f.position.x, y, f.position.z}});
        }
    }
    lamps = spread(lamps, 300);
    lamps.push_back({.position = viewer.position});  // never worse than a torch
    tbb::parallel_for(std::size_t{0}, lamps.size(), [&](std::size_t i) {
        Lamp& lamp = lamps[i];
        FreePoint f = probe(bvh, lamp.position);
        lamp.clearance = f.clearance;
        lamp.roominess = f.roominess;
        if (f.inside > 0.3f) return;
        float room = std::min(1.0f, f.clearance / (0.35f * std::max(f.roominess, 1e-6f)));
        lamp.score = 0.02f + lampShare(bvh, surfaces, lamp.position) * (0.4f + 0.6f * room);
    });
    lamps.back().score *= 0.5f;
    Lamp best;
    for (const Lamp& lamp : lamps)
        if (lamp.score > best.score) best = lamp;
    return best;
}

void addLamp(Scene& scene, const TriangleBvh& bvh, const Lamp& best, const std::string& why) {
    // The largest level loop through the best position whose every point keeps clear.
    auto at = [&](float radius, double turns, int quarter) {
        auto s = static_cast<float>(builtin::sinTurns(turns));
        auto c = static_cast<float>(1 - builtin::cosTurns(turns));
        glm::vec3 along = quarter % 2 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
        glm::vec3 across = quarter % 2 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
        float sign = quarter < 2 ? 1.0f : -1.0f;
        return best.position + sign * radius * (0.5f * c * along + 0.3f * s * across);
    };
    float radius = 0;
    int quarter = 0;
    for (float r = 1.6f * best.roominess; r > 0.02f * best.roominess && radius == 0; r *= 0.8f)
        for (int q = 0; q < 4 && radius == 0; ++q) {
            bool free = true;
            for (int i = 0; i < 32 && free; ++i) {
                glm::vec3 a = at(r, i / 32.0, q), b = at(r, (i + 1) / 32.0, q);
                FreePoint f = probe(bvh, a);
                free = f.clearance > 0.4f * best.clearance && f.inside < 0.35f && clear(bvh, a, b);
            }
            if (free) radius = r, quarter = q;
        }

    Light lamp;
    lamp.name = "default lamp";
    lamp.type = LightType::point;
    auto metres = static_cast<float>(static_cast<double>(best.roominess) * scene.root.edge);
    lamp.intensity = glm::vec3(1, 0.92f, 0.8f) * (4 * std::max(metres * metres, 1e-12f));
    RootCube root = scene.root;
    add(scene, lamp, [&](double turns) {
        glm::dvec3 p = root.worldFromRoot(at(radius, turns, quarter));
        return std::pair(p, p - glm::dvec3(0, root.edge, 0));
    });
    scene.notes.push_back(why + ": a lamp was hung in the room");
}

// ---------------------------------------------------------------- what glows

// Luminance of the radiance at a point, 0 if another surface covers it.
float emissionAt(const TriangleBvh& bvh, const SurfacePoint& point) {
    const auto hit = bvh.intersect(point.position, -point.normal, 0, 2 * kOff);
    if (!hit || hit->triangle != point.triangle) return 0;
    const BvhSurface there = bvh.surface(*hit);
    return luminance({there.emissionR, there.emissionG, there.emissionB});
}

// A point that stands for a part of all emissive surfaces.
struct Glow {
    SurfacePoint point;
    bool twoSided = false;
    float intensity = 0;  // luminance of what it sends along its normal, W/sr a root-cube unit^2
};

// Spread by area and brightness.
std::vector<Glow> glowsOf(const TriangleBvh& bvh, int count = 64) {
    const Scene& scene = *bvh.scene;
    const auto materialOf = [&](std::uint32_t triangle) -> const Material& {
        return scene.materials[scene.triangleMaterials[triangle]];
    };
    const auto brightness = [&](std::uint32_t triangle) {
        const Material& m = materialOf(triangle);
        return m.emits() ? std::max(static_cast<double>(luminance(m.emission)), 1e-3) : 0.0;
    };
    double weight = 0;  // of all area
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        weight += brightness(i) * areaOf(scene, i);
    }
    std::vector<Glow> glows;
    const std::vector<SurfacePoint> points = surfaceSamples(bvh, count, brightness);
    for (const SurfacePoint& point : points) {
        const double area =
            weight / (brightness(point.triangle) * static_cast<double>(points.size()));
        glows.push_back({point, materialOf(point.triangle).doubleSided,
                         emissionAt(bvh, point) * static_cast<float>(area)});
    }
    return glows;
}

// W/m^2.
float irradianceFrom(const TriangleBvh& bvh, const Glow& glow, const SurfacePoint& receiver) {
    glm::vec3 from = glow.point.position, normal = glow.point.normal;
    if (glow.twoSided && dot3(normal, receiver.position - from) < 0) {
        from -= 2 * kOff * normal;
        normal = -normal;
    }
    const glm::vec3 way = from - receiver.position;
    const float cosines =
        std::max(0.0f, dot3(receiver.normal, way)) * std::max(0.0f, -dot3(normal, way));
    if (!(cosines * glow.intensity > 0) || !clear(bvh, receiver.position, from)) return 0;
    const float r2 = dot3(way, way);
    return glow.intensity * cosines / (r2 * r2);
}

// W/m^2 on all surfaces of what they emit, as if none of it got away.
float meanIrradiance(const TriangleBvh& bvh) {
    constexpr int kPoints = 4096;  // textures may be dark but for small parts
    double powerW = 0, area = 0;
    for (const Glow& glow : glowsOf(bvh, kPoints)) powerW += kPi * double{glow.intensity};
    for (std::uint32_t i = 0; i < bvh.scene->triangles.size(); ++i) area += areaOf(*bvh.scene, i);
    return area > 0 ? static_cast<float>(powerW / area) : 0;
}

// ---------------------------------------------------------------- what the file lights

// A point that sends light, towards directions within a cone about its axis.
struct Source {
    glm::vec3 position{0}, axis{0, -1, 0};
    float cosOuter = -1;  // -1: all around
    float intensity = 0;  // luminance along the axis, W/sr
    bool cosine = false;  // it falls off with the cosine: a surface that glows
    float towards(glm::vec3 direction) const {
        const float along = dot3(direction, axis);
        if (cosine) return intensity * std::max(along, 0.0f);
        return along >= cosOuter ? intensity : 0;
    }
};

// Of lamps and of what glows; none if some light comes from far away.
std::vector<Source> sourcesOf(const TriangleBvh& bvh) {
    const Scene& scene = *bvh.scene;
    std::vector<Source> sources;
    for (const PosedLight& posed : scene.lightsAt(0, scene.defaultAnimation())) {
        if (posed.light.type == LightType::directional) return {};
        const bool spot = posed.light.type == LightType::spot;
        sources.push_back(
            {.position = scene.root.rootFromWorld(posed.position),
             .axis = glm::vec3(posed.direction),
             .cosOuter = spot ? static_cast<float>(std::cos(posed.light.outerConeRad)) : -1,
             .intensity = luminance(posed.light.intensity)});
    }
    sources = spread(sources, 64);
    const auto squareMetres = static_cast<float>(scene.root.edge * scene.root.edge);
    for (const Glow& glow : glowsOf(bvh)) {
        const glm::vec3 at = glow.point.position, normal = glow.point.normal;
        const float intensity = glow.intensity * squareMetres;
        const Source front{
            .position = at, .axis = normal, .cosOuter = 0, .intensity = intensity, .cosine = true};
        sources.push_back(front);
        if (!glow.twoSided) continue;
        Source& back = sources.emplace_back(front);
        back.position = at - 2 * kOff * normal;
        back.axis = -normal;
    }
    return sources;
}

// Share of what the sources send that leaves the scene; 1 if they send nothing.
float escapedShare(const TriangleBvh& bvh, const std::vector<Source>& sources) {
    static const std::vector<glm::vec3> directions = sphereDirections(128);
    std::vector<float> all(sources.size()), free(sources.size());
    tbb::parallel_for(std::size_t{0}, sources.size(), [&](std::size_t i) {
        for (const glm::vec3& d : directions) {
            const float sent = sources[i].towards(d);
            all[i] += sent;
            if (sent > 0 && !bvh.occluded(sources[i].position, d, 0, 4)) free[i] += sent;
        }
    });
    const float sent = std::accumulate(all.begin(), all.end(), 0.0f);
    return sent > 0 ? std::accumulate(free.begin(), free.end(), 0.0f) / sent : 1;
}

}  // namespace

std::vector<SurfacePoint> litSurfaces(const TriangleBvh& bvh,
                                      const std::vector<SurfacePoint>& points) {
    const Scene& scene = *bvh.scene;
    const auto lights = spread(scene.lightsAt(0, scene.defaultAnimation()), 16);
    const auto isLit = [&](const SurfacePoint& p) {
        return std::any_of(lights.begin(), lights.end(), [&](const PosedLight& light) {
            const bool far = light.light.type == LightType::directional;
            const glm::vec3 way = far ? -4.0f * glm::vec3(light.direction)
                                      : scene.root.rootFromWorld(light.position) - p.position;
            return dot3(way, p.normal) > 0 && !bvh.occluded(p.position, way, 0, 1);
        });
    };
    std::vector<SurfacePoint> lit;
    std::copy_if(points.begin(), points.end(), std::back_inserter(lit), isLit);
    return lit;
}

bool isLitWithin(const TriangleBvh& bvh, Surroundings& s) {
    constexpr float kEscapes = 0.1f, kDim = 0.02f;
    if (!s.hasRooms()) return false;  // a car's lamps
    const std::vector<Source> sources = sourcesOf(bvh);
    if (escapedShare(bvh, sources) > kEscapes) return false;
    // Rooms that they light, not those beside.
    std::vector<float> light(s.standing.size());
    tbb::parallel_for(std::size_t{0}, light.size(), [&](std::size_t i) {
        for (const Source& source : sources) {
            const glm::vec3 way = s.standing[i].position - source.position;
            const float distance = std::max(length3(way), s.eyeHeight);
            const float sent = source.towards(normalizeOr(way, source.axis));
            if (sent > 0 && clear(bvh, source.position, s.standing[i].position)) {
                light[i] += sent / (distance * distance);
            }
        }
    });
    const float most = *std::max_element(light.begin(), light.end());
    std::vector<FreePoint> lit;
    for (std::size_t i = 0; i < light.size(); ++i) {
        if (light[i] > kDim * most) lit.push_back(s.standing[i]);
    }
    if (!lit.empty()) s.standing = std::move(lit);  // else they are in shades
    return true;
}

bool lightReaches(const TriangleBvh& bvh, const Surroundings& s) {
    std::vector<glm::vec3> places;
    for (const FreePoint& place : spread(s.standing, 24)) places.push_back(place.position);
    const std::vector<SurfacePoint> seen = visibleSurfaces(bvh, places, 64);
    if (!litSurfaces(bvh, seen).empty()) return true;
    const std::vector<Glow> glows = glowsOf(bvh);
    if (glows.empty()) return bvh.scene->lights.empty();
    return std::any_of(seen.begin(), seen.end(), [&](const SurfacePoint& p) {
        return std::any_of(glows.begin(), glows.end(),
                           [&](const Glow& glow) { return irradianceFrom(bvh, glow, p) > 0; });
    });
}

bool emissionLights(const TriangleBvh& bvh, const Surroundings& s,
                    const std::optional<Viewer>& viewer) {
    if (s.interior) return meanIrradiance(bvh) >= kShareInRooms * luminance(kSun);
    constexpr float kDark = 0.01f;  // of textures, which say dark where they mean black
    std::vector<SurfacePoint> points =
        viewer ? spread(surfacesInView(bvh, *viewer), 512) : surfaceSamples(bvh, 512);
    std::erase_if(points, [&](const SurfacePoint& p) { return emissionAt(bvh, p) > kDark; });
    if (points.empty()) return true;
    const std::vector<Glow> glows = glowsOf(bvh);
    std::vector<char> lit(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        float sum = 0;
        for (const Glow& glow : glows) sum += irradianceFrom(bvh, glow, points[i]);
        lit[i] = sum > kShareOfSun * luminance(kSun);
    });
    const auto count = static_cast<float>(std::count(lit.begin(), lit.end(), 1));
    return count >= kLitEnough * static_cast<float>(points.size());
}

void placeLight(Scene& scene, const TriangleBvh& bvh, const Surroundings& s, const Viewer& viewer,
                const std::string& why) {
    if (s.interior) {
        const std::vector<glm::vec3> places = lookouts(bvh, s, viewer);
        const std::vector<SurfacePoint> around = spread(visibleSurfaces(bvh, places, 64), 500);
        // For the sun what is in view counts too: it need not stand against the viewer.
        const std::vector<SurfacePoint> inView = spread(surfacesInView(bvh, viewer), 400);
        std::vector<SurfacePoint> surfaces = around;
        surfaces.insert(surfaces.end(), inView.begin(), inView.end());
        // Through open roofs and windows the sun may reach far enough.
        struct Direction {
            float azimuth, elevation, share, score;
        };
        // A low one reaches in where only windows let it. Few points are in what comes through
        // them, so more are asked how wide that is.
        for (const bool isLow : {false, true}) {
            const float lowestDeg = isLow ? 15 : 35;
            std::vector<Direction> directions;
            for (int e = 0; e < 5; ++e)
                for (int a = 0; a < 24; ++a)
                    directions.push_back({static_cast<float>(a) * kPi / 12,
                                          (lowestDeg + 10 * static_cast<float>(e)) * kPi / 180, 0,
                                          0});
            tbb::parallel_for(std::size_t{0}, directions.size(), [&](std::size_t i) {
                Direction& d = directions[i];
                glm::vec3 toSun = sunDirection(d.azimuth, d.elevation);
                d.share = sunShare(bvh, surfaces, toSun);
                // Rather low than overhead; and a picture that is mostly sunlit shows no shade.
                float glare = std::max(0.0f, sunShare(bvh, inView, toSun) - 0.12f);
                d.score = (d.share - 1.5f * glare) * (1.6f - toSun.y * toSun.y);
            });
            auto best = std::max_element(
                directions.begin(), directions.end(),
                [](const Direction& a, const Direction& b) { return a.score < b.score; });
            if (best->share < kSunShare) continue;
            if (isLow) {
                const std::vector<SurfacePoint> more = visibleSurfaces(bvh, places, 1024);
                surfaces.insert(surfaces.end(), more.begin(), more.end());
            }
            addSunbeam(scene, bvh, surfaces, isLow ? kThroughWindows : kThroughRoofs, best->azimuth,
                       best->elevation, why);
            return;
        }
        Lamp lamp = bestLamp(bvh, s, viewer, around);
        if (lamp.score > 0) {
            addLamp(scene, bvh, lamp, why);
            return;
        }
    }
    // From above, left of the viewer and a little behind.
    glm::vec3 back = -viewer.forward;
    float azimuth = std::atan2(back.x, back.z) - 0.7f;
    addSun(scene, azimuth, 0.85f, why);
}

}  // namespace mv::framing
