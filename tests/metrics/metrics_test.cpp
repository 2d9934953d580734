// Metrics against values worked out by hand, against OpenImageIO, against numbers of independent.py
// (scikit-image 0.19.3; FLIP from the papers' equations), and by what must hold for any pictures.

#include "megaviews/measure/metrics.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <numeric>

#include "megaviews/core/error.h"
#include "megaviews/measure/pixel_errors.h"
#include "megaviews/measure/rows.h"
#include "megaviews/measure/ssim.h"
#include "metrics/patterns.h"

namespace mv::test {
namespace {

Compared pattern() {
    const Pattern pattern;
    return {pattern.radiance(), pattern.display()};
}

double valueOf(const Compared& compared, Metric metric) {
    return evaluate(compared, std::vector{metric}).front().value;
}

Compared comparedOf(const RgbImage& test, const RgbImage& reference) {
    return {ImagePair(test, reference), ImagePair(test, reference)};
}

TEST(MetricsTable, NamesEachMetricOnceInItsPlace) {
    std::size_t index = 0;
    for (const MetricInfo& info : metricsTable()) {
        EXPECT_EQ(static_cast<std::size_t>(info.metric), index++) << info.name;
        EXPECT_EQ(findMetric(info.name), &info);
        EXPECT_EQ(&infoOf(info.metric), &info);
        EXPECT_FALSE(info.description.empty());
        EXPECT_EQ(info.higherIsBetter, info.name == "psnr" || info.name == "ssim");
    }
    EXPECT_EQ(findMetric("PSNR"), nullptr);
}

TEST(MetricsTable, IsTheOneOfTheDocumentation) {
    std::ifstream file(MEGAVIEWS_SOURCE_DIR "/docs/metrics.md");
    const std::string page(std::istreambuf_iterator<char>(file), {});
    std::string table =
        "| name | unit | measured on | better | what | source |\n|---|---|---|---|---|---|\n";
    for (const MetricInfo& info : metricsTable()) {
        table.append("| `").append(info.name).append("` | ").append(info.unit);
        table.append(info.domain == MetricDomain::display ? " | display" : " | radiance");
        table.append(info.higherIsBetter ? " | higher | " : " | lower | ");
        table.append(info.description).append(" | ").append(info.source).append(" |\n");
    }
    EXPECT_NE(page.find(table), std::string::npos) << "docs/metrics.md should hold\n" << table;
}

TEST(Metrics, AreThoseWorkedOutByHand) {
    // Two pixels, r = (1, 2, 3), (0, 0, 0); t = r + (1, 0, 0), (0, 0.5, 0). Mean of r: 1.
    const RgbImage reference{2, 1, {1, 2, 3, 0, 0, 0}}, test{2, 1, {2, 2, 3, 0, 0.5f, 0}};
    const Compared compared = comparedOf(test, reference);
    EXPECT_DOUBLE_EQ(valueOf(compared, Metric::mse), 1.25 / 6);
    EXPECT_NEAR(valueOf(compared, Metric::relMse), (1 / 1.01 + 0.25 / 0.01) / 6, 1e-12);
    EXPECT_NEAR(valueOf(compared, Metric::mape), 100 * (1 / 1.01 + 0.5 / 0.01) / 6, 1e-10);
    EXPECT_NEAR(valueOf(compared, Metric::psnr), 10 * std::log10(6 / 1.25), 1e-12);
    const double whole = 0.2126 + 2 * 0.7152 + 3 * 0.0722;
    EXPECT_NEAR(valueOf(compared, Metric::leaked), 100 * (0.2126 + 0.3576) / whole, 1e-10);
    EXPECT_EQ(valueOf(compared, Metric::occluded), 0);
    const Compared swapped = comparedOf(reference, test);
    EXPECT_EQ(valueOf(swapped, Metric::leaked), 0);
    EXPECT_GT(valueOf(swapped, Metric::occluded), 0);
    // A filter with negative lobes may leave less than nothing: errors are relative to its size.
    RgbImage below = reference, belowTest = test;
    for (float& v : below.rgb) v = -v;
    for (float& v : belowTest.rgb) v = -v;
    for (const Metric m : {Metric::mse, Metric::relMse, Metric::mape}) {
        EXPECT_DOUBLE_EQ(valueOf(comparedOf(belowTest, below), m), valueOf(compared, m));
    }
}

TEST(Metrics, AddUpWithoutLosingSmallRows) {
    EXPECT_EQ(compensatedSum(std::vector{1.0, 1e100, 1.0, -1e100}), 2.0);
    EXPECT_EQ(compensatedSum(std::vector{1e16, 1.0, 1.0, -1e16}), 2.0);
    EXPECT_EQ(compensatedSum(std::vector{1e308, 1e308, 1.0}), kInfinity);
}

TEST(Metrics, OfFlatPicturesFollowFromTheirFormulas) {
    // No variance: SSIM is its luminance term. Beyond the edge a picture goes on: no edges at all.
    const Compared grey =
        comparedOf(constant(20, 15, 0.5f, 0.5f, 0.5f), constant(20, 15, 0.25f, 0.25f, 0.25f));
    EXPECT_NEAR(valueOf(grey, Metric::ssim), (2 * 0.125 + 1e-4) / (0.3125 + 1e-4), 1e-12);
    // Black to white is 100 of lightness, which is above the knee at 0.4 of green to blue.
    const Compared most = comparedOf(constant(20, 15, 1, 1, 1), constant(20, 15, 0, 0, 0));
    const Compared greenBlue = comparedOf(constant(9, 9, 0, 1, 0), constant(9, 9, 0, 0, 1));
    EXPECT_NEAR(valueOf(greenBlue, Metric::flip), 1, 1e-5);
    // HyAB of Hunt-adjusted green (L 87.73, a -86.18, b 83.18) and blue (32.30, 79.20, -107.86).
    const double distance =
        std::hypot(-0.8773 * 86.18 - 0.323 * 79.2, 0.8773 * 83.18 + 0.323 * 107.86) + 87.73 - 32.30;
    const double ratio = std::pow(100 / distance, 0.7);
    EXPECT_NEAR(valueOf(most, Metric::flip), 0.95 + 0.05 * (ratio - 0.4) / 0.6, 1e-4);
}

TEST(Metrics, AgreeWithScikitImageAndThePapersEquations) {
    const Pattern p;
    ASSERT_EQ(std::accumulate(p.reference.begin(), p.reference.end(), 0), 1141548);
    ASSERT_EQ(std::accumulate(p.test.begin(), p.test.end(), 0), 1111749);
    const Compared c = pattern();
    // Printed by independent.py.
    EXPECT_NEAR(meanSquaredError(c.display), 0.0033929675925758298, 1e-9);
    EXPECT_NEAR(valueOf(c, Metric::psnr), 24.69420288434076, 1e-5);
    EXPECT_NEAR(valueOf(c, Metric::ssim), 0.9114931633704928, 1e-6);
    EXPECT_NEAR(valueOf(c, Metric::flip), 0.14498383815984997, 1e-5);
    const FlipMap map = flip(c.display);
    EXPECT_NEAR(map.errors[7 * 61 + 5], 0.07507443960278347, 1e-4);
    EXPECT_NEAR(map.errors[30 * 61 + 40], 0.3647468298107071, 1e-4);
    EXPECT_NEAR(map.errors[0], 0.04948024655559272, 1e-4);
    EXPECT_NEAR(valueOf(c, Metric::mse) / 194.13150677634414, 1, 1e-6);
    EXPECT_NEAR(valueOf(c, Metric::relMse) / 0.13466301016348245, 1, 1e-6);
    EXPECT_NEAR(valueOf(c, Metric::mape) / (100 * 0.35011433176635115), 1, 1e-6);
    EXPECT_NEAR(valueOf(c, Metric::leaked) / (100 * 0.09020443394374959), 1, 1e-6);
    EXPECT_NEAR(valueOf(c, Metric::occluded) / (100 * 0.15075675111299067), 1, 1e-6);
    const HdrFlipMap hdr = hdrFlip(*c.radiance);
    EXPECT_NEAR(hdr.mean, 0.24490105828027472, 1e-5);
    EXPECT_NEAR(hdr.startEv, -6.10199791968147, 1e-5);
    EXPECT_NEAR(hdr.stopEv, -3.0753478634766833, 1e-5);
    EXPECT_EQ(hdr.exposures, 4);
    EXPECT_NEAR(hdr.errors[30 * 61 + 40], 0.5511080565803371, 1e-4);
    const auto meanSquare = [](const FlipMap& m) {
        return std::inner_product(m.errors.begin(), m.errors.end(), m.errors.begin(), 0.0) /
               static_cast<double>(m.errors.size());
    };
    EXPECT_NEAR(meanSquare(map), 0.03072286999896336, 1e-6);
    EXPECT_NEAR(meanSquare(hdr), 0.078114851170192, 1e-6);
}

// [Wang et al. 2004, eqs. 13 to 17], one window after another with central moments.
double ssimByWindows(const RgbImage& a, const RgbImage& b) {
    const auto luma = [](const RgbImage& image, int x, int y) {
        const float* v = &image.rgb[3 * static_cast<std::size_t>(y * image.width + x)];
        return 0.2126 * double(v[0]) + 0.7152 * double(v[1]) + 0.0722 * double(v[2]);
    };
    const int w = a.width, h = a.height;
    const int marginX = std::min(5, (w - 1) / 2), marginY = std::min(5, (h - 1) / 2);
    double sum = 0;
    int windows = 0;
    for (int cy = marginY; cy < h - marginY; ++cy) {
        for (int cx = marginX; cx < w - marginX; ++cx, ++windows) {
            const auto mean = [&](const auto& value) {
                double total = 0, weights = 0;
                for (int y = std::max(cy - 5, 0); y <= std::min(cy + 5, h - 1); ++y) {
                    for (int x = std::max(cx - 5, 0); x <= std::min(cx + 5, w - 1); ++x) {
                        const int d2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
                        const double weight = std::exp(-d2 / 4.5);
                        total += weight * value(x, y);
                        weights += weight;
                    }
                }
                return total / weights;
            };
            const double meanA = mean([&](int x, int y) { return luma(a, x, y); });
            const double meanB = mean([&](int x, int y) { return luma(b, x, y); });
            const auto moment = [&](const RgbImage& p, double m, const RgbImage& q, double n) {
                return mean(
                    [&](int x, int y) { return (luma(p, x, y) - m) * (luma(q, x, y) - n); });
            };
            const double varA = moment(a, meanA, a, meanA), varB = moment(b, meanB, b, meanB);
            sum += (2 * meanA * meanB + 0.0001) * (2 * moment(a, meanA, b, meanB) + 0.0009) /
                   ((meanA * meanA + meanB * meanB + 0.0001) * (varA + varB + 0.0009));
        }
    }
    return sum / windows;
}

TEST(Metrics, OfStructureIsThatOfWindowsOneByOne) {
    for (const auto& [width, height] : {std::pair{11, 11}, {14, 12}, {7, 30}, {24, 4}, {2, 1}}) {
        const RgbImage a = randomImage(width, height, 21), b = withNoise(a, 0.3f, 22);
        EXPECT_NEAR(valueOf(comparedOf(b, a), Metric::ssim), ssimByWindows(b, a), 1e-12) << width;
    }
}

TEST(Metrics, FlipIsGivenUpBetweenItsParts) {
    const Compared c = pattern();
    std::vector<float> said;
    const Progress listen = [&](std::string_view, float share) { said.push_back(share); };
    EXPECT_EQ(flip(c.display, kFlipPixelsPerDegree, listen).mean, flip(c.display).mean);
    EXPECT_GE(said.size(), 3u);
    said.clear();
    const HdrFlipMap whole = hdrFlip(*c.radiance, kFlipPixelsPerDegree, listen);
    EXPECT_GE(said.size(), 3u * static_cast<std::size_t>(whole.exposures));
    EXPECT_TRUE(std::is_sorted(said.begin(), said.end()));
    EXPECT_EQ(said.front(), 0);
    EXPECT_LT(said.back(), 1);
    for (const std::size_t last : {std::size_t{1}, said.size() / 2, said.size()}) {
        std::size_t calls = 0;
        const Progress stop = [&](std::string_view, float) {
            if (++calls == last) throw Cancelled();
        };
        EXPECT_THROW(evaluate(c, std::vector{Metric::mse, Metric::hdrFlip}, nullptr, stop),
                     Cancelled);
        EXPECT_EQ(calls, last);
    }
}

TEST(Metrics, AgreeWithOpenImageIO) {
    for (const auto& [width, height] : {std::pair{61, 47}, {1, 1}, {640, 3}}) {
        const RgbImage reference = randomImage(width, height, 3);
        const RgbImage test = withNoise(reference, 0.2f, 4);
        const OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::FLOAT);
        OIIO::ImageBuf a(spec, const_cast<float*>(test.rgb.data()));
        OIIO::ImageBuf b(spec, const_cast<float*>(reference.rgb.data()));
        const OIIO::ImageBufAlgo::CompareResults oiio = OIIO::ImageBufAlgo::compare(a, b, 1, 1);
        const ImagePair pair(test, reference);
        EXPECT_NEAR(meanSquaredError(pair) / (oiio.rms_error * oiio.rms_error), 1, 1e-6) << width;
        // Its PSNR takes the largest value as peak.
        EXPECT_NEAR(peakSignalToNoiseRatio(pair), -20 * std::log10(oiio.rms_error), 1e-5) << width;
    }
}

TEST(Metrics, FindNothingInEqualPictures) {
    for (const auto& [width, height] : {std::pair{33, 17}, {1, 1}, {5, 40}, {40, 2}}) {
        const RgbImage image = randomImage(width, height, 5);
        const Compared compared = comparedOf(image, image);
        for (const Metric metric : metricsOf(compared)) {
            const double value = valueOf(compared, metric);
            if (metric == Metric::psnr) {
                EXPECT_EQ(value, std::numeric_limits<double>::infinity());
            } else {
                EXPECT_NEAR(value, metric == Metric::ssim, 1e-12) << infoOf(metric).name;
            }
        }
    }
}

TEST(Metrics, AreSymmetricWhereNeitherPictureIsTheMeasure) {
    const RgbImage a = randomImage(40, 30, 6), b = withNoise(a, 0.3f, 7);
    const Compared ab = comparedOf(a, b), ba = comparedOf(b, a);
    for (const Metric m : {Metric::mse, Metric::psnr, Metric::ssim, Metric::flip}) {
        EXPECT_NEAR(valueOf(ab, m), valueOf(ba, m), 1e-9) << infoOf(m).name;
    }
    EXPECT_NEAR(valueOf(ab, Metric::leaked) / valueOf(ba, Metric::occluded),
                energyError(*ab.radiance).leaked / energyError(*ba.radiance).occluded, 1e-12);
}

TEST(Metrics, GrowWorseWithNoise) {
    const RgbImage reference = randomImage(48, 32, 8);
    std::vector<double> last;
    for (const float amplitude : {0.02f, 0.05f, 0.1f, 0.2f, 0.4f}) {
        const Compared compared = comparedOf(withNoise(reference, amplitude, 9), reference);
        std::vector<double> values;
        for (const Metric m : metricsOf(compared)) {
            values.push_back(valueOf(compared, m) * (infoOf(m).higherIsBetter ? -1 : 1));
        }
        for (std::size_t i = 0; i < last.size(); ++i) {
            EXPECT_GT(values[i], last[i]) << metricsTable()[i].name << " at " << amplitude;
        }
        last = values;
    }
}

TEST(Metrics, OfRatiosDoNotDependOnTheUnitOfLight) {
    const Pattern p;
    const Compared plain{p.radiance(), p.display()};
    for (const float scale : {1e-6f, 1e6f}) {
        RgbImage test = p.radiance().test(), reference = p.radiance().reference();
        for (float& v : test.rgb) v *= scale;
        for (float& v : reference.rgb) v *= scale;
        const Compared scaled{ImagePair(test, reference), p.display()};
        for (const Metric m : {Metric::relMse, Metric::mape, Metric::hdrFlip, Metric::leaked}) {
            EXPECT_NEAR(valueOf(scaled, m) / valueOf(plain, m), 1, 1e-4) << infoOf(m).name;
        }
    }
}

TEST(Metrics, LeaveOutPixelsThatAreNotFinite) {
    const RgbImage reference = randomImage(30, 20, 10), test = withNoise(reference, 0.1f, 11);
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        RgbImage badTest = test, badReference = reference;
        badTest.rgb[3 * 77 + 1] = bad;
        badReference.rgb[3 * 300] = bad;
        const Compared compared = comparedOf(badTest, badReference);
        EXPECT_EQ(compared.display.badPixels(), 2u);
        EXPECT_TRUE(compared.display.isBad(77));
        EXPECT_TRUE(compared.display.isBad(300));
        for (const MetricValue& value : evaluate(compared, metricsOf(compared))) {
            EXPECT_TRUE(std::isfinite(value.value)) << infoOf(value.metric).name;
        }
        // The mean over the others, by hand.
        double sum = 0;
        for (std::size_t p = 0; p < test.pixels(); ++p) {
            for (std::size_t c = 0; c < 3 && p != 77 && p != 300; ++c) {
                sum += std::pow(double(test.rgb[3 * p + c]) - double(reference.rgb[3 * p + c]), 2);
            }
        }
        EXPECT_NEAR(valueOf(compared, Metric::mse), sum / (3.0 * 598), 1e-12);
        // FLIP looks at neighbours, which differ: the pixels themselves show nothing.
        for (const FlipMap& map : {flip(compared.display), FlipMap(hdrFlip(*compared.radiance))}) {
            EXPECT_EQ(map.errors[77], 0);
            EXPECT_EQ(map.errors[300], 0);
            EXPECT_GT(map.errors[78], 0);
        }
    }
}

