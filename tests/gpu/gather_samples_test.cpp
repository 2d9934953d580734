// The samples a pixel gathered, as the gather's own shader writes them down.

#include <cmath>
#include <set>

#include "gpu/gather_fixture.h"
#include "megaviews/maps/view_maps.h"

namespace mv {
namespace {

using test::GatherGpu;
using test::receiversOf;
using test::uploadMaps;

constexpr int kWireRes = 16;
constexpr int kWireWidth = 24, kWireHeight = 15;
constexpr int kWire = 9;  // the column of a thin wire: odd, so that no half-size pixel shows it

GBuffer gbufferWithWire(const test::Room& room) {
    GBuffer g = room.gbuffer(kWireWidth, kWireHeight);
    auto positions = g.position.readFloats(4), normals = g.normal.readFloats(4);
    const vec3 normal = normalize(vec3(-1, 1, 1));
    for (int y = 0; y < kWireHeight; ++y) {
        const auto i = static_cast<std::size_t>(4 * (y * kWireWidth + kWire));
        const vec3 p(0.3f, 0.5f + 0.01f * static_cast<float>(y), 0.7f);
        for (std::size_t c = 0; c < 3; ++c) {
            positions[i + c] = p[static_cast<int>(c)];
            normals[i + c] = normal[static_cast<int>(c)];
        }
        positions[i + 3] = 1;
        normals[i + 3] = 0.15f;
    }
    return test::Room::makeGBuffer(kWireWidth, kWireHeight, positions, normals);
}

struct SampledPicture {
    const test::Room& room;
    const GBuffer& gbuffer;
    const ViewHierarchy& tree;     // of the samples
    const ViewHierarchy& mapTree;  // of the maps
    const GpuViewMaps& maps;
    GatherOptions options = test::plainOptions();
};

// Every pixel's samples sum up to its unfiltered irradiance; returns how many were hidden, and
// drawn.
struct Drawn {
    std::uint64_t samples = 0, hidden = 0;
};
Drawn expectSums(const SampledPicture& c) {
    const GpuViewHierarchy cull = upload(c.tree), map = upload(c.mapTree);
    gl::Profiler profiler;
    GatherResult result;
    GatherRecords records;
    GatherPass& pass = GatherGpu::pass();
    pass.prepare(c.gbuffer, cull, c.options, profiler);
    pass.record(map, c.maps, nullptr, profiler, records);
    const RootCube& root = c.room.scene.root;
    const GatherInputs in{c.gbuffer, root, map, c.maps, records, c.options};
    pass.gather(in, profiler, result);
    const auto unfiltered = result.unfiltered.readFloats(4);
    const auto receivers = receiversOf(c.gbuffer);
    Drawn drawn;
    for (int y = 0; y < kWireHeight; ++y) {
        for (int x = y % 3; x < kWireWidth; x += 3) {
            const auto samples = pass.readSamples(in, {x, y});
            const auto i = static_cast<std::size_t>(y * kWireWidth + x);
            if (!receivers[i]) {
                EXPECT_TRUE(samples.empty());
                continue;
            }
            glm::dvec3 sum(0);
            double largest = 0, before = INFINITY;
            std::set<std::uint32_t> slots;
            std::uint32_t count = 0;
            for (const GatheredSample& s : samples) {
                EXPECT_TRUE(slots.insert(s.slot).second);
                const View& view =
                    *std::find_if(c.tree.sortedViews.begin(), c.tree.sortedViews.end(),
                                  [&](const View& v) { return v.slot == s.slot; });
                EXPECT_EQ(s.position, vec3(view.positionX, view.positionY, view.positionZ));
                EXPECT_LE(s.visible, s.samples);
                if (s.visible == s.samples) {
                    EXPECT_EQ(s.irradiance, s.unoccluded);
                }
                if (s.visible == 0) {
                    EXPECT_EQ(s.irradiance, vec3(0));
                }
                const double bright = 0.2126 * double{s.unoccluded.x} +
                                      0.7152 * double{s.unoccluded.y} +
                                      0.0722 * double{s.unoccluded.z};
                EXPECT_LE(bright, before * 1.00001);
                before = bright;
                sum += glm::dvec3(s.irradiance);
                largest = std::max(largest, bright);
                count += s.samples;
                drawn.hidden += s.samples - s.visible;
            }
            drawn.samples += count;
            if (c.options.samples > 0 && c.options.cull.scale == 1) {
                EXPECT_LE(count, static_cast<std::uint32_t>(c.options.samples));
            }
            if (x == kWire && c.options.cull.scale == 2 && c.options.samples > 0) {
                EXPECT_LE(count, static_cast<std::uint32_t>(std::max(c.options.samples, 16)));
                EXPECT_GT(count, 0u);
            }
            for (int k = 0; k < 3; ++k) {
                const double got = sum[k];
                const double want = double{unfiltered[4 * i + static_cast<std::size_t>(k)]};
                EXPECT_NEAR(got, want, 2e-6 * want + 1e-9 * largest) << x << ", " << y;
            }
            if (::testing::Test::HasFailure()) return drawn;
        }
    }
    EXPECT_EQ(gl::reportedErrors(), 0u);
    return drawn;
}

TEST_F(GatherGpu, SamplesOfAPixelSumUpToItsIrradiance) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(150, 2), {.levels = 5});
    const ViewMaps maps = room->traceMaps(tree, kWireRes);
    const GpuViewMaps fused = uploadMaps(maps.texels, kWireRes, tree.leafCount);
    std::vector<std::uint32_t> nodeTexels(tree.nodes.size() * mapTexels(kWireRes), kNone);
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
        if (tree.mapOfNode[n] == kNone) continue;
        std::copy_n(maps.texels.begin() +
                        static_cast<std::ptrdiff_t>(tree.mapOfNode[n] * mapTexels(kWireRes)),
                    mapTexels(kWireRes),
                    nodeTexels.begin() + static_cast<std::ptrdiff_t>(n * mapTexels(kWireRes)));
    }
    const GpuViewMaps unfused =
        uploadMaps(nodeTexels, kWireRes, static_cast<std::uint32_t>(tree.nodes.size()), false);
    const GpuViewMaps none;
    const GBuffer gbuffer = gbufferWithWire(*room);
    for (const int scale : {1, 2, 3}) {
        for (const GpuViewMaps* kind : {&none, &fused, &unfused}) {
            for (const int samples : {16, 0, 3}) {
                if (samples != 16 && kind == &unfused) continue;
                SCOPED_TRACE("scale " + std::to_string(scale) + ", " + std::to_string(samples) +
                             " samples, maps " +
                             (kind == &none    ? "none"
                              : kind == &fused ? "fused"
                                               : "unfused"));
                GatherOptions options = test::plainOptions();
                options.samples = samples;
                options.candidates = samples == 16 ? 8 : 1;
                options.cull.scale = scale;
                options.seed = 5;
                options.accumulationIndex = 2;
                options.rules = samples == 3 ? kPublishedRules : kCorrectedRules;
                const Drawn drawn = expectSums({*room, gbuffer, tree, tree, *kind, options});
                EXPECT_GT(drawn.samples,
                          static_cast<std::uint64_t>(samples * kWireWidth * kWireHeight / 6));
                EXPECT_EQ(drawn.hidden > 0, kind != &none);
            }
        }
    }
}

