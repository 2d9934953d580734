#include "megaviews/io/png.h"

// The encoder is compiled into this file alone, without file access.
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

#include <cassert>
#include <new>

namespace mv {

std::vector<std::uint8_t> encodePng(const Image& image) {
    assert(image.width > 0 && image.height > 0);
    const std::size_t pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    assert(image.rgba.size() == 4 * pixels);
    bool opaque = true;
    for (std::size_t i = 0; i < pixels; ++i) opaque = opaque && image.rgba[4 * i + 3] == 255;

    std::vector<std::uint8_t> rgb;
    if (opaque) {
        rgb.reserve(3 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            rgb.insert(rgb.end(),
                       {image.rgba[4 * i], image.rgba[4 * i + 1], image.rgba[4 * i + 2]});
        }
    }
    const int channels = opaque ? 3 : 4;
    std::vector<std::uint8_t> png;
    const auto append = [](void* to, void* data, int size) {
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        static_cast<std::vector<std::uint8_t>*>(to)->assign(bytes, bytes + size);
    };
    // It gives up for want of memory alone.
    if (!stbi_write_png_to_func(append, &png, image.width, image.height, channels,
                                opaque ? rgb.data() : image.rgba.data(), channels * image.width)) {
        throw std::bad_alloc();
    }
    return png;
}

}  // namespace mv
