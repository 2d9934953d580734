// Power prefixes at awkward sizes and the lists of kept views, also where they do not fit.

#include <set>

#include "gpu/gather_fixture.h"
#include "megaviews/views/view_spacing.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_views_pass.h"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
namespace {

using test::GatherGpu;

TEST_F(GatherGpu, PowerPrefixAtAwkwardSizes) {
    GatherViewsPass pass;
    GatherViews out;
    GatherRecords packed;
    for (const std::size_t count :
         {1u, 2u, 63u, 64u, 65u, 511u, 512u, 513u, 4095u, 4097u, 30000u}) {
        const ViewHierarchy tree = ViewHierarchy::build(test::roomViews(count, 3, 0.1), {});
        const GpuViewHierarchy gpu = upload(tree);
        pass.render(gpu, 0.01f, out);
        pass.record(gpu, {}, nullptr, out, packed);
        const auto prefix = out.prefix.read(0, count + 1);
        const auto records = packed.records.read(0, count);
        const auto expected = powerPrefix(tree.sortedViews);
        EXPECT_EQ(prefix[0], 0u);
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_GT(prefix[i + 1], prefix[i]) << count << " views, view " << i;
            // Totals are summed in another order: a relative error of single precision.
            const double units = prefix[i + 1] - prefix[i];
            const double want = expected[i + 1] - expected[i];
            EXPECT_NEAR(units, want, 1e-4 * want + 1) << count << " views, view " << i;
            EXPECT_EQ(unitsOf(records[i].unitsAndLamp), prefix[i + 1] - prefix[i]);
            EXPECT_FALSE(isOnLamp(records[i].unitsAndLamp));
            // Units times flux a unit is the flux.
            const View& v = tree.sortedViews[i];
            EXPECT_NEAR(double{records[i].fluxG} * units / double{kPowerUnits}, double{v.fluxG},
                        1e-5 * double{v.fluxG});
            EXPECT_EQ(records[i].positionX, v.positionX);
        }
    }
}

// Of views all over the root cube, and of those of a room that is a speck of it.
TEST_F(GatherGpu, ClampDistancesAreThoseOfTheCpu) {
    GatherViewsPass pass;
    GatherViews out;
    for (const float scale : {1.0f, 5e-4f}) {
        std::vector<View> views = test::roomViews(5000, 3, 0.1);
        for (std::size_t i = 0; i < views.size(); ++i) {
            View& v = views[i];
            if (i % 8 == 0) continue;
            v.positionX = 0.3f + scale * v.positionX, v.positionY = 0.3f + scale * v.positionY;
            v.positionZ = 0.3f + scale * v.positionZ;
        }
        const ViewHierarchy tree = ViewHierarchy::build(views, {});
        pass.render(upload(tree), std::nullopt, out);
        const std::vector<float> expected = clampDistances(tree.sortedViews);
        const std::vector<float> found = out.clampDistances.read(0, expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            ASSERT_NEAR(found[i], expected[i], 1e-5f * expected[i]) << scale << ", view " << i;
        }
    }
}

struct Lists {
    std::vector<GatherList> lists;
    std::vector<GatherRun> runs;
    std::vector<std::uint32_t> prefix;
    std::uint32_t receivers, capacity;
    std::uint32_t tilesAcross;
    std::vector<std::uint32_t> planes;  // of pixels
    std::vector<GatherTile> tiles;

