// How far the window's pictures are apart: numbers for the errors panel, FLIP for the difference.

#include <spdlog/spdlog.h>

#include <limits>
#include <utility>

#include "app/common/frame_images.h"
#include "app/common/map_references.h"
#include "app/viewer/measure.h"
#include "app/viewer/session.h"
#include "ui/format.h"

namespace mv {
namespace {

std::string sizeText(int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height);
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

std::optional<std::vector<float>> Session::measureFlip(const FlipRequest& request) {
    if (flip_.version() != request.version) {
        flip_.startFlip(request.version, {radianceOf(request.right), radianceOf(request.left), true,
                                          request.exposureEv, request.toneMap});
    }
    if (flip_.busy()) return std::nullopt;
    return flip_.flip();
}

// "MegaViews", or "Left: MegaViews" of two.
std::string Session::sideTitle(int side) const {
    if (!effective_.compare) return ui::methodTitle(effective_.method);
    return side == 0 ? std::string("Left: ") + ui::methodTitle(effective_.method)
                     : std::string("Right: ") + ui::methodTitle(*effective_.compare);
}

bool Session::measuring() const {
    if (model_.instrument != ui::Instrument::errors) return false;
    const bool pictures =
        !model_.errors.tables.empty() && (errors_.version() != picture_ || errors_.busy());
    return pictures || model_.errors.mapsWait;
}

// Exact maps are made anew when the views or the maps' resolution change, and compared with a
// side's maps whenever those were made anew.
void Session::measureMaps() {
    ui::ErrorsData& data = model_.errors;
    data.maps.clear();
    data.mapsWait = false;
    const std::uint64_t views = renderer_.viewsVersion();
    const bool moving = std::exchange(lastViews_, views) != views;
    const bool open = model_.instrument == ui::Instrument::errors && shown_;
    const int count = !open ? 0 : wanted_.compare ? 2 : 1;
    const Settings sides[] = {wanted_, comparedSide(wanted_)};  // not those of a draft
    const bool alike = makesMaps(wanted_.method) && sides[0].viewRes == sides[1].viewRes;
    for (int i = 0; i < 2; ++i) {
        const Settings& side = sides[i];
        MeasuredMaps& measured = measuredMaps_[static_cast<std::size_t>(i)];
        const bool asked = i < count && data.mapViews > 0 && makesMaps(side.method);
        const int maker = alike ? 0 : i;  // which side's exact maps serve this one
        std::optional<MeasuredMaps::Wanted> wanted;
        if (asked && maker == i) wanted = {views, side.viewRes, data.mapViews};
        if (measured.wanted && measured.wanted != wanted) {
            references_.endMaps(i);
            measured.wanted.reset();
        }
        if (wanted && !measured.wanted && !moving) {
            FrameInput input;
            input.timeS = shownTimeS_;
            input.animation = animation_;
            references_.beginMaps(side, input, renderer_.readViews().views,
                                  static_cast<std::size_t>(data.mapViews), i);
            measured.wanted = wanted;
        }
        const auto exact = asked && !draft_ ? references_.maps(maker) : nullptr;
        if (!asked) measured.exact.reset();
        if (exact && (measured.exact != exact || measured.version != renderer_.mapsVersion(i))) {
            measured.exact = exact;
            measured.version = renderer_.mapsVersion(i);
            measured.report = mapErrorsOf(*exact, renderer_.readViews().views, renderer_, side, i)
                                  .value_or(MapErrorReport());
            spdlog::debug("{}", toText(measured.report, side.method));
        }
        if (asked && !exact) data.mapsWait = true;
        if (i >= count) continue;
        data.maps.push_back(
            mapTable(sideTitle(i), side.method, exact ? &measured.report : nullptr));
    }
}

void Session::measureErrors() {
    if (effective_.difference != Difference::flip) flip_.stop();
    ui::ErrorsData& data = model_.errors;
    data.tables.clear();
    if (model_.instrument != ui::Instrument::errors || !shown_) {
        errors_.stop();
        return;
    }

    // Which picture is measured against which; a side of -1 is the file.
    struct Pair {
        int test, reference;
    };
    std::vector<Pair> pairs;
    const bool compares = effective_.compare.has_value();
    if (compares) {
        const bool rightIsTruth =
            isReference(*effective_.compare) && !isReference(effective_.method);
        pairs.push_back(rightIsTruth ? Pair{0, 1} : Pair{1, 0});
    }
    if (referenceFile_) {
        pairs.push_back({0, -1});
        if (compares) pairs.push_back({1, -1});
    }
    const auto title = [&](int side) {
        return side < 0 ? options_.measure.referenceFile : sideTitle(side);
    };
    std::vector<std::size_t> measured;  // tables that are
    for (const Pair& pair : pairs) {
        const bool linear = pair.reference >= 0 || referenceFile_->linear;
        ui::ErrorTable table = emptyTable(title(pair.test), title(pair.reference), linear);
        const gl::Texture& picture = renderer_.radianceOf(pair.test);
        if (!isPicture(effective_.view)) {
            table.reason = "This debug view shows data, not light.";
        } else if (pair.reference < 0 && (referenceFile_->image.width != picture.width() ||
                                          referenceFile_->image.height != picture.height())) {
            table.reason = "The file is " +
                           sizeText(referenceFile_->image.width, referenceFile_->image.height) +
                           ", the picture " + sizeText(picture.width(), picture.height()) +
                           ": set the resolution to the file's.";
        } else {
            measured.push_back(data.tables.size());
        }
        data.tables.push_back(std::move(table));
    }
    data.waits = !still_;
    if (!still_) {
        errors_.stop();
        return;
    }
    if (errors_.version() != picture_) {
        std::vector<PictureComparison> comparisons;
        for (const std::size_t i : measured) {
            const Pair& pair = pairs[i];
            const bool fromFile = pair.reference < 0;
            PictureComparison c{
                radianceOf(renderer_.radianceOf(pair.test)),
                fromFile ? referenceFile_->image : radianceOf(renderer_.radianceOf(pair.reference)),
                !fromFile || referenceFile_->linear, renderer_.exposureEv(), effective_.toneMap};
            if (!c.linear) c.test = displayImage(c.test, c.exposureEv, c.toneMap);
            comparisons.push_back(std::move(c));
        }
        errors_.start(picture_, std::move(comparisons));
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

}  // namespace mv
