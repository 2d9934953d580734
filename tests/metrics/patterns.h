#pragma once
// The pictures of independent.py, and small ones.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "megaviews/measure/rgb_image.h"

namespace mv::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

inline RgbImage constant(int width, int height, float r, float g, float b) {
    RgbImage image{width, height, {}};
    for (std::size_t p = 0; p < image.pixels(); ++p) image.rgb.insert(image.rgb.end(), {r, g, b});
    return image;
}

inline RgbImage randomImage(int width, int height, unsigned seed, float most = 1) {
    std::mt19937 random(seed);
    RgbImage image = constant(width, height, 0, 0, 0);
    for (float& v : image.rgb) {
        v = most * static_cast<float>(random() % 65536) / 65535.0f;
    }
    return image;
}

// The image plus noise of at most `amplitude`, kept in [0,1].
inline RgbImage withNoise(RgbImage image, float amplitude, unsigned seed) {
    std::mt19937 random(seed);
    for (float& v : image.rgb) {
        const float noise = static_cast<float>(random() % 2001) / 1000.0f - 1;
        v = std::clamp(v + amplitude * noise, 0.0f, 1.0f);
    }
    return image;
}

// Whole numbers 0..255: checks on a ramp; the test picture has noise and a shadow on it.
struct Pattern {
    int width = 61, height = 47;
    std::vector<int> reference, test;

    Pattern() {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int c = 0; c < 3; ++c) add(x, y, c);
            }
        }
    }

    ImagePair display() const {
        return pair([](int v) { return static_cast<float>(v / 255.0); });
    }
    ImagePair radiance() const {
        return pair([](int v) {
            const double square = double(v) * v;
            return static_cast<float>(square * square * 0x1p-24);
        });
    }

  private:
    void add(int x, int y, int c) {
        const int value = 20 + 3 * x / 2 + y + 15 * c + 60 * ((x / 8 + y / 8) % 2);
        auto hash = static_cast<std::uint32_t>((y * width + x) * 3 + c);
        hash = hash * 2654435761u + 12345u;
        hash ^= hash >> 15;
        hash *= 2246822519u;
        hash ^= hash >> 13;
        const int noise = static_cast<int>(hash % 41) - 20;
        const int shadow = x > 30 && y > 20 && x < 45 ? 25 : 0;
        reference.push_back(value);
        test.push_back(std::clamp(value + noise - shadow, 0, 255));
    }
    template <typename Function>
    ImagePair pair(const Function& value) const {
        RgbImage t{width, height, {}}, r{width, height, {}};
        for (const int v : test) t.rgb.push_back(value(v));
        for (const int v : reference) r.rgb.push_back(value(v));
        return {std::move(t), std::move(r)};
    }
};

}  // namespace mv::test
