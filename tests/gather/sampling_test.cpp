// Sampling by power in integers: ranges partition the units exactly, every view is picked as often
// as it has units, and the estimate's mean is the full sum.

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

#include "gather/random_views.h"
#include "megaviews/gather/gather.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
namespace {

using test::Rng;

TEST(MulHigh, IsTheHighWord) {
    EXPECT_EQ(mulHigh(0xFFFFFFFFu, 0xFFFFFFFFu), 0xFFFFFFFEu);
    EXPECT_EQ(mulHigh(0x80000000u, 2u), 1u);
    EXPECT_EQ(mulHigh(0xFFFFFFFFu, 1u), 0u);
}

TEST(Strata, PartitionTheUnits) {
    Rng rng(1);
    for (int i = 0; i < 2000; ++i) {
        const uint total = i % 3 ? static_cast<uint>(rng()) : static_cast<uint>(rng() % 50);
        const uint count = 1 + static_cast<uint>(rng() % (i % 2 ? 8 : 65535));
        EXPECT_EQ(stratumBegin(total, count, 0), 0u);
        EXPECT_EQ(stratumBegin(total, count, count), total) << total << " / " << count;
        for (uint s = 0; s < std::min(count, 50u); ++s) {
            const uint width = stratumBegin(total, count, s + 1) - stratumBegin(total, count, s);
            EXPECT_TRUE(width == total / count || width == total / count + 1)
                << total << " / " << count << " stratum " << s;
        }
    }
}

TEST(Power, UnitsFitAndNoLightIsForgotten) {
    EXPECT_EQ(gatherPower(vec3(0)), 0);
    EXPECT_EQ(gatherPower(vec3(std::nanf(""), 1, 1)), 0);
    EXPECT_EQ(powerUnits(0, 1, 1), 0u);
    EXPECT_EQ(powerUnits(1e-20f, 1, 1u << 30), 1u);
    EXPECT_EQ(powerUnits(1, 1, 1), 0x40000001u);
    EXPECT_EQ(powerUnits(1, 4, 4), 0x10000001u);  // as much as the mean
    EXPECT_EQ(powerUnits(2, 4, 4), 0x18000001u);
    for (const std::size_t count : {1u, 2u, 1000u, 300000u}) {
        std::vector<View> views = test::roomViews(count, 7);
        views[count / 2].fluxR = 1e9f;
        if (count > 2) views[1].fluxR = views[1].fluxG = views[1].fluxB = 0;
        const auto prefix = powerPrefix(views);
        ASSERT_EQ(prefix.size(), count + 1);
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_LE(prefix[i], prefix[i + 1]) << "overflow at view " << i << " of " << count;
            sum += prefix[i + 1] - prefix[i];
            EXPECT_EQ(prefix[i + 1] == prefix[i], views[i].fluxR == 0 && views[i].fluxG == 0) << i;
        }
        EXPECT_EQ(sum, prefix.back());
        EXPECT_GT(sum, 0x3FF00000u);
        EXPECT_LT(sum, 1u << kPowerUnitBits);
    }
    EXPECT_EQ(powerPrefix({}), std::vector<std::uint32_t>{0});
}

// Whatever power and importance: exact where it fits, and else in as few words as it takes.
TEST(Lists, FitThirtyTwoBits) {
    Rng rng(4);
    for (int i = 0; i < 2000; ++i) {
        struct Part {
            uint power, shift;
        };
        std::vector<Part> parts(1 + rng() % 512);
        std::uint64_t left = (1u << kPowerUnitBits) - 1, sum = 0;
        float roundedSum = 0;
        for (Part& p : parts) {
            p.power = static_cast<uint>(std::min<std::uint64_t>(left, rng() >> (rng() % 32 + 1)));
            p.shift = static_cast<uint>(rng()) % (kMaxImportanceShift + 1);
            left -= p.power;
            sum += std::uint64_t{p.power} << p.shift;
            roundedSum += static_cast<float>(p.power) * static_cast<float>(1u << p.shift);
        }
        std::uint64_t units = 0;
        for (const Part& p : parts) {
            const uint scale = listScale(p.shift, roundedSum);
            ASSERT_LE(scale, 2 * kMaxImportanceShift);
            const uint own = listUnits(p.power, scale);
            units += own;
            if (own == 0) continue;
            // All of the run's power lies in its units, and the last of them has some of it.
            EXPECT_EQ(powerAtUnit(0, 0, scale), 0u);
            EXPECT_LT(powerAtUnit(own - 1, 0, scale), p.power);
            EXPECT_GE(powerAtUnit(own - 1, 0xFFFFFFFFu, scale), p.power - 1);
            EXPECT_GE(double{powerOfListUnit(scale)} * own, p.power);
        }
        if (sum < (1u << 30)) {
            EXPECT_EQ(units, sum);
        } else {
            EXPECT_GE(units, (1u << 30) - 512u);
        }
        EXPECT_LE(units, (1u << 31) + 512u);
    }
}

