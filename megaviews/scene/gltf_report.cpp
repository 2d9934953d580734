#include "megaviews/scene/gltf_report.h"

#include <spdlog/spdlog.h>

#include "megaviews/core/error.h"
#include "megaviews/scene/utf8.h"

namespace mv {

std::string printable(std::string_view text, std::size_t longest) {
    std::string result;
    std::size_t i = 0;
    while (i < text.size()) {
        const std::size_t length = utf8SequenceLength(text.substr(i));
        const bool control = length == 1 && (static_cast<unsigned char>(text[i]) < 0x20 ||
                                             static_cast<unsigned char>(text[i]) == 0x7f);
        if (result.size() + length > longest) return result + "…";
        if (length == 0 || control) {
            result += '?';
            i += 1;
        } else {
            result += text.substr(i, length);
            i += length;
        }
    }
    return result;
}

std::string quote(std::string_view text) { return '"' + printable(text) + '"'; }

std::string GltfReport::sentence(const std::string& place, const std::string& reason) const {
    return place.empty() ? file_ + ": " + reason : file_ + ": " + place + ": " + reason;
}

void GltfReport::fail(const std::string& place, const std::string& reason) const {
    throw Error(ExitCode::input, sentence(place, reason));
}

void GltfReport::warn(const std::string& place, const std::string& reason) {
    // A hostile file could earn one warning an entry: the first hundred tell enough.
    constexpr std::size_t kMost = 100;
    if (warnings.size() > kMost) return;
    warnings.push_back(warnings.size() == kMost ? file_ + ": further warnings are not shown"
                                                : sentence(place, reason));
    spdlog::warn("{}", warnings.back());
}

}  // namespace mv
