// Marching on the GPU: sums against the CPU reference, in as many draws as it takes, the samples of
// a pixel, and the method `rays` through a whole frame.

#include <algorithm>

#include "gpu/frame_fixture.h"
#include "gpu/gather_fixture.h"
#include "megaviews/methods/rays/march_tree.h"
#include "renderer/methods/rays/visibility.h"
#include "renderer/visibility.h"

namespace mv {
namespace {

using test::FrameTest;
using test::GatherGpu;
using test::receiversOf;

constexpr int kWidth = 40, kHeight = 24;

struct MarchCase {
    const test::Room& room;
    const GBuffer& gbuffer;
    const ViewHierarchy& tree;
    const GpuViewMaps& maps;
    GatherOptions options = test::plainOptions();
};

GatherResult gathered(const MarchCase& c) {
    const GpuViewHierarchy tree = upload(c.tree);
    gl::Profiler profiler;
    GatherResult result;
    test::gatherOnce(GatherGpu::pass(), c.gbuffer, c.room.scene.root, tree, c.maps, c.options,
                     profiler, result);
    EXPECT_EQ(gl::reportedErrors(), 0u);
    return result;
}

GatherOptions marching(const GpuMarchTree& march) {
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    options.filter = false;
    options.sample = marchedSample(march);
    return options;
}

double energyOf(const std::vector<float>& texels) {
    double sum = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) sum += i % 4 == 3 ? 0.0 : double{texels[i]};
    return sum;
}

// Of all pixels, over the seeds from 0 on.
double meanEnergy(MarchCase c, std::uint32_t seeds) {
    double sum = 0;
    for (c.options.seed = 0; c.options.seed < seeds; ++c.options.seed) {
        sum += energyOf(gathered(c).irradiance.readFloats(4));
    }
    return sum / seeds;
}

// Irradiance of all pixels, and how many differ from the CPU's.
struct Compared {
    std::vector<float> irradiance;
    double energy = 0;
    int surfaces = 0, different = 0;
};
Compared compare(const MarchCase& c, const MarchTree& tree) {
    Compared out;
    out.irradiance = gathered(c).irradiance.readFloats(4);
    const auto receivers = receiversOf(c.gbuffer);
    GatherReferenceOptions reference = test::referenceOf(c.options, c.room.scene.root);
    reference.blocked = [&](const Receiver& r, glm::vec3 position, glm::vec3 normal) {
        return tree.blocked(r.position, r.normal, position, normal);
    };
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (!receivers[i]) continue;
        const glm::dvec3 e = gatherAll(*receivers[i], c.tree, nullptr, reference);
        const glm::dvec3 got(out.irradiance[4 * i], out.irradiance[4 * i + 1],
                             out.irradiance[4 * i + 2]);
        ++out.surfaces;
        out.different += glm::length(got - e) > 1e-3 * glm::length(e) + 1e-7;
    }
    out.energy = energyOf(out.irradiance);
    EXPECT_GT(out.surfaces, kWidth * kHeight / 2);
    return out;
}

TEST_F(GatherGpu, MarchedSumIsTheReferences) {
    const MarchTree tree = MarchTree::build(room->hierarchy);
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    EXPECT_EQ(march.nodeCount, room->hierarchy.nodes.size());
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    for (const std::size_t count : {std::size_t{1}, std::size_t{300}}) {
        const ViewHierarchy views = ViewHierarchy::build(room->views(count, 2), {.levels = 5});
        const Compared all = compare({*room, gbuffer, views, {}, marching(march)}, tree);
        // Normals are packed, so ends of ways differ by a hair: few samples may, too.
        EXPECT_LE(all.different, all.surfaces / 50);
        if (count == 1) continue;
        GatherOptions unseen = marching(march);
        unseen.sample.reset();
        const auto open = gathered({*room, gbuffer, views, {}, unseen}).irradiance.readFloats(4);
        EXPECT_LT(all.energy, 0.99 * energyOf(open));
    }
}