// Picks every unit once: each view must be picked as often as it owns units, kept ones only.
TEST(PickView, FollowsTheUnitsExactly) {
    const ViewHierarchy h = ViewHierarchy::build(test::roomViews(200, 11), {});
    std::vector<std::uint32_t> prefix(h.sortedViews.size() + 1, 0);
    Rng rng(2);
    for (std::size_t i = 0; i < h.sortedViews.size(); ++i) {
        prefix[i + 1] = prefix[i] + static_cast<std::uint32_t>(rng() % 5);  // some own nothing
    }
    ReceiverBounds receiver;
    receiver.center = {0.3f, 0.1f, 0.5f};
    receiver.axis = {0, 1, 0};
    receiver.cosCone = 1;
    for (const int level : {0, 2, 4, 6, 10}) {
        const std::vector<std::uint32_t> nodes = keptViewNodes(receiver, h, level);
        const KeptViews kept = keptRuns(receiver, nodes, h, prefix);
        std::vector<std::uint32_t> expected(h.sortedViews.size(), 0), picked = expected;
        std::set<uint> shifts;
        for (const std::uint32_t n : nodes) {
            const uint shift = importanceShift(h.nodes[n], receiver.center, receiver.half,
                                               receiver.axis, receiver.cosCone, receiver.sinCone);
            ASSERT_LE(shift, kMaxImportanceShift);
            shifts.insert(shift);
            for (std::uint32_t v = 0; v < h.nodes[n].viewCount; ++v) {
                const std::uint32_t view = h.nodes[n].firstView + v;
                expected[view] = (prefix[view + 1] - prefix[view]) << shift;
            }
        }
        if (level > 2) {
            EXPECT_GT(shifts.size(), 3u);
        }
        for (std::uint32_t unit = 0; unit < kept.units; ++unit) {
            const PickedView p = pickView(kept, prefix, unit);
            ++picked[p.view];
            EXPECT_EQ(p.units, expected[p.view]);
        }
        EXPECT_EQ(picked, expected) << "level " << level;
        EXPECT_LE(kept.runs.size(), nodes.size());
    }
}

// Where a unit of the list is several of power, places within units tell them apart.
TEST(PickView, FollowsPowerWithinUnits) {
    const ViewHierarchy h = ViewHierarchy::build(test::roomViews(20000, 12), {});
    const auto prefix = powerPrefix(h.sortedViews);
    const View& near = h.sortedViews[7000];
    ReceiverBounds receiver;  // of every direction
    receiver.center = glm::vec3(near.positionX, near.positionY, near.positionZ) +
                      0.01f * glm::vec3(near.normalX, near.normalY, near.normalZ);
    const KeptViews kept = keptRuns(receiver, keptViewNodes(receiver, h, 6), h, prefix);
    std::set<uint> scales;
    for (const ViewRun& run : kept.runs) scales.insert(run.scale);
    ASSERT_LT(*scales.begin(), kMaxImportanceShift);  // several of power
    // As often as their units say, in sixteenths of all views along the curve.
    std::vector<double> expected(16, 0), picked(16, 0);
    const auto part = [&](std::uint32_t view) { return view * 16 / h.sortedViews.size(); };
    double all = 0;
    for (const ViewRun& run : kept.runs) {
        for (std::uint32_t v = run.first; v < run.end; ++v) {
            const double units = (prefix[v + 1] - prefix[v]) / double{powerOfListUnit(run.scale)};
            expected[part(v)] += units;
            all += units;
        }
    }
    EXPECT_NEAR(all, kept.units, 1e-6 * kept.units);
    Rng rng(13);
    constexpr int kPicks = 200000;
    for (int i = 0; i < kPicks; ++i) {
        const uint unit = mulHigh(static_cast<uint>(rng()), kept.units);
        const PickedView p = pickView(kept, prefix, unit, static_cast<uint>(rng()));
        if (p.view != kNone) picked[part(p.view)] += 1;
    }
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const double want = expected[i] / all * kPicks;
        EXPECT_NEAR(picked[i], want, 5 * std::sqrt(want) + 1) << "part " << i;
    }
}

