#pragma once
// Pictures as the error metrics take them, in one of the two domains of docs/metrics.md: linear
// radiance in W/(m^2 sr) without bound, or display values, sRGB-encoded and in [0,1].

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "megaviews/settings/settings.h"

namespace mv {

struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> rgb;  // three values a pixel, rows from the top

    std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
};

// What the renderer's last pass makes of radiance: exposure, tone map, sRGB; not rounded to 8 bit.
// A pixel with a value that is NaN or infinite stays as it is, so that it is still counted as bad.
RgbImage displayImage(const RgbImage& radiance, double exposureEv, ToneMap toneMap);

// A picture and its reference, of one size. A pixel that is not finite in either is bad: it is
// black in both, counted, and left out of every mean.
class ImagePair {
  public:
    ImagePair() = default;
    ImagePair(RgbImage test, RgbImage reference);  // asserts equal sizes

    int width() const { return test_.width; }
    int height() const { return test_.height; }
    const RgbImage& test() const { return test_; }
    const RgbImage& reference() const { return reference_; }
    bool isBad(std::size_t pixel) const { return bad_[pixel] != 0; }
    std::uint64_t badPixels() const { return badPixels_; }
    std::uint64_t goodPixels() const { return test_.pixels() - badPixels_; }

  private:
    RgbImage test_, reference_;
    std::vector<std::uint8_t> bad_;
    std::uint64_t badPixels_ = 0;
};

// Mean of one value a pixel over the good ones; NaN if there is none.
double meanOfGood(const ImagePair& pair, std::span<const float> values);

}  // namespace mv
