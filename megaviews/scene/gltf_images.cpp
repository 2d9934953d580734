#include "megaviews/scene/gltf_images.h"

// The decoder is compiled into this file alone, without its other formats and without file access.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_FAILURE_USERMSG
#include <stb/stb_image.h>
#include <tbb/parallel_for.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <string_view>

#include "megaviews/core/colour.h"
#include "megaviews/scene/uri.h"

namespace mv {

namespace {

using Json = nlohmann::json;

// Where the encoded bytes of one image are.
struct Source {
    std::string name, place;
    std::vector<std::uint8_t> owned;
    std::span<const std::uint8_t> bytes;
    std::string error;
    std::int64_t pixels = 0;
};

std::string formatOf(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 16));
    if (text.starts_with("\x89PNG\r\n\x1a\n")) return "PNG";
    if (text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == "WEBP") return "WebP";
    if (text.starts_with("\xabKTX")) return "KTX";
    if (text.starts_with("DDS ")) return "DDS";
    if (text.starts_with("GIF8")) return "GIF";
    return "";
}

// Why an image of this size is not decoded.
std::string sizeError(std::int64_t width, std::int64_t height) {
    if (std::max(width, height) <= kLargestImageSide && width * height <= kMostImagePixels)
        return "";
    return std::to_string(width) + " x " + std::to_string(height) +
           " pixels are too many (at most " + std::to_string(kLargestImageSide) + " a side and " +
           std::to_string(kMostImagePixels >> 20) + " Mi in all)";
}

// Why an image cannot be decoded, judged by its header alone; sets width and height.
std::string headerError(std::span<const std::uint8_t> bytes, int& width, int& height) {
    if (bytes.empty()) return "it is empty";
    if (bytes.size() > INT32_MAX) return "it is larger than 2 GiB";
    // The decoder calls a PNG beyond its own limits damaged: its size stands at a fixed place.
    constexpr std::size_t kPngWidth = 16, kPngHeight = 20;
    if (formatOf(bytes) == "PNG" && bytes.size() >= kPngHeight + 4) {
        const auto bigEndian = [&](std::size_t at) {
            std::int64_t value = 0;
            for (std::size_t i = 0; i < 4; ++i) value = value << 8 | bytes[at + i];
            return value;
        };
        std::string error = sizeError(bigEndian(kPngWidth), bigEndian(kPngHeight));
        if (!error.empty()) return error;
    }
    if (formatOf(bytes) == "WebP") {
        WebPBitstreamFeatures features{};
        if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK) {
            return "its WebP header is damaged";
        }
        if (features.has_animation) return "animated WebP images are not supported";
        width = features.width;
        height = features.height;
        return sizeError(width, height);
    }
    int channels = 0;
    if (!stbi_info_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                               &channels)) {
        const std::string format = formatOf(bytes);
        if (!format.empty() && format != "PNG")
            return format + " images are not supported, only PNG, JPEG and WebP";
        return "it is damaged or neither PNG, JPEG nor WebP";
    }
    return sizeError(width, height);
}

std::uint8_t srgbFromLinear(float c) {
    const double s = c <= 0.0031308f ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::clamp(s * 255 + 0.5, 0.0, 255.0));
}

void halve(DecodedImage& image, Texels texels) {
    const std::size_t curved = texels == Texels::colours ? 3 : 0;  // channels stored as sRGB
    const int width = std::max(image.width / 2, 1), height = std::max(image.height / 2, 1);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(width) *
                                  static_cast<std::size_t>(height) * 4);
    const auto texel = [&](int x, int y, std::size_t c) {
        const auto at = static_cast<std::size_t>(std::min(y, image.height - 1)) *
                            static_cast<std::size_t>(image.width) +
                        static_cast<std::size_t>(std::min(x, image.width - 1));
        return image.rgba[4 * at + c];
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::uint8_t* to =
                &out[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                          static_cast<std::size_t>(x))];
            for (std::size_t c = 0; c < 4; ++c) {
                float sum = 0;
                for (int k = 0; k < 4; ++k) {
                    const std::uint8_t value = texel(2 * x + (k & 1), 2 * y + (k >> 1), c);
                    sum += c < curved ? linearOfByte(value) : static_cast<float>(value);
                }
                to[c] = c < curved ? srgbFromLinear(sum / 4)
                                   : static_cast<std::uint8_t>(sum / 4 + 0.5f);
            }
        }
    }
    image.width = width;
    image.height = height;
    image.rgba = std::move(out);
}