// One part of a tile may keep so few views that they are all summed, beside one that draws samples:
// their pixels work through the same questions.
TEST_F(GatherGpu, PartsOfATileMayGatherDifferently) {
    constexpr int kEdge = static_cast<int>(kTileEdge);
    std::vector<float> positions, normals;
    for (int i = 0; i < kEdge * kEdge; ++i) {
        const bool floor = i / kEdge < 5;  // else a ceiling
        const float u = static_cast<float>(i % kEdge) * 1e-3f;
        const vec3 p(0.3f + u, floor ? 0.2f : 0.8f, 0.7f + static_cast<float>(i / kEdge) * 1e-3f);
        positions.insert(positions.end(), {p.x, p.y, p.z, 1});
        normals.insert(normals.end(), {0, floor ? 1.0f : -1.0f, 0, 0.03f});
    }
    const GBuffer gbuffer = test::Room::makeGBuffer(kEdge, kEdge, positions, normals);
    test::Rng rng(8);
    std::vector<View> set;
    for (int i = 0; i < 203; ++i) {
        const bool down = i >= 3;
        const vec3 p = test::point(rng, 0.2f, 0.4f);
        set.push_back(test::makeView({p.x, down ? 0.85f : 0.15f, 0.7f + p.z - 0.3f},
                                     {0, down ? -1.0f : 1.0f, 0}, vec3(1)));
    }
    test::numberSlots(set);
    const ViewHierarchy views = ViewHierarchy::build(set, {});
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    GatherOptions options = marching(march);
    const auto all = gathered({*room, gbuffer, views, {}, options}).irradiance.readFloats(4);
    options.samples = 8;
    options.candidates = 4;
    const auto drawn = gathered({*room, gbuffer, views, {}, options}).irradiance.readFloats(4);
    double floorSum = 0, floorDrawn = 0;
    for (std::size_t i = 0; i < std::size_t{kEdge} * kEdge; ++i) {
        EXPECT_GT(all[4 * i], 0) << i;
        if (i / kEdge < 5) {
            floorSum += double{all[4 * i]};
            floorDrawn += double{drawn[4 * i]};
            EXPECT_GT(drawn[4 * i + 3], 0) << "samples vary";
        } else {
            EXPECT_NEAR(drawn[4 * i], all[4 * i], 1e-4f * all[4 * i]) << i;
            EXPECT_EQ(drawn[4 * i + 3], 0) << "a full sum does not";
        }
    }
    EXPECT_NEAR(floorDrawn, floorSum, 0.3 * floorSum);
}

// Drawn in parts of this many rounds each, whole sums and samples are what they are drawn at once,
// and what does not fit at all is said. The last rounds are too few for one sample.
struct PartsCase {
    GatherOptions options;
    std::vector<std::uint32_t> rounds;
    std::uint32_t tooFew = 0;
};
void expectSameInParts(const test::Room& room, PartsCase c) {
    const ViewHierarchy views = ViewHierarchy::build(room.views(200, 4), {.levels = 5});
    const GBuffer gbuffer = room.gbuffer(kWidth, kHeight);
    GatherOptions& options = c.options;
    for (const int scale : {1, 2}) {
        for (const int samples : {0, 24}) {
            options.samples = samples;
            options.cull.scale = scale;
            options.roundsAtOnce = 0;
            const auto whole =
                gathered({room, gbuffer, views, {}, options}).unfiltered.readFloats(4);
            for (const std::uint32_t rounds : c.rounds) {
                options.roundsAtOnce = rounds;
                const auto parts =
                    gathered({room, gbuffer, views, {}, options}).unfiltered.readFloats(4);
                double different = 0, sum = 0;
                for (std::size_t i = 0; i < whole.size(); ++i) {
                    if (i % 4 == 3) {
                        ASSERT_NEAR(parts[i], whole[i], 1e-4f * whole[i] + 1e-12f) << "variance";
                        continue;
                    }
                    different += std::abs(double{parts[i]} - double{whole[i]});
                    sum += double{whole[i]};
                }
                EXPECT_LT(different, 1e-5 * sum) << rounds << " rounds, scale " << scale;
            }
            options.roundsAtOnce = c.tooFew;
            EXPECT_THROW(gathered({room, gbuffer, views, {}, options}), Error);
        }
    }
}

