// The cross-bilateral filter: constants stay, edges and shadows stay, noise goes, at both scales.

#include <bit>
#include <limits>
#include <random>

#include "gpu/gather_fixture.h"
#include "renderer/passes/filter_pass.h"

namespace mv {
namespace {

using test::GatherGpu;

// A gather whose result is known: views so far away that every pixel of a plane gets the same.
struct Plane {
    std::vector<float> positions, normals;
    int width, height;
    float depth = 0.03f;  // pixels are 1e-3 apart: an image of 32 rows at this depth
    Plane(int w, int h) : width(w), height(h) {}
    void pixel(vec3 p, vec3 n, bool present = true) {
        positions.insert(positions.end(), {p.x, p.y, p.z, present ? 1.0f : 0.0f});
        normals.insert(normals.end(), {n.x, n.y, n.z, depth});
    }
    GBuffer gbuffer() const { return test::Room::makeGBuffer(width, height, positions, normals); }
};

std::vector<float> gather(const test::Room& room, const GBuffer& gbuffer,
                          const std::vector<View>& views, GatherOptions options,
                          GatherResult* result = nullptr) {
    const ViewHierarchy tree = ViewHierarchy::build(views, {});
    const GpuViewHierarchy gpu = upload(tree);
    gl::Profiler profiler;
    GatherResult local;
    GatherResult& out = result ? *result : local;
    test::gatherOnce(GatherGpu::pass(), gbuffer, room.scene.root, gpu, {}, options, profiler, out);
    EXPECT_EQ(gl::reportedErrors(), 0u);
    return out.irradiance.readFloats(4);
}

std::vector<View> lampAbove(vec3 flux = {1, 1, 1}) {
    return {test::makeView({0.5f, 0.99f, 0.5f}, {0, -1, 0}, flux)};
}

TEST_F(GatherGpu, FilterKeepsAConstant) {
    // Every pixel is the same point, so every irradiance is the same number.
    for (const int scale : {1, 2, 3, 4}) {
        for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {7, 5}, {64, 33}}) {
            Plane plane(w, h);
            for (int i = 0; i < w * h; ++i) {
                plane.pixel({0.5f, 0.2f, 0.5f}, {0, 1, 0}, i % 11 != 10);
            }
            GatherOptions options = test::plainOptions();
            options.samples = 1;
            options.cull.scale = scale;
            const auto e = gather(*room, plane.gbuffer(), lampAbove(), options);
            for (int i = 0; i < w * h; ++i) {
                const auto k = static_cast<std::size_t>(4 * i);
                if (i % 11 == 10) {
                    EXPECT_EQ(e[k], 0);
                } else {
                    EXPECT_NEAR(e[k], e[0], 1e-6f * e[0]) << w << "x" << h << " pixel " << i;
                }
            }
            EXPECT_GT(e[0], 0);
        }
    }
}

// The left half is lit, the right half is not: a step in depth, a crease, or a gap between them.
void expectEdgeKept(const test::Room& room, const Plane& plane, int scale) {
    GatherOptions options = test::plainOptions();
    options.samples = 1;
    options.cull.scale = scale;
    const auto e = gather(room, plane.gbuffer(), lampAbove(), options);
    for (int y = 0; y < plane.height; ++y) {
        for (int x = 0; x < plane.width; ++x) {
            const auto k = static_cast<std::size_t>(4 * (y * plane.width + x));
            if (x < plane.width / 2) {
                EXPECT_GT(e[k], 0.9f * e[0]) << "lit pixel " << x << " " << y;
            } else {
                EXPECT_EQ(e[k], 0) << "dark pixel " << x << " " << y;
            }
        }
    }
    EXPECT_GT(e[0], 0);
}

