#pragma once
// A picture of irradiance that is made row by row, so that work which was cancelled goes on where
// it stopped. Each pixel is one task with sums in a fixed order: the bytes do not depend on the
// number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "megaviews/core/progress.h"

namespace mv {

// Irradiance E in W/m^2, everything but albedo / pi, as the gather's. Rows as the receivers' were,
// so bottom first for a G-buffer. A pixel without a surface is 0.
struct IrradianceImage {
    int width = 0, height = 0;
    int rowsDone = 0;                 // the first rows hold values, those after them 0
    std::vector<glm::vec3> mean;      // width * height
    std::vector<glm::vec3> variance;  // of the mean; empty where there is none to estimate

    bool done() const { return rowsDone == height; }
};

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
