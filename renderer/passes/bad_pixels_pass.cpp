#include "renderer/passes/bad_pixels_pass.h"

#include <numeric>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {

void BadPixelsPass::count(const gl::Texture& radiance, gl::ReadBack& counts) {
    const auto texels = static_cast<std::uint32_t>(radiance.width() * radiance.height());
    const std::uint32_t parts = (texels + kTexelsPerInvocation - 1) / kTexelsPerInvocation;
    counts_.ensure("bad pixel counts", parts * sizeof(std::uint32_t));
    counts_.bindStorage(kBlockBadCounts);
    radiance.bind(kUnitRadiance);
    program_.set("size", glm::ivec2(radiance.width(), radiance.height()));
    program_.dispatchInvocations(parts);
    counts.request(counts_, 0, parts * sizeof(std::uint32_t));
}

std::optional<std::uint64_t> BadPixelsPass::take(gl::ReadBack& counts) {
    const auto parts = counts.take<std::uint32_t>();
    if (!parts) return std::nullopt;
    return std::accumulate(parts->begin(), parts->end(), std::uint64_t{0});
}

}  // namespace mv
