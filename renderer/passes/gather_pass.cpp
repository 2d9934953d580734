#include "renderer/passes/gather_pass.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <vector>

#include "renderer/gl/program.h"
#include "renderer/gl/vertex_array.h"
#include "renderer/passes/alone_pixels.h"
#include "renderer/passes/filter_pass.h"
#include "renderer/passes/gather_samples.h"
#include "renderer/passes/gather_shares.h"
#include "renderer/passes/near_field_pass.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

// Passes of the filter by the samples of a pixel. Each pass is twice as wide as the one before: it
// averages over about four times the area and so halves what noise is left, as four times the
// samples would. The steps, of five to six times, are a rule of thumb and not measured.
struct FilterStep {
    int samples, passes;  // up to so many samples take so many passes
};
constexpr FilterStep kFilterSteps[] = {{16, 5}, {96, 4}, {512, 3}};
constexpr int kFewestPasses = 2;  // of more samples than any step's
constexpr int kFilterRows = 270;  // of a picture that takes so many

// One pass less where upsampling smooths too; more passes on larger pictures, whose pixels are
// smaller on the surfaces, so that the filter reaches as far on them. Each time the number of sets
// that are averaged has doubled, one pass less: the mean has less noise with each, and would keep
// the first one's blur. A full sum has no noise.
int filterPasses(const GatherOptions& options, int rows) {
    if (!options.filter || options.samples == 0) return 0;
    const auto* step =
        std::find_if(std::begin(kFilterSteps), std::end(kFilterSteps),
                     [&](const FilterStep& s) { return options.samples <= s.samples; });
    int passes = step != std::end(kFilterSteps) ? step->passes : kFewestPasses;
    passes -= std::bit_width(static_cast<unsigned>(options.set)) - 1;
    const double larger = std::log2(std::max(1.0, static_cast<double>(rows) / kFilterRows));
    return std::max(1, passes + static_cast<int>(std::lround(larger)) - (options.cull.scale > 1));
}

// How many times the light around them fireflies may have. Of sets that are averaged, the more the
// less each weighs: the mean then misses less and less of what is bright alone, and has no more of
// fireflies than the first had.
constexpr float kFireflyFactor = 1.5f;
std::optional<OutlierLimit> outlierLimit(const GatherOptions& options) {
    if (!options.limitFireflies) return {};
    return OutlierLimit{kFireflyFactor * static_cast<float>(options.set),
                        options.sky.sky != nullptr};
}

}  // namespace

struct GatherPass::Impl {
    GatherViewsPass viewsPass;
    GatherCullPass cullPass;
    GatherSum sum;
    NearFieldPass nearField;
    SkyPass sky;
    HistoryPass history;
    FilterPass filter;
    gl::Program accumulate{"accumulate", {"passes/accumulate.comp"}};
    gl::Program upsampling, listDoubted, boundDoubted;
    AlonePixels alone;
    gl::Texture found;
    std::uint64_t prepared = 0;  // GBuffer::drawing of the last prepare()

    void gather(const GatherCall& in, const gl::Texture& irradiance, const gl::Texture& candidates);
    void upsample(const GatherCall& in, const gl::Texture& filteredCoarse,
                  const gl::Texture& irradiance, const GatherResult& out);
    void gatherAlone(const GatherCall& in, const gl::Texture& irradiance, const GatherResult& out);
    // Of the gather's pixels, whose samples gave `own`: what second_look.comp lists in `filtered`.
    void lookAgain(const GatherCall& in, const gl::Texture& own, const gl::Texture& filtered,
                   const GatherResult& out);
    // The same pixels' light, of the picture's size.
    void filterWhole(const GBuffer& gbuffer, const GatherOptions& options, const gl::Texture& light,
                     gl::Texture& filtered);
    // light: of the gather's pixels -> filtered, of the picture's; and at a scale above 1 the rest
    // of `out`. ofThisFrame: `light` has no more samples than this frame's.
    void smooth(const GatherCall& in, const gl::Texture& light, bool ofThisFrame,
                gl::Texture& filtered, const GatherResult& out);
    // Where no view lives: nothing, and the sky at the picture's own pixels, without history.
    void gatherWithoutViews(const GBuffer& gbuffer, const GatherOptions& options,
                            gl::Profiler& profiler, GatherResult& out);
};

