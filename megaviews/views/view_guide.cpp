#include "megaviews/views/view_guide.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "megaviews/views/running_shares.h"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/random.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kPilotPaths = 2048;  // of each of its rounds
constexpr std::uint32_t kPilotRounds = 2;
constexpr std::uint32_t kMaxGuideBits = 5;
constexpr std::uint32_t kMaxGuideCells = 4096;
constexpr double kGuideByPower = 0.5;         // share of the paths that follow power alone
constexpr double kGuideByLight = 0.2;         // of the others, that follow a light's worth
constexpr std::uint32_t kWatchedSlots = 256;  // of importanceChange

// Dimensions of random4: one draws the points, one sets the pilot's seeds apart from the frame's.
constexpr std::uint32_t kDrawPoint = 17;
constexpr std::uint32_t kDrawPilot = 18;
constexpr std::uint32_t kDrawPlace = 19;

std::uint32_t pilotSeed(std::uint32_t seed, std::uint32_t round) {
    return pcg4d(uvec4(seed, round, 0, kDrawPilot)).x;
}

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

// Each cell and its eight neighbours, weighted 1 2 1: a pilot has few paths a cell.
std::vector<double> smoothed(const std::vector<double>& cells, std::uint32_t bits) {
    const int edge = 1 << bits;
    const std::size_t perLight = std::size_t{1} << (2 * bits);
    std::vector<double> out(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const std::size_t light = i / perLight * perLight;
        const int column = static_cast<int>(i % perLight) % edge;
        const int row = static_cast<int>(i % perLight) / edge;
        double sum = 0, weights = 0;
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                if (column + x < 0 || column + x >= edge) continue;
                if (row + y < 0 || row + y >= edge) continue;
                const double weight = (x ? 1 : 2) * (y ? 1 : 2);
                sum +=
                    weight * cells[light + static_cast<std::size_t>((row + y) * edge + column + x)];
                weights += weight;
            }
        }
        out[i] = sum / weights;
    }
    return out;
}

// Half of the shares by power, and half of them the same for each light that has any.
std::vector<double> halfByLight(std::vector<double> shares, std::uint32_t bits) {
    const std::size_t perLight = std::size_t{1} << (2 * bits);
    std::size_t lights = 0;
    for (std::size_t i = 0; i < shares.size(); i += perLight) lights += shares[i] > 0;
    for (double& share : shares) {
        if (share > 0) share = 0.5 * share + 0.5 / static_cast<double>(lights * perLight);
    }
    return shares;
}

// A part of what each light is worth goes to all its cells alike, since few of them were tried.
void spreadOverLights(std::vector<double>& cells, std::uint32_t bits) {
    const std::size_t perLight = std::size_t{1} << (2 * bits);
    for (std::size_t light = 0; light < cells.size(); light += perLight) {
        const auto begin = cells.begin() + static_cast<std::ptrdiff_t>(light);
        const auto end = begin + static_cast<std::ptrdiff_t>(perLight);
        const double mean = std::accumulate(begin, end, 0.0) / static_cast<double>(perLight);
        for (auto cell = begin; cell != end; ++cell) {
            *cell = (1 - kGuideByLight) * *cell + kGuideByLight * mean;
        }
    }
}

// The cell that a path of the pilot drew.
std::uint32_t cellOf(const VplData& vpl, std::uint32_t path) {
    const float u = random4(vpl.setup.seed, path, 0, kVplDrawEmit).x;
    const float* end = vpl.guide + vpl.setup.guideCells - 1;
    return static_cast<std::uint32_t>(std::upper_bound(vpl.guide, end, u) - vpl.guide);
}

// Shares by power: of each light the same for all its cells.
std::vector<double> powerShares(const Emitters& emitters, std::uint32_t bits) {
    std::vector<double> shares;
    const std::size_t perLight = std::size_t{1} << (2 * bits);
    double before = 0;
    for (const LightRecord& light : emitters.lights) {
        const double until = static_cast<double>(light.cumulative);
        shares.insert(shares.end(), perLight, (until - before) / static_cast<double>(perLight));
        before = until;
    }
    if (emitters.emissiveCount() > 0) {
        shares.insert(shares.end(), perLight, (1 - before) / static_cast<double>(perLight));
    }
    return shares;
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
        const std::optional<RayHit> hit =
            bvh.intersect(ray.origin, ray.direction, kNearPlane, kVplFar);
        if (!hit) continue;
        const BvhSurface s = bvh.surface(*hit);
        glm::vec3 normal(s.geometricX, s.geometricY, s.geometricZ);
        if (glm::dot(normal, ray.direction) > 0) normal = -normal;
        points.push_back(
            {s.positionX, s.positionY, s.positionZ, 0, normal.x, normal.y, normal.z, 0});
    }
    return points;
}

