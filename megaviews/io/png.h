#pragma once
// An image of a scene as the bytes of a PNG file, as --save-scene embeds it. Pictures are written
// elsewhere, with what they say of themselves.

#include <cstdint>
#include <vector>

#include "megaviews/scene/scene.h"

namespace mv {

// 8 bits a channel, RGB where every pixel is opaque and RGBA otherwise; a decoder gives the same
// bytes back. The image must have pixels. Equal images give equal bytes; safe to call from several
// threads.
std::vector<std::uint8_t> encodePng(const Image& image);

}  // namespace mv
