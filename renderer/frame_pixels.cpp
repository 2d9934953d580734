// Still pictures that sample more than the pixels' centres: each further set of gather samples has
// a point of its own in every pixel, which is drawn, lit and gathered, and averaged as radiance.
// The mean's filter is the pixel itself, a box. G-buffer and light of the centres stay as they are,
// for everything that is read back or measured. Views and maps serve all points.

#include <cmath>
#include <utility>

#include "renderer/frame_state.h"

namespace mv {
namespace {

// A mean of displayed values belongs to one exposure, which is a multiple of this step. It stays
// while the exposure in use rounds to it: the user may turn the exposure a little, and the eye sees
// no difference.
constexpr int kExposureStepEv = 2;
// The mean is made for a curve near ACES' (compressLight()); AgX is near 1.5x / (1 + 1.5x).
constexpr double kAgxShiftEv = -1.4;

}  // namespace

std::uint64_t PixelPoint::bytes() const {
    return gbuffer.bytes() + direct.bytes() + radiance.bytes() + gathered.bytes() +
           reflected.bytes();
}

int ExposureState::pointsEv(const Settings& settings) const {
    const double ev = settings.display.exposureEv.value_or(usedEv) +
                      (settings.display.toneMap == ToneMap::agx ? kAgxShiftEv : 0);
    return kExposureStepEv * static_cast<int>(std::lround(ev / kExposureStepEv));
}

void FrameRenderer::Impl::drawPoint(const Settings& settings, int n) {
    if (!pixelPoint) pixelPoint = std::make_unique<PixelPoint>();
    PixelPoint& p = *pixelPoint;
    FrameCamera camera = surfaces.camera;
    const glm::vec2 pixels(settings.resolution.width, settings.resolution.height);
    camera.offset += 2.0f * pixelOffset(static_cast<std::uint32_t>(n - 1)) / pixels;
    if (p.set == n && p.camera == camera) return;
    p.set = 0;
    drawGBuffer(settings, camera, p.gbuffer);
    directPass.render(lights.punctual, scene->root, sceneOnGpu->triangles, p.gbuffer, profiler,
                      p.direct);
    p.camera = camera;
    p.set = n;
}

void FrameRenderer::Impl::gatherPoint(const Settings& settings, int n, Side& side) {
    const DebugView view = settings.picture.view;
    const int ev = exposure.pointsEv(settings);
    {
        const gl::OwnerScope owner(profiler, kBothSides);  // both sides sample the same points
        drawPoint(settings, n);
    }
    PixelPoint& p = *pixelPoint;
    const SetLight from = lightOfSet(settings, n, p.gbuffer, side);
    GatherOptions options = gatherOptionsOf(settings, side, from.visibility, n);
    options.past = historyOf(settings, n, p.camera, side);
    const GatherInputs in = from.inputs(p.gbuffer, scene->root, options, &side.asked);
    gatherPass.gather(in, profiler, p.gathered);
    noteUndecided(in, side);
    if (p.gbuffer.reflects) {
        reflect(settings, n, p.gbuffer, side, from, p.reflected);
    } else {
        p.reflected = {};
    }

    // Skips points that a frame averaged before it was given up. The centres are the first point.
    const auto average = [&](const gl::Texture& of, int point, PixelMeans& means) {
        if (means.points < point) averagePixelsPass.render(of, ev, profiler, means);
    };
    const bool remembers = options.past.history && options.past.keepsOwnLight;
    if (side.points.points == 0) {
        ComposePass::Input centres = lightOf(side);
        if (side.showsHistory) {
            composePass.render(centres, view, profiler, p.radiance);
            average(p.radiance, 1, side.rememberedPoints);
        }
        centres.irradiance = &side.gathered.irradiance;
        composePass.render(centres, view, profiler, p.radiance);
        average(p.radiance, 1, side.points);
    }
    ComposePass::Input light{.gbuffer = &p.gbuffer,
                             .direct = &p.direct,
                             .irradiance = &p.gathered.irradiance,
                             .unfilteredIrradiance = &p.gathered.unfiltered,
                             .candidates = &p.gathered.candidates,
                             .reflected = &p.reflected,
                             .emissionScale = lights.emitters.lightScale};
    composePass.render(light, view, profiler, p.radiance);
    average(p.radiance, n, side.points);
    if (remembers && side.rememberedPoints.points > 0) {
        light.irradiance = &p.gathered.remembered;
        composePass.render(light, view, profiler, p.radiance);
        average(p.radiance, n, side.rememberedPoints);
    } else {
        side.rememberedPoints = {};
    }
    side.sets = n;
    picture.pointsChanged = true;
}

}  // namespace mv
