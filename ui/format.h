#pragma once
// Numbers as people read them: thousands separated, a unit on each, a width that stays.

#include <cstdint>
#include <string>

#include "megaviews/settings/settings.h"

namespace mv::ui {

std::string withThousands(std::uint64_t n);
std::string withThousands(std::int64_t n);
std::string countOrDash(std::uint64_t n);           // "-" for 0: there is nothing to count
std::string bytesText(std::uint64_t bytes);         // "3.3 MiB"
std::string fixedText(double value, int decimals);  // "1,234.50"
std::string percentText(double share01);            // "12.3 %"
std::string shareText(std::uint64_t part, std::uint64_t whole);  // the same; "-" of nothing
// Four significant digits over any range: "0.01234", "12.34", "1.234e+07".
std::string numberText(double value);
std::string shortText(double value);  // the same without zeros at the end: "0.5", "512"
// "MegaViews", "ManyLoDs", "no visibility": as the papers write them.
const char* methodTitle(Method method);
// The word of a choice as panels write it; methods as above.
std::string choiceTitle(std::string_view settingKey, std::string_view name);
// A label or value as a literal within a printf format.
std::string escapedFormat(std::string_view text);

}  // namespace mv::ui