GatherPass::GatherPass() : impl_(std::make_unique<Impl>()) {}
GatherPass::~GatherPass() = default;

void GatherPass::Impl::gather(const GatherCall& in, const gl::Texture& irradiance,
                              const gl::Texture& candidates) {
    sum.askSlices(in, sum.wholePicture());
    gl::Program& p = sum.bindGather(GatherShader::gather, in);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    candidates.bindImage(kImageCandidates, GL_READ_WRITE, GL_RGBA32F);
    sum.askedCounts.ensure("samples that asked", 8);
    sum.askedCounts.bindStorage(kBlockAskedCounts);
    sum.runGather(p, GatherShader::gather, in, sum.wholePicture());
    if (in.options.sample && in.asked) in.asked->request(sum.askedCounts, 0, 8);
}

void GatherPass::Impl::upsample(const GatherCall& in, const gl::Texture& filteredCoarse,
                                const gl::Texture& irradiance, const GatherResult& out) {
    if (!upsampling) {
        upsampling = gl::Program("upsample", {"passes/upsample.comp"});
    }
    const int width = in.gbuffer.width, height = in.gbuffer.height;
    sum.setUpsample(upsampling, in, filteredCoarse);
    irradiance.bindImage(kImageIrradiance, GL_WRITE_ONLY, GL_RGBA32F);
    out.unfiltered.bindImage(kImageUnfiltered, GL_WRITE_ONLY, GL_RGBA32F);
    out.candidates.bindImage(kImageUpsampledCandidates, GL_WRITE_ONLY, GL_RGBA32F);
    upsampling.set("size", glm::ivec2(width, height));
    alone.clear(width, height);
    alone.bind();
    upsampling.dispatch2D(width, height);
}

void GatherPass::Impl::gatherAlone(const GatherCall& in, const gl::Texture& irradiance,
                                   const GatherResult& out) {
    gl::Program& p = sum.bindAlone(in);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    out.unfiltered.bindImage(kImageUnfiltered, GL_READ_WRITE, GL_RGBA32F);
    sum.inParts(p, GatherShader::alone, in, 0, [&] { alone.dispatch(p); });
    if (in.options.sky.sky) {
        sky.renderAlone(in.options.sky, in.gbuffer, alone, *in.profiler, irradiance,
                        out.unfiltered);
    }
}

void GatherPass::Impl::lookAgain(const GatherCall& in, const gl::Texture& own,
                                 const gl::Texture& filtered, const GatherResult& out) {
    if (!listDoubted) {
        listDoubted = gl::Program("second look", {"passes/second_look.comp"});
        boundDoubted = gl::Program("second look", {"passes/second_look.comp"}, {{"MV_BOUND", "1"}});
    }
    const gl::Texture& candidates =
        in.options.cull.scale == 1 ? out.candidates : sum.coarseCandidates;
    found.ensure("light of further looks", GL_TEXTURE_2D, GL_RG32F, own.width(), own.height());
    found.bindImage(kImageFound, GL_READ_WRITE, GL_RG32F);
    std::uint32_t looked = 0;  // samples
    const auto bind = [&](gl::Program& p) {
        own.bind(kUnitFilterSource);
        candidates.bind(kUnitCandidates);
        filtered.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
        p.set("samples", static_cast<std::uint32_t>(in.options.samples));
        p.set("looked", looked);
    };
    // Most of those out of luck find light soon; the last and longest look is for those in the
    // dark.
    for (const std::uint32_t times : {1u, 2u, kAllLooksSamples - 3u}) {
        bind(listDoubted);
        listDoubted.set("size", glm::ivec2(own.width(), own.height()));
        alone.clear(own.width(), own.height());
        alone.bind();
        listDoubted.dispatch2D(own.width(), own.height());
        const std::uint32_t samples = times * static_cast<std::uint32_t>(in.options.samples);
        gl::Program& again = sum.bindAgain(in, samples);
        sum.inParts(again, GatherShader::again, in, 0, [&] { alone.dispatch(again); });
        looked += samples;
    }
    bind(boundDoubted);
    alone.dispatch(boundDoubted);
}

