#pragma once
// Pictures as files, through OpenImageIO: PNG holds the 8-bit picture as displayed, EXR the linear
// radiance before exposure as 32-bit floats. Both carry what made them.

#include <cstdint>
#include <string>
#include <vector>

#include "app/common/picture_info.h"
#include "megaviews/measure/rgb_image.h"
#include "renderer/frame_renderer.h"

namespace mv {

using Metadata = std::vector<std::pair<std::string, std::string>>;

// `pixels`: top row first, `channels` values a pixel. A complete file is renamed to `file`. Throw
// Error(ExitCode::output).
void writePng(const std::string& file, int width, int height, int channels,
              const std::vector<std::uint8_t>& pixels, const Metadata& metadata);
void writeExr(const std::string& file, int width, int height, int channels,
              const std::vector<float>& pixels, const Metadata& metadata);

// The renderer's last picture; the extension, .png or .exr, chooses which.
void writePicture(const std::string& file, const FrameRenderer& renderer, const PictureInfo& info);

// A picture to measure against. Floating point is linear radiance, whole numbers are display
// values.
struct ReferenceImage {
    RgbImage image;
    bool linear = false;
    std::string exposure, toneMap,
        pixelSamples;  // as settings' texts, if this program wrote the file
};
// One channel is grey, alpha is ignored. Throws Error(ExitCode::input) naming the file.
ReferenceImage readReference(const std::string& file);

// The state that a picture written by this program carries; see state.h. Empty if it carries none.
// Throws Error(ExitCode::input) if the file is no picture.
std::string findPictureState(const std::string& file);
// The same; throws Error(ExitCode::input) if the file carries none.
std::string readPictureState(const std::string& file);

// What stands in a framebuffer (0: the window's), as an opaque PNG.
void writeFramebuffer(const std::string& file, unsigned framebuffer, int width, int height,
                      const Metadata& metadata);

}  // namespace mv