TEST(Metrics, OfNoPixelsAreNaN) {
    for (const RgbImage& image : {RgbImage{}, RgbImage{2, 1, {kNaN, 0, 0, 0, kInfinity, 0}}}) {
        const Compared compared = comparedOf(image, image);
        for (const MetricValue& value : evaluate(compared, metricsOf(compared))) {
            EXPECT_TRUE(std::isnan(value.value)) << infoOf(value.metric).name;
        }
    }
}

TEST(Metrics, SurviveBlackAndExtremeReferences) {
    const Compared black = comparedOf(constant(8, 8, 0.5f, 0.5f, 0.5f), constant(8, 8, 0, 0, 0));
    EXPECT_EQ(valueOf(black, Metric::relMse), std::numeric_limits<double>::infinity());
    EXPECT_EQ(valueOf(black, Metric::leaked), std::numeric_limits<double>::infinity());
    EXPECT_TRUE(std::isfinite(valueOf(black, Metric::hdrFlip)));
    // Mostly black, with one texel of the sun, and negative radiance from a filter.
    RgbImage sun = constant(30, 30, 0, 0, 0), test = constant(30, 30, -1, 1e30f, 1e-30f);
    sun.rgb[0] = 1e20f;
    const HdrFlipMap hdr = hdrFlip(ImagePair(test, sun));
    EXPECT_EQ(hdr.exposures, 20);
    EXPECT_GT(hdr.mean, 0);
    for (const float error : hdr.errors) EXPECT_TRUE(error >= 0 && error <= 1) << error;
}

