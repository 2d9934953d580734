#include "megaviews/views/running_shares.h"

#include <algorithm>
#include <cmath>

#include "megaviews/core/colour.h"
#include "megaviews/core/error.h"

namespace mv {

double weightOf(const glm::dvec3& flux) {
    const double w = luminanceOf(flux) + 1e-3 * (flux.x + flux.y + flux.z);
    return std::isfinite(w) && w > 0 ? w : 0.0;
}

std::vector<float> runningShares(const std::vector<double>& weights) {
    constexpr double kQuanta = 16777216.0;
    double total = 0, positive = 0;
    for (const double w : weights) {
        total += w;
        positive += w > 0;
    }
    std::vector<float> shares(weights.size(), 0.0f);
    if (!(total > 0)) return shares;
    if (positive > kQuanta) {
        throw Error(ExitCode::impossible,
                    "the scene has more than 16777216 emissive triangles; VPLs cannot be shot from "
                    "that many");
    }
    double sum = 0, seen = 0, previous = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        sum += weights[i];
        seen += weights[i] > 0;
        const double share = std::min(1.0, sum / total);
        if (weights[i] > 0) previous = seen + std::floor((kQuanta - positive) * share);
        if (seen == positive) previous = kQuanta;
        shares[i] = static_cast<float>(previous / kQuanta);
    }
    return shares;
}

}  // namespace mv
