// How far the window's pictures are apart: numbers for the errors panel, FLIP for the difference.

#include "app/common/frame_images.h"
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

}  // namespace

std::optional<std::vector<float>> Session::measureFlip(const FlipRequest& request) {
    if (flip_.version() != request.version) {
        flip_.startFlip(request.version, {radianceOf(request.right), radianceOf(request.left), true,
                                          request.exposureEv, request.toneMap});
    }
    if (flip_.busy()) return std::nullopt;
    return flip_.flip();
}

bool Session::measuring() const {
    return model_.instrument == ui::Instrument::errors && !model_.errors.tables.empty() &&
           (errors_.version() != picture_ || errors_.busy());
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
    const auto title = [&](int side) -> std::string {
        if (side < 0) return options_.measure.referenceFile;
        const Method method = side == 0 ? effective_.method : *effective_.compare;
        const std::string name = ui::methodTitle(method);
        return compares ? (side == 0 ? "Left: " : "Right: ") + name : name;
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