void GatherPass::Impl::smooth(const GatherCall& in, const gl::Texture& light, bool ofThisFrame,
                              gl::Texture& filtered, const GatherResult& out) {
    const GBuffer& g = in.gbuffer;
    const int passes = filterPasses(in.options, g.height);
    // With what frames before left, a pixel has more samples than this frame's; what maps alone
    // answer, they would answer again; and looks at views know nothing of a sky that the pixel's
    // few directions have missed.
    const bool again = in.options.secondLook && passes > 0 && ofThisFrame && in.options.sample &&
                       in.options.sampleAsked != SampleAsked::withoutMaps && !in.options.sky.sky;
    filtered.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, g.width, g.height);
    if (in.options.cull.scale > 1) {
        const gl::Texture& small = filter.render(g, sum.lists.surfaces, in.options.cull.scale,
                                                 light, passes, outlierLimit(in.options), nullptr);
        if (again) lookAgain(in, light, small, out);
        upsample(in, small, filtered, out);
        gatherAlone(in, filtered, out);
    } else {
        filterWhole(g, in.options, light, filtered);
        if (again) lookAgain(in, light, filtered, out);
    }
}

void GatherPass::Impl::filterWhole(const GBuffer& g, const GatherOptions& options,
                                   const gl::Texture& light, gl::Texture& filtered) {
    if (const int passes = filterPasses(options, g.height); passes > 0) {
        filter.render(g, sum.lists.surfaces, 1, light, passes, outlierLimit(options), &filtered);
        return;
    }
    filtered.copy(light);
}

void GatherPass::Impl::gatherWithoutViews(const GBuffer& gbuffer, const GatherOptions& options,
                                          gl::Profiler& profiler, GatherResult& out) {
    out.remembered.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width, gbuffer.height);
    for (gl::Texture* t : {&out.irradiance, &out.unfiltered, &out.remembered, &out.candidates}) {
        t->clear();
    }
    if (!options.sky.sky) return;
    {
        const gl::PassScope scope(profiler, Stage::skyLight);
        sky.render(options.sky, gbuffer, sum.lists, {}, profiler, out.unfiltered);
    }
    const gl::PassScope scope(profiler, Stage::filter);
    filterWhole(gbuffer, options, out.unfiltered, out.irradiance);
    out.remembered.copy(out.irradiance);
}

void GatherPass::prepare(const GBuffer& gbuffer, const GpuViewHierarchy& cullTree,
                         const GatherOptions& options, gl::Profiler& profiler) {
    Impl& m = *impl_;
    m.prepared = gbuffer.drawing;
    const gl::PassScope scope(profiler, Stage::gatherCull);
    if (cullTree.aliveCount == 0) {
        GatherCullOptions whole;
        whole.level = 0;
        m.cullPass.findTiles(gbuffer, whole, m.sum.lists);
        return;
    }
    m.viewsPass.render(cullTree, options.clampDistance, m.sum.views);
    m.cullPass.render(gbuffer, cullTree, m.sum.views, {options.cull}, m.sum.lists);
}

void GatherPass::record(const GpuViewHierarchy& mapHierarchy, const GpuViewMaps& maps,
                        const GpuMapViews* mapViews, gl::Profiler& profiler, GatherRecords& out) {
    if (mapHierarchy.aliveCount == 0) return;
    const gl::PassScope scope(profiler, Stage::gather);
    impl_->viewsPass.record(mapHierarchy, maps, mapViews, impl_->sum.views, out);
}

