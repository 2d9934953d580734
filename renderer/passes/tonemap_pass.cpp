#include "renderer/passes/tonemap_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "megaviews/core/colour.h"
#include "megaviews/settings/debug_legends.h"
#include "renderer/gl/program.h"
#include "renderer/gl/vertex_array.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/debug_view.glsl"
#include "shaders/shared/tone.glsl"

namespace mv {
namespace {

// At most one surface texel in kWhiteShare may be brighter, once exposed, than what the tone map
// shows as 94 % of white.
constexpr std::size_t kWhiteShare = 50;

// A sky that takes more of the picture than this is no more than so far above middle grey.
constexpr double kWideSky = 1.0 / 3, kSkyAboveGreyEv = 2.5;
// Before it, what reflects more than this on average is shown so many times as bright as grey, at
// most twice: of a room one sees by its light that it is white, of a lone statue by nothing.
constexpr double kGreyAlbedo = 0.4;

double whiteOf(ToneMap toneMap) {
    switch (toneMap) {
        case ToneMap::none:
            return 0.94;
        case ToneMap::aces:
            return 2.5;
        case ToneMap::neutral:
            return 1.5;
        case ToneMap::agx:
            return 7.3;
    }
    assert(false);
    return 1;
}

static_assert(static_cast<int>(DebugView::final) == MV_VIEW_FINAL);
static_assert(static_cast<int>(DebugView::direct) == MV_VIEW_DIRECT);
static_assert(static_cast<int>(DebugView::indirect) == MV_VIEW_INDIRECT);
static_assert(static_cast<int>(DebugView::unfiltered) == MV_VIEW_UNFILTERED);
static_assert(static_cast<int>(DebugView::normals) == MV_VIEW_NORMALS);
static_assert(static_cast<int>(DebugView::albedo) == MV_VIEW_ALBEDO);
static_assert(static_cast<int>(DebugView::depth) == MV_VIEW_DEPTH);
static_assert(static_cast<int>(DebugView::candidates) == MV_VIEW_CANDIDATES);
static_assert(static_cast<int>(DebugView::undecided) == MV_VIEW_UNDECIDED);
static_assert(static_cast<int>(DebugView::nan) == MV_VIEW_NAN);
static_assert(static_cast<int>(DebugView::sharing) == MV_VIEW_SHARING);
static_assert(static_cast<int>(DebugView::shared) == MV_VIEW_SHARED);
static_assert(static_cast<int>(ToneMap::none) == 0 && static_cast<int>(ToneMap::aces) == 1 &&
              static_cast<int>(ToneMap::neutral) == 2 && static_cast<int>(ToneMap::agx) == 3);

}  // namespace

struct TonemapPass::Impl {
    gl::VertexArray noVertices{"full screen"};
    std::map<DebugView, gl::Program> composePrograms;
    std::map<std::pair<DebugView, ToneMap>, gl::Program> tonemapPrograms;
    gl::Program count{"count bad pixels", {"passes/count_bad.comp"}};
    gl::Program average;  // made at first use
    gl::Texture black{"no light", GL_TEXTURE_2D, GL_RGBA32F, 1, 1};
    gl::Buffer counts;
    gl::Framebuffer target;

