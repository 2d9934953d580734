#pragma once
// The constants of Rec. 709 and sRGB in double precision; shaders/shared/light.glsl and tone.glsl
// have them in float, for shaders and their twins.

#include <cmath>

namespace mv {

// Takes anything with three channels that can be indexed.
template <typename Rgb>
double luminanceOf(const Rgb& c) {
    return 0.2126 * static_cast<double>(c[0]) + 0.7152 * static_cast<double>(c[1]) +
           0.0722 * static_cast<double>(c[2]);
}

// IEC 61966-2-1, exact, of a value in [0,1].
inline double linearFromSrgb(double x) {
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

}  // namespace mv
