#include "megaviews/scene/utf8.h"

namespace mv {

std::size_t utf8SequenceLength(std::string_view text) {
    if (text.empty()) return 0;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    if (first < 0x80) return 1;
    std::size_t length = 0;
    unsigned lowest = 0x80, highest = 0xbf;  // of the second byte
    if (first >= 0xc2 && first <= 0xdf) {
        length = 2;
    } else if (first >= 0xe0 && first <= 0xef) {
        length = 3;
        if (first == 0xe0) lowest = 0xa0;   // overlong
        if (first == 0xed) highest = 0x9f;  // surrogates
    } else if (first >= 0xf0 && first <= 0xf4) {
        length = 4;
        if (first == 0xf0) lowest = 0x90;   // overlong
        if (first == 0xf4) highest = 0x8f;  // beyond U+10FFFF
    }
    if (length == 0 || text.size() < length) return 0;
    if (byte(1) < lowest || byte(1) > highest) return 0;
    for (std::size_t i = 2; i < length; ++i) {
        if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
    }
    return length;
}

std::size_t repairUtf8(std::string& text) {
    std::size_t bad = 0;
    std::string repaired;
    std::size_t copiedTo = 0;
    for (std::size_t i = 0; i < text.size();) {
        if (static_cast<unsigned char>(text[i]) < 0x80) {
            ++i;
            continue;
        }
        const std::size_t length = utf8SequenceLength(std::string_view(text).substr(i));
        if (length == 0) {
            repaired.append(text, copiedTo, i - copiedTo);
            repaired += "\xef\xbf\xbd";
            copiedTo = ++i;
            ++bad;
        } else {
            i += length;
        }
    }
    if (bad > 0) {
        repaired.append(text, copiedTo, std::string::npos);
        text = std::move(repaired);
    }
    return bad;
}

}  // namespace mv
