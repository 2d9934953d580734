#include "ui/format.h"

#include <cmath>
#include <cstdio>

#include "megaviews/settings/settings_table.h"

namespace mv::ui {

std::string withThousands(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) {
        digits.insert(static_cast<std::size_t>(i), 1, ',');
    }
    return digits;
}

std::string countOrDash(std::uint64_t n) { return n > 0 ? withThousands(n) : "-"; }

std::string withThousands(std::int64_t n) {
    if (n >= 0) return withThousands(static_cast<std::uint64_t>(n));
    return "-" + withThousands(~static_cast<std::uint64_t>(n) + 1);
}

std::string fixedText(double value, int decimals) {
    if (!std::isfinite(value)) return std::isnan(value) ? "NaN" : value > 0 ? "inf" : "-inf";
    char text[352];  // the longest double has 309 digits before its point
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    std::string out = text;
    const std::size_t sign = out[0] == '-' ? 1 : 0;
    const std::size_t point = std::min(out.find('.'), out.size());
    for (std::size_t i = point; i > sign + 3; i -= 3) out.insert(i - 3, 1, ',');
    return out;
}

std::string bytesText(std::uint64_t bytes) {
    const double b = static_cast<double>(bytes);
    if (bytes >= 1ull << 30) return fixedText(b / (1ull << 30), 2) + " GiB";
    if (bytes >= 1ull << 20) return fixedText(b / (1ull << 20), 1) + " MiB";
    return fixedText(b / (1ull << 10), 1) + " KiB";
}

std::string percentText(double share01) { return fixedText(100 * share01, 1) + " %"; }

std::string shareText(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return "-";
    return percentText(static_cast<double>(part) / static_cast<double>(whole));
}

std::string numberText(double value) {
    if (!std::isfinite(value)) return fixedText(value, 0);
    const double size = std::abs(value);
    if (size == 0) return "0";
    if (size >= 1e6 || size < 1e-4) {
        char text[32];
        std::snprintf(text, sizeof text, "%.3e", value);
        return text;
    }
    const int digits = static_cast<int>(std::floor(std::log10(size)));
    return fixedText(value, std::max(3 - digits, 0));
}

std::string shortText(double value) {
    std::string text = numberText(value);
    if (text.find('.') == std::string::npos || text.find('e') != std::string::npos) return text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

const char* methodTitle(Method method) { return infoOf(method).title; }

std::string choiceTitle(std::string_view settingKey, std::string_view name) {
    if (settingKey == "method" || settingKey == "compare") {
        for (const MethodInfo& info : kMethods) {
            if (name == info.name) return info.title;
        }
    }
    if (settingKey == "step-pairs") {
        return name == "spread"  ? "evenly spread"
               : name == "pair"  ? "of the picked pair"
               : name == "views" ? "of the picked views"
                                 : std::string(name);
    }
    if (name == "aces") return "ACES-like";
    if (name == "agx") return "AgX";
    if (name == "nan") return "NaN and infinity";
    if (name == "shared") return "shared by picked views";
    return std::string(name);
}

std::string escapedFormat(std::string_view text) {
    std::string out;
    for (const char c : text) out += c == '%' ? "%%" : std::string(1, c);
    return out;
}

}  // namespace mv::ui
