#include "app/viewer/measuring.h"

#include <spdlog/spdlog.h>

#include <limits>
#include <utility>

#include "app/common/frame_images.h"
#include "app/common/output_names.h"
#include "app/viewer/references.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/colour_map.glsl"
#include "ui/format.h"

namespace mv {
namespace {

std::string sizeText(int width, int height, const char* times) {
    return std::to_string(width) + times + std::to_string(height);
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

// Whichever of a pixel's points is shown.
bool sameView(FrameCamera a, FrameCamera b) {
    a.offset = b.offset = glm::vec2(0);
    return a == b;
}

// "MegaViews", or "Left: MegaViews" of two.
std::string sideTitle(const Settings& settings, int side) {
    if (!settings.compare) return ui::methodTitle(settings.side[0].method);
    return side == 0 ? std::string("Left: ") + ui::methodTitle(settings.side[0].method)
                     : std::string("Right: ") + ui::methodTitle(settings.side[1].method);
}

ui::ErrorTable emptyTable(std::string of, std::string against, bool linear) {
    ui::ErrorTable table;
    table.of = std::move(of);
    table.against = std::move(against);
    for (const MetricInfo& info : metricsTable()) {
        if (!linear && info.domain == MetricDomain::radiance) continue;
        table.values.push_back({.label = std::string(info.label),
                                .unit = std::string(info.unit),
                                .help = std::string(info.description),
                                .higherIsBetter = info.higherIsBetter,
                                .value = std::nullopt});
    }
    return table;
}

// report: null while it is not there.
ui::ErrorTable mapTable(std::string of, Method method, const MapErrorReport* report) {
    ui::ErrorTable table;
    table.of = std::move(of);
    if (!makesMaps(method)) {
        table.reason =
            std::string("The method \"") + ui::methodTitle(method) + "\" makes no depth maps.";
        return table;
    }
    for (const MapMetricInfo& info : mapMetricsTable()) {
        std::optional<double> percent;
        if (report) {
            percent = report->errors.texels > 0 ? info.percent(report->errors)
                                                : std::numeric_limits<double>::quiet_NaN();
        }
        table.values.push_back({.label = std::string(info.label),
                                .unit = "%",
                                .help = std::string(info.description),
                                .higherIsBetter = false,
                                .value = percent});
    }
    if (report) {
        table.against = ui::withThousands(report->views) + " views, " +
                        ui::withThousands(report->errors.texels) + " texels";
        table.badPixels = report->errors.bad;
    }
    return table;
}

}  // namespace

Measuring::Measuring(const RunOptions& options)
    : options_(options.measure), references_(referenceFolder(options)) {
    if (options_.referenceFile.empty()) return;
    loadReference(options_.referenceFile);
    given_ = reference_;
}

void Measuring::loadReference(const std::string& file) {
    reference_ = std::make_shared<const ReferenceImage>(readReference(file));
    referenceName_ = file;
    keptFrom_.reset();
    errors_.stop();
}

void Measuring::keepReference(const FrameRenderer& renderer, const Settings& settings,
                              const FrameCamera& camera, int side) {
    reference_ = std::make_shared<const ReferenceImage>(
        ReferenceImage{radianceOf(renderer.radianceOf(side)), true, {}, {}, {}});
    referenceName_ = std::string("the kept picture, ") +
                     ui::methodTitle(settings.side[static_cast<std::size_t>(side)].method);
    keptFrom_ = camera;
    keptOf_ = sceneName_;
    errors_.stop();
}

void Measuring::prepare(const RunOptions& options, Settings& settings) const {
    const std::string& file = options_.referenceFile;
    if (!given_) return;
    const RgbImage& image = given_->image;
    const auto size = [](int width, int height) { return sizeText(width, height, "x"); };
    if (image.width != settings.resolution.width || image.height != settings.resolution.height) {
        throw Error(ExitCode::usage,
                    "--reference: '" + file + "' is " + size(image.width, image.height) +
                        ", the picture " +
                        size(settings.resolution.width, settings.resolution.height) +
                        "; --resolution " + size(image.width, image.height) + " would fit");
    }
    if (settings.display.difference != Difference::off || !showsLight(settings.picture.view)) {
        throw Error(
            ExitCode::usage,
            "--reference: measures pictures; " +
                (settings.display.difference == Difference::off
                     ? "--view " + std::string(nameOf(settings.picture.view)) + " shows data"
                     : "--difference shows data"));
    }
    wantedMetrics(options_, given_->linear);
    takeFrom(settings, options, "exposure", given_->exposure, file);
    takeFrom(settings, options, "tonemap", given_->toneMap, file);
    const std::string points =
        std::to_string(settings.averagesPixels() ? settings.setsWanted() : 1);
    if (!given_->pixelSamples.empty() && given_->pixelSamples != points) {
        spdlog::warn("'{}' has {} points a pixel, the picture {}: edges differ by that alone", file,
                     given_->pixelSamples, points);
    }
}

Measurement Measuring::measure(const FrameRenderer& renderer, const Settings& settings) const {
    const bool linear = given_->linear;
    const Compared both = compared({.test = linear ? radianceOf(renderer) : displayOf(renderer),
                                    .reference = given_->image,
                                    .linear = linear,
                                    .exposureEv = renderer.exposureEv(),
                                    .toneMap = settings.display.toneMap});
    FlipMap map;
    Measurement out = mv::measure(both, wantedMetrics(options_, linear),
                                  options_.diffFile.empty() ? nullptr : &map);
    out.reference = options_.referenceFile;
    out.thresholds = options_.thresholds;
    if (out.badPixels > 0) {
        spdlog::warn("{} pixels are NaN or infinite in the picture or in '{}' and not measured",
                     out.badPixels, out.reference);
    }
    if (!options_.diffFile.empty()) writeMap(options_.diffFile, map, both.display);
    return out;
}

void Measuring::setScene(std::shared_ptr<const SceneAssets> assets) {
    sceneName_ = assets ? assets->scene.name : "";
    references_.setScene(std::move(assets));
    begun_ = {};
}

bool Measuring::supply(FrameRenderer& renderer, const Settings& settings, const FrameMoment& moment,
                       bool moving) {
    bool more = false;
    for (const int side : {0, 1}) {
        const std::uint64_t wanted = renderer.wantedReference(side);
        std::uint64_t& begun = begun_[static_cast<std::size_t>(side)];
        if (begun != 0 && begun != wanted) {
            references_.end(side);
            begun = 0;
        }
        if (wanted == 0 || (begun == 0 && moving)) continue;
        if (begun == 0) {
            references_.begin({sideAlone(settings, static_cast<std::size_t>(side)), moment,
                               renderer.readViews().views, renderer.readReceivers()},
                              side);
            begun = wanted;
        }
        const ReferenceWorker::Light light = references_.more(side);
        if (light.irradiance.empty() && !light.complete) continue;
        renderer.setReference(side, wanted, light.irradiance, light.complete);
        more = true;
    }

    const std::uint64_t flip = renderer.wantedFlip();
    if (flip == 0) {
        flip_.stop();
    } else if (flip_.version() != flip && !moving) {
        flip_.startFlip(flip, {.test = radianceOf(renderer.radianceOf(1)),
                               .reference = radianceOf(renderer.radianceOf(0)),
                               .linear = true,
                               .exposureEv = renderer.exposureEv(),
                               .toneMap = settings.display.toneMap});
    } else if (flip_.version() == flip && !flip_.busy()) {
        const std::vector<float> errors = flip_.flip();
        if (!errors.empty()) renderer.setFlip(flip, errors);
        more = true;
    }
    return more;
}

// Exact maps are made anew when the views or the maps' resolution change, and compared with a
// side's maps whenever those were made anew.
std::array<Measuring::SideMaps, 2> Measuring::measureMaps(const FrameRenderer& renderer,
                                                          const Settings& settings,
                                                          const FrameMoment& moment, int views,
                                                          bool draft) {
    std::array<SideMaps, 2> out;
    const std::uint64_t now = renderer.viewsVersion();
    const bool moving = std::exchange(lastViews_, now) != now;
    const Settings sides[] = {sideAlone(settings, 0), sideAlone(settings, 1)};
    const bool alike = makesMaps(settings.side[0].method) &&
                       sides[0].side[0].maps.resolution == sides[1].side[0].maps.resolution;
    for (int i = 0; i < 2; ++i) {
        const Settings& side = sides[i];
        MeasuredMaps& measured = measuredMaps_[static_cast<std::size_t>(i)];
        const bool asked =
            views > 0 && (i == 0 || settings.compare) && makesMaps(side.side[0].method);
        const int maker = alike ? 0 : i;  // which side's exact maps serve this one
        std::optional<MeasuredMaps::Wanted> wanted;
        if (asked && maker == i) {
            wanted = {renderer.mapViewsVersion(i), side.side[0].maps.resolution, views};
        }
        if (measured.wanted && measured.wanted != wanted) {
            references_.endMaps(i);
            measured.wanted.reset();
        }
        if (wanted && !measured.wanted && !moving) {
            references_.beginMaps({side, moment, renderer.readMapViews(i).views, {}},
                                  static_cast<std::size_t>(views), i);
            measured.wanted = wanted;
        }
        const auto exact = asked && !draft ? references_.maps(maker) : nullptr;
        if (!asked) measured.exact.reset();
        if (exact && (measured.exact != exact || measured.version != renderer.mapsVersion(i))) {
            measured.exact = exact;
            measured.version = renderer.mapsVersion(i);
            measured.report = mapErrorsOf(*exact, renderer.readMapViews(i).views, renderer, side, i)
                                  .value_or(MapErrorReport());
            spdlog::info("{}", toText(measured.report, side.side[0].method));
        }
        out[static_cast<std::size_t>(i)] = {asked && !exact, exact ? &measured.report : nullptr};
    }
    return out;
}

void Measuring::fill(const FrameRenderer& renderer, const Picture* picture, ui::ErrorsData& data) {
    data.tables.clear();
    data.maps.clear();
    data.mapsWait = false;
    if (!picture) {
        errors_.stop();
        measureMaps(renderer, {}, {}, 0, false);
        return;
    }
    fillPictures(renderer, *picture, data);
    const Settings& wanted = picture->wanted;
    const auto maps = measureMaps(renderer, wanted, picture->moment, data.mapViews, picture->draft);
    for (int i = 0; i < (wanted.compare ? 2 : 1); ++i) {
        const SideMaps& side = maps[static_cast<std::size_t>(i)];
        data.maps.push_back(mapTable(sideTitle(picture->settings, i),
                                     i == 0 ? wanted.side[0].method : wanted.side[1].method,
                                     side.report));
        data.mapsWait = data.mapsWait || side.waits;
    }
}

std::optional<Error> Measuring::takeErrorsFailure() {
    std::optional<Error> failure = errors_.takeFailure();
    return failure ? failure : flip_.takeFailure();
}

void Measuring::fillPictures(const FrameRenderer& renderer, const Picture& picture,
                             ui::ErrorsData& data) {
    // Which picture is measured against which; a side of -1 is the file.
    struct Pair {
        int test, reference;
    };
    std::vector<Pair> pairs;
    const Settings& settings = picture.settings;
    const bool compares = settings.compare;
    if (compares) {
        const bool rightIsTruth =
            isReference(settings.side[1].method) && !isReference(settings.side[0].method);
        pairs.push_back(rightIsTruth ? Pair{0, 1} : Pair{1, 0});
    }
    if (reference_) {
        pairs.push_back({0, -1});
        if (compares) pairs.push_back({1, -1});
    }
    const auto title = [&](int side) {
        return side < 0 ? referenceName_ : sideTitle(settings, side);
    };
    std::vector<std::size_t> measured;  // tables that are
    for (const Pair& pair : pairs) {
        const bool linear = pair.reference >= 0 || reference_->linear;
        ui::ErrorTable table = emptyTable(title(pair.test), title(pair.reference), linear);
        const gl::Texture& texture = renderer.radianceOf(pair.test);
        if (!showsLight(settings.picture.view)) {
            table.reason = "This debug view shows data, not light.";
        } else if (pair.reference < 0 && (reference_->image.width != texture.width() ||
                                          reference_->image.height != texture.height())) {
            table.reason = "The reference is " +
                           sizeText(reference_->image.width, reference_->image.height, " x ") +
                           ", the picture " + sizeText(texture.width(), texture.height(), " x ") +
                           ": set the resolution to its size.";
        } else if (pair.reference < 0 && keptFrom_ && keptOf_ != sceneName_) {
            table.reason = "The picture was kept of another scene: open that, or keep this one.";
        } else if (pair.reference < 0 && keptFrom_ &&
                   !sameView(*keptFrom_, picture.moment.camera)) {
            table.reason = "The picture was kept from another camera: go back, or keep this one.";
        } else {
            measured.push_back(data.tables.size());
        }
        data.tables.push_back(std::move(table));
    }
    data.waits = !picture.still;
    if (!picture.still) {
        errors_.stop();
        return;
    }
    if (errors_.version() != picture.number) {
        std::vector<Comparison> comparisons;
        for (const std::size_t i : measured) {
            const Pair& pair = pairs[i];
            const bool fromFile = pair.reference < 0;
            Comparison c{.test = radianceOf(renderer.radianceOf(pair.test)),
                         .reference = fromFile ? reference_->image
                                               : radianceOf(renderer.radianceOf(pair.reference)),
                         .linear = !fromFile || reference_->linear,
                         .exposureEv = renderer.exposureEv(),
                         .toneMap = settings.display.toneMap};
            if (!c.linear) c.test = displayImage(c.test, c.exposureEv, c.toneMap);
            comparisons.push_back(std::move(c));
        }
        errors_.start(picture.number, std::move(comparisons));
    }
    const std::vector<PictureErrors::Result> results = errors_.results();
    for (std::size_t i = 0; i < results.size(); ++i) {
        ui::ErrorTable& table = data.tables[measured[i]];
        table.badPixels = results[i].badPixels;
        for (std::size_t v = 0; v < results[i].values.size(); ++v) {
            table.values[v].value = results[i].values[v].value;
        }
    }
}

bool Measuring::unfinished(const ui::ErrorsData& data) const {
    return (!data.tables.empty() && (data.waits || errors_.busy())) || data.mapsWait;
}

}  // namespace mv
