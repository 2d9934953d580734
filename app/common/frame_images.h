#pragma once
// The renderer's last picture as files and metrics take it: top row first, three values a pixel.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "megaviews/metrics/rgb_image.h"
#include "renderer/frame_renderer.h"

namespace mv {

// OpenGL counts rows from the bottom, files from the top; colour goes without its alpha of 1.
template <typename T>
std::vector<T> topDownColor(const std::vector<T>& rgba, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<T> out(w * h * 3);
    for (std::size_t y = 0; y < h; ++y) {
        const T* from = &rgba[(h - 1 - y) * w * 4];
        T* to = &out[y * w * 3];
        for (std::size_t x = 0; x < w; ++x) std::copy_n(from + 4 * x, 3, to + 3 * x);
    }
    return out;
}

RgbImage radianceOf(const FrameRenderer& renderer);
RgbImage displayOf(const FrameRenderer& renderer);  // the 8-bit values, in [0,1]

}  // namespace mv
