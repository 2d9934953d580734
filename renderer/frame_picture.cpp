#include <algorithm>
#include <cmath>

#include <spdlog/spdlog.h>

#include "renderer/frame_state.h"
#include "renderer/gl/workarounds.h"
#include "renderer/passes/fit_exposure.h"
#include "shaders/shared/colour_map.glsl"

namespace mv {
namespace {

// A fitted exposure stays while another fit differs by no more than this.
constexpr double kAdaptsFromEv = 2;

}  // namespace

void FrameRenderer::Impl::makePicture(const Settings& settings, const FrameInput& input) {
    sideCount = settings.compare ? 2 : 1;
    if (sideCount == 1) sides[1].reset();
    const bool composed = picture.mustCompose(settings);
    const bool changed = composed || picture.pointsChanged;
    if (changed) picture.shown.reset();  // in case this throws
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        composeSide(settings, i, composed, changed);
    }
    if (exposure.fittedEarly && !awaitsReferences()) exposure.fittedEv.reset();
    if (!settings.display.exposureEv &&
        (!exposure.fittedEv || exposure.fittedFor != settings.display.toneMap ||
         input.adaptExposure)) {
        fitExposure(settings, kAdaptsFromEv);
    }
    exposure.usedEv = settings.display.exposureEv.value_or(exposure.fittedEv.value_or(0));
    const bool mustShow = picture.shown != settings || picture.shownEv != exposure.usedEv;
    if (mustShow) show(settings);
    const bool asksFlip = sideCount == 2 && settings.display.difference == Difference::flip;
    if (asksFlip && mustShow) ++picture.flipVersion;
    picture.awaitsFlip = asksFlip && (mustShow || picture.awaitsFlip);
}

void FrameRenderer::Impl::composeSide(const Settings& settings, std::size_t index, bool composed,
                                      bool changed) {
    Side& side = *sides[index];
    const gl::OwnerScope owner(profiler, ownerOf(index));
    if (composed) compose(settings, settings.picture.view, side);
    if (!settings.smoothsMotion()) {
        side.temporal = {};
    } else if (sequence.movingFrames == 0) {
        side.temporal.means.points = 0;  // the next motion begins a new mean
    } else if (sequence.ownSamples && !sequence.repeats) {
        temporalPass.render(side.radiance, surfaces.gbuffer, surfaces.camera,
                            exposure.pointsEv(settings), profiler, side.temporal);
    }
    side.showsPoints =
        side.temporal.means.points > 0 || (settings.averagesPixels() && side.averagesPixels());
    if (changed) badPixelsPass.count(side.shownRadiance(), side.badCounts);
    while (const auto bad = BadPixelsPass::take(side.badCounts)) side.badPixels = *bad;
}

void FrameRenderer::Impl::composeSharing(const Settings& settings, Side& side) {
    const bool picks = settings.picture.view == DebugView::shared;
    InspectSettings picked;
    if (picks) {
        picked.pickA = settings.inspect.pickA;
        picked.pickB = settings.inspect.pickB;
    }
    const SharingInputs inputs{.view = settings.picture.view,
                               .picked = picked,
                               .seed = settings.seed,
                               .maps = side.mapsVersion,
                               .gbuffer = surfaces.version};
    if (side.sharingInputs == inputs) return;
    const bool hasPairs = testsPairs(side.settings.method);
    const uint rules = hasPairs ? side.settings.rules : kCorrectedRules;
    const SharingInput input{.gbuffer = surfaces.gbuffer,
                             .scene = sceneOnGpu->nodes(rules),
                             .views = mapHierarchy(side),
                             .rules = rules,
                             .mapRes = side.settings.maps.resolution,
                             .present = hasPairs,
                             .pairSize = static_cast<float>(side.settings.pairs.size)};
    side.statistics.meanSharing = 0;
    if (picks) {
        sharingPass.shared(input, surfaces.camera, settings.inspect.pickA.value_or(-1),
                           settings.inspect.pickB.value_or(-1), profiler, side.radiance);
    } else {
        const int grid = gl::isOn(gl::Workaround::sparseSharing) ? 2 : 1;
        sharingPass.sharing(input, settings.seed, grid, profiler, side.radiance);
        side.statistics.meanSharing = SharingPass::meanSharing(side.radiance);
    }
    side.sharingInputs = inputs;
}

void FrameRenderer::Impl::compose(const Settings& settings, DebugView view, Side& side) {
    if (view == DebugView::sharing || view == DebugView::shared) {
        composeSharing(settings, side);
        return;
    }
    side.sharingInputs.reset();
    side.statistics.meanSharing = 0;
    composeLight(view, side, side.radiance);
}

