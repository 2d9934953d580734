// The gather on the GPU against its CPU reference: full sums, sampled means, maps of every kind.

#include "gpu/gather_fixture.h"
#include "megaviews/maps/view_maps.h"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/shadow_test.glsl"
#include "support/map_queries.h"

namespace mv {
namespace {

using test::GatherGpu;
using test::packMaps;
using test::receiversOf;
using test::uploadMaps;

constexpr int kRes = 16;

// One gather: everything but the G-buffer is made here.
struct Gathered {
    std::vector<float> irradiance, unfiltered, candidates;
    GatherResult result;
    GatherShares shares;
};
Gathered gather(const test::Room& room, const GBuffer& gbuffer, const ViewHierarchy& cullTree,
                const ViewHierarchy& mapTree, const GpuViewMaps& maps, GatherOptions options) {
    const GpuViewHierarchy gpuCull = upload(cullTree), gpuMap = upload(mapTree);
    gl::Profiler profiler;
    Gathered out;
    GatherPass& pass = GatherGpu::pass();
    GatherRecords records;
    pass.prepare(gbuffer, gpuCull, options, profiler);
    pass.record(gpuMap, maps, nullptr, profiler, records);
    const GatherInputs in{gbuffer, room.scene.root, gpuMap, maps, records, options};
    pass.gather(in, profiler, out.result);
    out.shares = pass.readShares(in);
    out.irradiance = out.result.irradiance.readFloats(4);
    out.unfiltered = out.result.unfiltered.readFloats(4);
    out.candidates = out.result.candidates.readFloats(1);
    EXPECT_EQ(gl::reportedErrors(), 0u);
    return out;
}
GatherOptions fullSum() {
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    options.filter = false;
    return options;
}

// Pixels that differ by more than rounding: a view whose depth is right at the threshold may be
// lit on one side and shadowed on the other.
void expectFullSum(const test::Room& room, const GBuffer& gbuffer, const ViewHierarchy& tree,
                   const ViewMaps* maps, const GatherOptions& options, const Gathered& got,
                   double allowedShare) {
    const auto receivers = receiversOf(gbuffer);
    std::size_t surfaces = 0, different = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (!receivers[i]) {
            EXPECT_EQ(got.irradiance[4 * i + 1], 0);
            continue;
        }
        ++surfaces;
        EXPECT_EQ(got.irradiance[4 * i + 3], 0) << "a full sum has no noise";
        const glm::dvec3 e =
            gatherAll(*receivers[i], tree, maps, test::referenceOf(options, room.scene.root));
        const double tolerance = 1e-3 * (e.x + e.y + e.z) + 1e-7;
        for (std::size_t c = 0; c < 3; ++c) {
            if (std::abs(double{got.irradiance[4 * i + c]} - e[static_cast<int>(c)]) > tolerance) {
                ++different;
                if (allowedShare == 0) {
                    ADD_FAILURE() << "pixel " << i << " channel " << c << ": "
                                  << got.irradiance[4 * i + c] << " instead of "
                                  << e[static_cast<int>(c)];
                }
                break;
            }
        }
        if (allowedShare == 0 && different > 3) return;
    }
    EXPECT_GT(surfaces, receivers.size() / 2);
    EXPECT_LE(static_cast<double>(different), allowedShare * static_cast<double>(surfaces));
}

// Of the views, those that a pixel and they face each other; the mean over the grid of
// readShares().
double facingShare(const GBuffer& gbuffer, const ViewHierarchy& tree) {
    const auto receivers = receiversOf(gbuffer);
    double facing = 0, pixels = 0;
    for (int y = 0; y < gbuffer.height; y += 16) {
        for (int x = 0; x < gbuffer.width; x += 16) {
            const auto& r = receivers[static_cast<std::size_t>(y * gbuffer.width + x)];
            if (!r) continue;
            pixels += 1;
            for (const View& v : tree.sortedViews) {
                const glm::vec3 way =
                    glm::vec3(v.positionX, v.positionY, v.positionZ) - r->position;
                const glm::vec3 normal(v.normalX, v.normalY, v.normalZ);
                const bool everywhere = normal == glm::vec3(0);
                facing += dot(way, r->normal) > 0 && (everywhere || dot(way, normal) < 0);
            }
        }
    }
    return facing / (pixels * static_cast<double>(tree.sortedViews.size()));
}

TEST_F(GatherGpu, FullSumWithoutVisibility) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(700, 1), {});
    const GBuffer gbuffer = room->gbuffer(48, 30);
    const double facing = facingShare(gbuffer, tree);
    EXPECT_GT(facing, 0.05);
    for (const int level : {0, 1, 3, 6, 10}) {
        for (const float cutoff : {0.0f, 0.3f}) {
            GatherOptions options = fullSum();
            options.cull.level = level;
            options.cull.cutoff = cutoff;
            const Gathered got = gather(*room, gbuffer, tree, tree, {}, options);
            SCOPED_TRACE("cull level " + std::to_string(level));
            expectFullSum(*room, gbuffer, tree, nullptr, options, got, 0);
            // Culling does something, from a few levels on, and nothing at level 0.
            if (level == 0) {
                EXPECT_EQ(got.shares.kept, 1);
                EXPECT_EQ(got.shares.receivers, 1u);
            }
            EXPECT_NEAR(got.shares.facing, facing, 1e-6);
            if (cutoff == 0) {
                EXPECT_GE(got.shares.kept, facing) << "what faces a pixel must be kept";
            }
            if (level >= 3) {
                EXPECT_LT(got.shares.kept, cutoff > 0 ? 0.7 : 0.98);
                EXPECT_GT(got.shares.receivers, 5u);
            }
        }
    }
}

