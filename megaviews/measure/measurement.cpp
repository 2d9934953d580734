#include "megaviews/measure/measurement.h"

#include <spdlog/fmt/fmt.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "megaviews/core/error.h"
#include "megaviews/core/text.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

const MetricInfo& metricNamed(const std::string& name, const std::string& where) {
    if (const MetricInfo* info = findMetric(name)) return *info;
    throw Error(ExitCode::usage,
                where + ": " + notOneOf(name, namesIn(metricsTable(), &MetricInfo::name)));
}

void addOnce(std::vector<Metric>& metrics, Metric metric) {
    if (std::find(metrics.begin(), metrics.end(), metric) == metrics.end()) {
        metrics.push_back(metric);
    }
}

std::string withUnit(const std::string& number, const MetricInfo& info) {
    return info.unit.empty() ? number : number + " " + std::string(info.unit);
}

bool isMet(const Threshold& threshold, double value) {
    return infoOf(threshold.metric).higherIsBetter ? value >= threshold.value
                                                   : value <= threshold.value;
}

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

std::vector<Metric> metricsFromText(const std::string& text, const std::string& where) {
    std::vector<Metric> metrics;
    if (text == "all") return metrics;
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
        end = text.find(',', begin);
        const std::string name = text.substr(begin, end == std::string::npos ? end : end - begin);
        addOnce(metrics, metricNamed(name, where).metric);
    }
    return metrics;
}

Threshold thresholdFromText(const std::string& text, const std::string& where) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) {
        throw Error(ExitCode::usage, where + ": '" + text + "' is not METRIC:VALUE");
    }
    const Metric metric = metricNamed(text.substr(0, colon), where).metric;
    return {metric, numberFromText(text.substr(colon + 1), -1e30, 1e30, false, where)};
}

std::vector<Metric> wantedMetrics(const MeasureOptions& options, bool hasRadiance) {
    std::vector<Metric> metrics = options.metrics;
    if (metrics.empty()) {
        for (const MetricInfo& info : metricsTable()) {
            if (hasRadiance || info.domain == MetricDomain::display) {
                metrics.push_back(info.metric);
            }
        }
    }
    for (const Threshold& threshold : options.thresholds) addOnce(metrics, threshold.metric);
    if (!options.diffFile.empty()) addOnce(metrics, Metric::flip);
    for (const Metric metric : metrics) {
        const MetricInfo& info = infoOf(metric);
        if (hasRadiance || info.domain == MetricDomain::display) continue;
        throw Error(ExitCode::usage, std::string(info.name) + " is measured on radiance; '" +
                                         options.referenceFile +
                                         "' holds display values (an .exr holds radiance)");
    }
    return metrics;
}

double valueOf(const Measurement& measurement, Metric metric) {
    const auto found = std::find_if(measurement.values.begin(), measurement.values.end(),
                                    [&](const MetricValue& v) { return v.metric == metric; });
    return found == measurement.values.end() ? std::nan("") : found->value;
}

Measurement measure(const Compared& compared, std::span<const Metric> metrics, FlipMap* flipMap,
                    const Progress& progress) {
    Measurement out;
    out.exposureEv = compared.exposureEv;
    out.toneMap = compared.toneMap;
    out.badPixels = compared.display.badPixels();
    out.values = evaluate(compared, metrics, flipMap, progress);
    return out;
}

std::string toText(const Measurement& measurement) {
    std::string out;
    for (const auto& [metric, value] : measurement.values) {
        const MetricInfo& info = infoOf(metric);
        out += fmt::format("{} {}\n", info.name, withUnit(fmt::format("{:.6g}", value), info));
    }
    return out;
}

std::string missedThresholds(const Measurement& measurement) {
    std::string out;
    for (const Threshold& threshold : measurement.thresholds) {
        const MetricInfo& info = infoOf(threshold.metric);
        const double value = valueOf(measurement, threshold.metric);
        if (isMet(threshold, value)) continue;
        // As many digits as it takes to tell the two apart.
        std::string is, limit;
        for (int digits = 3; digits <= 17 && is == limit; ++digits) {
            is = fmt::format("{:.{}g}", value, digits);
            limit = fmt::format("{:.{}g}", threshold.value, digits);
        }
        const char* sign = std::isnan(value) ? "is not" : info.higherIsBetter ? "<" : ">";
        out += fmt::format("{}{} {} {} {}", out.empty() ? "" : "; ", info.name, withUnit(is, info),
                           sign, withUnit(limit, info));
    }
    return out;
}

Json toJson(const Measurement& measurement) {
    Json out = {{"reference", measurement.reference},
                {"exposureEv", measurement.exposureEv},
                {"toneMap", nameOf(measurement.toneMap)},
                {"badPixels", measurement.badPixels}};
    out["values"] = Json::object();
    for (const auto& [metric, value] : measurement.values) {
        out["values"][std::string(infoOf(metric).name)] = numberOrNull(value);
    }
    out["thresholds"] = Json::array();
    for (const Threshold& threshold : measurement.thresholds) {
        out["thresholds"].push_back(
            {{"metric", infoOf(threshold.metric).name},
             {"value", threshold.value},
             {"met", isMet(threshold, valueOf(measurement, threshold.metric))}});
    }
    return out;
}

}  // namespace mv