Source findSource(GltfFile& file, const tinygltf::Model& model, const Json& image,
                  std::size_t index) {
    Source source;
    source.place = "images[" + std::to_string(index) + "]";
    if (!image.is_object()) {
        source.error = "it is not an object";
        return source;
    }
    if (const auto name = image.find("name"); name != image.end() && name->is_string()) {
        source.name = printable(name->get_ref<const std::string&>());
    }
    const auto uri = image.find("uri"), view = image.find("bufferView");
    if (uri != image.end() && uri->is_string()) {
        const auto& text = uri->get_ref<const std::string&>();
        if (source.name.empty() && !text.starts_with("data:")) source.name = printable(text);
        Resource resource = readUri(file.folder, text);
        file.noteRead(resource);
        source.error = resource.error;
        source.owned = std::move(resource.bytes);
        source.bytes = source.owned;
    } else if (view != image.end() && view->is_number_unsigned() &&
               view->get<std::uint64_t>() + 1 < model.bufferViews.size()) {  // the last is no view
        const tinygltf::BufferView& v = model.bufferViews[view->get<std::size_t>()];
        const auto& buffer = model.buffers[static_cast<std::size_t>(v.buffer)].data;
        source.bytes = std::span(buffer).subspan(v.byteOffset, v.byteLength);
    } else {
        source.error = "it has neither a uri nor a valid bufferView";
    }
    return source;
}

// PNG or JPEG whose header has been found right.
void decodeByStb(std::span<const std::uint8_t> bytes, DecodedImage& image) {
    int width = 0, height = 0, channels = 0;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height,
                              &channels, 4),
        stbi_image_free);
    if (!pixels) {
        const char* reason = stbi_failure_reason();
        image.error = "it cannot be decoded (" + std::string(reason ? reason : "damaged") + ")";
        return;
    }
    image.width = width;
    image.height = height;
    image.rgba.assign(pixels.get(), pixels.get() + std::size_t{4} *
                                                       static_cast<std::size_t>(width) *
                                                       static_cast<std::size_t>(height));
}

}  // namespace

float linearOfByte(std::uint8_t value) {
    static const auto kTable = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < 256; ++i) {
            table[i] = static_cast<float>(linearFromSrgb(static_cast<double>(i) / 255));
        }
        return table;
    }();
    return kTable[value];
}

DecodedImage decodeImage(std::span<const std::uint8_t> bytes, int halvings, Texels texels) {
    DecodedImage image;
    image.error = headerError(bytes, image.width, image.height);
    if (!image.error.empty()) return image;
    if (formatOf(bytes) == "WebP") {
        const std::size_t row = std::size_t{4} * static_cast<std::size_t>(image.width);
        image.rgba.resize(row * static_cast<std::size_t>(image.height));
        if (!WebPDecodeRGBAInto(bytes.data(), bytes.size(), image.rgba.data(), image.rgba.size(),
                                static_cast<int>(row))) {
            image.rgba.clear();
            image.error = "it cannot be decoded (its WebP data are damaged)";
        }
    } else {
        decodeByStb(bytes, image);
    }
    if (!image.error.empty()) return image;
    for (int i = 0; i < halvings; ++i) halve(image, texels);
    return image;
}