TEST_F(GatherGpu, FullSumWithFusedMaps) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(150, 2), {.levels = 5});
    ASSERT_LT(tree.leafCount, 150u);  // some leaves hold several views
    const ViewMaps maps = room->traceMaps(tree, kRes);
    GpuViewMaps gpuMaps = uploadMaps(maps.texels, kRes, tree.leafCount);
    const GBuffer gbuffer = room->gbuffer(48, 30);
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        GatherOptions options = fullSum();
        options.rules = rules;
        const Gathered got = gather(*room, gbuffer, tree, tree, gpuMaps, options);
        expectFullSum(*room, gbuffer, tree, &maps, options, got, 0.01);
        gpuMaps.inQuads = true;  // as maps that a buffer texture of words does not hold
        EXPECT_EQ(gather(*room, gbuffer, tree, tree, gpuMaps, options).irradiance, got.irradiance);
        GpuViewMaps packed = packMaps(gpuMaps);
        const Gathered halves = gather(*room, gbuffer, tree, tree, packed, options);
        packed.inQuads = true;
        EXPECT_EQ(gather(*room, gbuffer, tree, tree, packed, options).irradiance,
                  halves.irradiance);
        // As maps of the same depths, unpacked.
        const GpuViewMaps rounded =
            uploadMaps(packed.readTexels(0, tree.leafCount), kRes, tree.leafCount);
        EXPECT_EQ(gather(*room, gbuffer, tree, tree, rounded, options).irradiance,
                  halves.irradiance);
        gpuMaps.inQuads = false;
        GatherOptions lessBias = options;
        lessBias.bias = 0.25f;
        const Gathered darker = gather(*room, gbuffer, tree, tree, gpuMaps, lessBias);
        EXPECT_NE(darker.irradiance, got.irradiance);
        expectFullSum(*room, gbuffer, tree, &maps, lessBias, darker, 0.01);
        // Shadows are there: the block hides something.
        const Gathered open = gather(*room, gbuffer, tree, tree, {}, options);
        double shadowed = 0, all = 0;
        for (std::size_t i = 1; i < open.irradiance.size(); i += 4) {
            EXPECT_LE(got.irradiance[i], open.irradiance[i] * 1.0001f);
            shadowed += double{got.irradiance[i]};
            all += double{open.irradiance[i]};
        }
        EXPECT_LT(shadowed, 0.97 * all);
        EXPECT_GT(shadowed, 0.2 * all);
    }
}

