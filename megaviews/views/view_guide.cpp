#include "megaviews/views/view_guide.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "megaviews/views/running_shares.h"
#include "shaders/shared/random.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kPilotPaths = 2048;  // of each of its rounds
constexpr std::uint32_t kPilotRounds = 2;
constexpr std::uint32_t kMaxGuideBits = 5;
constexpr std::uint32_t kMaxGuideCells = 4096;
constexpr double kGuideByPower = 0.5;         // share of the paths that follow power alone
constexpr std::uint32_t kWatchedSlots = 256;  // of importanceChange

// Dimensions of random4: one draws the points, one sets the pilot's seeds apart from the frame's.
constexpr std::uint32_t kDrawPoint = 17;
constexpr std::uint32_t kDrawPilot = 18;

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

// The cell that a path of the pilot drew.
std::uint32_t cellOf(const VplData& vpl, const Emitters& emitters, std::uint32_t bits,
                     std::uint32_t path) {
    const vec4 r = random4(vpl.setup.seed, path, 0, kVplDrawEmit);
    const vec4 more = random4(vpl.setup.seed, path, 0, kVplDrawEmitMore);
    const vec4 turn = random4(vpl.setup.seed, path, 0, kVplDrawEmitDirection);
    if (vpl.setup.guideCells > 0) {
        const float* end = vpl.guide + vpl.setup.guideCells - 1;
        return static_cast<std::uint32_t>(std::upper_bound(vpl.guide, end, r.x) - vpl.guide);
    }
    std::uint32_t light = 0;
    while (light < emitters.lights.size() && r.x >= emitters.lights[light].cumulative) ++light;
    const auto part = [](float u, std::uint32_t partBits) {
        return static_cast<std::uint32_t>(u * static_cast<float>(1u << partBits));
    };
    const std::uint32_t turnBits = bits / 2;
    const bool surface = light >= emitters.lights.size();
    const bool sky = !surface && emitters.lights[light].type == kLightSky;
    const std::uint32_t column = part(surface ? more.x : r.y, bits);
    const std::uint32_t row =
        surface || sky ? part(turn.x, turnBits) + (part(turn.y, bits - turnBits) << turnBits)
                       : part(r.z, bits);
    return (((light << bits) + row) << bits) + column;
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

float importanceOf(const View& view, const std::vector<ImportancePoint>& points) {
    if (view.flags == kViewDead || points.empty()) return 0;
    float sum = 0;
    for (const ImportancePoint& point : points) sum += importanceTerm(view, point);
    return viewLuminance(view) * (sum / static_cast<float>(points.size()));
}

ViewGuide makeViewGuide(const TriangleBvh& bvh, const Emitters& emitters,
                        const ImportanceCamera& camera, int bounces, std::uint32_t seed) {
    ViewGuide guide;
    guide.points = importancePoints(bvh, camera, seed);
    const std::size_t lights = emitters.lights.size() + (emitters.emissiveCount() > 0 ? 1 : 0);
    if (emitters.empty() || lights == 0 || lights > kMaxGuideCells) return guide;
    std::uint32_t bits = kMaxGuideBits;
    while (bits > 0 && (lights << (2 * bits)) > kMaxGuideCells) --bits;

    const std::vector<double> byPower = powerShares(emitters, bits);
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
        std::vector<double> worth(kPilotPaths);
        std::vector<int> alive(kPilotPaths);
        tbb::parallel_for(
            tbb::blocked_range<std::uint32_t>(0, kPilotPaths, 16), [&](const auto& range) {
                for (std::uint32_t path = range.begin(); path < range.end(); ++path) {
                    glm::vec3 origin, direction, flux;
                    vplEmit(vpl, data, path, origin, direction, flux);
                    View view;
                    for (int bounce = 1; bounce <= bounces && vplAnyFlux(flux); ++bounce) {
                        if (!vplBounce(vpl, data, path, static_cast<std::uint32_t>(bounce), 0,
                                       origin, direction, flux, view)) {
                            break;
                        }
                        worth[path] += static_cast<double>(importanceOf(view, guide.points));
                        ++alive[path];
                    }
                }
            });
        std::vector<double> cells(byPower.size(), 0.0);
        double total = 0, views = 0;
        for (std::uint32_t path = 0; path < kPilotPaths; ++path) {
            cells[cellOf(vpl, emitters, bits, path)] += worth[path];
            total += worth[path];
            views += alive[path];
        }
        guide.aliveShare = static_cast<float>(views / (double(kPilotPaths) * bounces));
        if (!(total > 0)) break;
        cells = smoothed(cells, bits);
        double sum = 0;
        for (const double c : cells) sum += c;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const double guided = (1 - kGuideByPower) * (cells[i] / sum);
            // A light without flux is never chosen.
            cells[i] = byPower[i] > 0 ? guided + kGuideByPower * byPower[i] : 0;
        }
        guide.cells = runningShares(cells);
        guide.bits = bits;
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

void thinViews(ViewSet& candidates, const std::vector<ImportancePoint>& points,
               std::uint64_t wantedViews, std::uint32_t seed) {
    const std::vector<View>& views = candidates.views;
    const auto count = static_cast<std::uint32_t>(views.size());
    const std::uint32_t blocks = (count + kImportanceBlock - 1) / kImportanceBlock;
    const auto wanted = static_cast<float>(wantedViews);
    std::vector<float> importance(count);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, 256), [&](const auto& range) {
        for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
            importance[i] = importanceOf(views[i], points);
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
    std::vector<double> a, b;
    double sumA = 0, sumB = 0;
    for (const View& view : watched.views) {
        a.push_back(static_cast<double>(importanceOf(view, before)));
        b.push_back(static_cast<double>(importanceOf(view, after)));
        sumA += a.back();
        sumB += b.back();
    }
    if (!(sumA > 0) || !(sumB > 0)) return sumA > 0 || sumB > 0 ? 1 : 0;
    double change = 0;
    for (std::size_t i = 0; i < a.size(); ++i) change += std::abs(a[i] / sumA - b[i] / sumB);
    return 0.5 * change;
}

}  // namespace mv