TEST_F(GatherGpu, FilterDoesNotLeakOverEdges) {
    constexpr int kSize = 33;  // odd: half-resolution pixels straddle the edge
    for (const int scale : {1, 2, 3}) {
        Plane crease(kSize, kSize), step(kSize, kSize);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const float u = static_cast<float>(x) * 1e-3f, v = static_cast<float>(y) * 1e-3f;
                const bool lit = x < kSize / 2;
                // A floor that meets a wall facing away from the lamp's plane.
                crease.pixel(lit ? vec3(0.5f + u, 0.2f, 0.5f + v)
                                 : vec3(0.5f + static_cast<float>(kSize / 2) * 1e-3f,
                                        0.2f - (u - 0.016f), 0.5f + v),
                             lit ? vec3(0, 1, 0) : vec3(0, -0.6f, 0.8f));
                // Two floors, the dark one above the lamp.
                step.pixel(lit ? vec3(0.5f + u, 0.2f, 0.5f + v) : vec3(0.5f + u, 0.995f, 0.5f + v),
                           {0, 1, 0});
            }
        }
        expectEdgeKept(*room, crease, scale);
        expectEdgeKept(*room, step, scale);
    }
}

double variance(const std::vector<float>& e, double& mean) {
    double sum = 0, squares = 0;
    std::size_t n = 0;
    for (std::size_t i = 1; i < e.size(); i += 4, ++n) {
        sum += double{e[i]};
        squares += double{e[i]} * double{e[i]};
    }
    mean = sum / static_cast<double>(n);
    return squares / static_cast<double>(n) - mean * mean;
}

// So small that under many views its irradiance is nearly constant.
GBuffer patchOfFloor() {
    Plane plane(64, 64);
    for (int i = 0; i < 64 * 64; ++i) {
        plane.pixel({0.3f + static_cast<float>(i % 64) * 1e-5f, 0.125f,
                     0.3f + static_cast<float>(i / 64) * 1e-5f},
                    {0, 1, 0});
    }
    return plane.gbuffer();
}

TEST_F(GatherGpu, FilterLowersTheNoiseAndKeepsTheMean) {
    const GBuffer gbuffer = patchOfFloor();
    const std::vector<View> views = room->views(2000, 31);
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    double exact = 0, noisyMean = 0, mean = 0;
    variance(gather(*room, gbuffer, views, options), exact);
    options.samples = 4;
    options.filter = false;
    const double noisy = variance(gather(*room, gbuffer, views, options), noisyMean);
    options.filter = true;
    const double smooth = variance(gather(*room, gbuffer, views, options), mean);
    EXPECT_NEAR(noisyMean, exact, 0.05 * exact);
    EXPECT_NEAR(mean, noisyMean, 0.01 * exact);
    EXPECT_LT(smooth, 0.02 * noisy);
    options.cull.scale = 2;
    double halfMean = 0;
    const double half = variance(gather(*room, gbuffer, views, options), halfMean);
    EXPECT_NEAR(halfMean, exact, 0.05 * exact);
    EXPECT_LT(half, 0.05 * noisy);
}

// A mean of many sets has little noise, and would keep what each was blurred by: later sets are
// filtered less and less, down to one pass.
TEST_F(GatherGpu, FilterIsNarrowerTheMoreSetsThereAre) {
    const GBuffer gbuffer = patchOfFloor();
    const std::vector<View> views = room->views(2000, 31);
    GatherOptions options = test::plainOptions();
    options.samples = 4;
    double mean = 0, before = 0;
    for (const int set : {1, 2, 4, 8, 16}) {
        options.set = set;
        const double left = variance(gather(*room, gbuffer, views, options), mean);
        EXPECT_GT(left, 1.3 * before) << set;
        before = left;
    }
    options.set = 3;
    const auto third = gather(*room, gbuffer, views, options);
    options.set = 2;
    EXPECT_EQ(gather(*room, gbuffer, views, options), third) << "doublings count";
    options.set = 1000;
    const double last = variance(gather(*room, gbuffer, views, options), mean);
    options.filter = false;
    EXPECT_LT(last, 0.6 * variance(gather(*room, gbuffer, views, options), mean));
}

