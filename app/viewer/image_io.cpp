#include "app/viewer/image_io.h"

#include <OpenImageIO/imageio.h>
#include <epoxy/gl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "app/common/output_names.h"
#include "app/common/state.h"
#include "megaviews/settings/error.h"

namespace mv {
namespace {

// OpenGL counts rows from the bottom, files from the top; colour goes without its alpha of 1.
template <typename T>
std::vector<T> topDownColor(const std::vector<T>& rgba, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<T> out(w * h * 3);
    for (std::size_t y = 0; y < h; ++y) {
        const T* from = &rgba[(h - 1 - y) * w * 4];
        T* to = &out[y * w * 3];
        for (std::size_t x = 0; x < w; ++x) std::copy_n(from + 4 * x, 3, to + 3 * x);
    }
    return out;
}

template <typename T>
void writeImage(const std::string& file, const char* format, OIIO::TypeDesc type, int width,
                int height, int channels, const std::vector<T>& pixels, const Metadata& metadata) {
    OIIO::ImageSpec spec(width, height, channels, type);
    for (const auto& [name, value] : metadata) spec.attribute(name, value);
    const std::string aside = file + ".part" + std::to_string(getpid());
    const auto fail = [&](const std::string& reason) {
        std::error_code ignored;
        std::filesystem::remove(aside, ignored);
        throw Error(ExitCode::output, "'" + file + "' cannot be written: " + reason);
    };
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) fail(OIIO::geterror());
    if (!output->open(aside, spec)) fail(output->geterror());
    if (!output->write_image(type, pixels.data())) fail(output->geterror());
    if (!output->close()) fail(output->geterror());
    std::error_code error;
    std::filesystem::rename(aside, file, error);
    if (error) fail(error.message());
}

}  // namespace

void writePng(const std::string& file, int width, int height, int channels,
              const std::vector<std::uint8_t>& pixels, const Metadata& metadata) {
    writeImage(file, "png", OIIO::TypeDesc::UINT8, width, height, channels, pixels, metadata);
}

void writeExr(const std::string& file, int width, int height, int channels,
              const std::vector<float>& pixels, const Metadata& metadata) {
    // A fixed date: OpenImageIO would put in the present one, and no two files would be equal.
    Metadata fixed = metadata;
    fixed.emplace_back("DateTime", "1970:01:01 00:00:00");
    writeImage(file, "openexr", OIIO::TypeDesc::FLOAT, width, height, channels, pixels, fixed);
}

void writePicture(const std::string& file, const FrameRenderer& renderer, const PictureInfo& info) {
    const Metadata metadata = pictureMetadata(info);
    if (extensionOf(file) == ".exr") {
        const gl::Texture& radiance = renderer.radiance();
        const int w = radiance.width(), h = radiance.height();
        writeExr(file, w, h, 3, topDownColor(radiance.readFloats(4), w, h), metadata);
    } else {
        const gl::Texture& display = renderer.display();
        const int w = display.width(), h = display.height();
        writePng(file, w, h, 3, topDownColor(display.readBytes(4), w, h), metadata);
    }
}

std::string readPictureState(const std::string& file) {
    std::error_code unreadable;
    if (!std::filesystem::exists(file, unreadable)) {
        throw Error(ExitCode::input, "'" + file + "' cannot be read: no such file");
    }
    const auto input = OIIO::ImageInput::open(file);
    if (!input) throw Error(ExitCode::input, "'" + file + "' is no picture: " + OIIO::geterror());
    const std::string state = input->spec().get_string_attribute(std::string(kStateKey));
    if (state.empty()) {
        throw Error(ExitCode::input, "'" + file + "' carries no state of this program");
    }
    return state;
}

void writeFramebuffer(const std::string& file, unsigned framebuffer, int width, int height,
                      const Metadata& metadata) {
    std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(width) *
                                   static_cast<std::size_t>(height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    writePng(file, width, height, 3, topDownColor(rgba, width, height), metadata);
}

}  // namespace mv