float Importance::of(const View& view) const {
    if (view.flags == kViewDead || points.empty()) return 0;
    float sum = 0;
    for (const ImportancePoint& point : points) sum += importanceTerm(view, point, distance);
    const float unoccluded = viewLuminance(view) * (sum / static_cast<float>(points.size()));

    const uint key = mortonKeyOf(vec3(view.positionX, view.positionY, view.positionZ));
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

namespace {

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

// Around most of the points, whichever single ones lie far away.
void findRegion(const std::vector<ImportancePoint>& points, ViewGuide& guide) {
    constexpr double kMost = 0.92;
    constexpr float kAround = 1.3f;
    if (points.empty()) return;
    const auto quantile = [](std::vector<float> values, double share) {
        const auto at = values.begin() +
                        static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return *at;
    };
    std::vector<float> xs, ys, zs, distances;
    for (const ImportancePoint& p : points) {
        xs.push_back(p.positionX);
        ys.push_back(p.positionY);
        zs.push_back(p.positionZ);
    }
    guide.region = {quantile(xs, 0.5), quantile(ys, 0.5), quantile(zs, 0.5)};
    for (const ImportancePoint& p : points) {
        distances.push_back(
            glm::distance(glm::vec3(p.positionX, p.positionY, p.positionZ), guide.region));
    }
    guide.regionRadius = kAround * quantile(distances, kMost);
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

// Where a ray meets a surface, as the place of a view that lights where it came from.
std::optional<View> placeAlong(const TriangleBvh& bvh, glm::vec3 origin, glm::vec3 direction) {
    const std::optional<RayHit> hit = bvh.intersect(origin, direction, kNearPlane, kVplFar);
    if (!hit) return std::nullopt;
    const BvhSurface s = bvh.surface(*hit);
    glm::vec3 normal(s.geometricX, s.geometricY, s.geometricZ);
    if (glm::dot(normal, direction) > 0) normal = -normal;
    return vplAt({s.positionX, s.positionY, s.positionZ}, normal, {1, 1, 1}, 1, 0);
}

// Some of the pilot's views, which lie where light falls, and places that the points themselves
// see: what lights them from near, however little light the pilot found there.
std::vector<ImportancePlace> askedPlaces(const TriangleBvh& bvh, const Importance& importance,
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
            asked[i] =
                ImportancePlace{at.x,           at.y,           at.z,           mortonKeyOf(at),
                                place->normalX, place->normalY, place->normalZ, *visible};
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

}  // namespace

ViewGuide makeViewGuide(const TriangleBvh& bvh, const Emitters& emitters,
                        const ImportanceCamera& camera, int bounces, std::uint32_t seed) {
    ViewGuide guide;
    Importance& importance = guide.importance;
    importance.points = importancePoints(bvh, camera, seed);
    importance.distance = distanceBetween(importance.points);
    findRegion(importance.points, guide);
    const std::size_t lights = emitters.lights.size() + (emitters.emissiveCount() > 0 ? 1 : 0);
    if (emitters.empty() || lights == 0 || lights > kMaxGuideCells) return guide;
    std::uint32_t bits = kMaxGuideBits;
    while (bits > 0 && (lights << (2 * bits)) > kMaxGuideCells) --bits;

    const std::vector<double> byPower = powerShares(emitters, bits);
    // The pilot's first round tries weak lights as well: they may be all that there is in sight.
    guide.cells = runningShares(halfByLight(byPower, bits));
    guide.bits = bits;
    for (std::uint32_t round = 0; round < kPilotRounds; ++round) {
        // Bounce-0 views on emitters are not the paths' affair.
        VplData vpl;
        vpl.setup = makeVplSetup(emitters, {1, bounces, pilotSeed(seed, round)}, &guide);
        vpl.setup.surfaceSlots = 0;
        vpl.setup.paths = kPilotPaths;
        vpl.lights = emitters.lights.data();
        vpl.emissive = emitters.surfaces ? emitters.surfaces->triangles.data() : nullptr;
        vpl.guide = guide.cells.data();
        vpl.sky = emitters.skyTexels();
        const BvhData data = bvh.data();
        const auto each = static_cast<std::size_t>(bounces);
        std::vector<View> views(kPilotPaths * each, vplDead());
        tbb::parallel_for(
            tbb::blocked_range<std::uint32_t>(0, kPilotPaths, 16), [&](const auto& range) {
                for (std::uint32_t path = range.begin(); path < range.end(); ++path) {
                    glm::vec3 origin, direction, flux;
                    vplEmit(vpl, data, path, origin, direction, flux);
                    for (int bounce = 1; bounce <= bounces && vplAnyFlux(flux); ++bounce) {
                        View& view = views[path * each + static_cast<std::size_t>(bounce - 1)];
                        if (!vplBounce(vpl, data, path, static_cast<std::uint32_t>(bounce), 0,
                                       origin, direction, flux, view)) {
                            view = vplDead();
                            break;
                        }
                    }
                }
            });
        if (round == 0) importance.places = askedPlaces(bvh, importance, views);
        std::vector<float> worth(views.size());
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, views.size(), 64),
                          [&](const auto& range) {
                              for (std::size_t i = range.begin(); i < range.end(); ++i) {
                                  worth[i] = importance.of(views[i]);
                              }
                          });
        std::vector<double> cells(byPower.size(), 0.0);
        double total = 0, alive = 0;
        for (std::size_t i = 0; i < views.size(); ++i) {
            const auto path = static_cast<std::uint32_t>(i / each);
            cells[cellOf(vpl, path)] += static_cast<double>(worth[i]);
            total += static_cast<double>(worth[i]);
            alive += views[i].flags != kViewDead;
        }
        guide.aliveShare = static_cast<float>(alive / static_cast<double>(views.size()));
        if (!(total > 0)) {
            guide.cells.clear();
            break;
        }
        cells = smoothed(cells, bits);
        spreadOverLights(cells, bits);
        double sum = 0;
        for (const double c : cells) sum += c;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const double guided = (1 - kGuideByPower) * (cells[i] / sum);
            // A light without flux is never chosen.
            cells[i] = byPower[i] > 0 ? guided + kGuideByPower * byPower[i] : 0;
        }
        guide.cells = runningShares(cells);
    }
    return guide;
}