// The room's maps stand at the leaves or, for every second leaf, at its parent, as before fusion.
TEST_F(GatherGpu, FullSumWithUnfusedMaps) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(60, 3), {});
    const std::size_t size = mapTexels(kRes);
    std::vector<std::uint32_t> nodeTexels(tree.nodes.size() * size, kNone);
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        if (tree.mapOfNode[n] == kNone) continue;
        const auto parent = parentOf(tree.nodes[n]);
        const auto target = n % 2 && parent != kNone ? std::size_t{parent} : n;
        const auto texels = room->trace(boxCenter(tree.nodes[target]), kRes);
        std::copy(texels.begin(), texels.end(),
                  nodeTexels.begin() + static_cast<std::ptrdiff_t>(target * size));
    }
    const auto nodeCount = static_cast<std::uint32_t>(tree.nodes.size());
    const GpuViewMaps gpuMaps = uploadMaps(nodeTexels, kRes, nodeCount, false);
    const GBuffer gbuffer = room->gbuffer(32, 20);
    const GatherOptions options = fullSum();
    const Gathered got = gather(*room, gbuffer, tree, tree, gpuMaps, options);
    const auto receivers = receiversOf(gbuffer);
    std::size_t different = 0, surfaces = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (!receivers[i]) continue;
        const Receiver& r = *receivers[i];
        ++surfaces;
        glm::dvec3 e(0);
        for (std::uint32_t v = 0; v < tree.sortedViews.size(); ++v) {
            const vec3 offset = r.position - boxCenter(tree.nodes[tree.leafOfView[v]]);
            const float depth = queryUnfused(nodeTexels, tree, kRes, v, offset);
            const uint bits = std::isinf(depth) ? kNone : floatBitsToUint(depth);
            if (!isLit(bits, offset, r.normal, kRes, true, 1)) continue;
            e += gatherOne(r, v, tree, nullptr, test::referenceOf(options, room->scene.root));
        }
        if (std::abs(double{got.irradiance[4 * i + 1]} - e.y) > 1e-3 * e.y + 1e-7) ++different;
    }
    EXPECT_LE(different, surfaces / 50) << "of " << surfaces;
}

TEST_F(GatherGpu, SampledMeanIsTheFullSum) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(600, 4), {.levels = 6});
    const ViewMaps maps = room->traceMaps(tree, 8);
    const GpuViewMaps gpuMaps = uploadMaps(maps.texels, 8, tree.leafCount);
    const GBuffer gbuffer = room->gbuffer(16, 12);
    const GpuViewHierarchy gpuTree = upload(tree);
    // A wide clamp: without it a few near views make a distribution too heavy-tailed to test.
    GatherOptions options = fullSum();
    options.clampDistance = 0.15f;
    const Gathered full = gather(*room, gbuffer, tree, tree, gpuMaps, options);
    gl::Profiler profiler;
    GatherPass& pass = GatherGpu::pass();
    GatherResult result;
    for (const auto& [samples, candidates] : {std::pair{1, 1}, {7, 1}, {4, 16}}) {
        options.samples = samples;
        options.candidates = candidates;
        constexpr int kSeeds = 300;
        std::vector<double> sum(full.irradiance.size(), 0), squares = sum;
        for (int s = 0; s < kSeeds; ++s) {
            options.seed = static_cast<std::uint32_t>(s % 20);
            options.accumulationIndex = static_cast<std::uint32_t>(s / 20);
            test::gatherOnce(pass, gbuffer, room->scene.root, gpuTree, gpuMaps, options, profiler,
                             result);
            const auto e = result.irradiance.readFloats(4);
            for (std::size_t i = 0; i < e.size(); ++i) {
                sum[i] += double{e[i]};
                squares[i] += double{e[i]} * double{e[i]};
            }
        }
        // Each pixel within 6 sigma, all together within 4.
        double total = 0, expected = 0, variance = 0;
        for (std::size_t i = 1; i < sum.size(); i += 4) {
            const double mean = sum[i] / kSeeds;
            const double var = (squares[i] / kSeeds - mean * mean) / kSeeds;
            const double want = double{full.irradiance[i]};
            EXPECT_LT(std::abs(mean - want), 6 * std::sqrt(std::max(0.0, var)) + 1e-6)
                << samples << " samples, pixel " << i / 4;
            total += mean;
            expected += want;
            variance += var;
        }
        // Pixels of a tile are not independent: at worst 64 of them move together.
        EXPECT_NEAR(total, expected, 4 * std::sqrt(64 * variance)) << samples << " samples";
        EXPECT_LT(std::sqrt(64 * variance), 0.1 * expected);
    }
}

