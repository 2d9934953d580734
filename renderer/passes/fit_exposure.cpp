#include "renderer/passes/fit_exposure.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "megaviews/core/colour.h"

namespace mv {
namespace {

// At most one surface texel in kWhiteShare may be brighter, once exposed, than what the tone map
// shows as 94 % of white.
constexpr std::size_t kWhiteShare = 50;

// A sky that takes more of the picture than this is no more than so far above middle grey.
constexpr double kWideSky = 1.0 / 3, kSkyAboveGreyEv = 2.5;
// Before it, what reflects more than this on average is shown so many times as bright as grey, at
// most twice: of a room one sees by its light that it is white, of a lone statue by nothing.
constexpr double kGreyAlbedo = 0.4;

double whiteOf(ToneMap toneMap) {
    switch (toneMap) {
        case ToneMap::none:
            return 0.94;
        case ToneMap::aces:
            return 2.5;
        case ToneMap::neutral:
            return 1.5;
        case ToneMap::agx:
            return 7.3;
    }
    assert(false);
    return 1;
}

}  // namespace

std::optional<double> fitExposure(const gl::Texture& radiance, const GBuffer& gbuffer,
                                  ToneMap toneMap) {
    const std::vector<float> color = radiance.readFloats(4);
    const std::vector<float> position = gbuffer.position.readFloats(4);
    const std::vector<float> emission = gbuffer.emission.readFloats(4);
    std::vector<double> luminances;
    std::vector<std::size_t> surfaces;  // whose they are, into the arrays
    double sum = 0, skyLogs = 0;
    std::size_t skyPixels = 0;
    for (std::size_t i = 0; i + 3 < color.size(); i += 4) {
        const double luminance = luminanceOf(&color[i]);
        if (!std::isfinite(luminance) || luminance <= 0) continue;
        if (position[i + 3] == 0) {
            skyLogs += std::log2(luminance);
            ++skyPixels;
            continue;
        }
        if (emission[i] > 0 || emission[i + 1] > 0 || emission[i + 2] > 0) continue;
        luminances.push_back(luminance);
        surfaces.push_back(i);
        sum += luminance;
    }
    if (luminances.empty()) return std::nullopt;
    const auto surfacePixels = static_cast<double>(luminances.size());
    const double floor = 0.01 * sum / surfacePixels;
    double logSum = 0;
    for (const double luminance : luminances) logSum += std::log2(std::max(luminance, floor));
    double middle = std::log2(kMiddleGrey) - logSum / surfacePixels;
    const bool wideSky =
        static_cast<double>(skyPixels) > kWideSky * static_cast<double>(color.size()) / 4;
    if (wideSky) {
        const std::vector<float> albedo = gbuffer.albedo.readFloats(4);
        double albedoSum = 0;
        for (const std::size_t i : surfaces) albedoSum += luminanceOf(&albedo[i]);
        middle += std::log2(std::clamp(albedoSum / surfacePixels / kGreyAlbedo, 1.0, 2.0));
    }
    // A picture of shade with some sun in it has its mean in the shade: what the sun shines on must
    // not all turn white.
    const auto rank = luminances.size() - 1 - luminances.size() / kWhiteShare;
    std::nth_element(luminances.begin(), luminances.begin() + static_cast<std::ptrdiff_t>(rank),
                     luminances.end());
    double ev = std::min(middle, std::log2(whiteOf(toneMap) / luminances[rank]));
    // What is dark before a wide sky is shown dark.
    if (wideSky) {
        const double sky = skyLogs / static_cast<double>(skyPixels);
        ev = std::min(ev, std::log2(kMiddleGrey) + kSkyAboveGreyEv - sky);
    }
    return ev;
}

bool isDark(std::optional<double> fittedEv, const GBuffer& gbuffer) {
    constexpr double kDarkEv = 20;  // what a thousandth of starlight takes
    if (fittedEv) return *fittedEv > kDarkEv;
    const std::vector<float> albedo = gbuffer.albedo.readFloats(4);
    const std::vector<float> emission = gbuffer.emission.readFloats(4);
    std::size_t black = 0, glowing = 0;
    for (std::size_t i = 0; i + 3 < albedo.size(); i += 4) {
        const bool glows = luminanceOf(&emission[i]) > 0;
        glowing += glows;
        black += !glows && luminanceOf(&albedo[i]) > 0;
    }
    return black > glowing;
}

}  // namespace mv
