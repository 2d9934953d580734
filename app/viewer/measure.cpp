#include "app/viewer/measure.h"

#include <spdlog/spdlog.h>

#include "app/common/frame_images.h"
#include "app/common/output_names.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/colour_map.glsl"

namespace mv {
namespace {

std::string sizeText(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

bool isPicture(const Settings& settings) {
    return settings.difference == Difference::off && mv::isPicture(settings.view);
}

void takeFrom(Settings& settings, const RunOptions& options, const char* key,
              const std::string& value, const std::string& file) {
    if (value.empty() || options.isGiven(key)) return;
    setFromText(settings, *findSetting(key), value, "'" + file + "'");
}

// FLIP from 0 to 1 in viridis; a pixel that was left out is grey.
void writeMap(const std::string& file, const FlipMap& map, const ImagePair& pair) {
    const int width = pair.width(), height = pair.height();
    if (extensionOf(file) == ".exr") {
        writeExr(file, width, height, 1, map.errors, {{"megaviews.metric", "flip"}});
        return;
    }
    std::vector<std::uint8_t> pixels;
    pixels.reserve(3 * map.errors.size());
    for (std::size_t p = 0; p < map.errors.size(); ++p) {
        const glm::vec3 color = pair.isBad(p) ? glm::vec3(0.5f) : viridis(map.errors[p]);
        for (int c = 0; c < 3; ++c) {
            pixels.push_back(static_cast<std::uint8_t>(color[c] * 255.0f + 0.5f));
        }
    }
    writePng(file, width, height, 3, pixels, {{"megaviews.metric", "flip"}});
}

}  // namespace

bool isPicture(DebugView view) {
    return view == DebugView::final || view == DebugView::direct || view == DebugView::indirect ||
           view == DebugView::unfiltered;
}

Measure::Measure(const RunOptions& options, Settings& settings)
    : options_(options.measure), reference_(readReference(options.measure.referenceFile)) {
    const std::string& file = options_.referenceFile;
    const RgbImage& image = reference_.image;
    if (image.width != settings.width || image.height != settings.height) {
        throw Error(ExitCode::usage,
                    "--reference: '" + file + "' is " + sizeText(image.width, image.height) +
                        ", the picture " + sizeText(settings.width, settings.height) +
                        "; --resolution " + sizeText(image.width, image.height) + " would fit");
    }
    if (!isPicture(settings)) {
        throw Error(ExitCode::usage,
                    "--reference: measures pictures; " +
                        (settings.difference == Difference::off
                             ? "--view " + std::string(nameOf(settings.view)) + " shows data"
                             : "--difference shows data"));
    }
    metrics_ = wantedMetrics(options_, reference_.linear);
    takeFrom(settings, options, "exposure", reference_.exposure, file);
    takeFrom(settings, options, "tonemap", reference_.toneMap, file);
}

Measurement Measure::of(const FrameRenderer& renderer, const Settings& settings,
                        double exposureEv) {
    Compared compared;
    if (reference_.linear) {
        const RgbImage radiance = radianceOf(renderer);
        compared.radiance.emplace(radiance, reference_.image);
        compared.display = ImagePair(displayImage(radiance, exposureEv, settings.toneMap),
                                     displayImage(reference_.image, exposureEv, settings.toneMap));
    } else {
        compared.display = ImagePair(displayOf(renderer), reference_.image);
    }
    FlipMap map;
    Measurement out;
    out.reference = options_.referenceFile;
    out.exposureEv = exposureEv;
    out.toneMap = settings.toneMap;
    out.badPixels = compared.display.badPixels();
    out.values = evaluate(compared, metrics_, options_.diffFile.empty() ? nullptr : &map);
    out.thresholds = options_.thresholds;
    if (out.badPixels > 0) {
        spdlog::warn("{} pixels are NaN or infinite in the picture or in '{}' and not measured",
                     out.badPixels, out.reference);
    }
    if (!options_.diffFile.empty()) writeMap(options_.diffFile, map, compared.display);
    return out;
}

}  // namespace mv