// Seven, six and four samples a draw; of those some have too few steps, so that all is done again.
TEST_F(GatherGpu, MarchesInAsManyDrawsAsItTakes) {
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    expectSameInParts(*room, {marching(march), {14000, 2000, 600}, 70});
}

// The same of rays, those of an invocation together.
TEST_F(GatherGpu, AsksRaysInAsManyDrawsAsItTakes) {
    BvhTables triangles;
    triangles.setScene(room->scene, room->bvh);
    GatherOptions options = test::plainOptions();
    options.filter = false;
    options.sample = shadowRaySample(triangles);
    expectSameInParts(*room, {options, {14000, 2000, 600}, 70});
}

// Maps that let all light through, or none: where they are doubted, the mean is that of rays alone.
TEST_F(GatherGpu, CheckedMapsAreRightInTheMean) {
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    const ViewHierarchy views = ViewHierarchy::build(room->views(200, 4), {.levels = 5});
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    GatherOptions options = marching(march);
    options.clampDistance = 0.15f;
    const double want =
        energyOf(gathered({*room, gbuffer, views, {}, options}).irradiance.readFloats(4));
    options.samples = 16;
    options.candidates = 8;
    options.sampleAsked = SampleAsked::inDoubt;
    for (const std::uint32_t texel : {kNone, floatBitsToUint(1e-6f)}) {
        const std::vector<std::uint32_t> texels(views.leafCount * mapTexels(16), texel);
        const GpuViewMaps wrong = test::uploadMaps(texels, 16, views.leafCount);
        const auto meanOf = [&](float check) {
            options.mapCheck = check;
            return meanEnergy({*room, gbuffer, views, wrong, options}, 12);
        };
        const double unchecked = meanOf(0);
        if (texel == kNone) {
            EXPECT_GT(unchecked, 1.05 * want);
        } else {
            EXPECT_LT(unchecked, 0.5 * want);
        }
        EXPECT_NEAR(meanOf(0.25f), want, 0.02 * want) << "texels " << texel;
        EXPECT_NEAR(meanOf(1), want, 0.01 * want) << "texels " << texel;
    }
}

// Views above the ceiling whose maps let all light through, among brighter ones behind a wall that
// take most samples: what is believed of them is taken back, on the whole, where they are asked.
TEST_F(GatherGpu, WhatLeaksIsTakenBack) {
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    std::vector<View> all;
    test::Rng rng(5);
    const auto across = [&] { return test::uniform(rng, 0.2f, 0.8f); };
    for (int i = 0; i < 200; ++i) {
        const glm::vec3 behindWall(0.95f, across(), across());
        all.push_back(test::makeView(behindWall, glm::vec3(-1, 0, 0), glm::vec3(1)));
    }
    for (int i = 0; i < 20; ++i) {
        const glm::vec3 aboveCeiling(across(), 0.95f, across()), inside(across(), 0.86f, across());
        all.push_back(test::makeView(aboveCeiling, glm::vec3(0, -1, 0), glm::vec3(0.1f)));
        all.push_back(test::makeView(inside, glm::vec3(0, -1, 0), glm::vec3(1e-3f)));
    }
    test::numberSlots(all);
    const ViewHierarchy views = ViewHierarchy::build(all, {.levels = 5});
    ViewMaps maps = room->traceMaps(views, 16);
    const std::size_t size = mapTexels(16);
    for (std::size_t i = 0; i < maps.centers.size(); ++i) {
        const std::uint32_t texel = maps.centers[i].x > 0.9f ? floatBitsToUint(1e-6f) : kNone;
        std::fill_n(&maps.texels[i * size], size, texel);
    }
    const GpuViewMaps wrong = test::uploadMaps(maps.texels, 16, views.leafCount);
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    GatherOptions options = marching(march);
    options.clampDistance = 0.15f;
    const double want =
        energyOf(gathered({*room, gbuffer, views, {}, options}).irradiance.readFloats(4));
    options.samples = 8;
    options.candidates = 32;
    options.sampleAsked = SampleAsked::inDoubt;
    EXPECT_GT(meanEnergy({*room, gbuffer, views, wrong, options}, 1), 50 * want);
    options.mapCheck = 0.6;
    EXPECT_NEAR(meanEnergy({*room, gbuffer, views, wrong, options}, 64), want, 0.25 * want);
}

