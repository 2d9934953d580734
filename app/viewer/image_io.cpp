#include "app/viewer/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <memory>
#include <span>
#include <string_view>

#include "app/common/frame_images.h"
#include "app/common/output_names.h"
#include "app/common/state.h"
#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"

namespace mv {
namespace {

template <typename T>
void writeImage(const std::string& file, const char* format, OIIO::TypeDesc type, int width,
                int height, int channels, const std::vector<T>& pixels, const Metadata& metadata) {
    OIIO::ImageSpec spec(width, height, channels, type);
    for (const auto& [name, value] : metadata) spec.attribute(name, value);
    const auto fail = [&](const std::string& reason) {
        return Error(ExitCode::output, "'" + file + "' cannot be written: " + reason);
    };
    // Into memory first: the library's own files do not notice a disk that is full.
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto output = OIIO::ImageOutput::create(format);
    if (!output) throw fail(OIIO::geterror());
    output->set_ioproxy(&memory);
    if (!output->open(file, spec) || !output->write_image(type, pixels.data()) ||
        !output->close()) {
        throw fail(output->geterror());
    }
    OutputFile out(file);
    out.write(std::span<const unsigned char>(bytes));
    out.commit();
}

std::vector<float> displayValues(const std::vector<std::uint8_t>& bytes) {
    std::vector<float> out(bytes.size());
    std::transform(bytes.begin(), bytes.end(), out.begin(),
                   [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; });
    return out;
}

std::uint32_t bigEndian(std::span<const std::uint8_t> bytes) {
    return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
           std::uint32_t{bytes[2]} << 8 | bytes[3];
}

// The CRC that PNG defines.
std::uint32_t crcOf(std::span<const std::uint8_t> bytes) {
    std::uint32_t crc = ~0u;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1) != 0 ? 0xEDB88320u : 0);
    }
    return ~crc;
}

// What ends libpng, which says so on standard error itself; empty for what is no PNG.
std::string whyBrokenPng(const std::string& file) {
    constexpr std::size_t kSignature = 8, kFrame = 12;  // length, name and checksum of a chunk
    const std::vector<std::uint8_t> bytes = readRegularFile(file).bytes;
    constexpr std::string_view kBegin = "\x89PNG\r\n\x1a\n";
    if (!std::ranges::equal(std::span(bytes).first(std::min(bytes.size(), kSignature)), kBegin, {},
                            {}, [](char c) { return static_cast<std::uint8_t>(c); })) {
        return {};
    }
    for (std::span<const std::uint8_t> rest = std::span(bytes).subspan(kSignature);;) {
        if (rest.size() < kFrame || bigEndian(rest) > rest.size() - kFrame) return "it ends early";
        const std::size_t length = bigEndian(rest);
        const auto named = rest.subspan(4, length + 4);
        const std::string name(named.begin(), named.begin() + 4);
        const bool needed = name[0] >= 'A' && name[0] <= 'Z';
        if (needed && crcOf(named) != bigEndian(rest.subspan(length + 8))) {
            return "its chunk " + name + " is damaged";
        }
        if (name == "IEND") return {};
        rest = rest.subspan(length + kFrame);
    }
}

// A library's, which has one for each that it tried.
std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& file,
                                              const OIIO::ImageSpec* configuration = nullptr) {
    if (const std::string reason = whyUnreadable(file); !reason.empty()) {
        throw Error(ExitCode::input, "'" + file + "' cannot be read: " + reason);
    }
    if (const std::string reason = whyBrokenPng(file); !reason.empty()) {
        throw Error(ExitCode::input, "'" + file + "' cannot be read: " + reason);
    }
    auto input = OIIO::ImageInput::open(file, configuration);
    if (!input) {
        throw Error(ExitCode::input,
                    "'" + file + "' is no picture: " + firstLine(OIIO::geterror()));
    }
    return input;
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

ReferenceImage readReference(const std::string& file) {
    OIIO::ImageSpec plain;
    plain.attribute("oiio:UnassociatedAlpha", 1);  // colour as stored
    const auto input = openPicture(file, &plain);
    const OIIO::ImageSpec& spec = input->spec();
    const auto fail = [&](const std::string& reason) {
        return Error(ExitCode::input, "'" + file + "' cannot be read: " + reason);
    };
    if (spec.depth > 1 || spec.nchannels == 2) throw fail("it is no grey or RGB picture");
    const int channels = std::min(spec.nchannels, 3);
    ReferenceImage out;
    out.linear = spec.format.is_floating_point();
    out.exposure = spec.get_string_attribute("megaviews.exposure");
    out.toneMap = spec.get_string_attribute("megaviews.tonemap");
    out.pixelSamples = spec.get_string_attribute("megaviews.pixelSamples");
    out.image = {spec.width, spec.height, {}};
    std::vector<float> values(out.image.pixels() * static_cast<std::size_t>(channels));
    if (spec.format == OIIO::TypeDesc::UINT8) {
        std::vector<std::uint8_t> bytes(values.size());
        if (!input->read_image(0, 0, 0, channels, spec.format, bytes.data())) {
            throw fail(firstLine(input->geterror()));
        }
        values = displayValues(bytes);
    } else if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data())) {
        throw fail(firstLine(input->geterror()));
    }
    if (channels == 3) {
        out.image.rgb = std::move(values);
    } else {
        for (const float v : values) out.image.rgb.insert(out.image.rgb.end(), {v, v, v});
    }
    return out;
}

std::string findPictureState(const std::string& file) {
    return std::string(openPicture(file)->spec().get_string_attribute(std::string(kStateKey)));
}

std::string readPictureState(const std::string& file) {
    std::string state = findPictureState(file);
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
