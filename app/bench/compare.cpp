#include "app/bench/compare.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/bench/options.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "megaviews/core/error.h"
#include "megaviews/io/npy.h"
#include "megaviews/measure/measurement.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

RgbImage readImage(const std::string& file) {
    NpyArray<float> array = readNpy<float>(file);
    const std::vector<std::uint64_t>& shape = array.shape;
    constexpr std::uint64_t kMost = 1 << 30;  // a side, or pixels in all
    const auto isTooLarge = [&] {
        return shape[0] > kMost || shape[1] > kMost || shape[0] * shape[1] > kMost;
    };
    if (shape.size() != 3 || shape[2] != 3 || isTooLarge()) {
        std::string text;
        for (const std::uint64_t n : shape) text += (text.empty() ? "" : "x") + std::to_string(n);
        throw Error(ExitCode::input, "'" + file + "' is no picture: its shape is " + text +
                                         ", not HxWx3 of at most 2^30 pixels");
    }
    return {static_cast<int>(shape[1]), static_cast<int>(shape[0]), std::move(array.elements)};
}

}  // namespace

int compareFiles(const std::vector<std::string>& arguments) {
    CLI::App app(
        "Measures the picture A against the reference B: float32 .npy files of shape HxWx3, "
        "linear radiance, rows from the top.",
        "megaviews-bench compare");
    std::string a, b, metrics = "all", exposure = "0", toneMap = "aces", jsonFile;
    std::vector<std::string> thresholds;
    bool display = false;
    app.add_option("A", a, "The picture.")->required()->type_name("FILE.npy");
    app.add_option("B", b, "The reference.")->required()->type_name("FILE.npy");
    app.add_option("--metrics", metrics, "Errors to print. [all]")->type_name("all|NAME,NAME");
    app.add_option("--threshold", thresholds,
                   "Leave with exit code 1 if an error is larger, or a psnr or ssim lower.")
        ->type_name("METRIC:VALUE")
        ->allow_extra_args(false);
    app.add_option("--exposure", exposure, "Of both pictures as displayed. [0 EV]")
        ->type_name("EV");
    app.add_option("--tonemap", toneMap, "Of both pictures as displayed. [aces]")
        ->type_name("none|aces|neutral|agx");
    app.add_flag("--display", display, "The files hold display values in [0,1], not radiance.");
    app.add_option("--json", jsonFile, "Write the errors as JSON too.")->type_name("FILE.json");
    if (!parseOptions(app, arguments)) return static_cast<int>(ExitCode::ok);

    MeasureOptions options;
    options.referenceFile = b;
    options.metrics = metricsFromText(metrics, "--metrics");
    for (const std::string& text : thresholds) {
        options.thresholds.push_back(thresholdFromText(text, "--threshold"));
    }
    Settings settings;
    setFromText(settings, *findSetting("exposure"), exposure, "--exposure");
    setFromText(settings, *findSetting("tonemap"), toneMap, "--tonemap");
    const std::vector<Metric> wanted = wantedMetrics(options, !display);
    if (!jsonFile.empty()) {
        requireJson(jsonFile, "compare: --json");
        checkApart({a, b}, {jsonFile});
        checkWritable({jsonFile});
    }

    RgbImage test = readImage(a), reference = readImage(b);
    if (test.width != reference.width || test.height != reference.height) {
        throw Error(ExitCode::usage, "'" + a + "' and '" + b + "' differ in size");
    }
    Measurement measurement =
        measure(compared({.test = std::move(test),
                          .reference = std::move(reference),
                          .linear = !display,
                          .exposureEv = settings.display.exposureEv.value_or(0),
                          .toneMap = settings.display.toneMap}),
                wanted);
    measurement.reference = b;
    measurement.thresholds = options.thresholds;
    std::fputs(toText(measurement).c_str(), stdout);
    if (!jsonFile.empty()) writeJson(jsonFile, toJson(measurement));
    if (measurement.badPixels > 0) {
        throw Error(ExitCode::checkFailed,
                    std::to_string(measurement.badPixels) + " pixels are NaN or infinite");
    }
    const std::string missed = missedThresholds(measurement);
    if (!missed.empty()) throw Error(ExitCode::checkFailed, missed);
    return static_cast<int>(ExitCode::ok);
}

}  // namespace mv
