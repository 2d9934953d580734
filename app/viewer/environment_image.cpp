#include "app/viewer/environment_image.h"

#include <cmath>
#include <filesystem>
#include <span>

#include <spdlog/spdlog.h>

#include "app/viewer/image_io.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/text.h"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

constexpr int kMaxEdge = 1 << 14;

}  // namespace

EnvironmentImage readEnvironment(const std::string& file) {
    const ReferenceImage read = readReference(file);
    const RgbImage& image = read.image;
    const auto fail = [&](const std::string& reason) {
        return Error(ExitCode::input, "'" + file + "' is no environment: " + reason);
    };
    if (image.width > kMaxEdge || image.height > kMaxEdge) {
        throw fail("it is larger than " + std::to_string(kMaxEdge) + " pixels");
    }
    EnvironmentImage out{image.width, image.height, {}, {}};
    out.radiance.reserve(image.pixels());
    constexpr float kMost = 65504;  // the largest half: a sun beyond it is stored as infinite
    std::size_t bad = 0;
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        glm::vec3 c(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]);
        if (!read.linear) {
            c = {linearFromSrgbChannel(c.x), linearFromSrgbChannel(c.y),
                 linearFromSrgbChannel(c.z)};
        }
        bool isBad = false;
        for (int k = 0; k < 3; ++k) {
            isBad |= !(c[k] >= 0);
            if (std::isinf(c[k])) c[k] = kMost;
        }
        bad += isBad;
        out.radiance.push_back(isBad ? glm::vec3(0) : c);
    }
    if (bad > 0) {
        spdlog::warn("'{}': {} of {} pixels are negative or no numbers and count as black", file,
                     bad, image.pixels());
    }
    if (2 * image.height != image.width) {
        spdlog::warn("'{}' is {}x{}: an image of latitude and longitude is twice as wide as high",
                     file, image.width, image.height);
    }
    Hash hash;
    hash.add(std::as_bytes(std::span(out.radiance)));
    out.hash = hash.hex();
    return out;
}

bool isEnvironmentFile(const std::string& file) {
    const std::string extension = lowered(std::filesystem::path(file).extension().string());
    return extension == ".hdr" || extension == ".exr";
}

std::shared_ptr<const EnvironmentImage> EnvironmentSlot::of(const EnvironmentSettings& settings) {
    const std::string file = environmentFile(settings);
    if (file == file_) return image_;
    std::shared_ptr<const EnvironmentImage> image;
    if (!file.empty()) image = std::make_shared<const EnvironmentImage>(readEnvironment(file));
    image_ = std::move(image);
    file_ = file;
    return image_;
}

void EnvironmentSlot::readAgain() {
    if (image_) image_ = std::make_shared<const EnvironmentImage>(readEnvironment(file_));
}

}  // namespace mv
