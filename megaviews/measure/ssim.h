#pragma once
// Structural similarity [Wang, Bovik, Sheikh and Simoncelli 2004, eq. 13]: means, variances and
// covariance of both pictures in an 11 x 11 Gaussian window (sigma 1.5), compared around each
// pixel.

#include "megaviews/measure/rgb_image.h"

namespace mv {

// Mean SSIM of display values, at most 1 (equal), K1 = 0.01, K2 = 0.03, L = 1. On the pictures'
// luma 0.2126 R + 0.7152 G + 0.0722 B, over the windows that lie within the picture, as the
// authors' program does. A side shorter than the window has one or two rows of windows in its
// middle, cut at the picture's edge. NaN for a picture without good pixels.
double structuralSimilarity(const ImagePair& display);

}  // namespace mv