// With as many rays, pixels are nearer to the full sum where rays correct what maps believe.
TEST_F(GatherGpu, MapsTakeNoiseFromRays) {
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    const ViewHierarchy views = ViewHierarchy::build(room->views(200, 4), {.levels = 5});
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    GatherOptions options = marching(march);
    options.clampDistance = 0.15f;
    const GpuViewMaps none;
    const auto pixelsOf = [&](const GpuViewMaps& maps) {
        return gathered({*room, gbuffer, views, maps, options}).irradiance.readFloats(4);
    };
    const std::vector<float> want = pixelsOf(none);
    options.samples = 8;
    options.candidates = 8;
    options.mapCheck = 0.6;
    const ViewMaps traced = room->traceMaps(views, 16);
    const GpuViewMaps maps = test::uploadMaps(traced.texels, 16, views.leafCount);
    const auto errorOf = [&](const GpuViewMaps& of) {
        if (of.present) options.sampleAsked = SampleAsked::inDoubt;
        double sum = 0;
        for (options.seed = 0; options.seed < 4; ++options.seed) {
            const std::vector<float> got = pixelsOf(of);
            for (std::size_t i = 0; i < got.size(); ++i) {
                if (i % 4 == 3) continue;
                sum += std::pow(double{got[i]} - double{want[i]}, 2);
            }
        }
        return sum;
    };
    EXPECT_LT(errorOf(maps), 0.6 * errorOf(none));
}

TEST_F(GatherGpu, MarchedSamplesOfAPixelSumUpToItsIrradiance) {
    const GpuMarchTree march = uploadMarchTree(room->hierarchy);
    const ViewHierarchy views = ViewHierarchy::build(room->views(150, 2), {.levels = 5});
    const GpuViewMaps none;
    const ViewMaps traced = room->traceMaps(views, 16);
    const GpuViewMaps maps = test::uploadMaps(traced.texels, 16, views.leafCount);
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    const GpuViewHierarchy tree = upload(views);
    struct Case {
        int samples;
        const GpuViewMaps& maps;  // that rays correct
        double mapCheck;
    };
    for (const auto& [samples, visible, mapCheck] :
         {Case{0, none, 0}, Case{20, none, 0}, Case{20, maps, 0.6}, Case{20, maps, 0}}) {
        GatherOptions options = marching(march);
        options.samples = samples;
        options.candidates = 8;
        if (visible.present) options.sampleAsked = SampleAsked::inDoubt;
        options.mapCheck = mapCheck;
        gl::Profiler profiler;
        GatherRecords records;
        GatherResult result;
        const RootCube& root = room->scene.root;
        pass().prepare(gbuffer, tree, options, profiler);
        pass().record(tree, visible, nullptr, profiler, records);
        pass().gather({gbuffer, root, tree, visible, records, options}, profiler, result);
        const auto unfiltered = result.unfiltered.readFloats(4);
        std::uint32_t hidden = 0;
        for (int y = 1; y < kHeight; y += 7) {
            for (int x = 1; x < kWidth; x += 5) {
                glm::dvec3 sum(0), open(0);
                for (const GatheredSample& s :
                     pass().readSamples({gbuffer, root, tree, visible, records, options}, {x, y})) {
                    sum += glm::dvec3(s.irradiance);
                    open += glm::dvec3(s.unoccluded);
                    hidden += s.samples - s.visible;
                }
                const auto i = static_cast<std::size_t>(y * kWidth + x);
                for (int k = 0; k < 3; ++k) {
                    const double want = double{unfiltered[4 * i + static_cast<std::size_t>(k)]};
                    // What corrects beliefs may be as large as the light, and cancel.
                    const double slack = visible.present ? 1e-5 * open[k] : 1e-9;
                    EXPECT_NEAR(sum[k], want, 1e-5 * want + slack) << x << ", " << y;
                }
            }
        }
        EXPECT_GT(hidden, 0u);
    }
}

