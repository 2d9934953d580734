// Pictures of sharing against paths of pairs followed on the CPU.

#include "renderer/passes/sharing_pass.h"

#include <cmath>

#include "gl/gl_fixture.h"
#include "megaviews/settings/debug_legends.h"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/pair_path.glsl"
#include "support/synthetic.h"
#include "support/upload_views.h"

namespace mv {
namespace {

using testing::SyntheticScene;

GpuSceneHierarchy uploadScene(const SyntheticScene& scene, uint rules) {
    GpuSceneHierarchy out;
    out.nodes = {"scene nodes", testing::nodesOf(scene, rules)};
    out.levelBegin = scene.levelBegin;
    out.nodeCount = static_cast<std::uint32_t>(scene.nodes.size());
    out.levels = scene.levels;
    return out;
}

class SharingPassTest : public GlTest {
  protected:
    static constexpr int kWidth = 37, kHeight = 21;
    std::vector<vec3> points;  // of each pixel
    std::vector<bool> present;
    GBuffer gbuffer;

    void TearDown() override { gbuffer = {}; }

    // Every pixel shows a random leaf's surface; some show nothing.
    void makePicture(const SyntheticScene& scene) {
        std::mt19937 random(5);
        const auto leaves = scene.leaves();
        points.clear();
        present.clear();
        std::vector<float> positions, normals, albedos;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            vec3 p(0);
            const bool surface = !leaves.empty() && i % 11 != 3;
            if (surface) {
                const SceneNode& leaf = scene.nodes[leaves[random() % leaves.size()]];
                p = boxCenter(leaf) + boxHalf(leaf) * testing::randomIn(random, -0.5f, 0.5f);
            }
            points.push_back(p);
            present.push_back(surface);
            positions.insert(positions.end(), {p.x, p.y, p.z, surface ? 1.0f : 0.0f});
            normals.insert(normals.end(), {0, 1, 0, 0.5f});
            albedos.insert(albedos.end(), {0.5f, 0.5f, 0.5f, surface ? 1.0f : 0.0f});
        }
        gbuffer.width = kWidth;
        gbuffer.height = kHeight;
        gbuffer.position.ensure("positions", GL_TEXTURE_2D, GL_RGBA32F, kWidth, kHeight);
        gbuffer.normal.ensure("normals", GL_TEXTURE_2D, GL_RGBA16F, kWidth, kHeight);
        gbuffer.albedo.ensure("albedos", GL_TEXTURE_2D, GL_RGBA16F, kWidth, kHeight);
        gbuffer.position.writeFloats(4, positions);
        gbuffer.normal.writeFloats(4, normals);
        gbuffer.albedo.writeFloats(4, albedos);
    }
};

PairEnd endOf(const SyntheticScene& scene, const ViewHierarchy& views, uint rules, int res,
              vec3 point, uint view) {
    const auto& nodes = testing::nodesOf(scene, rules);
    const PairTrees trees{nodes.data(), views.nodes.data()};
    return pairEnd(trees, scenePathTo(trees, point), viewPathFrom(trees, views.leafOfView[view]),
                   rules, pairResolution(static_cast<float>(res), rules, 1));
}

TEST_F(SharingPassTest, CountsTheViewsThatShare) {
    const SyntheticScene room = testing::makeRoom(6);
    makePicture(room);
    const auto all = testing::viewsOnSurfaces(room, 900, 8);
    SharingPass pass;
    gl::Profiler profiler;
    gl::Texture out;
    double means[2] = {};
    for (const uint rules : {kCorrectedRules, kPublishedRules}) {
        const GpuSceneHierarchy scene = uploadScene(room, rules);
        for (const bool flat : {false, true}) {
            for (const std::size_t count : {1u, 7u, 16u, 17u, 900u}) {
                SCOPED_TRACE(std::to_string(count) + (flat ? " flat" : " tree") +
                             (rules == kPublishedRules ? " published" : " corrected"));
                const ViewHierarchy views = ViewHierarchy::build(
                    {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)},
                    {6, rules, flat});
                const GpuViewHierarchy gpuViews = upload(views);
                pass.sharing({gbuffer, scene, gpuViews, rules, 16, true}, 3, 1, profiler, out);
                const auto texels = out.readFloats(2);
                double sum = 0, weight = 0;
                const uint n = static_cast<uint>(count), draws = std::min(n, 16u);
                for (int i = 0; i < kWidth * kHeight; ++i) {
                    const auto pixel = static_cast<std::size_t>(i);
                    uint shared = 0, rendered = 0;
                    for (uint k = 0; present[pixel] && k < draws; ++k) {
                        const uint begin = stratumBegin(n, draws, k);
                        const uint width = stratumBegin(n, draws, k + 1) - begin;
                        const uint hash = pcg4d(uvec4(3u,
                                                      static_cast<uint>(i / kWidth) << 16u |
                                                          static_cast<uint>(i % kWidth),
                                                      k, 0u))
                                              .x;
                        const PairEnd end = endOf(room, views, rules, 16, points[pixel],
                                                  begin + mulHigh(hash, width));
                        if (!isRendered(end)) continue;
                        shared += end.viewCount;
                        ++rendered;
                    }
                    const float mean = rendered ? float(shared) / float(rendered) : 0.0f;
                    ASSERT_FLOAT_EQ(texels[2 * pixel], mean) << "pixel " << i;
                    ASSERT_FLOAT_EQ(texels[2 * pixel + 1], float(rendered) / float(draws));
                    if (flat && rendered) {
                        ASSERT_EQ(texels[2 * pixel], 1.0f);
                    }
                    sum += shared;
                    weight += rendered;
                }
                ASSERT_GT(weight, 0);
                EXPECT_NEAR(SharingPass::meanSharing(out), sum / weight, 1e-4);
                if (count == 900 && !flat) means[rules == kPublishedRules] = sum / weight;
            }
        }
    }
    // Sharing is there, and there is more of it under the corrected rules.
    EXPECT_GT(means[0], 1.3);
    EXPECT_GT(means[0], means[1]);
    expectNoGlErrors();
}

