// FrameRenderer: sets of samples, gathered from the maps of a side and averaged.

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "renderer/frame_state.h"

namespace mv {
namespace {

// Sky rays per pixel when --gather-samples 0 sums all views.
constexpr int kSkyRaysOfFullSum = 256;

}  // namespace

GatherOptions FrameRenderer::Impl::gatherOptions(const Settings& settings) {
    GatherOptions options{settings.gather};
    options.seed = settings.seed;
    return options;
}

void FrameRenderer::Impl::cullGather(const Settings& settings) {
    const CullInputs inputs{.cull = settings.gather.cull,
                            .clampDistance = settings.gather.clampDistance,
                            .views = views.frame.version,
                            .gbuffer = surfaces.version};
    if (culled.inputs == inputs) return;
    culled.inputs.reset();
    culled.drawing.reset();
    cullFor(settings, surfaces.gbuffer, views.frame.tree, views.frame.version);
    culled.inputs = inputs;
    ++culled.version;
}

void FrameRenderer::Impl::cullFor(const Settings& settings, const GBuffer& of,
                                  const GpuViewHierarchy& tree, std::uint64_t version) {
    if (culled.drawing == of.drawing && culled.views == version) return;
    culled.drawing.reset();  // in case this throws
    gatherPass.prepare(of, tree, gatherOptions(settings), profiler);
    culled.drawing = of.drawing;
    culled.views = version;
}

int FrameRenderer::Impl::nextSets(const Settings& settings, int count) {
    // Points of pixels are composed as they are gathered, for one view and one exposure.
    const bool averages = settings.averagesPixels();
    if (averages) pointsView = settings.picture.view;
    if (!averages) pixelPoint.reset();
    std::optional<DebugView> view;
    if (settings.mayAveragePixels() && !sequence.ownSamples) view = pointsView;
    int fewest = std::numeric_limits<int>::max(), most = 0;
    const int before = sides[0]->sets;
    for (int i = 0; i < count; ++i) {
        Side& side = *sides[static_cast<std::size_t>(i)];
        const SampleInputs inputs{
            .gather = settings.gather,
            .rules = side.settings.rules,
            .seed = settings.seed,
            .referenceSamples = side.isReference() ? side.settings.referenceSamples : 0,
            .cull = culled.version,
            .maps = side.mapsVersion,
            .ownSamples = sequence.ownSamples,
            .averagesViews = settings.averagesViews(),
            .pointsView = view};
        const bool exposed =
            side.points.points == 0 || side.points.ev == exposure.pointsEv(settings);
        // A repeated frame makes the same maps again, to count their pairs.
        const bool same = sequence.repeats || (side.sampleInputs == inputs && exposed);
        if (!same) side.sets = 0;
        side.sampleInputs = inputs;
        fewest = std::min(fewest, side.sets);
        most = std::max(most, side.sets);
    }
    const bool keeps = view && !averages;  // a view of data is shown, and the points wait
    const int wanted = sequence.ownSamples ? 1
                       : keeps             ? std::max(fewest, 1)
                                           : settings.setsWanted();
    const bool anew = fewest == 0 || most > wanted;
    if (anew && sequence.ownSamples) {
        sequence.setsBefore += static_cast<std::uint32_t>(before);
        for (const auto& side : sides) {
            if (side) side->sets = 0;
        }
    }
    return anew ? 1 : std::min(fewest + 1, wanted);
}

GatherOptions FrameRenderer::Impl::gatherOptionsOf(const Settings& settings, const Side& side,
                                                   const Visibility* visibility, int set) const {
    GatherOptions options = gatherOptions(settings);
    options.rules = side.settings.rules;
    options.set = set;
    options.accumulationIndex = static_cast<std::uint32_t>(set - 1);
    if (sequence.ownSamples) options.accumulationIndex += sequence.setsBefore;
    if (visibility) options.sample = visibility->sample();
    if (side.isReference()) options.sample = shadowRaySample(sceneOnGpu->triangles);
    if (settings.gather.nearField && views.frame.input->settings.particles == 0) {
        NearFieldScene& near = options.nearFieldOf;
        near.triangles = &sceneOnGpu->triangles;
        near.lights = &lights.punctual;
        if (lights.sky.sky()) near.sky = &lights.sky;
        const bool lamps =
            lights.emitters.emissiveCount() > 0 && views.frame.input->settings.areOfLamps();
        if (lamps) near.emissionScale = lights.emitters.lightScale;
        near.bounces = views.frame.input->settings.bounces;
        near.gloss = views.frame.input->gloss;
        near.clampDistance = options.clampDistance;
        near.rootEdge = scene->root.edge;
        near.seed = options.seed;
        near.accumulationIndex = options.accumulationIndex;
    }
    if (lights.sky.sky()) {
        const int rays = options.samples == 0 ? kSkyRaysOfFullSum : settings.gather.skySamples;
        options.sky = {.sky = &lights.sky,
                       .triangles = &sceneOnGpu->triangles,
                       .samples = rays,
                       .maps = lights.skyMaps.get(),
                       .seed = options.seed,
                       .accumulationIndex = options.accumulationIndex};
    }
    const bool fused = visibility && visibility->maps().present && visibility->maps().fused;
    const bool undecided =
        hasRule(options.rules, kRuleFootprint) && settings.gather.undecided == Undecided::rays;
    if (!options.sample && fused && (undecided || !visibility->maps().slices.empty())) {
        options.sample = shadowRaySample(sceneOnGpu->triangles);
        options.sampleAsked = undecided ? SampleAsked::inDoubt : SampleAsked::withoutMaps;
    }
    return options;
}

HistoryOptions FrameRenderer::Impl::historyOf(const Settings& settings, int n,
                                              const FrameCamera& camera, Side& side) const {
    if (settings.gather.history == 0 || !sequence.keepsHistory) side.history = {};
    const bool keepsOwnLight = !sequence.ownSamples;
    if (settings.gather.samples == 0 || !sequence.keepsHistory) return {};
    if (keepsOwnLight && n >= std::min(settings.gather.history, settings.setsWanted())) return {};
    // The history stays if only the number of samples or views differs, as in a draft.
    HistoryInputs inputs{.method = side.settings,
                         .views = settings.views,
                         .gather = settings.gather,
                         .lightScale = settings.scene.lightScale,
                         .environment = settings.scene.environment,
                         .seed = settings.seed,
                         .generation = generation};
    GatherSettings& of = inputs.gather;
    of.samples = of.candidates = of.skySamples = of.history = 0;
    of.cull = {};
    of.cull.cutoff = settings.gather.cull.cutoff;
    inputs.views.vpls = inputs.views.maps = 0;
    inputs.method.maps.resolution = 0;
    if (side.historyInputs != inputs) side.history = {};
    side.historyInputs = std::move(inputs);
    // Views of the same lights that are chosen for another camera bring the same light.
    ViewsInput lit = *views.frame.input;
    lit.camera.reset();
    lit.settings.vpls = lit.settings.maps = 0;
    const bool mayChange = side.historyLight != lit;
    side.historyLight = std::move(lit);
    const float aspect =
        static_cast<float>(surfaces.gbuffer.width) / static_cast<float>(surfaces.gbuffer.height);
    const DebugView view = settings.picture.view;
    const bool gathersInTurns =
        sequence.gathersInTurns && showsLight(view) && view != DebugView::unfiltered;
    return {.history = &side.history,
            .clipFromRoot = camera.clipFromWorld(aspect),
            .frames = settings.gather.history,
            .mayChange = mayChange,
            .keepsOwnLight = keepsOwnLight,
            .gathersInTurns = gathersInTurns};
}

void FrameRenderer::Impl::setLight(std::span<const glm::vec3> irradiance, Side& side) {
    // Background texels have candidates, too: compose.frag masks them.
    std::vector<float> texels, candidates(irradiance.size(), 1);
    texels.reserve(4 * irradiance.size());
    for (const glm::vec3& e : irradiance) texels.insert(texels.end(), {e.x, e.y, e.z, 1});
    side.irradiance = {};
    side.unfiltered = {};
    for (gl::Texture* texture : {&side.gathered.irradiance, &side.gathered.unfiltered}) {
        texture->ensure("reference irradiance", GL_TEXTURE_2D, GL_RGBA32F, surfaces.gbuffer.width,
                        surfaces.gbuffer.height);
        texture->writeFloats(4, texels);
    }
    side.gathered.candidates.ensure("reference candidates", GL_TEXTURE_2D, GL_R32F,
                                    surfaces.gbuffer.width, surfaces.gbuffer.height);
    side.gathered.candidates.writeFloats(1, candidates);
    picture.lightChanged = true;
}

bool FrameRenderer::Impl::awaitsReferences() const {
    return std::any_of(sides.begin(), sides.end(), [](const auto& side) {
        return side && side->isReference() && !side->referenceWhole;
    });
}

void FrameRenderer::Impl::noteUndecided(const GatherInputs& in, Side& side) {
    const bool asks = in.options.sample && in.mapHierarchy.aliveCount > 0;
    if (!asks) side.undecidedShare = 0;
    while (asks && side.asked.requested()) {
        const auto counts = side.asked.take<std::uint32_t>();
        if (!counts) break;
        const double could = counts->at(0);
        side.undecidedShare = could > 0 ? counts->at(1) / could : 0;
    }
    side.statistics.undecidedShare = side.undecidedShare;
}

void FrameRenderer::Impl::gather(const Settings& settings, int n, Side& side) {
    if (side.isReference()) {
        side.history = {};
        side.showsHistory = false;
        side.points = {};
        side.rememberedPoints = {};
        if (side.sets == 0) {
            side.reference = ++references;
            side.referenceWhole = false;
            const auto pixels = static_cast<std::size_t>(surfaces.gbuffer.width) *
                                static_cast<std::size_t>(surfaces.gbuffer.height);
            setLight(std::vector<glm::vec3>(pixels), side);
        }
        if (side.sets != n) {
            reflectCentres(settings, n, lightOfSet(settings, 1, surfaces.gbuffer, side), side);
            picture.lightChanged = true;
        }
        side.sets = n;
        return;
    }
    if (side.sets == n) return;
    if (n > 1 && settings.averagesPixels()) return gatherPoint(settings, n, side);
    side.sets = 0;  // in case this throws
    const SetLight from = lightOfSet(settings, n, surfaces.gbuffer, side);
    if (n == 1 && (settings.setsWanted() == 1 || settings.averagesPixels())) {
        side.irradiance = {};
        side.unfiltered = {};
    }
    if (n == 2) {  // the first set becomes the mean
        std::swap(side.irradiance, side.gathered.irradiance);
        std::swap(side.unfiltered, side.gathered.unfiltered);
    }
    GatherOptions options = gatherOptionsOf(settings, side, from.visibility, n);
    options.past = historyOf(settings, n, surfaces.camera, side);
    side.showsHistory = options.past.history && options.past.keepsOwnLight;
    const GatherInputs in = from.inputs(surfaces.gbuffer, scene->root, options, &side.asked);
    gatherPass.gather(in, profiler, side.gathered);
    noteUndecided(in, side);
    if (n > 1) {
        gatherPass.accumulate(side.gathered.irradiance, n, profiler, side.irradiance);
        gatherPass.accumulate(side.gathered.unfiltered, n, profiler, side.unfiltered);
    }
    reflectCentres(settings, n, from, side);
    side.points.points = 0;
    side.rememberedPoints = {};
    if (!settings.averagesPixels()) side.points = {};
    if (pixelPoint) pixelPoint->set = 0;
    side.sets = n;
    picture.lightChanged = true;
}

}  // namespace mv
