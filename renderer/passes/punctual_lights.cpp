#include "renderer/passes/punctual_lights.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <spdlog/spdlog.h>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

// The sky has flux and no intensity: passes of its own shine it.
float power(const LightRecord& l) {
    const bool shines = luminance({l.intensityR, l.intensityG, l.intensityB}) > 0;
    const float p = shines ? luminance({l.fluxR, l.fluxG, l.fluxB}) : 0.0f;
    return std::isfinite(p) ? p : 0.0f;
}

// By luminance of their flux; equals in the order of the scene.
std::vector<LightRecord> byPower(const std::vector<LightRecord>& lights) {
    std::vector<LightRecord> out;
    std::copy_if(lights.begin(), lights.end(), std::back_inserter(out),
                 [](const LightRecord& l) { return power(l) > 0; });
    std::stable_sort(out.begin(), out.end(), [](const LightRecord& a, const LightRecord& b) {
        return power(a) > power(b);
    });
    return out;
}

}  // namespace

void GpuLights::set(const std::vector<LightRecord>& lights) {
    std::vector<LightRecord> strongest = byPower(lights);
    constexpr std::size_t kMost = kMostLights;
    const std::size_t ignored = std::max(strongest.size(), kMost) - kMost;
    if (ignored > 0 && ignored != warnedOf_) {
        spdlog::warn("{} of {} punctual lights give no direct light: only the {} strongest do",
                     ignored, lights.size(), kMost);
    }
    warnedOf_ = ignored;
    strongest.resize(strongest.size() - ignored);
    count_ = static_cast<std::uint32_t>(strongest.size());
    records_.ensure("punctual lights", std::max<std::size_t>(strongest.size(), 1));
    if (count_ > 0) records_.write(0, strongest);
}

void GpuLights::bindTexels() const { records_.bindTexels(kUnitLights); }

}  // namespace mv
