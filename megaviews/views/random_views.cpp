#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "megaviews/views/view_set.h"

namespace mv {
namespace {

View randomView(const SceneBounds& box, std::uint32_t seed, std::uint32_t k, float fluxW) {
    // Streams of their own: particles take 0 to 2.
    const glm::vec4 place = random4(seed, k, 0, 3);
    const glm::vec4 direction = random4(seed, k, 0, 4);
    const glm::vec3 position = glm::mix(box.min, box.max, glm::vec3(place));
    const float z = 1 - 2 * direction.x, across = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * direction.y;
    View view{};
    view.positionX = position.x;
    view.positionY = position.y;
    view.positionZ = position.z;
    view.flags = kViewHemisphere;
    view.normalX = across * std::cos(angle);
    view.normalY = across * std::sin(angle);
    view.normalZ = z;
    view.bounce = 1;
    view.fluxR = view.fluxG = view.fluxB = fluxW;
    view.slot = k;
    return view;
}

}  // namespace

ViewSet makeRandomViews(const SceneBounds& bounds, std::uint64_t count, std::uint32_t seed,
                        double powerW) {
    ViewSet set;
    set.views.resize(count);
    const auto fluxW = static_cast<float>(count ? powerW / static_cast<double>(count) : 0);
    tbb::parallel_for(std::uint64_t{0}, count, [&](std::uint64_t k) {
        set.views[k] = randomView(bounds, seed, static_cast<std::uint32_t>(k), fluxW);
    });
    return set;
}

}  // namespace mv
