#include "megaviews/measure/pixel_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "megaviews/core/colour.h"
#include "megaviews/measure/rows.h"

namespace mv {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Sum of term(test, reference) over good pixels, both pointing to three values.
template <typename Term>
double sumOfGood(const ImagePair& pair, const Term& term) {
    const auto width = static_cast<std::size_t>(pair.width());
    return sumRows(pair.height(), [&](int y) {
        double sum = 0;
        const std::size_t begin = static_cast<std::size_t>(y) * width;
        for (std::size_t p = begin; p < begin + width; ++p) {
            if (pair.isBad(p)) continue;
            sum += term(&pair.test().rgb[3 * p], &pair.reference().rgb[3 * p]);
        }
        return sum;
    });
}

template <typename Term>
double meanOfChannels(const ImagePair& pair, const Term& term) {
    if (pair.goodPixels() == 0) return kNaN;
    const double sum = sumOfGood(pair, [&](const float* t, const float* r) {
        double pixel = 0;
        for (int c = 0; c < 3; ++c) pixel += term(double(t[c]), double(r[c]));
        return pixel;
    });
    return sum / (3.0 * static_cast<double>(pair.goodPixels()));
}

double meanOfReference(const ImagePair& pair) {
    return meanOfChannels(pair, [](double, double r) { return r; });
}

double share(double part, double whole) { return part == 0 ? 0 : part / whole; }

}  // namespace

double meanSquaredError(const ImagePair& pair) {
    return meanOfChannels(pair, [](double t, double r) { return (t - r) * (t - r); });
}

double relativeMeanSquaredError(const ImagePair& pair) {
    const double mean = meanOfReference(pair), floor = 1e-2 * mean * mean;
    return meanOfChannels(
        pair, [&](double t, double r) { return share((t - r) * (t - r), r * r + floor); });
}

double meanAbsolutePercentageError(const ImagePair& pair) {
    const double floor = 1e-2 * std::abs(meanOfReference(pair));
    return meanOfChannels(
        pair, [&](double t, double r) { return share(std::abs(t - r), std::abs(r) + floor); });
}

double peakSignalToNoiseRatio(const ImagePair& display) {
    return -10 * std::log10(meanSquaredError(display));
}

EnergyError energyError(const ImagePair& radiance) {
    if (radiance.goodPixels() == 0) return {kNaN, kNaN};
    const double whole =
        sumOfGood(radiance, [](const float*, const float* r) { return luminanceOf(r); });
    const double leaked = sumOfGood(radiance, [](const float* t, const float* r) {
        return std::max(luminanceOf(t) - luminanceOf(r), 0.0);
    });
    const double occluded = sumOfGood(radiance, [](const float* t, const float* r) {
        return std::max(luminanceOf(r) - luminanceOf(t), 0.0);
    });
    return {share(leaked, whole), share(occluded, whole)};
}

}  // namespace mv
