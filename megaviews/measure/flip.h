#pragma once
// FLIP: how far apart two pictures look to someone who flips between them on a screen [Andersson et
// al. 2020]: colour differences behind the eye's contrast sensitivity, raised where edges or points
// differ. HDR-FLIP [Andersson et al. 2021] takes the worst over all exposures that matter.

#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/measure/rgb_image.h"

namespace mv {

// The papers' viewing conditions: 0.7 m from a screen 0.7 m wide with 3840 pixels.
inline constexpr double kFlipPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979323846 / 180;

// One error a pixel in [0,1], rows from the top; 0 at bad pixels. mean: over good pixels, NaN if
// there is none.
struct FlipMap {
    std::vector<float> errors;
    double mean = 0;
};

// FLIP compares display values. `progress` may throw Cancelled, here and below.
FlipMap flip(const ImagePair& display, double pixelsPerDegree = kFlipPixelsPerDegree,
             const Progress& progress = {});

struct HdrFlipMap : FlipMap {
    double startEv = 0, stopEv = 0;  // exposures that were tried, chosen from the reference
    int exposures = 0;
};

// Compares radiances; negative ones are 0. The exposures reach from that which maps the reference's
// brightest pixel to 0.85 to that which does so with its median, at least two and about one a stop,
// tone mapped by the paper's ACES curve. A median of 2^-20 of the maximum or below counts as that.
HdrFlipMap hdrFlip(const ImagePair& radiance, double pixelsPerDegree = kFlipPixelsPerDegree,
                   const Progress& progress = {});

}  // namespace mv
