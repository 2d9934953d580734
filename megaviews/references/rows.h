#pragma once
// An irradiance image made row by row, so that work which was cancelled goes on where it stopped.
// Each pixel is one task with sums in a fixed order: the bytes do not depend on the
// number of threads.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <string_view>

#include "megaviews/core/progress.h"
#include "megaviews/gather/receiver.h"

namespace mv {

// Calls pixel(index) for every pixel of the rows that are not done. `progress` is called from this
// thread while no pixel is worked on, some times a second; if it throws, the rows done so far stay.
template <typename Pixel>
void forEachPixel(IrradianceImage& image, std::string_view stage, const Progress& progress,
                  const Pixel& pixel) {
    using Clock = std::chrono::steady_clock;
    constexpr std::size_t kLeast = 16;
    constexpr std::chrono::milliseconds kShort{50}, kLong{200};
    const auto width = static_cast<std::size_t>(image.width);
    std::size_t batch = kLeast;  // pixels at once
    while (image.rowsDone < image.height) {
        const std::size_t row = static_cast<std::size_t>(image.rowsDone) * width;
        for (std::size_t done = 0; done < width;) {
            report(progress, stage,
                   static_cast<float>(image.rowsDone) / static_cast<float>(image.height));
            const std::size_t first = row + done, end = row + std::min(width, done + batch);
            const auto start = Clock::now();
            using Range = tbb::blocked_range<std::size_t>;
            tbb::parallel_for(Range(first, end, 4), [&](const Range& range) {
                for (std::size_t i = range.begin(); i < range.end(); ++i) pixel(i);
            });
            const auto took = Clock::now() - start;
            if (took < kShort) batch = std::min(2 * batch, std::max(width, kLeast));
            if (took > kLong) batch = std::max(batch / 2, kLeast);
            done = end - row;
        }
        ++image.rowsDone;
    }
    report(progress, stage, 1);
}

}  // namespace mv