    std::uint32_t listOf(std::uint32_t x, std::uint32_t y, std::uint32_t width) const {
        const std::uint32_t tile = y / kTileEdge * tilesAcross + x / kTileEdge;
        return 1 + kTileParts * tile + partOfPlane(planes[y * width + x]);
    }
    std::vector<bool> heldViews(std::uint32_t list) const {
        std::vector<bool> held(prefix.size() - 1, false);
        for (std::uint32_t k = 0; k < lists[list].runs; ++k) {
            const GatherRun& run = runs[list * capacity + k];
            for (std::uint32_t v = run.firstView; v < runEnd(run.endAndScale); ++v) held[v] = true;
        }
        return held;
    }
};
Lists cull(const GBuffer& gbuffer, const ViewHierarchy& tree, std::uint32_t maxRuns,
           int cullLevel = 6) {
    const GpuViewHierarchy gpu = upload(tree);
    GatherViewsPass viewsPass;
    GatherViews views;
    viewsPass.render(gpu, 0.01, views);
    GatherCullPass pass;
    GatherLists out;
    GatherCullOptions options;
    options.maxRuns = maxRuns;
    options.level = cullLevel;
    pass.render(gbuffer, gpu, views, options, out);
    return {out.lists.read(0, out.receiverCount),
            out.runs.read(0, std::uint64_t{out.receiverCount} * out.capacity),
            views.prefix.read(0, tree.sortedViews.size() + 1),
            out.receiverCount,
            out.capacity,
            out.tilesAcross,
            out.planes.readUints(1),
            out.tiles.read(0, out.receiverCount - 1)};
}

// Runs ascend, do not touch, and their units are those of their views.
void expectSound(const Lists& l) {
    ASSERT_GT(l.receivers, 1u);
    for (std::uint32_t r = 0; r < l.receivers; ++r) {
        const GatherList& list = l.lists[r];
        ASSERT_LE(list.runs, l.capacity);
        std::uint32_t units = 0, views = 0, end = 0;
        for (std::uint32_t i = 0; i < list.runs; ++i) {
            const GatherRun& run = l.runs[r * l.capacity + i];
            const std::uint32_t first = run.firstView, last = runEnd(run.endAndScale);
            const std::uint32_t scale = runScale(run.endAndScale);
            EXPECT_EQ(run.unitsBefore, units) << "receiver " << r << " run " << i;
            EXPECT_TRUE(i == 0 || first >= end) << "receiver " << r << " run " << i;
            EXPECT_LE(scale, 2 * kMaxImportanceShift);
            ASSERT_GT(last, first);
            ASSERT_LT(last, l.prefix.size());
            EXPECT_EQ(run.powerBefore, l.prefix[first]);
            units += listUnits(l.prefix[last] - l.prefix[first], scale);
            views += last - first;
            end = last;
        }
        EXPECT_EQ(list.units, units);
        EXPECT_EQ(list.views, views);  // every view here has power
    }
}

TEST_F(GatherGpu, ListsHoldRunsOfViews) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(2000, 21), {});
    const Lists l = cull(room->gbuffer(128, 80), tree, 1024);
    expectSound(l);
    EXPECT_EQ(l.lists[0].runs, 1u);  // number 0 holds everything, in one run
    EXPECT_EQ(l.lists[0].views, 2000u);
    std::uint64_t kept = 0;
    for (std::uint32_t r = 1; r < l.receivers; ++r) {
        kept += l.lists[r].views;
        EXPECT_EQ(l.lists[r].level, 6u);
    }
    EXPECT_EQ(l.receivers, 1u + 16u * 10u * kTileParts);
    EXPECT_LT(kept, 2000ull * 95 / 100 * (l.receivers - 1));
}

