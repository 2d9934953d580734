#include "megaviews/views/sky_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "megaviews/core/colour.h"

namespace mv {
namespace {

constexpr double kCurve = 1024;  // places along the Morton curve, each way

// Where a number in [0, 1) falls among the running sums of some powers: which of them, and how far
// into it.
struct Place {
    std::uint32_t index;
    double part;
};
Place placeOf(const std::vector<double>& sums, double number) {
    const double target = number * sums.back();
    const auto above = std::upper_bound(sums.begin(), sums.end(), target);
    const auto i = std::min(static_cast<std::size_t>(above - sums.begin()), sums.size() - 1);
    const double before = i > 0 ? sums[i - 1] : 0, power = sums[i] - before;
    const double part = power > 0 ? (target - before) / power : 0.5;
    return {static_cast<std::uint32_t>(i), std::clamp(part, 0.0, 1.0)};
}

}  // namespace

std::vector<SkyView> makeSkyViews(const Sky& sky, int count) {
    // Running sums of power: of the columns of each row, and of the rows.
    const std::uint32_t rows = sky.rows, columns = 2 * rows;
    std::vector<std::vector<double>> inRow(rows, std::vector<double>(columns));
    std::vector<double> ofRows(rows);
    double sum = 0;
    for (std::uint32_t row = 0; row < rows; ++row) {
        double rowSum = 0;
        for (std::uint32_t column = 0; column < columns; ++column) {
            const std::uint32_t i = skyIndex(rows, column, row);
            const double before = i > 0 ? double{sky.texels[i - 1].cumulative} : 0;
            inRow[row][column] = rowSum += double{sky.texels[i].cumulative} - before;
        }
        ofRows[row] = sum += rowSum;
    }
    // A spherical Fibonacci lattice, moved where the power is.
    std::vector<std::pair<std::uint32_t, SkyView>> views;  // by place along the curve
    for (int k = 0; k < count && sum > 0; ++k) {
        const double height = (k + 0.5) / count;
        const double turns = k * (std::numbers::phi - 1), turn = turns - std::floor(turns);
        const Place row = placeOf(ofRows, height);
        const Place column = placeOf(inRow[row.index], turn);
        const double top = std::cos(std::numbers::pi * row.index / rows);
        const double bottom = std::cos(std::numbers::pi * (row.index + 1) / rows);
        const double y = top + (bottom - top) * row.part,
                     sine = std::sqrt(std::max(1 - y * y, 0.0));
        const double azimuth = std::numbers::pi * ((column.index + column.part) / rows - 1);
        const std::uint32_t i = skyIndex(rows, column.index, row.index);
        const SkyTexel& cell = sky.texels[i];
        const double share =
            double{cell.cumulative} - (i > 0 ? double{sky.texels[i - 1].cumulative} : 0);
        if (!(share > 0)) continue;
        const double solidAngle = (top - bottom) * std::numbers::pi / rows;
        const auto weight = static_cast<float>(solidAngle / (share * count));
        const vec3 light = vec3(cell.r, cell.g, cell.b) * weight;
        const SkyView view{.x = static_cast<float>(sine * std::cos(azimuth)),
                           .y = static_cast<float>(y),
                           .z = static_cast<float>(sine * std::sin(azimuth)),
                           .luminance = static_cast<float>(luminanceOf(light)),
                           .r = light.x,
                           .g = light.y,
                           .b = light.z,
                           .unused = 0};
        views.emplace_back(skySpread(static_cast<std::uint32_t>(height * kCurve)) |
                               skySpread(static_cast<std::uint32_t>(turn * kCurve)) << 1u,
                           view);
    }
    std::sort(views.begin(), views.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<SkyView> out;
    out.reserve(views.size());
    for (const auto& [place, view] : views) out.push_back(view);
    return out;
}

}  // namespace mv