void fillUnseen(Image& image, int alpha) {
    // Coarser and coarser means of what is seen, then back: what is not takes the finest there is.
    struct Level {
        int width = 0, height = 0;
        std::vector<std::array<std::uint8_t, 3>> colours;
        std::vector<bool> seen;
        std::size_t at(int x, int y) const {
            return static_cast<std::size_t>(std::min(y, height - 1)) *
                       static_cast<std::size_t>(width) +
                   static_cast<std::size_t>(std::min(x, width - 1));
        }
    };
    const auto texels = image.rgba.size() / 4;
    std::vector<Level> levels(1);
    levels[0] = {image.width, image.height, {}, std::vector<bool>(texels)};
    std::size_t unseen = 0;
    for (std::size_t i = 0; i < texels; ++i) {
        levels[0].seen[i] = image.rgba[4 * i + 3] >= alpha;
        unseen += !levels[0].seen[i];
    }
    if (unseen == 0 || unseen == texels) return;
    levels[0].colours.resize(texels);
    for (std::size_t i = 0; i < texels; ++i) {
        std::copy_n(&image.rgba[4 * i], 3, levels[0].colours[i].begin());
    }
    while (unseen > 0) {
        const Level& fine = levels.back();
        Level coarse{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}, {}};
        unseen = 0;
        for (int y = 0; y < coarse.height; ++y) {
            for (int x = 0; x < coarse.width; ++x) {
                std::array<int, 3> sum{};
                int count = 0;
                for (int k = 0; k < 9; ++k) {  // of an odd side the last texel belongs to two
                    const int fx = 2 * x + k % 3, fy = 2 * y + k / 3;
                    const bool spare =
                        (k % 3 == 2 && fine.width % 2 == 0) || (k / 3 == 2 && fine.height % 2 == 0);
                    if (spare || fx >= fine.width || fy >= fine.height) continue;
                    if (!fine.seen[fine.at(fx, fy)]) continue;
                    for (std::size_t c = 0; c < 3; ++c) sum[c] += fine.colours[fine.at(fx, fy)][c];
                    ++count;
                }
                std::array<std::uint8_t, 3> mean{};
                for (std::size_t c = 0; c < 3 && count > 0; ++c) {
                    mean[c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
                }
                coarse.colours.push_back(mean);
                coarse.seen.push_back(count > 0);
                unseen += count == 0;
            }
        }
        levels.push_back(std::move(coarse));
    }
    for (std::size_t l = levels.size() - 1; l-- > 0;) {
        Level& fine = levels[l];
        const Level& coarse = levels[l + 1];
        for (int y = 0; y < fine.height; ++y) {
            for (int x = 0; x < fine.width; ++x) {
                const std::size_t i = fine.at(x, y);
                if (!fine.seen[i]) fine.colours[i] = coarse.colours[coarse.at(x / 2, y / 2)];
            }
        }
    }
    for (std::size_t i = 0; i < texels; ++i) {
        std::copy_n(levels[0].colours[i].begin(), 3, &image.rgba[4 * i]);
    }
}

std::vector<int> halvingsOf(std::span<const glm::ivec2> sizes) {
    std::vector<int> halvings(sizes.size(), 0);
    const auto isTooMuch = [&] {
        std::int64_t sum = 0;
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            sum += std::int64_t{sizes[i].x >> halvings[i]} * (sizes[i].y >> halvings[i]);
        }
        return sum > kMostPixelsInAll;
    };
    for (int longest = kLargestImageSide / 2; isTooMuch(); longest /= 2) {
        for (std::size_t i = 0; i < sizes.size(); ++i) {
            while (std::max(sizes[i].x, sizes[i].y) >> halvings[i] > longest) ++halvings[i];
        }
    }
    return halvings;
}

std::vector<Image> loadImages(GltfFile& file, const tinygltf::Model& model,
                              std::span<const UsedImage> used, GltfReport& report,
                              const Progress& progress) {
    std::vector<Source> sources;
    std::vector<glm::ivec2> sizes(used.size(), glm::ivec2(0));
    const auto images = file.json.find("images");
    for (const UsedImage& image : used) {
        const auto i = static_cast<std::size_t>(image.index);
        sources.push_back(findSource(file, model, (*images)[i], i));
        Source& source = sources.back();
        if (!source.error.empty()) continue;
        glm::ivec2& size = sizes[sources.size() - 1];
        source.error = headerError(source.bytes, size.x, size.y);
        if (!source.error.empty()) size = glm::ivec2(0);
    }
    const std::vector<int> halvings = halvingsOf(sizes);
    if (std::ranges::any_of(halvings, [](int h) { return h > 0; })) {
        report.warn("images",
                    "they are too many pixels in all; those with the longest sides are "
                    "halved until they fit");
    }

    std::vector<Image> result(used.size());
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, sources.size(), [&](std::size_t i) {
        Source& source = sources[i];
        if (source.error.empty()) {
            DecodedImage decoded = decodeImage(source.bytes, halvings[i], used[i].texels);
            source.error = std::move(decoded.error);
            result[i] = {source.name, decoded.width, decoded.height, std::move(decoded.rgba)};
        }
        const std::size_t count = ++done;
        if (count % (sources.size() / 20 + 1) == 0) {
            mv::report(progress, "decode images",
                       static_cast<float>(count) / static_cast<float>(sources.size()));
        }
    });
    for (const Source& source : sources) {
        if (source.error.empty()) continue;
        const bool named =
            !source.name.empty() && source.error.find(source.name) == std::string::npos;
        report.warn(source.place, (named ? "image " + quote(source.name) + ": " : std::string()) +
                                      source.error + "; drawn without it");
    }
    return result;
}

}  // namespace mv
