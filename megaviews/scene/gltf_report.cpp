#include "megaviews/scene/gltf_report.h"

#include <spdlog/spdlog.h>

#include "megaviews/core/error.h"

namespace mv {

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
    if (logs_) spdlog::warn("{}", warnings.back());
}

}  // namespace mv