void GatherPass::gather(const GatherInputs& inputs, gl::Profiler& profiler, GatherResult& out) {
    Impl& m = *impl_;
    const GBuffer& gbuffer = inputs.gbuffer;
    const GatherOptions& options = inputs.options;
    assert(options.cull.scale >= 1 && options.samples >= 0 && options.samples <= 65535);
    assert(gbuffer.drawing == m.prepared);
    const int width = gbuffer.width, height = gbuffer.height;
    out.irradiance.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.unfiltered.ensure("unfiltered irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.candidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    if (inputs.mapHierarchy.aliveCount == 0) {
        return m.gatherWithoutViews(gbuffer, options, profiler, out);
    }

    // What the samples of this frame give, a texel for each of the gather's pixels.
    const bool whole = options.cull.scale == 1;
    const gl::Texture& own = whole ? out.unfiltered : m.sum.coarse;
    const gl::Texture& candidates = whole ? out.candidates : m.sum.coarseCandidates;
    if (!whole) {
        const int w = m.sum.lists.surfaces.width(), h = m.sum.lists.surfaces.height();
        m.sum.coarse.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, w, h);
        m.sum.coarseCandidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RGBA32F, w, h);
    }
    GatherCall in{inputs, &profiler};
    const bool remembers = options.past.history && options.samples > 0;
    if (remembers) {
        const gl::PassScope scope(profiler, Stage::history);
        in.resting = m.history.reproject(gbuffer, m.sum.lists.surfaces, options.cull.scale,
                                         options.samples, options.accumulationIndex, options.past);
    }
    {
        const gl::PassScope scope(profiler, Stage::gather);
        m.gather(in, own, candidates);
    }
    if (options.nearFieldOf.triangles) {
        const gl::PassScope scope(profiler, Stage::nearField);
        m.nearField.render(options.nearFieldOf, in.mapHierarchy, m.sum.views, m.sum.lists,
                           in.resting, own);
    }
    if (options.sky.sky) {
        const gl::PassScope scope(profiler, Stage::skyLight);
        m.sky.render(options.sky, gbuffer, m.sum.lists, in.resting, profiler, own);
    }
    if (remembers) {
        const gl::PassScope scope(profiler, Stage::history);
        m.history.remember(gbuffer, m.sum.lists.surfaces, options.cull.scale, own, options.samples,
                           in.resting, options.past);
    }
    {
        const gl::PassScope scope(profiler, Stage::filter);
        if (!remembers || options.past.keepsOwnLight) m.smooth(in, own, true, out.irradiance, out);
        if (remembers) {
            m.smooth(in, options.past.history->light, false,
                     options.past.keepsOwnLight ? out.remembered : out.irradiance, out);
        }
    }
}

void GatherPass::accumulate(const gl::Texture& set, int sets, gl::Profiler& profiler,
                            gl::Texture& mean) {
    assert(sets >= 2 && mean.width() == set.width() && mean.height() == set.height());
    const gl::PassScope scope(profiler, Stage::accumulate);
    gl::Program& p = impl_->accumulate;
    set.bind(kUnitSampleSet);
    mean.bindImage(kImageMean, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(mean.width(), mean.height()));
    p.set("sets", static_cast<float>(sets));
    p.dispatch2D(mean.width(), mean.height());
}

std::vector<GatheredSample> GatherPass::readSamples(const GatherInputs& in, glm::ivec2 pixel) {
    if (in.mapHierarchy.aliveCount == 0 || pixel.x < 0 || pixel.y < 0 ||
        pixel.x >= in.gbuffer.width || pixel.y >= in.gbuffer.height) {
        return {};
    }
    return readGatheredSamples(impl_->sum, {in}, pixel);
}

GatherShares GatherPass::readShares(const GatherInputs& in) {
    if (in.mapHierarchy.aliveCount == 0) return {};
    return readGatherShares(impl_->sum, {in});
}

std::uint64_t GatherPass::bytes() const {
    const Impl& m = *impl_;
    return m.sum.bytes() + m.history.bytes() + m.filter.bytes() + m.found.bytes() + m.alone.bytes();
}

}  // namespace mv