// A floor whose left half is half as bright, under noise: what the filter is told of the noise
// decides whether it goes, and whether the edge stays.
TEST_F(GatherGpu, FilterKeepsAShadowThatStandsOutOfTheNoise) {
    constexpr int kSize = 64;
    constexpr float kNoise = 0.1f;
    Plane plane(kSize, kSize);
    std::vector<std::uint32_t> points;
    for (int i = 0; i < kSize * kSize; ++i) {
        const vec3 p(0.3f + static_cast<float>(i % kSize) * 1e-3f, 0.125f,
                     0.3f + static_cast<float>(i / kSize) * 1e-3f);
        plane.pixel(p, {0, 1, 0});
        for (const float x : {p.x, p.y, p.z}) points.push_back(std::bit_cast<std::uint32_t>(x));
        points.push_back(packNormal({0, 1, 0}));
    }
    gl::Texture surfaces("test surfaces", GL_TEXTURE_2D, GL_RGBA32UI, kSize, kSize);
    glTextureSubImage2D(surfaces.id(), 0, 0, 0, kSize, kSize, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        points.data());

    const GBuffer gbuffer = plane.gbuffer();
    FilterPass filter;
    struct Halves {
        double mean[2], variance[2], step;  // the step: of the four columns at the edge
    };
    const auto filtered = [&](float variance) {
        std::mt19937 random(5);
        std::normal_distribution<float> noise(0, kNoise);
        std::vector<float> texels;
        for (int i = 0; i < kSize * kSize; ++i) {
            const float light = (i % kSize < kSize / 2 ? 0.5f : 1.0f) + noise(random);
            texels.insert(texels.end(), {light, light, light, variance});
        }
        gl::Texture noisy("test irradiance", GL_TEXTURE_2D, GL_RGBA32F, kSize, kSize);
        noisy.writeFloats(4, texels);
        const auto e = filter.render(gbuffer, surfaces, 1, noisy, 4, {}, nullptr).readFloats(4);
        Halves out{};
        double columns[kSize] = {};
        for (int half = 0; half < 2; ++half) {
            double squares = 0;
            for (int i = 0; i < kSize * kSize; ++i) {
                if (i % kSize / (kSize / 2) != half) continue;
                const double light = e[static_cast<std::size_t>(4 * i)];
                columns[i % kSize] += light / kSize;
                out.mean[half] += light * 2 / (kSize * kSize);
                squares += light * light * 2 / (kSize * kSize);
            }
            out.variance[half] = squares - out.mean[half] * out.mean[half];
        }
        out.step = (columns[33] + columns[32] - columns[31] - columns[30]) / 2;
        return out;
    };

    const Halves told = filtered(kNoise * kNoise);
    const Halves unknown = filtered(100);  // everything may be noise: a plain blur
    const Halves none = filtered(0);       // nothing is
    EXPECT_GT(told.step, 0.4) << "a step of five deviations stays";
    EXPECT_LT(unknown.step, 0.15);
    for (int half = 0; half < 2; ++half) {
        EXPECT_NEAR(told.mean[half], half == 0 ? 0.5 : 1, 0.01);
        EXPECT_LT(told.variance[half], 0.03 * kNoise * kNoise) << "and the noise goes";
        EXPECT_NEAR(none.variance[half], kNoise * kNoise, 0.1 * kNoise * kNoise);
    }
    // Light without bounds is not mixed, and does no harm to others.
    for (const float huge : {1e20f, std::numeric_limits<float>::infinity()}) {
        std::vector<float> texels(4 * kSize * kSize, 1.0f);
        for (std::size_t c = 0; c < 4; ++c) texels[4 * (32 * kSize + 32) + c] = huge;
        gl::Texture noisy("test irradiance", GL_TEXTURE_2D, GL_RGBA32F, kSize, kSize);
        noisy.writeFloats(4, texels);
        const auto e = filter.render(gbuffer, surfaces, 1, noisy, 1, {}, nullptr).readFloats(4);
        for (std::size_t i = 0; i < kSize * kSize; ++i) {
            const std::size_t x = i % kSize, y = i / kSize;
            if (x == 32 && y == 32) {
                EXPECT_EQ(e[4 * i], huge) << "what is wrong stays to be seen";
                continue;
            }
            EXPECT_NEAR(e[4 * i], 1, 1e-6) << x << " " << y << " beside " << huge;
        }
    }
}

