#include "app/viewer/measuring.h"

#include <spdlog/spdlog.h>

#include <limits>
#include <utility>

#include "app/common/frame_images.h"
#include "app/viewer/measure.h"
#include "app/viewer/references.h"
#include "ui/format.h"

namespace mv {
namespace {

std::string sizeText(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
}

// "MegaViews", or "Left: MegaViews" of two.
std::string sideTitle(const Settings& settings, int side) {
    if (!settings.compare) return ui::methodTitle(settings.method);
    return side == 0 ? std::string("Left: ") + ui::methodTitle(settings.method)
                     : std::string("Right: ") + ui::methodTitle(*settings.compare);
}

ui::ErrorTable emptyTable(std::string of, std::string against, bool linear) {
    ui::ErrorTable table{std::move(of), std::move(against), {}, 0, {}};
    for (const MetricInfo& info : metricsTable()) {
        if (!linear && info.domain == MetricDomain::radiance) continue;
        table.values.push_back({std::string(info.label), std::string(info.unit),
                                std::string(info.description), info.higherIsBetter, std::nullopt});
    }
    return table;
}

// report: null while it is not there.
ui::ErrorTable mapTable(std::string of, Method method, const MapErrorReport* report) {
    ui::ErrorTable table{std::move(of), {}, {}, 0, {}};
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
        table.values.push_back(
            {std::string(info.label), "%", std::string(info.description), false, percent});
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
    : referenceName_(options.measure.referenceFile), references_(referenceFolder(options)) {
    if (!referenceName_.empty()) referenceFile_ = readReference(referenceName_);
}

void Measuring::setScene(std::shared_ptr<const SceneAssets> assets) {
    references_.setScene(std::move(assets));
    begun_ = {};
}

bool Measuring::supply(FrameRenderer& renderer, const Settings& settings, const FrameInput& input,
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
            references_.begin({side == 0 ? settings : comparedSide(settings), input,
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
        flip_.startFlip(
            flip, {radianceOf(renderer.radianceOf(1)), radianceOf(renderer.radianceOf(0)), true,
                   renderer.exposureEv(), settings.toneMap});
    } else if (flip_.version() == flip && !flip_.busy()) {
        renderer.setFlip(flip, flip_.flip());
        more = true;
    }
    return more;
}

// Exact maps are made anew when the views or the maps' resolution change, and compared with a
// side's maps whenever those were made anew.
std::array<Measuring::SideMaps, 2> Measuring::measureMaps(const FrameRenderer& renderer,
                                                          const Settings& settings,
                                                          const FrameInput& input, int views,
                                                          bool draft) {
    std::array<SideMaps, 2> out;
    const std::uint64_t version = renderer.viewsVersion();
    const bool moving = std::exchange(lastViews_, version) != version;
    const Settings sides[] = {settings, comparedSide(settings)};
    const bool alike = makesMaps(settings.method) && sides[0].viewRes == sides[1].viewRes;
    for (int i = 0; i < 2; ++i) {
        const Settings& side = sides[i];
        MeasuredMaps& measured = measuredMaps_[static_cast<std::size_t>(i)];
        const bool asked = views > 0 && (i == 0 || settings.compare) && makesMaps(side.method);
        const int maker = alike ? 0 : i;  // which side's exact maps serve this one
        std::optional<MeasuredMaps::Wanted> wanted;
        if (asked && maker == i) wanted = {version, side.viewRes, views};
        if (measured.wanted && measured.wanted != wanted) {
            references_.endMaps(i);
            measured.wanted.reset();
        }
        if (wanted && !measured.wanted && !moving) {
            references_.beginMaps(side, input, renderer.readViews().views,
                                  static_cast<std::size_t>(views), i);
            measured.wanted = wanted;
        }
        const auto exact = asked && !draft ? references_.maps(maker) : nullptr;
        if (!asked) measured.exact.reset();
        if (exact && (measured.exact != exact || measured.version != renderer.mapsVersion(i))) {
            measured.exact = exact;
            measured.version = renderer.mapsVersion(i);
            measured.report = mapErrorsOf(*exact, renderer.readViews().views, renderer, side, i)
                                  .value_or(MapErrorReport());
            spdlog::debug("{}", toText(measured.report, side.method));
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
    const auto maps = measureMaps(renderer, wanted, picture->input, data.mapViews, picture->draft);
    for (int i = 0; i < (wanted.compare ? 2 : 1); ++i) {
        const SideMaps& side = maps[static_cast<std::size_t>(i)];
        data.maps.push_back(mapTable(sideTitle(picture->settings, i),
                                     i == 0 ? wanted.method : *wanted.compare, side.report));
        data.mapsWait = data.mapsWait || side.waits;
    }
}

void Measuring::fillPictures(const FrameRenderer& renderer, const Picture& picture,
                             ui::ErrorsData& data) {
    // Which picture is measured against which; a side of -1 is the file.
    struct Pair {
        int test, reference;
    };
    std::vector<Pair> pairs;
    const Settings& settings = picture.settings;
    const bool compares = settings.compare.has_value();
    if (compares) {
        const bool rightIsTruth = isReference(*settings.compare) && !isReference(settings.method);
        pairs.push_back(rightIsTruth ? Pair{0, 1} : Pair{1, 0});
    }
    if (referenceFile_) {
        pairs.push_back({0, -1});
        if (compares) pairs.push_back({1, -1});
    }
    const auto title = [&](int side) {
        return side < 0 ? referenceName_ : sideTitle(settings, side);
    };
    std::vector<std::size_t> measured;  // tables that are
    for (const Pair& pair : pairs) {
        const bool linear = pair.reference >= 0 || referenceFile_->linear;
        ui::ErrorTable table = emptyTable(title(pair.test), title(pair.reference), linear);
        const gl::Texture& texture = renderer.radianceOf(pair.test);
        if (!isPicture(settings.view)) {
            table.reason = "This debug view shows data, not light.";
        } else if (pair.reference < 0 && (referenceFile_->image.width != texture.width() ||
                                          referenceFile_->image.height != texture.height())) {
            table.reason = "The file is " +
                           sizeText(referenceFile_->image.width, referenceFile_->image.height) +
                           ", the picture " + sizeText(texture.width(), texture.height()) +
                           ": set the resolution to the file's.";
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
        std::vector<PictureComparison> comparisons;
        for (const std::size_t i : measured) {
            const Pair& pair = pairs[i];
            const bool fromFile = pair.reference < 0;
            PictureComparison c{
                radianceOf(renderer.radianceOf(pair.test)),
                fromFile ? referenceFile_->image : radianceOf(renderer.radianceOf(pair.reference)),
                !fromFile || referenceFile_->linear, renderer.exposureEv(), settings.toneMap};
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
