#include "megaviews/measure/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "megaviews/core/colour.h"
#include "megaviews/measure/rows.h"

namespace mv {
namespace {

constexpr int kRadius = 5;  // 11 x 11
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (K L)^2

std::vector<double> lumaOf(const RgbImage& image) {
    std::vector<double> out(image.pixels());
    for (std::size_t p = 0; p < out.size(); ++p) {
        out[p] = luminanceOf(&image.rgb[3 * p]);
    }
    return out;
}

// Centres of the windows along one side, and the window there.
struct Axis {
    int begin, end, length;

    explicit Axis(int n) : begin(std::min(kRadius, (n - 1) / 2)), end(n - begin), length(n) {}

    // Calls use(position, weight) for the window around `centre`; weights add up to 1.
    template <typename Use>
    void window(int centre, const Use& use) const {
        const int first = std::max(centre - kRadius, 0);
        const int last = std::min(centre + kRadius, length - 1);
        const auto weight = [&](int i) {
            return std::exp(-0.5 * (i - centre) * (i - centre) / (kSigma * kSigma));
        };
        double sum = 0;
        for (int i = first; i <= last; ++i) sum += weight(i);
        for (int i = first; i <= last; ++i) use(i, weight(i) / sum);
    }
};

// Weighted means of x, y, x^2, y^2, xy.
using Moments = std::array<double, 5>;

double ssimOf(const Moments& m) {
    const double xx = m[2] - m[0] * m[0], yy = m[3] - m[1] * m[1], xy = m[4] - m[0] * m[1];
    return (2 * m[0] * m[1] + kC1) * (2 * xy + kC2) /
           ((m[0] * m[0] + m[1] * m[1] + kC1) * (xx + yy + kC2));
}

}  // namespace

double structuralSimilarity(const ImagePair& display) {
    if (display.goodPixels() == 0) return std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> test = lumaOf(display.test());
    const std::vector<double> reference = lumaOf(display.reference());
    const Axis horizontal(display.width()), vertical(display.height());
    const auto width = static_cast<std::size_t>(display.width());

    std::vector<std::pair<int, double>> taps;  // of all columns' windows, one after another
    std::vector<std::size_t> tapsBegin;
    for (int x = horizontal.begin; x < horizontal.end; ++x) {
        tapsBegin.push_back(taps.size());
        horizontal.window(x, [&](int i, double weight) { taps.emplace_back(i, weight); });
    }
    tapsBegin.push_back(taps.size());

    const double sum = sumRows(vertical.end - vertical.begin, [&](int row) {
        // Down the window first, for the whole row, then along it.
        std::vector<Moments> columns(width, Moments{});
        vertical.window(vertical.begin + row, [&](int y, double weight) {
            const std::size_t begin = static_cast<std::size_t>(y) * width;
            for (std::size_t x = 0; x < width; ++x) {
                const double a = test[begin + x], b = reference[begin + x];
                const Moments terms = {a, b, a * a, b * b, a * b};
                for (std::size_t k = 0; k < terms.size(); ++k) columns[x][k] += weight * terms[k];
            }
        });
        double rowSum = 0;
        for (std::size_t x = 0; x + 1 < tapsBegin.size(); ++x) {
            Moments moments{};
            for (std::size_t t = tapsBegin[x]; t < tapsBegin[x + 1]; ++t) {
                const Moments& column = columns[static_cast<std::size_t>(taps[t].first)];
                for (std::size_t k = 0; k < moments.size(); ++k) {
                    moments[k] += taps[t].second * column[k];
                }
            }
            rowSum += ssimOf(moments);
        }
        return rowSum;
    });
    return sum / (double(horizontal.end - horizontal.begin) * (vertical.end - vertical.begin));
}

}  // namespace mv