std::uint64_t candidateCount(const ViewGuide& guide, std::uint64_t wanted) {
    constexpr std::uint64_t kLeast = 4, kMost = 16, kMaxCandidates = 1 << 21;
    const double perView = 2.0 / static_cast<double>(std::max(guide.aliveShare, 0.01f));
    const std::uint64_t each =
        std::clamp(static_cast<std::uint64_t>(std::ceil(perView)), kLeast, kMost);
    return std::max(wanted, std::min(each * wanted, kMaxCandidates));
}

void thinViews(ViewSet& candidates, const Importance& by, std::uint64_t wantedViews,
               std::uint32_t seed) {
    const std::vector<View>& views = candidates.views;
    const auto count = static_cast<std::uint32_t>(views.size());
    const std::uint32_t blocks = (count + kImportanceBlock - 1) / kImportanceBlock;
    const auto wanted = static_cast<float>(wantedViews);
    std::vector<float> importance(count);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, 256), [&](const auto& range) {
        for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
            importance[i] = by.of(views[i]);
        }
    });

    // Sums in the order of the GPU's: views of a block, blocks of a lane, lanes.
    using Sums = glm::vec3;
    const auto summed = [&](const auto& ofView) {
        const std::uint32_t perLane = (blocks + kImportanceLanes - 1) / kImportanceLanes;
        Sums sum(0);
        for (std::uint32_t lane = 0; lane < kImportanceLanes; ++lane) {
            Sums ofLane(0);
            const std::uint32_t end = std::min((lane + 1) * perLane, blocks);
            for (std::uint32_t block = lane * perLane; block < end; ++block) {
                Sums ofBlock(0);
                const std::uint32_t last = std::min((block + 1) * kImportanceBlock, count);
                for (std::uint32_t i = block * kImportanceBlock; i < last; ++i)
                    ofBlock += ofView(i);
                ofLane += ofBlock;
            }
            sum += ofLane;
        }
        return sum;
    };
    const Sums all = summed([&](std::uint32_t i) {
        return Sums(importance[i], viewLuminance(views[i]), views[i].flags != kViewDead ? 1 : 0);
    });
    ImportanceTotals totals{all.x, all.y, all.z, all.z <= wanted ? kInfinity : wanted};
    for (std::uint32_t round = 0; round < kImportanceRounds; ++round) {
        const Sums parts = summed([&](std::uint32_t i) {
            const float weight = candidateWeight(importance[i], viewLuminance(views[i]), totals);
            const bool certain = totals.scale * weight >= 1.0f;
            return Sums(certain ? 1 : 0, certain ? 0 : weight, 0);
        });
        totals.scale = nextScale(wanted, parts.x, parts.y, totals.scale);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        View& view = candidates.views[i];
        const float p =
            keepProbability(candidateWeight(importance[i], viewLuminance(view), totals), totals);
        if (!keepsCandidate(seed, i, view.bounce, p)) {
            view = vplDead();
            continue;
        }
        view.fluxR /= p;
        view.fluxG /= p;
        view.fluxB /= p;
    }
}

double importanceChange(const TriangleBvh& bvh, const Emitters& emitters,
                        const std::vector<ImportancePoint>& before,
                        const std::vector<ImportancePoint>& after, int bounces,
                        std::uint32_t seed) {
    const ViewSet watched = traceVpls(bvh, emitters, {kWatchedSlots, bounces, pilotSeed(seed, 0)});
    const Importance of[] = {{before, {}, distanceBetween(before)},
                             {after, {}, distanceBetween(before)}};
    std::vector<double> a, b;
    double sumA = 0, sumB = 0;
    for (const View& view : watched.views) {
        a.push_back(static_cast<double>(of[0].of(view)));
        b.push_back(static_cast<double>(of[1].of(view)));
        sumA += a.back();
        sumB += b.back();
    }
    if (!(sumA > 0) || !(sumB > 0)) return sumA > 0 || sumB > 0 ? 1 : 0;
    double change = 0;
    for (std::size_t i = 0; i < a.size(); ++i) change += std::abs(a[i] / sumA - b[i] / sumB);
    return 0.5 * change;
}

}  // namespace mv
