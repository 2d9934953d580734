#include "app/common/frame_images.h"

#include <cstdint>

namespace mv {

RgbImage radianceOf(const FrameRenderer& renderer) {
    const gl::Texture& radiance = renderer.radiance();
    const int w = radiance.width(), h = radiance.height();
    return {w, h, topDownColor(radiance.readFloats(4), w, h)};
}

RgbImage displayOf(const FrameRenderer& renderer) {
    const gl::Texture& display = renderer.display();
    const int w = display.width(), h = display.height();
    const std::vector<std::uint8_t> bytes = topDownColor(display.readBytes(4), w, h);
    RgbImage image{w, h, {}};
    image.rgb.resize(bytes.size());
    std::transform(bytes.begin(), bytes.end(), image.rgb.begin(),
                   [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; });
    return image;
}

}  // namespace mv
