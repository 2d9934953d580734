#pragma once
// Tables of what the last frame reported: stage times with their clock, pair counts, sharing and
// memory, one column a method.

#include <cstdint>
#include <string>

#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"

namespace mv::ui {

void statisticsPanel(const Settings& settings, const FrameStatistics& statistics);

// 1234567 -> "1,234,567"; 3500000 bytes -> "3.3 MiB".
std::string withThousands(std::uint64_t n);
std::string bytesText(std::uint64_t bytes);
// "MegaViews", "ManyLoDs", "no visibility": as the papers write them.
const char* methodTitle(Method method);

}  // namespace mv::ui
