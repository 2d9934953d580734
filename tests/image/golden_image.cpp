#include "image/golden_image.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

namespace mv {
namespace {

namespace fs = std::filesystem;

std::optional<Picture> readPicture(const fs::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) {
        OIIO::geterror();  // collected, or OpenImageIO complains at exit
        return std::nullopt;
    }
    Picture out;
    out.width = input->spec().width;
    out.height = input->spec().height;
    out.rgb.resize(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height) * 3);
    if (input->spec().nchannels < 3) return std::nullopt;
    input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, out.rgb.data());
    return out;
}

void writePicture(const fs::path& file, const Picture& picture) {
    fs::create_directories(file.parent_path());
    const auto output = OIIO::ImageOutput::create(file.string());
    const OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
    if (!output || !output->open(file.string(), spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, picture.rgb.data())) {
        ADD_FAILURE() << "cannot write " << file;
    }
}

Picture differenceOf(const Picture& a, const Picture& b) {
    Picture out = a;
    for (std::size_t i = 0; i < a.rgb.size(); ++i) {
        out.rgb[i] = static_cast<std::uint8_t>(std::min(255, 8 * std::abs(a.rgb[i] - b.rgb[i])));
    }
    return out;
}

}  // namespace

double failingShare(const Picture& a, const Picture& b, int difference) {
    std::size_t failing = 0;
    const std::size_t pixels = a.rgb.size() / 3;
    for (std::size_t p = 0; p < pixels; ++p) {
        int largest = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            largest = std::max(largest, std::abs(a.rgb[3 * p + c] - b.rgb[3 * p + c]));
        }
        if (largest > difference) ++failing;
    }
    return pixels ? static_cast<double>(failing) / static_cast<double>(pixels) : 0.0;
}

testing::AssertionResult matchesGolden(const Picture& picture, const std::string& name,
                                       Tolerance tolerance) {
    const fs::path golden = fs::path(MEGAVIEWS_SOURCE_DIR) / "tests/image/golden" / (name + ".png");
    const fs::path results = fs::path(MEGAVIEWS_BINARY_DIR) / "image-results";
    const char* bless = std::getenv("MEGAVIEWS_BLESS");
    if (bless && std::string_view(bless) == "1") {
        writePicture(golden, picture);
        return testing::AssertionSuccess();
    }
    const auto expected = readPicture(golden);
    if (!expected) {
        writePicture(results / (name + ".png"), picture);
        return testing::AssertionFailure() << "no golden picture " << golden;
    }
    if (expected->width != picture.width || expected->height != picture.height) {
        return testing::AssertionFailure() << golden << " has another size";
    }
    const double share = failingShare(picture, *expected, tolerance.difference);
    if (share <= tolerance.failing) return testing::AssertionSuccess();
    writePicture(results / (name + ".png"), picture);
    writePicture(results / (name + ".golden.png"), *expected);
    writePicture(results / (name + ".difference.png"), differenceOf(picture, *expected));
    return testing::AssertionFailure()
           << name << ": " << 100 * share << " % of the pixels differ by more than "
           << tolerance.difference << "/255; see " << results;
}

}  // namespace mv
