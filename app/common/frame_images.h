#pragma once
// The renderer's last frame as files and metrics take it: pictures top row first, three values a
// pixel, and depth maps against exact ones.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/measure/map_errors.h"
#include "megaviews/measure/rgb_image.h"
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
RgbImage radianceOf(const gl::Texture& texture);    // RGBA32F, bottom row first
RgbImage displayOf(const FrameRenderer& renderer);  // the 8-bit values, in [0,1]

// Errors of one side's maps in the renderer's last frame; settings: of that side. Nothing where it
// has no maps. Reads back maps: not for each frame.
std::optional<MapErrorReport> mapErrorsOf(const MapReferences& references,
                                          std::span<const View> views,
                                          const FrameRenderer& renderer, const Settings& settings,
                                          int side);
// The same against all the maps that the store has for these views; nothing if it has none.
std::optional<MapErrorReport> findMapErrors(const ReferenceStore& store,
                                            const FrameRenderer& renderer, const Scene& scene,
                                            const Settings& settings, const FrameMoment& moment,
                                            int side);

}  // namespace mv