ComposePass::Input FrameRenderer::Impl::lightOf(const Side& side) const {
    ComposePass::Input light;
    light.gbuffer = &surfaces.gbuffer;
    light.direct = &surfaces.direct;
    light.irradiance = &side.shownIrradiance();
    light.unfilteredIrradiance = &side.shownUnfiltered();
    light.candidates = &side.gathered.candidates;
    light.reflected = &side.reflected;
    light.emissionScale = lights.emitters.lightScale;
    return light;
}

void FrameRenderer::Impl::composeLight(DebugView view, const Side& side, gl::Texture& out) {
    composePass.render(lightOf(side), view, profiler, out);
}

void FrameRenderer::Impl::fitExposure(const Settings& settings, double toleranceEv) {
    const Side& side = *sides[0];
    gl::Texture light;
    const bool isFinal = settings.picture.view == DebugView::final;
    if (!isFinal) composeLight(DebugView::final, side, light);
    const std::optional<double> ev = mv::fitExposure(isFinal ? side.radiance : light,
                                                     surfaces.gbuffer, settings.display.toneMap);
    if (exposure.fittedFor == settings.display.toneMap && exposure.fittedEv &&
        (!ev || std::abs(*ev - *exposure.fittedEv) <= toleranceEv)) {
        return;
    }
    exposure.fittedEv = ev.value_or(0);
    exposure.fittedFor = settings.display.toneMap;
    exposure.fittedEarly = awaitsReferences();
    if (exposure.fittedEarly) return;
    spdlog::info("exposure fitted: {:+.2f} EV", *exposure.fittedEv);
    if (isDark(ev, surfaces.gbuffer)) spdlog::warn("next to no light reaches what is in sight");
}

void FrameRenderer::Impl::show(const Settings& settings) {
    picture.shown.reset();
    picture.differenceRange = 0;
    if (sideCount == 2 && settings.display.difference != Difference::off &&
        settings.display.difference != Difference::flip) {
        if (!differencePass) differencePass = std::make_unique<DifferencePass>();
        picture.differenceRange =
            differencePass->render(sides[0]->radiance, sides[1]->radiance,
                                   settings.display.difference, settings.display.differenceRange,
                                   exposure.usedEv, profiler, picture.radiance, picture.display);
    } else {
        for (const auto& side : sides) {
            if (!side) continue;
            const TonemapPass::Options options{exposure.usedEv, settings.display.toneMap,
                                               settings.picture.view};
            if (side->showsPoints) {
                tonemapPass.render(side->shownPoints(), options, profiler, side->display);
            } else {
                tonemapPass.render(side->radiance, options, profiler, side->display);
            }
        }
        if (sideCount == 2) joinSides(settings);
    }
    picture.lightChanged = picture.pointsChanged = false;
    overlay.current = false;
    picture.shown = settings;
    picture.shownEv = exposure.usedEv;
}

// Shows FLIP's errors in colours. A pixel that was not measured is grey, as in the file of --diff.
void FrameRenderer::Impl::showFlip(std::span<const float> errors) {
    picture.differenceRange = picture.shown->display.differenceRange.value_or(1);
    std::vector<std::uint8_t> colours;
    std::vector<float> values;
    for (const float error : errors) {
        const bool isBad = std::isnan(error);
        const glm::vec3 colour =
            isBad ? glm::vec3(0.5f) : viridis(error / static_cast<float>(picture.differenceRange));
        for (int c = 0; c < 3; ++c) {
            colours.push_back(static_cast<std::uint8_t>(colour[c] * 255.0f + 0.5f));
            values.push_back(isBad ? 0 : error);
        }
        colours.push_back(255);
        values.push_back(1);
    }
    picture.display.writeBytes(4, colours);
    picture.radiance.writeFloats(4, values);
    overlay.current = false;
}

void FrameRenderer::Impl::joinSides(const Settings& settings) {
    const int w = settings.resolution.width, h = settings.resolution.height;
    const int x = std::clamp(static_cast<int>(settings.display.split * w + 0.5), 0, w);
    picture.display.ensure("display, both sides", GL_TEXTURE_2D, GL_RGBA8, w, h);
    picture.radiance.ensure("radiance, both sides", GL_TEXTURE_2D, GL_RGBA32F, w, h);
    picture.display.copy(sides[0]->display, 0, x);
    picture.display.copy(sides[1]->display, x, w - x);
    picture.radiance.copy(sides[0]->shownRadiance(), 0, x);
    picture.radiance.copy(sides[1]->shownRadiance(), x, w - x);
}

}  // namespace mv