TEST(PickView, APartOfTheLastUnitMayBeNobodys) {
    // 64 views of 1000 units of power, of which a unit of the list is 8192.
    std::vector<std::uint32_t> prefix;
    for (std::uint32_t i = 0; i <= 64; ++i) prefix.push_back(1000 * i);
    KeptViews kept;
    kept.views = 64;
    kept.units = listUnits(prefix.back(), 0);
    kept.runs.push_back({0, 0, 64, 0});
    ASSERT_EQ(kept.units, 8u);
    EXPECT_EQ(pickView(kept, prefix, 0, 0).view, 0u);
    EXPECT_EQ(pickView(kept, prefix, 0, 0xFFFFFFFFu).view, 8u);
    EXPECT_EQ(pickView(kept, prefix, 1, 0).view, 8u);
    EXPECT_EQ(pickView(kept, prefix, 7, 0).view, 57u);
    EXPECT_EQ(pickView(kept, prefix, 7, 0xC0000000u).view, 63u);
    EXPECT_EQ(pickView(kept, prefix, 7, 0xFFFFFFFFu).view, kNone);
    EXPECT_NEAR(pickView(kept, prefix, 3, 0).units, 1000.0 / 8192, 1e-9);
}

TEST(RunSearchTable, CutsUnitsIntoFewRanges) {
    Rng rng(3);
    for (int i = 0; i < 20000; ++i) {
        const uint units =
            i < 300 ? static_cast<uint>(i) : static_cast<uint>(rng()) >> (rng() % 32);
        const uint shift = runSearchShift(units);
        EXPECT_LT(units >> shift, kRunSearchSlots) << units;
        if (units >= kRunSearchSlots) {
            EXPECT_GE(units >> shift, kRunSearchSlots / 2) << units;
        } else {
            EXPECT_EQ(shift, 0u) << units;
        }
    }
}

TEST(SampleOffset, BlocksShareStrataEvenly) {
    // The 16 ranks of a block are all different, and so are those of every 2 x 2 quarter's quarter.
    std::vector<bool> seen(16, false);
    for (uint y = 0; y < 4; ++y) {
        for (uint x = 0; x < 4; ++x) seen[blockRank(x, y)] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 16);
    for (uint y = 0; y < 4; y += 2) {
        for (uint x = 0; x < 4; x += 2) {
            unsigned quarters = 0;
            for (uint k = 0; k < 4; ++k) quarters |= 1u << (blockRank(x + k % 2, y + k / 2) / 4);
            EXPECT_EQ(quarters, 15u);
        }
    }
    // Those of a tile's pixels too, and its 4 x 4 blocks have a quarter of each sixteenth.
    std::vector<bool> inTile(kTileEdge * kTileEdge, false);
    for (uint y = 0; y < kTileEdge; ++y) {
        for (uint x = 0; x < kTileEdge; ++x) {
            inTile[tileRank(x, y)] = true;
            EXPECT_EQ(tileRank(x, y) >> 2u, blockRank(x, y));
            EXPECT_EQ(tileRank(x + kTileEdge, y + 3 * kTileEdge), tileRank(x, y));
        }
    }
    EXPECT_EQ(std::count(inTile.begin(), inTile.end(), true), kTileEdge * kTileEdge);
    // Numbers of one block fall into 16 different sixteenths, relative to one of them, and the
    // draws of a tile's ranks into as many as there are; the draws of a block of tiles are
    // sixteenths of these apart.
    constexpr uint kRankShift = 32 - kDrawRankBits;
    std::vector<uint> pixels, ranks, tiles;
    for (uint i = 0; i < 16; ++i) {
        pixels.push_back(sampleOffset(5, 8 + i % 4, 12 + i / 4, 3, 0) -
                         (blockRank(i % 4, i / 4) << 28u));
        ranks.push_back(drawOffset(5, 6, 2, 3, 4 * i + 1, 0) - ((4 * i + 1) << kRankShift));
        tiles.push_back(drawOffset(5, 8 + i % 4, 12 + i / 4, 3, 7, 0) -
                        (blockRank(i % 4, i / 4) << (kRankShift - 4)));
    }
    for (uint i = 0; i < 16; ++i) {
        EXPECT_LT(std::abs(static_cast<int>(pixels[i] - pixels[0])), 1 << 28);
        EXPECT_LT(std::abs(static_cast<int>(ranks[i] - ranks[0])), 1 << (kRankShift - 4));
        EXPECT_LT(std::abs(static_cast<int>(tiles[i] - tiles[0])), 1 << (kRankShift - 4));
    }
}

