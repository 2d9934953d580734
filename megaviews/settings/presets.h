#pragma once
// Named sets of settings: quality against time, and the two published methods as published. One
// table serves --preset, its list, the menu and the help.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "megaviews/settings/settings.h"

namespace mv {

struct PresetInfo {
    std::string_view name;                                              // "paper-megaviews"
    std::string_view help;                                              // one sentence
    std::vector<std::pair<std::string_view, std::string_view>> values;  // key, value
};

std::span<const PresetInfo> presetsTable();
const PresetInfo* findPreset(std::string_view name);  // nullptr if there is none

// Sets the preset's values and no others; returns their keys. Compared sides that would be equal
// afterwards are compared no more.
std::vector<std::string> applyPreset(Settings& settings, const PresetInfo& preset);

}  // namespace mv