TEST_F(GatherGpu, SamplesAreThoseOfTheReference) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(500, 5), {});
    const GBuffer gbuffer = room->gbuffer(32, 20);
    GatherOptions options = test::plainOptions();
    options.samples = 9;
    options.filter = false;
    options.cull.level = 0;
    options.seed = 77;
    options.accumulationIndex = 3;
    const auto prefix = powerPrefix(tree.sortedViews);
    const KeptViews kept = allRuns(prefix);
    const auto receivers = receiversOf(gbuffer);
    for (const int candidates : {1, 6, 16}) {
        options.candidates = candidates;
        const Gathered got = gather(*room, gbuffer, tree, tree, {}, options);
        std::size_t surfaces = 0, different = 0;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            if (!receivers[i]) continue;
            ++surfaces;
            const glm::dvec3 e =
                gatherSampled(*receivers[i], kept, prefix, tree, nullptr,
                              test::referenceOf(options, room->scene.root),
                              {9, 77, static_cast<uint>(i % 32), static_cast<uint>(i / 32), 3,
                               static_cast<uint>(candidates)});
            // The two totals of power are rounded differently: a sample may fall one view off.
            different += std::abs(double{got.irradiance[4 * i + 1]} - e.y) > 1e-3 * e.y + 1e-6;
        }
        EXPECT_LE(different, surfaces * (2 + static_cast<std::size_t>(candidates)) / 100);
    }
}

// Methods differ in their maps alone: where the maps agree, so do the pictures, to the bit.
TEST_F(GatherGpu, FlatHierarchyTakesTheSameSamples) {
    const std::vector<View> views = room->views(120, 6);
    const ViewHierarchy tree = ViewHierarchy::build(views, {});
    const ViewHierarchy flat = ViewHierarchy::build(views, {.flat = true});
    ASSERT_EQ(tree.leafCount, flat.leafCount);
    const GpuViewMaps treeMaps =
        uploadMaps(room->traceMaps(tree, kRes).texels, kRes, tree.leafCount);
    const GpuViewMaps flatMaps =
        uploadMaps(room->traceMaps(flat, kRes).texels, kRes, flat.leafCount);
    const GBuffer gbuffer = room->gbuffer(48, 30);
    GatherOptions options = test::plainOptions();
    options.samples = 8;
    const Gathered a = gather(*room, gbuffer, tree, tree, treeMaps, options);
    const Gathered b = gather(*room, gbuffer, tree, flat, flatMaps, options);
    EXPECT_EQ(a.unfiltered, b.unfiltered);
    EXPECT_EQ(a.irradiance, b.irradiance);
    EXPECT_EQ(a.candidates, b.candidates);
    const Gathered none = gather(*room, gbuffer, tree, flat, {}, options);
    EXPECT_NE(a.irradiance, none.irradiance);
}

TEST_F(GatherGpu, SameSettingsSameBytes) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(3000, 7), {});
    const GBuffer gbuffer = room->gbuffer(61, 37);
    for (const int scale : {1, 2, 3}) {
        GatherOptions options = test::plainOptions();
        options.samples = 8;
        options.candidates = 8;
        options.cull.scale = scale;
        const Gathered a = gather(*room, gbuffer, tree, tree, {}, options);
        const Gathered b = gather(*room, gbuffer, tree, tree, {}, options);
        EXPECT_EQ(a.irradiance, b.irradiance);
        EXPECT_EQ(a.candidates, b.candidates);
        EXPECT_EQ(a.shares.clampedEnergy, b.shares.clampedEnergy);
        // Nothing is left over from what the pass did before.
        const GpuViewHierarchy gpuTree = upload(tree);
        gl::Profiler profiler;
        GatherPass fresh;
        GatherResult result;
        test::gatherOnce(fresh, gbuffer, room->scene.root, gpuTree, {}, options, profiler, result);
        EXPECT_EQ(a.irradiance, result.irradiance.readFloats(4));
        options.seed = 1;
        EXPECT_NE(gather(*room, gbuffer, tree, tree, {}, options).irradiance, a.irradiance);
        options.seed = 0;
        options.accumulationIndex = 1;
        EXPECT_NE(gather(*room, gbuffer, tree, tree, {}, options).irradiance, a.irradiance);
    }
}