TEST_F(GatherGpu, SamplesOfAPixelAreTheReferencesSummands) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(120, 6), {.levels = 5});
    const ViewMaps maps = room->traceMaps(tree, kWireRes);
    const GpuViewMaps fused = uploadMaps(maps.texels, kWireRes, tree.leafCount);
    const GBuffer gbuffer = room->gbuffer(kWireWidth, kWireHeight);
    const auto receivers = receiversOf(gbuffer);
    const GpuViewHierarchy gpu = upload(tree);
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    gl::Profiler profiler;
    GatherResult result;
    GatherRecords records;
    const RootCube& root = room->scene.root;
    pass().prepare(gbuffer, gpu, options, profiler);
    pass().record(gpu, fused, nullptr, profiler, records);
    const GatherInputs in{gbuffer, root, gpu, fused, records, options};
    pass().gather(in, profiler, result);
    const GatherReferenceOptions reference = test::referenceOf(options, root);
    int checked = 0, different = 0;
    for (std::size_t i = 0; i < receivers.size(); i += 7) {
        if (!receivers[i]) continue;
        const glm::ivec2 pixel(static_cast<int>(i) % kWireWidth, static_cast<int>(i) / kWireWidth);
        const auto samples = pass().readSamples(in, pixel);
        EXPECT_GT(samples.size(), 10u);
        for (const GatheredSample& s : samples) {
            std::uint32_t view = 0;
            while (tree.sortedViews[view].slot != s.slot) ++view;
            const glm::dvec3 open = gatherOne(*receivers[i], view, tree, nullptr, reference);
            const glm::dvec3 lit = gatherOne(*receivers[i], view, tree, &maps, reference);
            EXPECT_LT(glm::length(open - glm::dvec3(s.unoccluded)),
                      1e-3 * glm::length(open) + 1e-9);
            ++checked;
            // A depth right at the threshold may fall on either side.
            different +=
                glm::length(lit - glm::dvec3(s.irradiance)) > 1e-3 * glm::length(open) + 1e-9;
        }
    }
    EXPECT_GT(checked, 1000);
    EXPECT_LE(different, checked / 100);
    // What is not there has no samples.
    for (const glm::ivec2 outside :
         {glm::ivec2(-1, 0), {0, -1}, {kWireWidth, 0}, {0, kWireHeight}}) {
        EXPECT_TRUE(pass().readSamples(in, outside).empty());
    }
    const GpuViewHierarchy nothing = upload(ViewHierarchy::build({}, {}));
    EXPECT_TRUE(pass().readSamples({gbuffer, root, nothing, {}, records, options}, {0, 0}).empty());
}

}  // namespace
}  // namespace mv