TEST(Metrics, AreTheSameBitsForAnyNumberOfThreads) {
    const RgbImage reference = randomImage(150, 100, 12), test = withNoise(reference, 0.2f, 13);
    const Compared compared = comparedOf(test, reference);
    const std::vector<Metric> all = metricsOf(compared);
    const std::vector<MetricValue> values = evaluate(compared, all);
    for (const std::size_t threads : {1u, 2u, 7u}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const double again = valueOf(compared, all[i]);
            EXPECT_EQ(std::bit_cast<std::uint64_t>(values[i].value),
                      std::bit_cast<std::uint64_t>(again))
                << infoOf(all[i]).name << ", " << threads << " threads";
        }
    }
}

TEST(Metrics, GiveTheFlipMapThatBelongsToThem) {
    const Compared c = pattern();
    FlipMap map;
    const std::vector<MetricValue> values =
        evaluate(c, std::vector{Metric::hdrFlip, Metric::flip}, &map);
    EXPECT_EQ(map.mean, values[1].value);
    evaluate(c, std::vector{Metric::flip, Metric::hdrFlip}, &map);
    EXPECT_EQ(map.mean, values[1].value);
    evaluate(c, std::vector{Metric::hdrFlip}, &map);
    EXPECT_EQ(map.mean, values[0].value);
    EXPECT_EQ(map.errors.size(), 61u * 47);
    EXPECT_EQ(metricsOf({std::nullopt, c.display}),
              (std::vector{Metric::psnr, Metric::ssim, Metric::flip}));
}

