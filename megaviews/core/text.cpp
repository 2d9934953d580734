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

}  // namespace mv
