#include "megaviews/measure/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <glm/glm.hpp>

#include "megaviews/core/colour.h"
#include "megaviews/measure/rows.h"

namespace mv {
namespace {

using Plane = std::vector<float>;

// ---------------------------------------------------------------- colour spaces
// Linear sRGB primaries under D65 to XYZ, divided by the white's XYZ.
struct XyzMatrix {
    glm::dmat3 fromRgb, toRgb;
    XyzMatrix() {
        const double d = 73733382;
        fromRgb = glm::transpose(glm::dmat3(3 * 10135552, 3 * 8788810, 3 * 4435075,  //
                                            6 * 2613072, 6 * 8788810, 6 * 887015,    //
                                            1425312, 8788810, 70074185)) /
                  d;
        const glm::dvec3 white = fromRgb * glm::dvec3(1);
        for (int c = 0; c < 3; ++c) fromRgb[c] /= white;
        toRgb = glm::inverse(fromRgb);
    }
};
const XyzMatrix kXyz;

// [Andersson et al. 2020, §4.1]: achromatic, red-green, blue-yellow; linear in the light.
glm::dvec3 opponent(const glm::dvec3& xyz) {
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
glm::dvec3 xyzOfOpponent(const glm::dvec3& c) {
    const double y = (c.x + 16) / 116;
    return {y + c.y / 500, y, y - c.z / 200};
}

// CIELAB, its chroma adjusted for the Hunt effect: the darker, the less it is seen.
glm::dvec3 huntLab(const glm::dvec3& rgb) {
    const auto root = [](double t) {
        const double delta = 6.0 / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const glm::dvec3 xyz = kXyz.fromRgb * rgb;
    const double fx = root(xyz.x), fy = root(xyz.y), fz = root(xyz.z);
    const double lightness = 116 * fy - 16;
    return {lightness, 0.01 * lightness * 500 * (fx - fy), 0.01 * lightness * 200 * (fy - fz)};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

float linearOfSrgb(float v) {
    return static_cast<float>(linearFromSrgb(std::clamp(double(v), 0.0, 1.0)));
}

// ---------------------------------------------------------------- filters
// One-dimensional kernel from -radius to radius.
using Kernel = std::vector<double>;

Kernel kernelOf(int radius, const std::function<double(double)>& weight) {
    Kernel out;
    for (int i = -radius; i <= radius; ++i) out.push_back(weight(i));
    return out;
}
double sumOf(const Kernel& kernel, double sign) {
    double sum = 0;
    for (const double w : kernel) sum += std::max(sign * w, 0.0);
    return sum;
}

// Adds scale * (plane filtered by `alongX` in rows and `alongY` in columns) to `out`; beyond its
// edge a picture goes on as at the edge.
void addFiltered(const Plane& plane, int width, int height, const Kernel& alongX,
                 const Kernel& alongY, double scale, Plane& out) {
    const auto w = static_cast<std::size_t>(width);
    const int radiusX = static_cast<int>(alongX.size() / 2);
    const int radiusY = static_cast<int>(alongY.size() / 2);
    forRows(height, [&](int y) {
        std::vector<double> column(w, 0.0);  // down the kernel
        for (int j = -radiusY; j <= radiusY; ++j) {
            const int from = std::clamp(y + j, 0, height - 1);
            const float* row = &plane[static_cast<std::size_t>(from) * w];
            const double weight = alongY[static_cast<std::size_t>(j + radiusY)];
            for (std::size_t x = 0; x < w; ++x) column[x] += weight * double(row[x]);
        }
        float* to = &out[static_cast<std::size_t>(y) * w];
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            for (int i = -radiusX; i <= radiusX; ++i) {
                const int from = std::clamp(x + i, 0, width - 1);
                sum += alongX[static_cast<std::size_t>(i + radiusX)] *
                       column[static_cast<std::size_t>(from)];
            }
            to[x] += static_cast<float>(scale * sum);
        }
    });
}

// The eye's contrast sensitivity in one channel, as a sum of Gaussians a sqrt(pi/b) exp(-pi^2
// x^2/b) of the angle x in degrees [Andersson et al. 2020, table 1].
struct Sensitivity {
    std::array<double, 2> a, b;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{{1, 0}, {0.0047, 1}}, {{1, 0}, {0.0053, 1}}, {{34.1, 13.5}, {0.04, 0.025}}}};

Plane filterBySensitivity(const Plane& plane, int width, int height, const Sensitivity& s,
                          double pixelsPerDegree) {
    // Three standard deviations of the widest Gaussian of all channels.
    const int radius = static_cast<int>(std::ceil(
        3 * std::sqrt(0.04 / (2 * std::numbers::pi * std::numbers::pi)) * pixelsPerDegree));
    std::array<Kernel, 2> kernels;
    std::array<double, 2> amplitudes{};
    double total = 0;
    for (std::size_t g = 0; g < 2; ++g) {
        kernels[g] = kernelOf(radius, [&](double i) {
            const double x = i / pixelsPerDegree;
            return std::exp(-std::numbers::pi * std::numbers::pi * x * x / s.b[g]);
        });
        amplitudes[g] = s.a[g] * std::sqrt(std::numbers::pi / s.b[g]);
        total += amplitudes[g] * sumOf(kernels[g], 1) * sumOf(kernels[g], 1);
    }
    Plane out(plane.size(), 0.0f);
    for (std::size_t g = 0; g < 2; ++g) {
        if (s.a[g] == 0) continue;
        addFiltered(plane, width, height, kernels[g], kernels[g], amplitudes[g] / total, out);
    }
    return out;
}

// ---------------------------------------------------------------- parts of the error
struct Prepared {
    Plane achromatic;                // Y of the opponent space in [0,1], not filtered
    std::vector<glm::vec3> huntLab;  // after the sensitivity filters
};

// linear: RGB in [0,1].
Prepared prepare(const std::vector<float>& linear, int width, int height, double pixelsPerDegree) {
    const std::size_t pixels = linear.size() / 3;
    std::array<Plane, 3> planes;
    for (Plane& plane : planes) plane.resize(pixels);
    const auto w = static_cast<std::size_t>(width);
    forRows(height, [&](int y) {
        for (std::size_t p = static_cast<std::size_t>(y) * w, end = p + w; p < end; ++p) {
            const glm::dvec3 c = opponent(
                kXyz.fromRgb * glm::dvec3(linear[3 * p], linear[3 * p + 1], linear[3 * p + 2]));
            for (std::size_t k = 0; k < 3; ++k) {
                planes[k][p] = static_cast<float>(c[static_cast<int>(k)]);
            }
        }
    });
    Prepared out;
    out.achromatic = planes[0];
    for (std::size_t k = 0; k < 3; ++k) {
        planes[k] =
            filterBySensitivity(planes[k], width, height, kSensitivities[k], pixelsPerDegree);
    }
    out.huntLab.resize(pixels);
    forRows(height, [&](int y) {
        for (std::size_t p = static_cast<std::size_t>(y) * w, end = p + w; p < end; ++p) {
            out.achromatic[p] = (out.achromatic[p] + 16) / 116;
            const glm::dvec3 rgb =
                kXyz.toRgb * xyzOfOpponent(glm::dvec3(planes[0][p], planes[1][p], planes[2][p]));
            out.huntLab[p] = huntLab(glm::clamp(rgb, 0.0, 1.0));
        }
    });
    return out;
}

// Powered HyAB distance to [0,1]: its larger part, above 0.4 of the largest that there is, to the
// last twentieth [§4.1.4].
double colorError(const glm::vec3& a, const glm::vec3& b) {
    const auto powered = [](double distance) { return std::pow(distance, 0.7); };
    static const double most =
        powered(hyab(huntLab(glm::dvec3(0, 1, 0)), huntLab(glm::dvec3(0, 0, 1))));
    const double knee = 0.4 * most, error = powered(hyab(glm::dvec3(a), glm::dvec3(b)));
    if (error < knee) return 0.95 * error / knee;
    return std::min(0.95 + 0.05 * (error - knee) / (most - knee), 1.0);
}

// Strength of edges (first derivative of a Gaussian) or points (second) [§4.2].
enum class Feature { edge, point };
Plane featureStrength(const Plane& plane, int width, int height, double pixelsPerDegree,
                      Feature feature) {
    const double sd = 0.5 * 0.082 * pixelsPerDegree;
    const int radius = static_cast<int>(std::ceil(3 * sd));
    const auto gauss = [&](double x) { return std::exp(-x * x / (2 * sd * sd)); };
    Kernel smooth = kernelOf(radius, gauss);
    for (double& w : smooth) w /= sumOf(kernelOf(radius, gauss), 1);
    // Positive weights add up to 1, negative ones to -1.
    Kernel derived = kernelOf(radius, [&](double x) {
        return (feature == Feature::edge ? -x : x * x / (sd * sd) - 1) * gauss(x);
    });
    const double positive = sumOf(derived, 1), negative = sumOf(derived, -1);
    for (double& w : derived) w /= w > 0 ? positive : negative;

    Plane alongX(plane.size(), 0.0f), alongY(plane.size(), 0.0f);
    addFiltered(plane, width, height, derived, smooth, 1, alongX);
    addFiltered(plane, width, height, smooth, derived, 1, alongY);
    for (std::size_t p = 0; p < plane.size(); ++p) alongX[p] = std::hypot(alongX[p], alongY[p]);
    return alongX;
}

// Told which share of a map is done; may throw.
using Done = std::function<void(double share01)>;

std::vector<float> errorMap(const std::vector<float>& test, const std::vector<float>& reference,
                            int width, int height, double pixelsPerDegree, const Done& done) {
    done(0);
    const Prepared t = prepare(test, width, height, pixelsPerDegree);
    done(0.4);
    const Prepared r = prepare(reference, width, height, pixelsPerDegree);
    done(0.8);
    const auto strength = [&](const Prepared& image, Feature feature) {
        return featureStrength(image.achromatic, width, height, pixelsPerDegree, feature);
    };
    const Plane edgeT = strength(t, Feature::edge), edgeR = strength(r, Feature::edge);
    const Plane pointT = strength(t, Feature::point), pointR = strength(r, Feature::point);
    std::vector<float> out(t.achromatic.size());
    const auto w = static_cast<std::size_t>(width);
    forRows(height, [&](int y) {
        for (std::size_t p = static_cast<std::size_t>(y) * w, end = p + w; p < end; ++p) {
            const double difference = std::max(std::abs(double(edgeT[p]) - double(edgeR[p])),
                                               std::abs(double(pointT[p]) - double(pointR[p])));
            const double featureError = std::sqrt(std::min(difference / std::sqrt(2.0), 1.0));
            const double color = colorError(t.huntLab[p], r.huntLab[p]);
            out[p] = static_cast<float>(std::pow(color, 1 - featureError));
        }
    });
    return out;
}

// The mean, and nothing at bad pixels.
void finish(FlipMap& map, const ImagePair& pair) {
    for (std::size_t p = 0; p < map.errors.size(); ++p) {
        if (pair.isBad(p)) map.errors[p] = 0;
    }
    map.mean = meanOfGood(pair, map.errors);
}

// ---------------------------------------------------------------- exposures
// The ACES curve as the paper takes it: (k0 x^2 + k1 x) / (k2 x^2 + k3 x + k4).
constexpr double kAces0 = 0.36 * 2.51, kAces1 = 0.6 * 0.03, kAces2 = 0.36 * 2.43,
                 kAces3 = 0.6 * 0.59, kAces4 = 0.14;

float aces(double x) {
    x = std::clamp(x, 0.0, 1e6);  // white, and its square is finite
    return static_cast<float>(
        std::min((kAces0 * x + kAces1) * x / ((kAces2 * x + kAces3) * x + kAces4), 1.0));
}

// The value that the curve maps to 0.85: the larger root.
double acesNearWhite() {
    const double t = 0.85;
    const double a = kAces0 - t * kAces2, b = kAces1 - t * kAces3, c = -t * kAces4;
    return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

std::vector<float> exposed(const RgbImage& image, double ev) {
    std::vector<float> out(image.rgb.size());
    const double exposure = std::exp2(ev);
    const std::size_t row = 3 * static_cast<std::size_t>(image.width);
    forRows(image.height, [&](int y) {
        for (std::size_t i = static_cast<std::size_t>(y) * row, end = i + row; i < end; ++i) {
            out[i] = aces(exposure * double(image.rgb[i]));
        }
    });
    return out;
}

// First and last exposure for a reference [Andersson et al. 2021, §3.2]; a black one has none.
bool exposureRange(const ImagePair& pair, double& startEv, double& stopEv) {
    std::vector<double> luminances;
    for (std::size_t p = 0; p < pair.reference().pixels(); ++p) {
        if (pair.isBad(p)) continue;
        const float* rgb = &pair.reference().rgb[3 * p];
        const glm::dvec3 light = glm::max(glm::dvec3(rgb[0], rgb[1], rgb[2]), 0.0);
        luminances.push_back((kXyz.fromRgb * light).y);
    }
    if (luminances.empty()) return false;
    const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    double median = *middle;
    if (luminances.size() % 2 == 0) {
        median = 0.5 * (median + *std::max_element(luminances.begin(), middle));
    }
    const double most = *std::max_element(middle, luminances.end());
    if (!(most > 0)) return false;
    startEv = std::log2(acesNearWhite() / most);
    stopEv = std::log2(acesNearWhite() / std::max(median, most * 0x1p-20));
    return true;
}

}  // namespace

FlipMap flip(const ImagePair& display, double pixelsPerDegree, const Progress& progress) {
    const auto linear = [](const RgbImage& image) {
        std::vector<float> out(image.rgb.size());
        std::transform(image.rgb.begin(), image.rgb.end(), out.begin(), linearOfSrgb);
        return out;
    };
    FlipMap out;
    out.errors = errorMap(linear(display.test()), linear(display.reference()), display.width(),
                          display.height(), pixelsPerDegree, [&](double share) {
                              report(progress, "FLIP", static_cast<float>(share));
                          });
    finish(out, display);
    return out;
}

HdrFlipMap hdrFlip(const ImagePair& radiance, double pixelsPerDegree, const Progress& progress) {
    HdrFlipMap out;
    out.errors.assign(radiance.reference().pixels(), 0.0f);
    exposureRange(radiance, out.startEv, out.stopEv);
    const double stops = out.stopEv - out.startEv;
    out.exposures = stops > 0 ? std::max(2, static_cast<int>(std::ceil(stops))) : 1;
    for (int i = 0; i < out.exposures; ++i) {
        const double ev = out.startEv + (i == 0 ? 0 : stops * i / (out.exposures - 1));
        const std::vector<float> errors = errorMap(
            exposed(radiance.test(), ev), exposed(radiance.reference(), ev), radiance.width(),
            radiance.height(), pixelsPerDegree, [&](double share) {
                report(progress, "HDR-FLIP", static_cast<float>((i + share) / out.exposures));
            });
        for (std::size_t p = 0; p < errors.size(); ++p) {
            out.errors[p] = std::max(out.errors[p], errors[p]);
        }
    }
    finish(out, radiance);
    return out;
}

}  // namespace mv