TEST(SampleOffset, IsUniformForEachPixel) {
    // Chi-square over 64 bins, 64000 seeds: 63 degrees of freedom, below 130 in all but 1e-6.
    for (const uint pixel : {0u, 1u, 5u, 15u}) {
        std::vector<int> bins(64, 0), drawn = bins;
        for (uint seed = 0; seed < 64000; ++seed) {
            const uint x = 40 + pixel % 4, y = 20 + pixel / 4;
            ++bins[sampleOffset(seed, x, y, 1, 0) >> 26u];
            ++drawn[drawOffset(seed, x, y, 1, pixel, 0) >> 26u];
        }
        double chi2 = 0, chi2Drawn = 0;
        for (std::size_t b = 0; b < 64; ++b) {
            chi2 += (bins[b] - 1000.0) * (bins[b] - 1000.0) / 1000.0;
            chi2Drawn += (drawn[b] - 1000.0) * (drawn[b] - 1000.0) / 1000.0;
        }
        EXPECT_LT(chi2, 130) << "pixel " << pixel;
        EXPECT_LT(chi2Drawn, 130) << "rank " << pixel;
    }
}

TEST(Candidates, AreDifferentRanksAndTheFirstIsThePixelsOwn) {
    for (uint candidates = 1; candidates <= kDrawRanks; ++candidates) {
        std::set<uint> first;
        for (uint pixel = 0; pixel < kTileEdge * kTileEdge; ++pixel) {
            std::set<uint> ranks;
            const uint swaps = rankSwaps(pixel);
            for (uint j = 0; j < candidates; ++j) {
                ranks.insert(candidateRank(pixel, swaps, j, candidates));
            }
            EXPECT_EQ(ranks.size(), candidates);
            EXPECT_LT(*ranks.rbegin(), kDrawRanks);
            first.insert(candidateRank(pixel, swaps, 0, candidates));
        }
        EXPECT_EQ(first.size(), kTileEdge * kTileEdge);
    }
}

// Neighbours that weigh the same err together, and the filter shows it as a block.
TEST(Candidates, OfTwoPixelsAQuarterIsTheSameAtMost) {
    constexpr uint kCandidates = 32;
    std::vector<std::set<uint>> of(kTileEdge * kTileEdge);
    for (uint rank = 0; rank < of.size(); ++rank) {
        for (uint j = 0; j < kCandidates; ++j) {
            of[rank].insert(candidateRank(rank, rankSwaps(rank), j, kCandidates));
        }
    }
    std::set<uint> ofAny;
    for (std::size_t a = 0; a < of.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            const auto common = std::count_if(of[a].begin(), of[a].end(),
                                              [&](uint rank) { return of[b].contains(rank); });
            EXPECT_LE(common, kCandidates / 4) << a << " " << b;
        }
        ofAny.insert(of[a].begin(), of[a].end());
    }
    EXPECT_EQ(ofAny.size(), kDrawRanks);
}