// What is far brighter than all around goes, with what it has spread to beside it; lines, edges and
// what is wrong stay.
TEST_F(GatherGpu, FirefliesAreAsBrightAsWhatLiesAroundThem) {
    constexpr int kSize = 24;
    constexpr float kFactor = 1.5f;
    Plane plane(kSize, kSize);
    for (int i = 0; i < kSize * kSize; ++i) plane.pixel({0.3f, 0.125f, 0.3f}, {0, 1, 0});
    const GBuffer gbuffer = plane.gbuffer();
    gl::Texture surfaces("test surfaces", GL_TEXTURE_2D, GL_RGBA32UI, kSize, kSize);
    gl::Texture noisy("test irradiance", GL_TEXTURE_2D, GL_RGBA32F, kSize, kSize);
    std::vector<std::uint32_t> points;
    for (int i = 0; i < kSize * kSize; ++i) {
        for (const float x : {0.3f, 0.125f, 0.3f})
            points.push_back(std::bit_cast<std::uint32_t>(x));
        points.push_back(packNormal({0, 1, 0}));
    }
    glTextureSubImage2D(surfaces.id(), 0, 0, 0, kSize, kSize, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        points.data());
    FilterPass filter;
    const auto at = [](int x, int y) { return static_cast<std::size_t>(4 * (y * kSize + x)); };
    const auto shown = [&](std::vector<float> light, std::optional<float> factor,
                           bool dark = false) {
        noisy.writeFloats(4, light);
        std::optional<OutlierLimit> limit;
        if (factor) limit = OutlierLimit{*factor, dark};
        return filter.render(gbuffer, surfaces, 1, noisy, 1, limit, nullptr).readFloats(4);
    };
    const auto put = [&](std::vector<float>& light, int x, int y, float value) {
        for (std::size_t c = 0; c < 3; ++c) light[at(x, y) + c] = value;
    };
    // So sure that no tap shares.
    std::vector<float> even(4 * kSize * kSize, 1.0f);
    for (std::size_t i = 3; i < even.size(); i += 4) even[i] = 1e-6f;
    std::vector<float> dots = even;
    put(dots, 8, 8, 30);
    put(dots, 15, 4, 30);  // with two beside it
    put(dots, 16, 4, 9);
    put(dots, 16, 5, 7);
    put(dots, 0, 23, 30);                               // in a corner
    for (int x = 4; x < 20; ++x) put(dots, x, 14, 30);  // a line
    put(dots, 20, 20, 1.4f);                            // little brighter
    const std::vector<float> kept = shown(dots, {});
    const std::vector<float> limited = shown(dots, kFactor);
    const std::vector<float> ofFour = shown(dots, 4 * kFactor);
    // Dark ones, under a sky; black has the grey of what is around.
    std::vector<float> holes = even;
    put(holes, 8, 8, 0.1f);
    put(holes, 15, 4, 0);
    put(holes, 16, 4, 0.2f);
    put(holes, 4, 20, -0.5f);                              // of samples that took too much
    for (int x = 4; x < 20; ++x) put(holes, x, 14, 0.1f);  // a line
    EXPECT_EQ(shown(holes, kFactor), shown(holes, {}));
    const std::vector<float> filled = shown(holes, kFactor, true);
    for (const auto& [x, y] : {std::pair{8, 8}, {15, 4}, {16, 4}, {4, 20}}) {
        EXPECT_FLOAT_EQ(filled[at(x, y)], 1 / kFactor) << x << " " << y;
    }
    EXPECT_FLOAT_EQ(filled[at(10, 14)], holes[at(10, 14)]);
    // A colour of which samples took too much is that of what is around, as bright as it was.
    std::vector<float> tinted = even;
    tinted[at(8, 8) + 2] = -0.5f;
    const std::vector<float> grey = shown(tinted, kFactor);
    const float light = luminance(glm::vec3(1, 1, -0.5f));
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(grey[at(8, 8) + c], light, 1e-3f);
    for (const auto& [x, y] : {std::pair{8, 8}, {15, 4}, {16, 4}, {16, 5}, {0, 23}}) {
        EXPECT_FLOAT_EQ(kept[at(x, y)], dots[at(x, y)]) << x << " " << y;
        EXPECT_FLOAT_EQ(limited[at(x, y)], kFactor) << x << " " << y;
        const float left = limited[at(x, y)] / kept[at(x, y)];
        EXPECT_FLOAT_EQ(limited[at(x, y) + 3], kept[at(x, y) + 3] * left * left);
        EXPECT_FLOAT_EQ(ofFour[at(x, y)], std::min(4 * kFactor, dots[at(x, y)])) << x << " " << y;
    }
    for (int x = 6; x < 18; ++x) EXPECT_EQ(limited[at(x, 14)], 30) << "line, " << x;
    EXPECT_FLOAT_EQ(limited[at(20, 20)], 1.4f);
    EXPECT_EQ(limited[at(12, 9)], 1);
    // What is small and far has none around it that says how bright it should be.
    std::vector<std::uint32_t> few = points;
    for (std::size_t i = 3; i < few.size(); i += 4) {
        const std::size_t x = i / 4 % kSize, y = i / 4 / kSize;
        if (x < 7 || x > 8 || y < 7 || y > 9) few[i] = kNoSurface;
    }
    glTextureSubImage2D(surfaces.id(), 0, 0, 0, kSize, kSize, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        few.data());
    EXPECT_FLOAT_EQ(shown(dots, kFactor)[at(8, 8)], 30);
    glTextureSubImage2D(surfaces.id(), 0, 0, 0, kSize, kSize, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
                        points.data());
    std::vector<float> wrong = even;
    put(wrong, 8, 8, std::numeric_limits<float>::infinity());
    EXPECT_EQ(shown(wrong, kFactor)[at(8, 8)], std::numeric_limits<float>::infinity());
    EXPECT_EQ(shown(wrong, kFactor)[at(9, 8)], 1);
}