TEST_F(GatherGpu, ListsThatDoNotFitAreCoarser) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(2000, 22), {});
    const GBuffer gbuffer = room->gbuffer(64, 40);
    const Lists wide = cull(gbuffer, tree, 1024);
    for (const std::uint32_t maxRuns : {1u, 2u, 7u, 40u}) {
        const Lists l = cull(gbuffer, tree, maxRuns);
        expectSound(l);
        ASSERT_EQ(l.receivers, wide.receivers);
        std::size_t coarser = 0,
                    joined = 0;  // receivers: of other levels; of fewer runs on the same
        for (std::uint32_t r = 0; r < l.receivers; ++r) {
            // Never fewer views: every view of a wide list is in the narrow one.
            const std::vector<bool> held = l.heldViews(r);
            for (std::uint32_t i = 0; i < wide.lists[r].runs; ++i) {
                const GatherRun& run = wide.runs[r * wide.capacity + i];
                for (std::uint32_t v = run.firstView; v < runEnd(run.endAndScale); ++v) {
                    ASSERT_TRUE(held[v]) << maxRuns << " runs, receiver " << r << " view " << v;
                }
            }
            ASSERT_LE(l.lists[r].level, wide.lists[r].level);
            const bool sameLevel = l.lists[r].level == wide.lists[r].level;
            coarser += !sameLevel;
            joined += sameLevel && l.lists[r].runs < wide.lists[r].runs;
        }
        // What is far is joined first.
        EXPECT_TRUE(maxRuns == 40 ? joined > 10 * coarser : coarser > 0)
            << maxRuns << " runs: " << joined << " joined, " << coarser << " coarser";
    }
}

// Whatever lights a pixel is in the pixel's list: bounds of receivers are never too narrow. Bent
// normals fill the receivers' cones; views that look anywhere have their horizons across boxes.
TEST_F(GatherGpu, ListsHoldAllThatLightsTheirPixels) {
    test::Rng rng(24);
    std::vector<View> views;
    for (int i = 0; i < 4000; ++i) {
        views.push_back(
            test::makeView(test::point(rng, 0.15f, 0.85f), test::direction(rng), vec3(1)));
    }
    test::numberSlots(views);
    const ViewHierarchy tree = ViewHierarchy::build(views, {});
    const GBuffer walls = room->gbuffer(240, 150);
    std::vector<float> normals = walls.normal.readFloats(4);
    for (std::size_t i = 0; i < normals.size(); i += 4) {
        const vec3 n(normals[i], normals[i + 1], normals[i + 2]);
        const vec3 bent = normalizeOr(n + test::direction(rng) * 0.4f, n);
        for (int k = 0; k < 3; ++k) normals[i + std::size_t(k)] = bent[k];
    }
    const GBuffer gbuffer =
        test::Room::makeGBuffer(240, 150, walls.position.readFloats(4), normals);
    const auto pixels = test::receiversOf(gbuffer);
    for (const int cullLevel : {4, 10}) {
        const Lists l = cull(gbuffer, tree, 1024, cullLevel);
        std::vector<std::vector<bool>> held(l.receivers);
        std::uint64_t lost = 0, left = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            if (!pixels[i]) continue;
            const auto x = static_cast<std::uint32_t>(i) % 240,
                       y = static_cast<std::uint32_t>(i) / 240;
            const std::uint32_t list = l.listOf(x, y, 240);
            ASSERT_LT(list, l.receivers);
            if (held[list].empty()) held[list] = l.heldViews(list);
            for (std::size_t v = 0; v < tree.sortedViews.size(); ++v) {
                if (held[list][v]) continue;
                const View& view = tree.sortedViews[v];
                const vec3 toView =
                    vec3(view.positionX, view.positionY, view.positionZ) - pixels[i]->position;
                ++left;
                lost += gatherTerm(toView, pixels[i]->normal,
                                   vec3(view.normalX, view.normalY, view.normalZ),
                                   view.flags == kViewOmnidirectional, 0.01f, 0) > 0;
            }
        }
        EXPECT_EQ(lost, 0u) << "of " << left << " at level " << cullLevel;
        EXPECT_GT(left, 100'000u);
    }
}