    Impl() { black.writeFloats(4, {0, 0, 0, 0}); }
    gl::Program& composeProgram(DebugView view) {
        gl::Program& p = composePrograms[view];
        if (!p) {
            p = gl::Program("compose", {"passes/full_screen.vert", "passes/compose.frag"},
                            {{"MV_VIEW", std::to_string(static_cast<int>(view))}});
        }
        return p;
    }
    gl::Program& tonemapProgram(DebugView view, ToneMap toneMap) {
        gl::Program& p = tonemapPrograms[{view, toneMap}];
        if (!p) {
            p = gl::Program("tone map", {"passes/full_screen.vert", "passes/tonemap.frag"},
                            {{"MV_VIEW", std::to_string(static_cast<int>(view))},
                             {"MV_TONE_MAP", std::to_string(static_cast<int>(toneMap))}});
        }
        return p;
    }
    // A framebuffer is little more than a name: made anew, it cannot outlive its texture.
    void bindTarget(const gl::Texture& texture) {
        target = gl::Framebuffer("picture", {&texture});
        target.bind();
    }
    // meanExposure: of the display's mean over a pixel; 0: of radiance as it is.
    void tonemap(const gl::Texture& radiance, float meanExposure, double exposureEv,
                 ToneMap toneMap, DebugView view, gl::Profiler& profiler, gl::Texture& display);
};

TonemapPass::TonemapPass() : impl_(std::make_unique<Impl>()) {}
TonemapPass::~TonemapPass() = default;

void TonemapPass::compose(const Input& input, DebugView view, gl::Profiler& profiler,
                          gl::Texture& radiance) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::compose);
    const GBuffer& g = *input.gbuffer;
    radiance.ensure("radiance", GL_TEXTURE_2D, GL_RGBA32F, g.width, g.height);
    m.bindTarget(radiance);
    const auto orBlack = [&](const gl::Texture* texture) -> const gl::Texture& {
        return texture && *texture ? *texture : m.black;
    };
    const gl::Texture* irradiance =
        view == DebugView::unfiltered ? input.unfilteredIrradiance : input.irradiance;
    g.normal.bind(kUnitNormal);
    g.albedo.bind(kUnitAlbedo);
    g.emission.bind(kUnitEmission);
    orBlack(input.direct).bind(kUnitDirect);
    orBlack(irradiance).bind(kUnitIrradiance);
    orBlack(input.candidates).bind(kUnitCandidates);
    orBlack(input.reflected).bind(kUnitReflected);
    gl::Program& p = m.composeProgram(view);
    const bool emits = view == DebugView::final || view == DebugView::direct ||
                       view == DebugView::unfiltered || view == DebugView::nan;
    if (emits) p.set("emissionScale", input.emissionScale);
    p.use();
    gl::drawFullScreen(m.noVertices);
}

void TonemapPass::countBadPixels(const gl::Texture& radiance, gl::ReadBack& counts) {
    Impl& m = *impl_;
    const auto texels = static_cast<std::uint32_t>(radiance.width() * radiance.height());
    const std::uint32_t parts = (texels + kTexelsPerInvocation - 1) / kTexelsPerInvocation;
    m.counts.ensure("bad pixel counts", parts * sizeof(std::uint32_t));
    m.counts.bindStorage(kBlockBadCounts);
    radiance.bind(kUnitRadiance);
    m.count.set("size", glm::ivec2(radiance.width(), radiance.height()));
    m.count.dispatchInvocations(parts);
    counts.request(m.counts, 0, parts * sizeof(std::uint32_t));
}

