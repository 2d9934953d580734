#include "app/bench/sweep_grid.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <variant>

#include "megaviews/core/error.h"
#include "megaviews/core/text.h"
#include "megaviews/settings/settings_table.h"

namespace mv {

void refuse(const std::string& message) { throw Error(ExitCode::usage, message); }

namespace {

const std::vector<std::string> kDistributions = {"single", "bounces", "particles", "random"};
constexpr int kManyBounces = 4;  // of the papers' second distribution [Kol19 §4.1]

// Settings that a distribution sets.
const std::vector<std::string> kDistributionSettings = {"bounces", "particles", "placement",
                                                        "views"};

// What shows a picture in another way, or two of them: no point of a grid.
bool changesNothingMeasured(const SettingInfo& setting) {
    const std::string_view key = setting.key;
    return setting.group == SettingGroup::instruments || key.starts_with("compare") ||
           key.starts_with("difference") || key == "split" || key == "view" ||
           key == "accumulate" || key == "pixel-samples" || key == "fresh-views" ||
           key == "temporal" || key == "history";
}

const SettingInfo& settingNamed(const std::string& key, const std::string& where) {
    const SettingInfo* setting = findSetting(key);
    if (!setting) {
        std::vector<std::string> keys = namesIn(settingsTable(), &SettingInfo::key);
        keys.emplace_back(kDistributionKey);
        refuse(where + ": unknown setting '" + key + "'" +
               didYouMean(key, keys, "; --help lists all"));
    }
    if (changesNothingMeasured(*setting)) {
        refuse(where + ": '" + key + "' changes only what is shown, not what is measured");
    }
    return *setting;
}

template <typename... Values>
bool isOneOf(const SettingField& field) {
    return (std::holds_alternative<Field<Values>>(field) || ...);
}
bool isWhole(const SettingInfo& s) {
    return isOneOf<int, std::optional<int>, std::int64_t, std::optional<std::int64_t>,
                   std::uint32_t>(s.field);
}
bool isNumber(const SettingInfo& s) {
    return isWhole(s) || isOneOf<double, std::optional<double>>(s.field);
}
bool isVector(const SettingInfo& s) { return isOneOf<Vector3, std::optional<Vector3>>(s.field); }

// FROM..TO:STEP as numbers; TO is reached if rounding alone keeps a value from it.
std::vector<std::string> rangeValues(const SettingInfo& setting, const std::string& item,
                                     const std::string& where) {
    const std::size_t dots = item.find("..");
    const std::size_t colon = item.find(':', dots);
    const auto fail = [&](const std::string& reason) {
        refuse(where + ": '" + item + "' " + reason);
    };
    if (!isNumber(setting)) fail("is a range, and " + std::string(setting.key) + " is no number");
    if (colon == std::string::npos) fail("has no step; 1K..64K:x2 or 16..64:+16 have one");
    const bool whole = isWhole(setting);
    const double from =
        numberFromText(item.substr(0, dots), setting.minimum, setting.maximum, whole, where);
    const double to = numberFromText(item.substr(dots + 2, colon - dots - 2), setting.minimum,
                                     setting.maximum, whole, where);
    const std::string step = item.substr(colon + 1);
    const bool factor = step.starts_with("x");
    if (!factor && !step.starts_with("+"))
        fail("has the step '" + step + "', not xFACTOR or +STEP");
    const double by = numberFromText(step.substr(1), 0, 1e9, whole && !factor, where);
    if (from > to) fail("runs backwards");
    if (factor ? by <= 1 || from <= 0 : by <= 0) {
        fail(factor ? "never ends: a factor above 1 and a first value above 0 do"
                    : "never ends: its step is not above 0");
    }
    std::vector<std::string> values;
    for (std::size_t i = 0;; ++i) {
        const double n = static_cast<double>(i);
        double value = factor ? from * std::pow(by, n) : from + by * n;
        if (value > to * (1 + 1e-12) + (factor ? 0 : 1e-9 * by)) break;
        // Steps that rounding takes back count, too.
        if (i == kMaxSweepPoints) {
            fail("has more than " + std::to_string(kMaxSweepPoints) + " values");
        }
        if (whole) value = std::round(value);
        std::string text = whole ? fmt::format("{:.0f}", value) : fmt::format("{:.12g}", value);
        if (values.empty() || values.back() != text) values.push_back(std::move(text));
    }
    return values;
}

void applyDistribution(Settings& settings, const std::string& name) {
    settings.views.particles = name == "particles" ? settings.views.vpls : 0;
    settings.views.placement = name == "random" ? Placement::random : Placement::traced;
    if (name == "single") settings.views.bounces = 1;
    if (name == "bounces") settings.views.bounces = kManyBounces;
}

std::string oneDistribution(const std::string& text, const std::string& where) {
    if (std::find(kDistributions.begin(), kDistributions.end(), text) != kDistributions.end()) {
        return text;
    }
    refuse(where + ": " + notOneOf(text, kDistributions));
}

void checkAxes(const Settings& base, std::span<const SweepAxis> axes) {
    const auto has = [&](std::string_view key) {
        return std::count_if(axes.begin(), axes.end(),
                             [&](const SweepAxis& axis) { return axis.key == key; });
    };
    for (const SweepAxis& axis : axes) {
        if (has(axis.key) > 1) refuse("--sweep: '" + axis.key + "' is swept twice");
    }
    if (!has(kDistributionKey)) return;
    for (const std::string& key : kDistributionSettings) {
        if (has(key)) refuse("--sweep: 'distribution' sets '" + key + "', which is swept as well");
    }
    if (!base.views.file.empty()) {
        refuse("--sweep: 'distribution' places views, and --views has them from a file");
    }
}

}  // namespace

SweepAxis sweepAxisFromText(const std::string& text, const std::string& where) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) refuse(where + ": '" + text + "' is not KEY=VALUES");
    SweepAxis axis;
    axis.key = text.substr(0, equals);
    const std::string list = text.substr(equals + 1);
    const std::string place = where + " " + axis.key;
    const auto add = [&](const std::string& value) {
        if (std::find(axis.values.begin(), axis.values.end(), value) != axis.values.end()) {
            refuse(place + ": '" + value + "' is there twice");
        }
        axis.values.push_back(value);
    };
    if (axis.key == kDistributionKey) {
        for (const std::string_view item : splitAt(list, ",")) {
            add(oneDistribution(std::string(item), place));
        }
        return axis;
    }
    const SettingInfo& setting = settingNamed(axis.key, where);
    const bool semicolons = isVector(setting) || list.find(';') != std::string::npos;
    for (const std::string_view part : splitAt(list, semicolons ? ";" : ",")) {
        const std::string item(part);
        const bool isRange = isNumber(setting) && item.find("..") != std::string::npos;
        const auto values =
            isRange ? rangeValues(setting, item, place) : std::vector<std::string>{item};
        for (const std::string& value : values) {
            Settings settings;
            setFromText(settings, setting, value, place);
            add(toText(settings, setting));
        }
    }
    return axis;
}

