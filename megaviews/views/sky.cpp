#include "megaviews/views/sky.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "megaviews/core/colour.h"
#include "megaviews/core/error.h"
#include "megaviews/scene/framing.h"
#include "megaviews/views/running_shares.h"

namespace mv {
namespace {

using glm::dvec3;

constexpr std::uint32_t kMaxRows = 512;  // of an image; a finer one is averaged
constexpr std::uint32_t kGradientRows = 128;

// On level ground, relative to what a sun sends through a square across: clear skies have 0.15 to
// 0.25 with the sun high, hazy ones more.
constexpr double kSkyToSun = 0.25;
// W/m^2 on level ground where there is no sun to compare with: a mean radiance of about 1.
constexpr double kSkyAlone = 3.0;

double smooth(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

// A clear sky as a gradient: deep above, pale at the horizon, bright about the sun, and dim ground
// below. By eye and no model of an atmosphere; brightness is set afterwards.
dvec3 gradient(dvec3 direction, const std::optional<SunLight>& sun) {
    const dvec3 zenith(0.20, 0.38, 0.80), horizon(0.85, 0.95, 1.05), ground(0.44, 0.41, 0.37);
    dvec3 above = glm::mix(horizon, zenith, std::pow(std::clamp(direction.y, 0.0, 1.0), 0.45));
    if (sun) {
        const double cosine = std::max(0.0, glm::dot(direction, dvec3(sun->toSun)));
        above += dvec3(1.0, 0.9, 0.7) * (0.5 * std::pow(cosine, 6) + 2.5 * std::pow(cosine, 120));
    }
    return glm::mix(ground, above, smooth(-0.06, 0.02, direction.y));
}

double cosineOf(std::uint32_t rows, double row) { return std::cos(std::numbers::pi * row / rows); }
double solidAngleOf(std::uint32_t rows, std::uint32_t row) {
    return (cosineOf(rows, row) - cosineOf(rows, row + 1.0)) * std::numbers::pi / rows;
}

// The direction to the middle of a cell.
dvec3 directionOf(std::uint32_t rows, std::uint32_t column, std::uint32_t row) {
    const double polar = std::numbers::pi * (row + 0.5) / rows;
    const double azimuth = std::numbers::pi * ((column + 0.5) / rows - 1);
    const double s = std::sin(polar);
    return {s * std::cos(azimuth), std::cos(polar), s * std::sin(azimuth)};
}

struct Cells {
    std::uint32_t rows = 1;
    std::vector<dvec3> radiance;  // by row, then column
    const dvec3& at(std::uint32_t column, std::uint32_t row) const {
        return radiance[2 * rows * row + column];
    }
    dvec3& at(std::uint32_t column, std::uint32_t row) { return radiance[2 * rows * row + column]; }
};

template <typename Radiance>
Cells cellsOf(std::uint32_t rows, const Radiance& radiance) {
    Cells cells{rows, std::vector<dvec3>(2 * std::size_t{rows} * rows)};
    tbb::parallel_for(0u, rows, [&](std::uint32_t row) {
        for (std::uint32_t column = 0; column < 2 * rows; ++column) {
            cells.at(column, row) = radiance(column, row);
        }
    });
    return cells;
}

Cells gradientCells(const std::optional<SunLight>& sun) {
    Cells cells = cellsOf(kGradientRows, [&](std::uint32_t column, std::uint32_t row) {
        return gradient(directionOf(kGradientRows, column, row), sun);
    });
    double level = 0;  // luminance of the irradiance on level ground
    for (std::uint32_t row = 0; row < cells.rows / 2; ++row) {
        for (std::uint32_t column = 0; column < 2 * cells.rows; ++column) {
            level += luminanceOf(cells.at(column, row)) * cosineOf(cells.rows, row + 0.5) *
                     solidAngleOf(cells.rows, row);
        }
    }
    const double wanted = sun ? kSkyToSun * luminanceOf(dvec3(sun->irradiance)) : kSkyAlone;
    for (dvec3& c : cells.radiance) c *= wanted / level;
    return cells;
}

// The image turned and averaged over each cell: areas of pixels, weighted by how far a cell covers
// them, so that all of a small sun stays.
Cells imageCells(const EnvironmentImage& image, double rotationDeg) {
    const auto wanted = static_cast<std::uint32_t>(std::max(1, image.height));
    const std::uint32_t rows = std::min(std::bit_ceil(wanted), kMaxRows);
    const double turn = rotationDeg / 360;
    return cellsOf(rows, [&](std::uint32_t column, std::uint32_t row) {
        const double left = (column / (2.0 * rows) + turn) * image.width;
        const double right = ((column + 1) / (2.0 * rows) + turn) * image.width;
        const double top = double(row) / rows * image.height;
        const double bottom = double(row + 1) / rows * image.height;
        dvec3 sum(0);
        double weights = 0;
        const int last = std::min(static_cast<int>(std::ceil(bottom)), image.height);
        for (int y = static_cast<int>(top); y < last; ++y) {
            const double from = std::max(top, double(y)), to = std::min(bottom, y + 1.0);
            const double high = std::cos(std::numbers::pi * from / image.height) -
                                std::cos(std::numbers::pi * to / image.height);
            const int end = static_cast<int>(std::ceil(right));
            for (int x = static_cast<int>(std::floor(left)); x < end; ++x) {
                const double wide = std::min(right, x + 1.0) - std::max(left, double(x));
                const int inside = ((x % image.width) + image.width) % image.width;
                sum += dvec3(image.radiance[static_cast<std::size_t>(y) *
                                                static_cast<std::size_t>(image.width) +
                                            static_cast<std::size_t>(inside)]) *
                       (high * wide);
                weights += high * wide;
            }
        }
        return weights > 0 ? sum / weights : dvec3(0);
    });
}

void fill(const Cells& cells, double scale, Sky& sky) {
    const std::uint32_t rows = sky.rows = cells.rows;
    sky.texels.resize(cells.radiance.size());
    std::vector<double> powers(cells.radiance.size());
    dvec3 irradiance(0);
    double total = 0;
    for (std::uint32_t row = 0; row < rows; ++row) {
        const double solidAngle = solidAngleOf(rows, row);
        for (std::uint32_t column = 0; column < 2 * rows; ++column) {
            const dvec3 radiance = glm::max(cells.at(column, row) * scale, dvec3(0));
            const glm::vec3 stored(radiance);
            const std::uint32_t i = skyIndex(rows, column, row);
            sky.texels[i] = {stored.x, stored.y, stored.z, 0};
            irradiance += dvec3(stored) * solidAngle;
            powers[i] = weightOf(stored) * solidAngle;
            total += powers[i];
        }
    }
    sky.irradiance = glm::vec3(irradiance);
    const std::vector<float> shares = runningShares(powers);
    for (std::size_t i = 0; i < shares.size(); ++i) sky.texels[i].cumulative = shares[i];
    double distance = 0;  // total variation between power and solid angle
    for (std::uint32_t row = 0; total > 0 && row < rows; ++row) {
        const double even = solidAngleOf(rows, row) / (4 * std::numbers::pi);
        for (std::uint32_t column = 0; column < 2 * rows; ++column) {
            distance += 0.5 * std::abs(powers[skyIndex(rows, column, row)] / total - even);
        }
    }
    sky.tableShare = static_cast<float>(distance);
}

}  // namespace

std::optional<SunLight> sunOf(const Scene& scene, const std::vector<PosedLight>& lights) {
    std::optional<SunLight> sun;
    for (const PosedLight& posed : lights) {
        glm::vec3 irradiance = posed.light.intensity;
        if (posed.light.type == LightType::spot && posed.light.isDefault) {
            const auto distanceM = static_cast<float>(kBeamDistance * scene.root.edge);
            irradiance /= distanceM * distanceM;
        } else if (posed.light.type != LightType::directional) {
            continue;
        }
        if (sun && luminanceOf(irradiance) <= luminanceOf(sun->irradiance)) continue;
        sun = SunLight{-glm::vec3(posed.direction), irradiance};
    }
    if (sun && !(luminanceOf(sun->irradiance) > 0)) return std::nullopt;
    return sun;
}

bool replacesPlacedLight(const EnvironmentSettings& settings) {
    return settings.source == "white" || !environmentFile(settings).empty();
}

std::shared_ptr<const Sky> makeSky(const Scene& scene, const std::vector<PosedLight>& lights,
                                   const Environment& environment, double lightScale,
                                   std::shared_ptr<const Sky> before) {
    const EnvironmentSettings& settings = environment.settings;
    const bool placedSun = std::any_of(lights.begin(), lights.end(), [](const PosedLight& posed) {
        return posed.light.isDefault && posed.light.type != LightType::point;
    });
    const bool isAuto = settings.source == "auto";
    if (settings.source == "none" || (isAuto && !placedSun)) return nullptr;
    if (!(lightScale * settings.scale > 0)) return nullptr;
    const bool isGradient = isAuto || settings.source == "sky";
    SkyInput input{environment, isGradient ? sunOf(scene, lights) : std::nullopt, lightScale};
    if (isAuto && !input.sun) return nullptr;  // put out
    if (before && before->input == input) return before;

    Cells cells;
    if (isGradient) {
        cells = gradientCells(input.sun);
    } else if (settings.source == "white") {
        cells = cellsOf(1, [](auto, auto) { return dvec3(1); });
    } else if (environment.image) {
        cells = imageCells(*environment.image, settings.rotationDeg);
    } else {
        throw Error(ExitCode::usage,
                    "environment: the image '" + settings.source + "' has not been read");
    }
    auto sky = std::make_shared<Sky>();
    sky->input = std::move(input);
    fill(cells, lightScale * settings.scale, *sky);
    if (!(luminanceOf(sky->irradiance) > 0)) return nullptr;
    return sky;
}

}  // namespace mv