std::uint64_t TonemapPass::badPixels(const std::vector<std::uint32_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

std::optional<double> TonemapPass::fitExposure(const gl::Texture& radiance, const GBuffer& gbuffer,
                                               ToneMap toneMap) {
    const std::vector<float> color = radiance.readFloats(4);
    const std::vector<float> position = gbuffer.position.readFloats(4);
    const std::vector<float> emission = gbuffer.emission.readFloats(4);
    std::vector<double> luminances;
    std::vector<std::size_t> surfaces;  // whose they are, into the arrays
    double sum = 0, skyLogs = 0;
    std::size_t skyPixels = 0;
    for (std::size_t i = 0; i + 3 < color.size(); i += 4) {
        const double luminance = luminanceOf(&color[i]);
        if (!std::isfinite(luminance) || luminance <= 0) continue;
        if (position[i + 3] == 0) {
            skyLogs += std::log2(luminance);
            ++skyPixels;
            continue;
        }
        if (emission[i] > 0 || emission[i + 1] > 0 || emission[i + 2] > 0) continue;
        luminances.push_back(luminance);
        surfaces.push_back(i);
        sum += luminance;
    }
    if (luminances.empty()) return std::nullopt;
    const auto surfacePixels = static_cast<double>(luminances.size());
    const double floor = 0.01 * sum / surfacePixels;
    double logSum = 0;
    for (const double luminance : luminances) logSum += std::log2(std::max(luminance, floor));
    double middle = std::log2(kMiddleGrey) - logSum / surfacePixels;
    const bool wideSky =
        static_cast<double>(skyPixels) > kWideSky * static_cast<double>(color.size()) / 4;
    if (wideSky) {
        const std::vector<float> albedo = gbuffer.albedo.readFloats(4);
        double albedoSum = 0;
        for (const std::size_t i : surfaces) albedoSum += luminanceOf(&albedo[i]);
        middle += std::log2(std::clamp(albedoSum / surfacePixels / kGreyAlbedo, 1.0, 2.0));
    }
    // A picture of shade with some sun in it has its mean in the shade: what the sun shines on must
    // not all turn white.
    const auto rank = luminances.size() - 1 - luminances.size() / kWhiteShare;
    std::nth_element(luminances.begin(), luminances.begin() + static_cast<std::ptrdiff_t>(rank),
                     luminances.end());
    double ev = std::min(middle, std::log2(whiteOf(toneMap) / luminances[rank]));
    // What is dark before a wide sky is shown dark.
    if (wideSky) {
        const double sky = skyLogs / static_cast<double>(skyPixels);
        ev = std::min(ev, std::log2(kMiddleGrey) + kSkyAboveGreyEv - sky);
    }
    return ev;
}

void TonemapPass::average(const gl::Texture& radiance, int ev, gl::Profiler& profiler,
                          Means& means) {
    Impl& m = *impl_;
    const gl::PassScope scope(profiler, Stage::accumulate);
    const int width = radiance.width(), height = radiance.height();
    if (!m.average) {
        m.average = gl::Program("average pixels", {"passes/average_pixels.comp"});
    }
    if (means.points == 0) {
        means.radiance.ensure("mean radiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        means.display.ensure("mean for display", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        means.ev = ev;
    }
    assert(means.radiance.width() == width && means.radiance.height() == height);
    ++means.points;
    radiance.bind(kUnitRadiance);
    means.radiance.bindImage(kImageMean, GL_READ_WRITE, GL_RGBA32F);
    means.display.bindImage(kImageDisplayMean, GL_READ_WRITE, GL_RGBA32F);
    m.average.set("size", glm::ivec2(width, height));
    m.average.set("points", static_cast<float>(means.points));
    m.average.set("exposure", std::exp2(static_cast<float>(means.ev)));
    // Producers: the average before; draws into `radiance` are ordered without.
    gl::barrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    m.average.dispatch2D(width, height);
    // Readers: the tone map, the split's copies, files.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT);
}

void TonemapPass::tonemap(const gl::Texture& radiance, double exposureEv, ToneMap toneMap,
                          DebugView view, gl::Profiler& profiler, gl::Texture& display) {
    impl_->tonemap(radiance, 0, exposureEv, toneMap, view, profiler, display);
}

void TonemapPass::tonemap(const Means& means, double exposureEv, ToneMap toneMap, DebugView view,
                          gl::Profiler& profiler, gl::Texture& display) {
    impl_->tonemap(means.display, std::exp2(static_cast<float>(means.ev)), exposureEv, toneMap,
                   view, profiler, display);
}

void TonemapPass::Impl::tonemap(const gl::Texture& radiance, float meanExposure, double exposureEv,
                                ToneMap toneMap, DebugView view, gl::Profiler& profiler,
                                gl::Texture& display) {
    Impl& m = *this;
    const gl::PassScope scope(profiler, Stage::toneMap);
    display.ensure("display", GL_TEXTURE_2D, GL_RGBA8, radiance.width(), radiance.height());
    m.bindTarget(display);
    radiance.bind(kUnitRadiance);
    gl::Program& program = m.tonemapProgram(view, toneMap);
    program.set("exposure", static_cast<float>(std::exp2(exposureEv)));
    program.set("meanExposure", meanExposure);
    if (const DebugLegend& legend = legendOf(view); legend.kind == LegendKind::scale) {
        const auto axis = [&](double x) { return legend.logarithmic ? std::log2(x) : x; };
        const double slope = 1 / (axis(legend.high) - axis(legend.low));
        program.set("scale", static_cast<float>(slope));
        program.set("scaleOffset", static_cast<float>(-axis(legend.low) * slope));
        program.set("logarithmic", legend.logarithmic ? 1 : 0);
        program.set("grey", legend.colours == ColourMap::grey ? 1 : 0);
    }
    program.use();
    gl::drawFullScreen(m.noVertices);
}

}  // namespace mv
