#include "renderer/passes/difference_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "renderer/gl/program.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

static_assert(static_cast<uint>(Difference::absolute) == kDifferenceAbsolute);
static_assert(static_cast<uint>(Difference::signedValue) == kDifferenceSigned);
static_assert(static_cast<uint>(Difference::relative) == kDifferenceRelative);

// The upper end of the bin in which the 99th percentile lies.
double percentile(const std::vector<std::uint32_t>& bins, std::uint64_t texels) {
    std::uint64_t bad = 0, below = texels;
    for (std::uint32_t b = kFiniteDifferenceBins; b < kDifferenceBins; ++b) bad += bins[b];
    for (const std::uint32_t n : bins) below -= n;  // the zeros, that is
    const std::uint64_t numbers = texels - bad;
    const std::uint64_t wanted = (numbers * 99 + 99) / 100;
    double range = 0;
    const bool mostlyZero = below >= wanted;
    for (std::uint32_t b = 0; b < kFiniteDifferenceBins; ++b) {
        if (bins[b] == 0) continue;
        below += bins[b];
        range = double{uintBitsToFloat((b + 1) << 16)};
        if (!mostlyZero && below >= wanted) break;
    }
    if (range == 0) return 1;
    return std::min(range, double{std::numeric_limits<float>::max()});
}

}  // namespace

struct DifferencePass::Impl {
    gl::Program difference{"difference", {"passes/full_screen.vert", "passes/difference.frag"}};
    gl::Program show{"difference", {"passes/full_screen.vert", "passes/difference_show.frag"}};
    gl::Program histogram{"difference histogram", {"passes/difference_histogram.comp"}};
    gl::Texture values;
    gl::Buffer bins;
};

DifferencePass::DifferencePass() : impl_(std::make_unique<Impl>()) {}
DifferencePass::~DifferencePass() = default;

std::uint64_t DifferencePass::bytes() const { return impl_->values.bytes() + impl_->bins.bytes(); }

double DifferencePass::render(const gl::Texture& left, const gl::Texture& right, Difference kind,
                              std::optional<double> range, double exposureEv,
                              gl::Profiler& profiler, gl::Texture& radiance, gl::Texture& display) {
    assert(kind != Difference::off);
    assert(left.width() == right.width() && left.height() == right.height());
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::difference);
    const int width = left.width(), height = left.height();
    radiance.ensure("difference", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    m.values.ensure("difference shown", GL_TEXTURE_2D, GL_R32F, width, height);
    display.ensure("difference in colours", GL_TEXTURE_2D, GL_RGBA8, width, height);

    left.bind(kUnitLeft);
    right.bind(kUnitRight);
    m.difference.set("kind", static_cast<std::uint32_t>(kind));
    m.difference.set("small", static_cast<float>(0.01 * kMiddleGrey * std::exp2(-exposureEv)));
    m.difference.drawFullScreen(gl::Framebuffer("difference", {&radiance, &m.values}));

    m.values.bind(kUnitDifferences);
    if (!range) {
        const std::uint64_t texels =
            static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
        m.bins.ensure("difference histogram", kDifferenceBins * 4);
        m.bins.fill(0);
        m.bins.bindStorage(kBlockHistogram);
        m.histogram.set("size", glm::ivec2(width, height));
        m.histogram.dispatchInvocations((texels + kTexelsPerInvocation - 1) / kTexelsPerInvocation);
        range = percentile(m.bins.read<std::uint32_t>(0, kDifferenceBins), texels);
    }

    m.show.set("kind", static_cast<std::uint32_t>(kind));
    m.show.set("range", std::max(static_cast<float>(*range), 1e-30f));
    m.show.drawFullScreen(gl::Framebuffer("difference in colours", {&display}));
    return *range;
}

}  // namespace mv
