#include "megaviews/views/view_guide.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "megaviews/views/running_shares.h"
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

constexpr std::uint32_t kDrawPilot = 18;  // `dimension`: sets the pilot's seeds apart

std::uint32_t pilotSeed(std::uint32_t seed, std::uint32_t round) {
    return pcg4d(uvec4(seed, round, 0, kDrawPilot)).x;
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

namespace {

// The pilot's views, path by path: dead where a path has ended.
struct Pilot {
    std::vector<View> views;           // `bounces` of each path
    std::vector<std::uint32_t> cells;  // that each path drew
};
Pilot tracePilot(const TriangleBvh& bvh, const Emitters& emitters, const ViewGuide& guide,
                 int bounces, std::uint32_t seed) {
    // Bounce-0 views on emitters are not the paths' affair.
    VplData vpl;
    vpl.setup = makeVplSetup(emitters, {1, bounces, seed}, &guide);
    vpl.setup.surfaceSlots = 0;
    vpl.setup.paths = kPilotPaths;
    vpl.lights = emitters.lights.data();
    vpl.emissive = emitters.surfaces ? emitters.surfaces->triangles.data() : nullptr;
    vpl.guide = guide.cells.data();
    vpl.sky = emitters.skyTexels();
    const BvhData data = bvh.data();
    const auto each = static_cast<std::size_t>(bounces);
    Pilot pilot{std::vector<View>(kPilotPaths * each, vplDead()),
                std::vector<std::uint32_t>(kPilotPaths)};
    tbb::parallel_for(
        tbb::blocked_range<std::uint32_t>(0, kPilotPaths, 16), [&](const auto& range) {
            for (std::uint32_t path = range.begin(); path < range.end(); ++path) {
                pilot.cells[path] = cellOf(vpl, path);
                glm::vec3 origin, direction, flux;
                vplEmit(vpl, data, path, origin, direction, flux);
                for (int bounce = 1; bounce <= bounces && vplAnyFlux(flux); ++bounce) {
                    View& view = pilot.views[path * each + static_cast<std::size_t>(bounce - 1)];
                    if (!vplBounce(vpl, data, path, static_cast<std::uint32_t>(bounce), 0, origin,
                                   direction, flux, view)) {
                        view = vplDead();
                        break;
                    }
                }
            }
        });
    return pilot;
}

// What the pilot's paths through each cell gave the points.
std::vector<double> worthOf(const Pilot& pilot, const Importance& importance, std::size_t cells) {
    std::vector<float> worth(pilot.views.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, worth.size(), 64), [&](const auto& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            worth[i] = importance.of(pilot.views[i]);
        }
    });
    const std::size_t each = pilot.views.size() / pilot.cells.size();
    std::vector<double> sums(cells);
    for (std::size_t i = 0; i < worth.size(); ++i) {
        sums[pilot.cells[i / each]] += static_cast<double>(worth[i]);
    }
    return sums;
}

// Cells by what they are worth, mixed with those by power.
std::vector<double> guidedShares(const std::vector<double>& worth,
                                 const std::vector<double>& byPower, std::uint32_t bits) {
    std::vector<double> cells = smoothed(worth, bits);
    spreadOverLights(cells, bits);
    const double sum = std::accumulate(cells.begin(), cells.end(), 0.0);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const double guided = (1 - kGuideByPower) * (cells[i] / sum);
        // A light without flux is never chosen.
        cells[i] = byPower[i] > 0 ? guided + kGuideByPower * byPower[i] : 0;
    }
    return cells;
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

}  // namespace

ViewGuide makeViewGuide(const TriangleBvh& bvh, const Emitters& emitters,
                        const ImportanceCamera& camera, int bounces, std::uint32_t seed) {
    ViewGuide guide;
    Importance& importance = guide.importance;
    importance = importanceOf(importancePoints(bvh, camera, seed));
    findRegion(importance.points, guide);
    const std::size_t lights = emitters.lights.size() + (emitters.emissiveCount() > 0 ? 1 : 0);
    if (emitters.empty() || lights == 0 || lights > kMaxGuideCells) return guide;
    guide.bits = kMaxGuideBits;
    while (guide.bits > 0 && (lights << (2 * guide.bits)) > kMaxGuideCells) --guide.bits;

    const std::vector<double> byPower = powerShares(emitters, guide.bits);
    // The pilot's first round tries weak lights as well: they may be all that there is in sight.
    guide.cells = runningShares(halfByLight(byPower, guide.bits));
    for (std::uint32_t round = 0; round < kPilotRounds; ++round) {
        const Pilot pilot = tracePilot(bvh, emitters, guide, bounces, pilotSeed(seed, round));
        const auto alive = std::count_if(pilot.views.begin(), pilot.views.end(),
                                         [](const View& v) { return v.flags != kViewDead; });
        guide.aliveShare = static_cast<float>(static_cast<double>(alive) /
                                              static_cast<double>(pilot.views.size()));
        if (round == 0) importance.places = placesAround(bvh, importance, pilot.views);
        const std::vector<double> worth = worthOf(pilot, importance, byPower.size());
        if (std::all_of(worth.begin(), worth.end(), [](double w) { return !(w > 0); })) {
            guide.cells.clear();
            break;
        }
        guide.cells = runningShares(guidedShares(worth, byPower, guide.bits));
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
    Importance of[] = {importanceOf(before), importanceOf(after)};
    of[1].distance = of[0].distance;
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