TEST_F(SharingPassTest, ACoarseGridShowsEveryCellsFirstPixel) {
    const SyntheticScene room = testing::makeRoom(5);
    makePicture(room);
    const ViewHierarchy views =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 300, 8), {.levels = 5});
    const GpuSceneHierarchy scene = uploadScene(room, kCorrectedRules);
    const GpuViewHierarchy gpuViews = upload(views);
    const SharingInput input{gbuffer, scene, gpuViews, kCorrectedRules, 16, true};
    SharingPass pass;
    gl::Profiler profiler;
    gl::Texture fine, coarse;
    pass.sharing(input, 1, 1, profiler, fine);
    const auto all = fine.readFloats(4);
    for (const int grid : {2, 3, 64}) {
        pass.sharing(input, 1, grid, profiler, coarse);
        ASSERT_EQ(coarse.width(), kWidth);
        const auto cells = coarse.readFloats(4);
        for (int i = 0; i < kWidth * kHeight; ++i) {
            const int x = i % kWidth / grid * grid, y = i / kWidth / grid * grid;
            for (int c = 0; c < 4; ++c) {
                ASSERT_EQ(cells[static_cast<std::size_t>(4 * i + c)],
                          all[static_cast<std::size_t>(4 * (y * kWidth + x) + c)])
                    << "grid " << grid << " pixel " << i;
            }
        }
    }
    expectNoGlErrors();
}

TEST_F(SharingPassTest, NothingToShowIsBlack) {
    const SyntheticScene room = testing::makeRoom(5), empty = testing::makeEmptyScene();
    const ViewHierarchy some =
        ViewHierarchy::build(testing::viewsOnSurfaces(room, 20, 8), {.levels = 5});
    const ViewHierarchy none = ViewHierarchy::build({}, {.levels = 5});
    SharingPass pass;
    gl::Profiler profiler;
    gl::Texture out;
    const auto expectBlack = [&](const SyntheticScene& scene, const ViewHierarchy& views,
                                 bool method) {
        makePicture(scene);
        const GpuSceneHierarchy gpuScene = uploadScene(scene, kCorrectedRules);
        const GpuViewHierarchy gpuViews = upload(views);
        pass.sharing({gbuffer, gpuScene, gpuViews, kCorrectedRules, 16, method}, 0, 1, profiler,
                     out);
        for (const float x : out.readFloats(3)) ASSERT_EQ(x, 0.0f);
        EXPECT_EQ(SharingPass::meanSharing(out), 0.0);
        pass.shared({gbuffer, gpuScene, gpuViews, kCorrectedRules, 16, method}, {}, 0, 1, profiler,
                    out);
        for (const float x : out.readFloats(4)) ASSERT_TRUE(std::isfinite(x));
    };
    expectBlack(empty, some, true);
    expectBlack(room, none, true);
    expectBlack(room, some, false);  // no method, no pairs
    expectNoGlErrors();
}