// Interleaving: the 16 pixels of a block together are better than 16 independent estimates.
TEST_F(GatherGpu, BlocksAreStratifiedTogether) {
    Plane plane(64, 64);
    for (int i = 0; i < 64 * 64; ++i) plane.pixel({0.3f, 0.125f, 0.3f}, {0, 1, 0});
    GatherOptions options = test::plainOptions();
    options.samples = 4;
    options.filter = false;
    const auto e = gather(*room, plane.gbuffer(), room->views(2000, 32), options);
    double mean = 0;
    const double pixel = variance(e, mean);
    double squares = 0;
    for (std::size_t b = 0; b < 256; ++b) {
        double sum = 0;
        for (std::size_t i = 0; i < 16; ++i) {
            const std::size_t x = b % 16 * 4 + i % 4, y = b / 16 * 4 + i / 4;
            sum += double{e[4 * (y * 64 + x) + 1]};
        }
        squares += (sum / 16 - mean) * (sum / 16 - mean);
    }
    EXPECT_LT(squares / 256, 0.75 * pixel / 16);
}

// A pixel that no half-resolution neighbour can speak for is gathered on its own.
// Light that falls in one direction alone, on a plane: each gathered pixel keeps its own, and those
// between take what lies between.
TEST_F(GatherGpu, LightOfALowerResolutionStandsWhereItWasGathered) {
    Plane plane(33, 9);
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 33; ++x) {
            plane.pixel({0.5f + 4e-3f * static_cast<float>(x), 0.2f, 0.5f}, {0, 1, 0});
        }
    }
    const GBuffer gbuffer = plane.gbuffer();
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    options.filter = false;
    const auto exact = gather(*room, gbuffer, lampAbove(), options);
    const float step = std::abs(exact[4 * 32] - exact[4 * 31]);  // a pixel's, where it is steepest
    for (const int scale : {2, 3, 4}) {
        options.cull.scale = scale;
        const auto e = gather(*room, gbuffer, lampAbove(), options);
        const auto last = static_cast<std::size_t>(32 / scale * scale);
        for (std::size_t x = 0; x <= last; ++x) {
            EXPECT_NEAR(e[4 * x], exact[4 * x], 0.1f * step) << scale << " " << x;
        }
    }
}