TEST_F(GatherGpu, ListsMatchTheReference) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(500, 23), {});
    const GBuffer gbuffer = room->gbuffer(32, 20);
    const Lists l = cull(gbuffer, tree, 1024, 5);
    expectSound(l);
    const auto pixels = test::receiversOf(gbuffer);
    for (std::uint32_t r = 1; r < l.receivers; ++r) {
        std::vector<Receiver> shown;
        for (std::uint32_t y = 0; y < 20; ++y) {
            for (std::uint32_t x = 0; x < 32; ++x) {
                const auto& pixel = pixels[y * 32 + x];
                if (pixel && l.listOf(x, y, 32) == r) shown.push_back(*pixel);
            }
        }
        std::vector<bool> kept(tree.sortedViews.size(), false);
        if (!shown.empty()) {
            for (const std::uint32_t n : keptViewNodes(receiverBounds(shown), tree, 5)) {
                const ViewNode& node = tree.nodes[n];
                std::fill_n(kept.begin() + node.firstView, node.viewCount, true);
            }
        }
        const std::vector<bool> held = l.heldViews(r);
        int different = 0;
        for (std::size_t v = 0; v < kept.size(); ++v) different += kept[v] != held[v];
        // Rounding may keep a view more or less that lights nothing.
        EXPECT_LE(different, 5) << "receiver " << r;
    }
}

// What lies in front and what lies behind, and two walls that meet, are receivers of their own;
// with one surface its two halves are.
TEST_F(GatherGpu, TilesArePartedWhereTheyShowTwoThings) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(30, 26), {});
    constexpr std::uint32_t kEdge = kTileEdge;
    std::vector<float> positions, normals;
    // Three tiles: a step in depth, a crease, a plane.
    for (std::uint32_t i = 0; i < 3 * kEdge * kEdge; ++i) {
        const std::uint32_t x = i % (3 * kEdge), y = i / (3 * kEdge);
        const float u = static_cast<float>(x % kEdge) * 1e-3f, v = static_cast<float>(y) * 1e-3f;
        const bool second = x % kEdge > y / 2;
        vec3 p(0.5f + u, 0.2f, 0.5f + v), n(0, 1, 0);
        if (x / kEdge == 0 && second) p.y = 0.6f;
        if (x / kEdge == 1 && second) n = {-1, 0, 0};
        positions.insert(positions.end(), {p.x, p.y, p.z, 1});
        normals.insert(normals.end(), {n.x, n.y, n.z, 0.03f});
    }
    const Lists l = cull(test::Room::makeGBuffer(3 * kEdge, kEdge, positions, normals), tree, 64);
    for (std::uint32_t tile = 0; tile < 2; ++tile) {
        std::set<std::uint32_t> lists[2];
        for (std::uint32_t y = 0; y < kEdge; ++y) {
            for (std::uint32_t x = 0; x < kEdge; ++x) {
                lists[x > y / 2].insert(l.listOf(tile * kEdge + x, y, 3 * kEdge));
            }
        }
        for (const std::uint32_t list : lists[0]) EXPECT_FALSE(lists[1].contains(list)) << tile;
        EXPECT_LE(lists[0].size() + lists[1].size(), kTileParts);
    }
    for (std::uint32_t r = 0; r < 3 * kTileParts; ++r) {
        const GatherTile& part = l.tiles[r];
        if (part.pixels == 0) continue;
        EXPECT_LT(part.halfY, 1e-4f) << r;
        EXPECT_GT(part.cosCone, 0.999f) << r;
    }
    // A plane has two halves, and no third part.
    for (std::uint32_t part = 0; part < kTileParts; ++part) {
        const std::uint32_t pixels = l.tiles[2 * kTileParts + part].pixels;
        if (part < 2) {
            EXPECT_GE(pixels, kEdge * kEdge / 4);
        } else {
            EXPECT_EQ(pixels, 0u);
        }
    }
}

// So many pixels that tiles are larger than those that draw views.
TEST_F(GatherGpu, TilesAreBounded) {
    const ViewHierarchy tree = ViewHierarchy::build(room->views(30, 25), {});
    const Lists l = cull(room->gbuffer(1200, 1000), tree, 64);
    EXPECT_LE(l.receivers, kMaxTiles * kTileParts + 1);
    EXPECT_EQ(l.tilesAcross, 75u);
    expectSound(l);
}

}  // namespace
}  // namespace mv