// By their weights, and what is left of the number is uniform whatever was chosen.
TEST(Choice, FollowsTheWeights) {
    const std::vector<float> weights = {0, 1, 0.5f, 0, 4, 2.5f, -1, std::nanf("")};
    constexpr int kNumbers = 80000;
    std::vector<int> chosen(weights.size(), 0), low = chosen;
    for (int i = 0; i < kNumbers; ++i) {
        Choice c = noChoice((static_cast<float>(i) + 0.5f) / kNumbers);
        for (uint k = 0; k < weights.size(); ++k) c = withCandidate(c, k, weights[k]);
        ASSERT_LT(c.chosen, weights.size());
        EXPECT_FLOAT_EQ(c.total, 8);
        EXPECT_EQ(c.weight, weights[c.chosen]);
        ++chosen[c.chosen];
        low[c.chosen] += c.number < 0.25f;
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const double want = weights[k] > 0 ? double{weights[k]} / 8 * kNumbers : 0;
        EXPECT_NEAR(chosen[k], want, 3) << k;
        EXPECT_NEAR(low[k], want / 4, 3) << k;
    }
    EXPECT_EQ(withCandidate(noChoice(0.5f), 3, 0).chosen, kNone);
}

// Each group takes as many samples as its share of the weights, rounded down or up, and over all
// numbers in the mean; together they take all.
TEST(Resampling, GroupsTakeSamplesByTheirWeights) {
    const std::vector<float> weights = {0, 1, 0.5f, 0, 4, 2.5f, 1e-6f, 0};
    const float total = std::accumulate(weights.begin(), weights.end(), 0.0f);
    constexpr uint kSamples = 8;
    constexpr int kNumbers = 4000;
    std::vector<double> mean(weights.size(), 0);
    for (int i = 0; i < kNumbers; ++i) {
        const float number = (static_cast<float>(i) + 0.5f) / kNumbers;
        float before = 0;
        uint taken = 0;
        for (std::size_t k = 0; k < weights.size(); ++k) {
            before += weights[k];
            const uint upTo = samplesUpTo(before, total, kSamples, number);
            ASSERT_GE(upTo, taken);
            ASSERT_LT(std::abs(static_cast<float>(upTo - taken) - weights[k] / total * kSamples),
                      1.001f);
            mean[k] += static_cast<double>(upTo - taken) / kNumbers;
            taken = upTo;
        }
        ASSERT_EQ(taken, kSamples);
    }
    for (std::size_t k = 0; k < weights.size(); ++k) {
        EXPECT_NEAR(mean[k], double{weights[k]} / double{total} * kSamples, 1e-3) << k;
    }
    for (const float nothing : {0.0f, std::nanf(""), kInfinity}) {
        EXPECT_EQ(samplesUpTo(nothing, nothing, kSamples, 0.5f), 0u);
    }
    // The groups of a stratum hold each of its candidates once.
    for (uint candidates = 1; candidates <= kDrawRanks; ++candidates) {
        uint begin = 0;
        for (uint group = 0; group < candidateGroups(candidates); ++group) {
            EXPECT_GT(groupEnd(group, candidates), begin);
            begin = groupEnd(group, candidates);
        }
        EXPECT_EQ(begin, candidates);
    }
}