TEST_F(GatherGpu, MarchesWithoutViewsOrScene) {
    const GpuMarchTree empty = uploadMarchTree({});
    const GBuffer gbuffer = room->gbuffer(kWidth, kHeight);
    const ViewHierarchy none = ViewHierarchy::build({}, {});
    for (const float value :
         gathered({*room, gbuffer, none, {}, marching(empty)}).irradiance.readFloats(4)) {
        ASSERT_EQ(value, 0);
    }
    const ViewHierarchy views = ViewHierarchy::build(room->views(12, 2), {});
    GatherOptions unseen = marching(empty);
    unseen.sample.reset();
    EXPECT_EQ(gathered({*room, gbuffer, views, {}, marching(empty)}).irradiance.readFloats(4),
              gathered({*room, gbuffer, views, {}, unseen}).irradiance.readFloats(4));
}

TEST_F(FrameTest, RaysNeedNoMaps) {
    settings.side[0].method = Method::rays;
    const FrameStatistics statistics = render();
    ASSERT_EQ(statistics.methods.size(), 1u);
    EXPECT_EQ(statistics.methods[0].mapBytes, 0u);
    EXPECT_EQ(statistics.methods[0].pairs, PairCounts{});
    EXPECT_EQ(statistics.badPixels, 0u);
    const auto isMarch = [](const MemoryUse& use) { return use.name == "march tree"; };
    EXPECT_TRUE(std::any_of(statistics.memory.begin(), statistics.memory.end(), isMarch));
    EXPECT_TRUE(renderer->readMaps().maps.texels.empty());
    const auto rays = radiance();

    // What is seen of a pixel: its samples, some of them hidden, sum up.
    std::uint32_t hidden = 0, samples = 0;
    for (int x = 5; x < settings.resolution.width; x += 9) {
        const int y = settings.resolution.height / 3;
        const PixelValues pixel = renderer->readPixel(x, y);
        if (!pixel.surface) continue;
        glm::dvec3 sum(0);
        for (const GatheredSample& s : renderer->readSamples(x, y)) {
            sum += glm::dvec3(s.irradiance);
            samples += s.samples;
            hidden += s.samples - s.visible;
        }
        EXPECT_LT(glm::length(sum - glm::dvec3(pixel.sides[0].unfiltered)),
                  1e-5 * glm::length(sum) + 1e-9);
    }
    EXPECT_GT(samples, 20u);
    EXPECT_GT(hidden, 0u);

    settings.side[0].method = Method::none;
    render();
    EXPECT_NE(radiance(), rays);
    settings.side[0].method = Method::rays;
    render();
    EXPECT_EQ(radiance(), rays);
}

TEST_F(FrameTest, TheMarchIsMadeWhenItIsAskedFor) {
    const auto hasMarch = [](const FrameStatistics& statistics) {
        return std::any_of(statistics.memory.begin(), statistics.memory.end(),
                           [](const MemoryUse& use) { return use.name == "march tree"; });
    };
    settings.side[0].method = Method::none;
    EXPECT_FALSE(hasMarch(render()));
    compareWith(settings, Method::rays);
    const FrameStatistics both = render();
    ASSERT_EQ(both.methods.size(), 2u);
    EXPECT_TRUE(hasMarch(both));
    EXPECT_EQ(both.methods[1].mapBytes, 0u);
}

}  // namespace
}  // namespace mv