Settings sweepSettings(const Settings& base, std::span<const SweepAxis> axes,
                       std::span<const std::string> values) {
    Settings settings = base;
    const std::string* distribution = nullptr;  // goes last: it copies the count of views
    for (std::size_t a = 0; a < axes.size(); ++a) {
        if (axes[a].key == kDistributionKey) {
            distribution = &values[a];
        } else {
            setFromText(settings, *findSetting(axes[a].key), values[a], "--sweep " + axes[a].key);
        }
    }
    if (distribution) applyDistribution(settings, *distribution);
    return settings;
}

std::vector<SweepPoint> sweepPoints(const Settings& base, std::span<const SweepAxis> axes) {
    checkAxes(base, axes);
    std::size_t count = 1;
    for (const SweepAxis& axis : axes) {
        count *= axis.values.size();
        if (count > kMaxSweepPoints) {
            refuse("--sweep: the grid has more than " + std::to_string(kMaxSweepPoints) +
                   " points");
        }
    }
    std::vector<SweepPoint> points(count);
    for (std::size_t i = 0; i < count; ++i) {
        SweepPoint& point = points[i];
        std::size_t rest = i;
        point.values.resize(axes.size());
        for (std::size_t a = axes.size(); a-- > 0;) {
            point.values[a] = axes[a].values[rest % axes[a].values.size()];
            rest /= axes[a].values.size();
        }
        point.settings = sweepSettings(base, axes, point.values);
        try {
            validate(point.settings);
        } catch (const Error& error) {
            if (axes.empty()) throw;
            throw Error(error.code, sweepPointName(axes, point.values) + ": " + error.what());
        }
    }
    return points;
}

std::string sweepPointName(std::span<const SweepAxis> axes, std::span<const std::string> values) {
    std::string out;
    for (std::size_t a = 0; a < axes.size(); ++a) {
        out += (out.empty() ? "" : " ") + axes[a].key + "=" + values[a];
    }
    return out;
}

nlohmann::ordered_json sweepValue(const std::string& key, const std::string& value,
                                  const Settings& settings) {
    if (key == kDistributionKey) return value;
    return toJson(settings, *findSetting(key));
}

nlohmann::ordered_json sweepValues(std::span<const SweepAxis> axes, const SweepPoint& point) {
    nlohmann::ordered_json out = nlohmann::ordered_json::object();
    for (std::size_t a = 0; a < axes.size(); ++a) {
        out[axes[a].key] = sweepValue(axes[a].key, point.values[a], point.settings);
    }
    return out;
}

}  // namespace mv
