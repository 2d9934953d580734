#pragma once
// The grammar of megaviews-bench sweep: which points a grid has. An axis is a setting by its key
// and the values it takes; the grid is the product of its axes, the first the slowest. Besides the
// settings there is one key more, `distribution`, which names the papers' ways of placing views.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/settings/settings.h"

namespace mv {

// Ends the command: bad usage.
[[noreturn]] void refuse(const std::string& message);

inline constexpr std::size_t kMaxSweepPoints = 10000;

// single: VPLs of one bounce; bounces: VPLs of 4 bounces; particles: as many glowing particles as
// --vpls says; random: views anywhere in the scene's box [Kol19 fig. 11].
inline constexpr std::string_view kDistributionKey = "distribution";

struct SweepAxis {
    std::string key;
    std::vector<std::string> values;  // at least one, each once, as settings write them back
};

// "KEY=ITEM,ITEM,...": an item is a value, or FROM..TO:xFACTOR or FROM..TO:+STEP, which end at the
// last value that is not above TO. Values that hold commas (X,Y,Z) are separated by ';'. Throws
// Error(ExitCode::usage), opening with `where`.
SweepAxis sweepAxisFromText(const std::string& text, const std::string& where);

// The settings of one value for each axis.
Settings sweepSettings(const Settings& base, std::span<const SweepAxis> axes,
                       std::span<const std::string> values);

struct SweepPoint {
    std::vector<std::string> values;  // by axis
    Settings settings;
};

// Every point, checked. No axis: one point. Throws Error(ExitCode::usage) for axes that contradict
// each other, combinations that no settings can have, and more than kMaxSweepPoints.
std::vector<SweepPoint> sweepPoints(const Settings& base, std::span<const SweepAxis> axes);

// "method=megaviews vpls=4096"
std::string sweepPointName(std::span<const SweepAxis> axes, std::span<const std::string> values);

// The value of a key as JSON writes it: a number where the setting is one.
nlohmann::ordered_json sweepValue(const std::string& key, const std::string& value,
                                  const Settings& settings);
// {"method": "megaviews", "vpls": 4096}
nlohmann::ordered_json sweepValues(std::span<const SweepAxis> axes, const SweepPoint& point);

}  // namespace mv