struct Estimate {
    double mean, sigma;  // of the mean
};
Estimate estimate(const Receiver& receiver, const KeptViews& kept,
                  const std::vector<std::uint32_t>& prefix, const ViewHierarchy& h, uint samples,
                  uint count, uint candidates = 1) {
    double sum = 0, squares = 0;
    for (uint seed = 0; seed < count; ++seed) {
        const double e =
            gatherSampled(
                receiver, kept, prefix, h, nullptr, {},
                {.samples = samples, .seed = seed, .x = seed % 7, .y = 3, .candidates = candidates})
                .y;
        sum += e;
        squares += e * e;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

TEST(GatherSampled, MeanIsTheFullSum) {
    for (const unsigned scene : {1u, 2u, 3u}) {
        const ViewHierarchy h = ViewHierarchy::build(test::roomViews(1000, scene, 0.1), {});
        const auto prefix = powerPrefix(h.sortedViews);
        ReceiverBounds bounds;
        bounds.center = {0.4f, 0.1f, 0.45f};
        bounds.half = {0.02f, 0, 0.02f};
        bounds.axis = {0, 1, 0};
        bounds.cosCone = 1;
        const KeptViews kept = keptRuns(bounds, keptViewNodes(bounds, h, 6), h, prefix);
        ASSERT_LT(kept.views, 900u);
        const Receiver receiver{bounds.center, bounds.axis};
        const double full = gatherAll(receiver, h, nullptr, {}).y;
        for (const uint samples : {1u, 3u, 8u, 64u}) {
            for (const uint candidates : {1u, 5u, 16u}) {
                const Estimate e =
                    estimate(receiver, kept, prefix, h, samples, 20000 / candidates, candidates);
                EXPECT_NEAR(e.mean, full, 4.5 * e.sigma)
                    << samples << " samples of " << candidates << ", scene " << scene;
                EXPECT_LT(e.sigma, 0.1 * full);
                EXPECT_GT(e.sigma, 0);
            }
        }
        EXPECT_DOUBLE_EQ(gatherSampled(receiver, kept, prefix, h, nullptr, {}, {.samples = 0}).y,
                         full);
        EXPECT_DOUBLE_EQ(
            gatherSampled(receiver, kept, prefix, h, nullptr, {}, {.samples = kept.views}).y, full);
    }
}

// Culling takes views away that give nothing; importance finds those that give much, and candidates
// those that give this pixel much.
TEST(GatherSampled, CullingAndImportanceLowerTheVariance) {
    Rng rng(5);
    double all = 0, culled = 0, important = 0, weighed = 0;
    for (unsigned scene = 0; scene < 16; ++scene) {
        const ViewHierarchy h = ViewHierarchy::build(test::roomViews(2000, scene), {});
        const auto prefix = powerPrefix(h.sortedViews);
        ReceiverBounds bounds;
        bounds.center = test::point(rng, 0.2f, 0.8f);
        bounds.half = vec3(0.01f);
        bounds.axis = test::direction(rng);
        bounds.cosCone = 1;
        const Receiver receiver{bounds.center, bounds.axis};
        const KeptViews kept = keptRuns(bounds, keptViewNodes(bounds, h, 6), h, prefix);
        KeptViews byPower = kept;
        byPower.units = 0;
        for (ViewRun& run : byPower.runs) {
            run.unitsBefore = byPower.units;
            run.scale = kMaxImportanceShift;
            byPower.units += prefix[run.end] - prefix[run.first];
        }
        const auto relative = [&](const KeptViews& views, uint candidates = 1) {
            const Estimate e = estimate(receiver, views, prefix, h, 8, 1000, candidates);
            return e.sigma / e.mean;
        };
        all += relative(allRuns(prefix));
        culled += relative(byPower);
        important += relative(kept);
        weighed += relative(kept, 16);
    }
    EXPECT_LT(culled, 0.85 * all);
    EXPECT_LT(important, 0.65 * culled);
    EXPECT_LT(weighed, 0.6 * important);
}

TEST(GatherSampled, DegenerateViewSets) {
    const Receiver receiver{{0.5f, 0.5f, 0.5f}, {0, 1, 0}};
    const ViewHierarchy none = ViewHierarchy::build({}, {});
    EXPECT_EQ(gatherSampled(receiver, {}, powerPrefix({}), none, nullptr, {}, {.samples = 8}),
              glm::dvec3(0));
    // Views without flux own no units.
    std::vector<View> dark = test::roomViews(20, 1);
    for (View& v : dark) v.fluxR = v.fluxG = v.fluxB = 0;
    const ViewHierarchy h = ViewHierarchy::build(dark, {});
    const KeptViews kept = allRuns(powerPrefix(h.sortedViews));
    EXPECT_EQ(kept.units, 0u);
    EXPECT_EQ(
        gatherSampled(receiver, kept, powerPrefix(h.sortedViews), h, nullptr, {}, {.samples = 8}),
        glm::dvec3(0));
    // All at one point: any sample gives the same sum.
    const std::vector<View> same(100, test::makeView({0.5f, 0.8f, 0.5f}, {0, -1, 0}, {1, 1, 1}));
    const ViewHierarchy together = ViewHierarchy::build(same, {});
    const auto prefix = powerPrefix(together.sortedViews);
    const double full = gatherAll(receiver, together, nullptr, {}).x;
    const double sampled =
        gatherSampled(receiver, allRuns(prefix), prefix, together, nullptr, {}, {.samples = 8}).x;
    EXPECT_NEAR(sampled, full, 1e-6 * full);
}

}  // namespace
}  // namespace mv
