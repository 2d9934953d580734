#include "megaviews/core/text.h"

#include <utf8cpp/utf8.h>
#include <algorithm>
#include <iterator>

namespace mv {

std::string printable(std::string_view text, std::size_t longest) {
    std::string result;
    utf8::replace_invalid(text.begin(), text.end(), std::back_inserter(result), '?');
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(result[i]); };
    std::replace_if(
        result.begin(), result.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
    if (result.size() <= longest) return result;
    std::size_t end = longest;
    while (end > 0 && (byte(end) & 0xc0) == 0x80) --end;  // not within a character
    return result.substr(0, end) + "…";
}

std::string quote(std::string_view text) { return '"' + printable(text) + '"'; }

std::string csvQuoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + '"';
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kSpace = " \t\r\n\v\f";
    const std::size_t begin = text.find_first_not_of(kSpace);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kSpace) - begin + 1);
}

std::string lowered(std::string_view text) {
    std::string out(text);
    for (char& c : out) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return out;
}

std::vector<std::string_view> splitAt(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find_first_of(separators, begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string_view::npos) return parts;
        begin = end + 1;
    }
}

}  // namespace mv