TEST_F(SharingPassTest, ColoursWhatTwoViewsShare) {
    const SyntheticScene room = testing::makeRoom(6);
    makePicture(room);
    auto list = testing::viewsOnSurfaces(room, 400, 9);
    list[17].flags = kViewDead;
    const GpuSceneHierarchy scene = uploadScene(room, kCorrectedRules);
    const auto classes = legendOf(DebugView::shared).classes;
    SharingPass pass;
    gl::Profiler profiler;
    gl::Texture out;
    std::vector<int> seen(classes.size());
    for (const bool flat : {false, true}) {
        const ViewHierarchy views = ViewHierarchy::build(list, {6, kCorrectedRules, flat});
        const GpuViewHierarchy gpuViews = upload(views);
        const auto sortedOf = [&](std::int64_t slot) {
            for (uint i = 0; i < views.sortedViews.size(); ++i)
                if (std::int64_t{views.sortedViews[i].slot} == slot) return i;
            return kNone;
        };
        EXPECT_EQ(sortedViewOf(gpuViews, 17), std::nullopt);
        EXPECT_EQ(sortedViewOf(gpuViews, -1), std::nullopt);
        EXPECT_EQ(sortedViewOf(gpuViews, 400), std::nullopt);
        EXPECT_EQ(sortedViewOf(gpuViews, 30), sortedOf(30));
        // Neighbours in the sorted order, views far apart, one view, the same twice, none.
        const auto slotAt = [&](std::size_t i) { return std::int64_t{views.sortedViews[i].slot}; };
        const std::pair<std::int64_t, std::int64_t> picks[] = {
            {slotAt(40), slotAt(41)}, {slotAt(3), slotAt(390)}, {slotAt(7), -1}, {-1, slotAt(7)},
            {slotAt(9), slotAt(9)},   {17, slotAt(5)},          {-1, -1}};
        for (const auto& [slotA, slotB] : picks) {
            SCOPED_TRACE(std::to_string(slotA) + " " + std::to_string(slotB));
            pass.shared({gbuffer, scene, gpuViews, kCorrectedRules, 16, true}, {}, slotA, slotB,
                        profiler, out);
            const auto texels = out.readFloats(4);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const vec3 colour(texels[4 * i], texels[4 * i + 1], texels[4 * i + 2]);
                if (!present[i]) {
                    ASSERT_EQ(colour, vec3(0));
                    continue;
                }
                const auto end = [&](std::int64_t slot) {
                    const uint view = sortedOf(slot);
                    return view == kNone ? PairEnd{kNone, kNone, kPairNone, 0, 0}
                                         : endOf(room, views, kCorrectedRules, 16, points[i], view);
                };
                const PairEnd a = end(slotA), b = end(slotB);
                SharedClass expected = SharedClass::neither;
                if (isRendered(a) && isRendered(b)) {
                    expected = a.sceneNode == b.sceneNode && a.viewNode == b.viewNode
                                   ? SharedClass::together
                                   : SharedClass::apart;
                } else if (isRendered(a) || isRendered(b)) {
                    expected = isRendered(a) ? SharedClass::onlyA : SharedClass::onlyB;
                }
                const auto number = static_cast<std::size_t>(expected);
                ++seen[number];
                // The class is the hue; brightness is the scene's.
                vec3 hue(0);
                for (int c = 0; c < 3; ++c) {
                    const float s = classes[number].colour[static_cast<std::size_t>(c)];
                    hue[c] = s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
                }
                ASSERT_GT(glm::length(colour), 0.02f);
                ASSERT_LT(glm::length(glm::normalize(colour) - glm::normalize(hue)), 2e-3f)
                    << "pixel " << i << " class " << classes[number].name;
                if (flat && slotA != slotB) {
                    ASSERT_NE(expected, SharedClass::together);
                }
            }
        }
    }
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_GT(seen[i], 100) << classes[i].name;
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