TEST_F(GatherGpu, ThinThingsAreGatheredAtFullResolution) {
    Plane plane(32, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const bool wire = x == 13;  // odd: half-resolution pixels show what lies behind
            const float u = static_cast<float>(x) * 1e-3f, v = static_cast<float>(y) * 1e-3f;
            plane.pixel(wire ? vec3(0.5f + u, 0.6f, 0.5f + v) : vec3(0.5f + u, 0.2f, 0.5f + v),
                        wire ? normalize(vec3(1, 1, 0)) : vec3(0, 1, 0));
        }
    }
    const GBuffer gbuffer = plane.gbuffer();
    GatherOptions options = test::plainOptions();
    options.samples = 0;
    const auto exact = gather(*room, gbuffer, lampAbove(), options);
    options.cull.scale = 2;
    const auto half = gather(*room, gbuffer, lampAbove(), options);
    for (std::size_t i = 0; i < 32 * 32; ++i) {
        EXPECT_NEAR(half[4 * i], exact[4 * i], 0.02f * exact[4 * i]) << i % 32 << " " << i / 32;
    }
}

// At a lower one still it takes the light of what is near, however that faces.
TEST_F(GatherGpu, ThinThingsOfACoarseDraftTakeWhatIsNear) {
    for (const bool alike : {true, false}) {
        Plane plane(32, 32);
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 32; ++x) {
                const bool wire = x == 13;
                const float u = static_cast<float>(x) * 1e-3f, v = static_cast<float>(y) * 1e-3f;
                plane.pixel(vec3(0.5f + u, wire ? 0.6f : 0.2f, 0.5f + v),
                            wire && !alike ? vec3(1, 0, 0) : vec3(0, 1, 0));
            }
        }
        const GBuffer gbuffer = plane.gbuffer();
        GatherOptions options = test::plainOptions();
        options.samples = 0;
        for (const int scale : {3, 4}) {
            options.cull.scale = scale;
            const auto e = gather(*room, gbuffer, lampAbove(), options);
            for (std::size_t i = 0; i < 32 * 32; ++i) {
                EXPECT_NEAR(e[4 * i], e[4 * 16], 0.05f * e[4 * 16]) << i % 32 << " " << i / 32;
            }
        }
    }
}

TEST_F(GatherGpu, OutputsHaveTheSizeOfTheGBuffer) {
    const GBuffer gbuffer = room->gbuffer(33, 17);
    for (const int scale : {1, 2, 3, 4}) {
        GatherOptions options = test::plainOptions();
        options.cull.scale = scale;
        options.samples = 2;
        GatherResult result;
        gather(*room, gbuffer, room->views(50, 33), options, &result);
        for (const gl::Texture* t : {&result.irradiance, &result.unfiltered, &result.candidates}) {
            EXPECT_EQ(t->width(), 33);
            EXPECT_EQ(t->height(), 17);
        }
    }
}

}  // namespace
}  // namespace mv
