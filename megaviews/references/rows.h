#pragma once
// An irradiance image made row by row, so that work which was cancelled goes on where it stopped.
// Each pixel is one task with sums in a fixed order: the bytes do not depend on the
// number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <string_view>

#include "megaviews/core/progress.h"
#include "megaviews/gather/receiver.h"

namespace mv {

// Calls pixel(index) for every pixel of the rows that are not done. `progress` is called from this
// thread, before each row; if it throws, the rows done so far stay.
template <typename Pixel>
void forEachPixel(IrradianceImage& image, std::string_view stage, const Progress& progress,
                  const Pixel& pixel) {
    const auto width = static_cast<std::size_t>(image.width);
    while (image.rowsDone < image.height) {
        report(progress, stage,
               static_cast<float>(image.rowsDone) / static_cast<float>(image.height));
        const std::size_t first = static_cast<std::size_t>(image.rowsDone) * width;
        using Range = tbb::blocked_range<std::size_t>;
        tbb::parallel_for(Range(first, first + width, 4), [&](const Range& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) pixel(i);
        });
        ++image.rowsDone;
    }
    report(progress, stage, 1);
}

}  // namespace mv
