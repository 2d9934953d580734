#pragma once
// Decodes the images of a glTF file that some texture in use refers to: PNG, JPEG and WebP
// [EXT_texture_webp], all of them in parallel, none before its header has said that it is of a
// bearable size. What cannot be decoded costs a warning. Serves the first stage, file -> Scene.

#include <tiny_gltf.h>

#include <span>
#include <vector>

#include "megaviews/core/progress.h"
#include "megaviews/scene/gltf_file.h"
#include "megaviews/scene/scene.h"

namespace mv {

inline constexpr int kLargestImageSide = 16384;
inline constexpr std::int64_t kMostImagePixels = std::int64_t{64} << 20;   // of one image
inline constexpr std::int64_t kMostPixelsInAll = std::int64_t{256} << 20;  // 1 GiB as RGBA8

// Of a channel of 8 bits, sRGB.
float linearOfByte(std::uint8_t value);

// PNG, JPEG or WebP from memory, whatever the file calls it. An image without pixels says why in
// `error`. Each factor of `halvings` halves both sides with a 2x2 box: of colours in linear light,
// of numbers (normals, roughness) as they are.
enum class Texels { colours, numbers };
struct DecodedImage {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    std::string error;
};
DecodedImage decodeImage(std::span<const std::uint8_t> bytes, int halvings = 0,
                         Texels texels = Texels::colours);

// How often the sides of images are halved so that all together are no more than kMostPixelsInAll:
// the longest first, so that a palette of few texels stays what it is beside large images.
std::vector<int> halvingsOf(std::span<const glm::ivec2> sizes);

struct UsedImage {
    int index;  // in the file
    Texels texels;
};
// Decodes images. Returns as many; those that failed have no pixels.
std::vector<Image> loadImages(GltfFile& file, const tinygltf::Model& model,
                              std::span<const UsedImage> used, GltfReport& report,
                              const Progress& progress);

// Gives texels of an alpha below that, 0 .. 255, the colour of those beside them that are not: what
// is never seen is not to darken or whiten what is, where texels are averaged. Alpha stays.
void fillUnseen(Image& image, int alpha);

}  // namespace mv
