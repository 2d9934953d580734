// Points within a pixel, and cameras that see through them.

#include "megaviews/views/frame_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

namespace mv {
namespace {

TEST(PixelOffset, BeginsInTheMiddleAndStaysInThePixel) {
    EXPECT_EQ(pixelOffset(0), glm::vec2(0));
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const glm::vec2 p = pixelOffset(i);
        ASSERT_GE(std::min(p.x, p.y), -0.5f) << i;
        ASSERT_LT(std::max(p.x, p.y), 0.5f) << i;
    }
}

// A (0, 2) net: each of the boxes of area 1/n, however wide, has one point.
TEST(PixelOffset, PowersOfTwoAreNets) {
    for (int m = 0; m <= 8; ++m) {
        const int n = 1 << m;
        for (int begin = 0; begin < 3 * n; begin += n) {
            for (int across = 0; across <= m; ++across) {
                const int columns = 1 << across, rows = n >> across;
                std::set<std::pair<int, int>> boxes;
                for (int i = begin; i < begin + n; ++i) {
                    const glm::vec2 p = pixelOffset(static_cast<std::uint32_t>(i)) + 0.5f;
                    boxes.emplace(static_cast<int>(p.x * static_cast<float>(columns)),
                                  static_cast<int>(p.y * static_cast<float>(rows)));
                }
                ASSERT_EQ(boxes.size(), static_cast<std::size_t>(n))
                    << n << " from " << begin << ", " << columns << " columns";
            }
        }
    }
}

TEST(FrameCamera, SeesTheRayOfAPixelAtItsOffset) {
    constexpr int kWidth = 32, kHeight = 18;
    for (const bool flat : {false, true}) {
        FrameCamera camera;
        camera.position = {0.2f, 0.3f, 1.4f};
        camera.forward = glm::normalize(glm::vec3(0.2f, 0.1f, -1));
        if (flat) camera.orthoHalfHeight = 0.4f;
        for (std::uint32_t i = 0; i < 16; ++i) {
            const glm::vec2 offset = pixelOffset(i);
            FrameCamera there = camera;
            there.offset = 2.0f * offset / glm::vec2(kWidth, kHeight);
            const PickRay ray = rayThrough(there, kWidth, kHeight, 20.5f, 4.5f, 0);
            const PickRay same =
                rayThrough(camera, kWidth, kHeight, 20.5f + offset.x, 4.5f + offset.y, 0);
            EXPECT_LT(glm::length(ray.direction - same.direction), 1e-5f);
            EXPECT_LT(glm::length(ray.origin - same.origin), 1e-5f);
            const glm::vec3 point = ray.origin + 0.7f * ray.direction;
            const glm::vec4 clip =
                there.clipFromWorld(float{kWidth} / float{kHeight}) * glm::vec4(point, 1);
            EXPECT_NEAR((clip.x / clip.w + 1) / 2 * kWidth, 20.5f, 1e-3f);
            EXPECT_NEAR((clip.y / clip.w + 1) / 2 * kHeight, 4.5f, 1e-3f);
        }
    }
}

}  // namespace
}  // namespace mv
