#pragma once
// Errors that look at one pixel at a time, with t the picture's and r the reference's value and the
// mean over all channels of all good pixels. Each is NaN if there is no good pixel.

#include "megaviews/measure/rgb_image.h"

namespace mv {

// mean((t - r)^2).
double meanSquaredError(const ImagePair& pair);

// mean((t - r)^2 / (r^2 + 1e-2 m^2)) with m the reference's mean, after [Rousselle et al. 2011],
// whose constant is absolute; with m the error does not depend on the unit of light. A value that
// is right adds nothing; where the reference is black everywhere, one that is wrong adds infinity.
double relativeMeanSquaredError(const ImagePair& pair);

// mean(|t - r| / (|r| + 1e-2 m)), as a fraction.
double meanAbsolutePercentageError(const ImagePair& pair);

// 10 log10(1 / MSE) dB of display values, whose peak is 1; infinite for equal pictures.
double peakSignalToNoiseRatio(const ImagePair& display);

// Energy that should not be there, sum(max(t - r, 0)), and energy that is missing,
// sum(max(r - t, 0)), as shares of the reference's sum(r), of radiances' luminance. Noise adds to
// both alike. Zero for equal pictures, infinite if the reference is black and the picture is not.
struct EnergyError {
    double leaked = 0, occluded = 0;
};
EnergyError energyError(const ImagePair& radiance);

}  // namespace mv