TEST(DisplayImage, IsWhatTheFormulasOfTheToneMapsGive) {
    const RgbImage radiance{2, 1, {0.5f, -1, 100, kNaN, 0, 1}};
    const RgbImage plain = displayImage(radiance, 0, ToneMap::none);
    EXPECT_NEAR(plain.rgb[0], 1.055 * std::pow(0.5, 1 / 2.4) - 0.055, 1e-6);
    EXPECT_EQ(plain.rgb[1], 0);
    EXPECT_FLOAT_EQ(plain.rgb[2], 1);
    EXPECT_TRUE(std::isnan(plain.rgb[3]));
    EXPECT_NEAR(displayImage(radiance, -3, ToneMap::none).rgb[0],
                1.055 * std::pow(0.0625, 1 / 2.4) - 0.055, 1e-6);
    const double aces = 0.5 * (2.51 * 0.5 + 0.03) / (0.5 * (2.43 * 0.5 + 0.59) + 0.14);
    EXPECT_NEAR(displayImage(radiance, 0, ToneMap::aces).rgb[0],
                1.055 * std::pow(aces, 1 / 2.4) - 0.055, 1e-6);
    // Khronos' PBR Neutral, below and above where it compresses, worked out by hand.
    const RgbImage two{2, 1, {0.5f, 0.3f, 0.05f, 2, 1, 0.5f}};
    const RgbImage neutral = displayImage(two, 0, ToneMap::neutral);
    const double byHand[] = {0.465625, 0.265625, 0.015625, 0.96, 0.534089, 0.321136};
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(neutral.rgb[i], 1.055 * std::pow(byHand[i], 1 / 2.4) - 0.055, 2e-6) << i;
    }
    // AgX for an exponent of 2.2, worked out in Python by the matrices and the sigmoid of Sobotka's
    // configuration, whose rows add up to 1 within 2e-4; above 1 is cut.
    const RgbImage four{4, 1, {0.5f, 0.3f, 0.05f, 2, 1, 0.5f, 0.01f, 0.01f, 0.01f, 20, 0, 0}};
    const RgbImage agx = displayImage(four, 0, ToneMap::agx);
    const double encoded[] = {0.694117, 0.598890, 0.341679, 0.887564, 0.791755, 0.692340,
                              0.096149, 0.096154, 0.096154, 1,        0.749999, 0.750206};
    for (std::size_t i = 0; i < 12; ++i) {
        EXPECT_NEAR(agx.rgb[i], 1.055 * std::pow(std::pow(encoded[i], 2.2), 1 / 2.4) - 0.055, 3e-4)
            << i;
    }
    const RgbImage bright{1, 1, {3e38f, 3e38f, 3e38f}};
    for (const ToneMap tone : {ToneMap::none, ToneMap::aces, ToneMap::neutral, ToneMap::agx}) {
        for (const float v : displayImage(bright, 20, tone).rgb) EXPECT_NEAR(v, 1, 1e-3);
    }
}

}  // namespace
}  // namespace mv::test
