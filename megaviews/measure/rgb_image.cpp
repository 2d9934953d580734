#include "megaviews/measure/rgb_image.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "megaviews/measure/rows.h"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

bool isFinite(const float* rgb) {
    return std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
}

}  // namespace

RgbImage displayImage(const RgbImage& radiance, double exposureEv, ToneMap toneMap) {
    RgbImage out = radiance;
    const auto exposure = static_cast<float>(std::exp2(exposureEv));
    const auto width = static_cast<std::size_t>(radiance.width);
    forRows(radiance.height, [&](int y) {
        float* row = out.rgb.data() + static_cast<std::size_t>(y) * width * 3;
        for (float* rgb = row; rgb != row + width * 3; rgb += 3) {
            if (!isFinite(rgb)) continue;
            // Above this every tone map is white; squares of it are still finite.
            glm::vec3 color = glm::clamp(glm::vec3(rgb[0], rgb[1], rgb[2]) * exposure, 0.0f, 1e9f);
            if (toneMap == ToneMap::aces) color = acesToneMap(color);
            if (toneMap == ToneMap::neutral) color = neutralToneMap(color);
            if (toneMap == ToneMap::agx) color = agxToneMap(color);
            color = srgbEncode(glm::clamp(color, 0.0f, 1.0f));
            for (int c = 0; c < 3; ++c) rgb[c] = color[c];
        }
    });
    return out;
}

ImagePair::ImagePair(RgbImage test, RgbImage reference)
    : test_(std::move(test)), reference_(std::move(reference)) {
    assert(test_.width == reference_.width && test_.height == reference_.height);
    assert(test_.rgb.size() == 3 * test_.pixels() && reference_.rgb.size() == test_.rgb.size());
    bad_.resize(test_.pixels());
    for (std::size_t p = 0; p < bad_.size(); ++p) {
        float *t = &test_.rgb[3 * p], *r = &reference_.rgb[3 * p];
        if (isFinite(t) && isFinite(r)) continue;
        bad_[p] = 1;
        ++badPixels_;
        std::fill_n(t, 3, 0.0f);
        std::fill_n(r, 3, 0.0f);
    }
}

double meanOfGood(const ImagePair& pair, std::span<const float> values) {
    if (pair.goodPixels() == 0) return std::numeric_limits<double>::quiet_NaN();
    const auto width = static_cast<std::size_t>(pair.width());
    const double sum = sumRows(pair.height(), [&](int y) {
        double row = 0;
        const std::size_t begin = static_cast<std::size_t>(y) * width;
        for (std::size_t p = begin; p < begin + width; ++p) {
            if (!pair.isBad(p)) row += static_cast<double>(values[p]);
        }
        return row;
    });
    return sum / static_cast<double>(pair.goodPixels());
}

}  // namespace mv