TEST_F(GatherGpu, AwkwardViewSets) {
    const GBuffer gbuffer = room->gbuffer(20, 12);
    std::vector<std::vector<View>> sets = {
        {}, room->views(1, 8, 0), room->views(2, 8), room->views(9, 9)};
    sets.emplace_back(300, test::makeView({0.5f, 0.874f, 0.5f}, {0, -1, 0}, {1, 2, 3}));
    sets.push_back(room->views(40, 10));
    for (View& v : sets.back()) v.fluxR = v.fluxG = v.fluxB = 0;  // all dark
    sets.push_back(room->views(64, 11));
    for (std::size_t i = 0; i < 64; i += 2) sets.back()[i].fluxR = 0, sets.back()[i].fluxG = 0;
    sets.push_back(room->views(100, 12));
    sets.back()[50].fluxG = 1e8f;  // one view has nearly all units
    for (std::vector<View>& views : sets) {
        test::numberSlots(views);
        const ViewHierarchy tree = ViewHierarchy::build(views, {});
        SCOPED_TRACE(std::to_string(views.size()) + " views");
        for (const int samples : {0, 100000}) {
            GatherOptions options = fullSum();
            options.samples = std::min(samples, 65535);
            const Gathered got = gather(*room, gbuffer, tree, tree, {}, options);
            if (!views.empty()) expectFullSum(*room, gbuffer, tree, nullptr, options, got, 0);
        }
        for (const int scale : {1, 2, 4}) {
            GatherOptions options = test::plainOptions();
            options.samples = 4;
            options.cull.scale = scale;
            for (const float e : gather(*room, gbuffer, tree, tree, {}, options).irradiance) {
                EXPECT_TRUE(std::isfinite(e));
            }
        }
    }
}

TEST_F(GatherGpu, PixelsAnywhere) {
    // Off every surface, with normals of any direction, and beyond the root cube.
    const ViewHierarchy tree = ViewHierarchy::build(room->views(200, 13), {});
    test::Rng rng(5);
    std::vector<float> positions, normals;
    for (int i = 0; i < 16 * 16; ++i) {
        const vec3 p = test::point(rng, -0.1f, 1.1f), n = test::direction(rng);
        positions.insert(positions.end(), {p.x, p.y, p.z, 1.0f});
        normals.insert(normals.end(), {n.x, n.y, n.z, 1.0f});
    }
    const GBuffer gbuffer = test::Room::makeGBuffer(16, 16, positions, normals);
    const GatherOptions options = fullSum();
    expectFullSum(*room, gbuffer, tree, nullptr, options,
                  gather(*room, gbuffer, tree, tree, {}, options), 0);
}

TEST_F(GatherGpu, ClampedEnergyIsMeasured) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(300, 14, 0), {});
    const GBuffer gbuffer = room->gbuffer(64, 64);
    GatherOptions options = fullSum();
    options.clampDistance = 0.5f;
    const Gathered got = gather(*room, gbuffer, tree, tree, {}, options);
    const auto receivers = receiversOf(gbuffer);
    GatherReferenceOptions reference = test::referenceOf(options, room->scene.root);
    const glm::dvec3 luminance(0.2126, 0.7152, 0.0722);
    double clamped = 0, open = 0;
    for (std::size_t y = 0; y < 64; y += 16) {
        for (std::size_t x = 0; x < 64; x += 16) {
            if (!receivers[y * 64 + x]) continue;
            reference.clampDistance = 0.5f;
            clamped += dot(luminance, gatherAll(*receivers[y * 64 + x], tree, nullptr, reference));
            reference.clampDistance = 0;
            open += dot(luminance, gatherAll(*receivers[y * 64 + x], tree, nullptr, reference));
        }
    }
    EXPECT_GT(got.shares.clampedEnergy, 0.01);
    EXPECT_NEAR(got.shares.clampedEnergy, 1 - clamped / open, 1e-3);
    options.clampDistance = 0;
    EXPECT_NEAR(gather(*room, gbuffer, tree, tree, {}, options).shares.clampedEnergy, 0, 1e-6);
}

}  // namespace
}  // namespace mv
