// What glossy surfaces reflect. The surfaces that their rays meet are a second G-buffer, which is
// lit as the first: directly, and through the side's own views and maps. Each set of samples has
// rays of its own. References, whose light is of the first G-buffer alone, are lit by views and
// rays there.

#include "renderer/frame_state.h"

namespace mv {

std::uint64_t Reflections::bytes() const {
    return pass.bytes() + gatherPass.bytes() + met.bytes() + direct.bytes() + radiance.bytes() +
           set.bytes() + records.records.bytes() + gathered.irradiance.bytes() +
           gathered.unfiltered.bytes() + gathered.candidates.bytes();
}

void FrameRenderer::Impl::traceReflections(const Settings& settings, int n, const GBuffer& of,
                                           const FrameCamera& camera) {
    if (!reflections) reflections = std::make_unique<Reflections>(results);
    Reflections& r = *reflections;
    const std::uint32_t before = ownSamples ? setsBefore : 0;
    const std::tuple inputs{&of, n, before, settings.seed, cullVersion, litBy.lights};
    if (r.inputs == inputs) return;
    r.inputs.forget();
    const int owner = std::exchange(profiler.owner, 0);  // both sides have the same rays
    const auto set = static_cast<std::uint32_t>(n - 1) + before;
    r.pass.trace(of, camera, sceneOnGpu->triangles, sky.sky() ? &sky : nullptr, settings.seed, set,
                 profiler, r.met);
    directPass.render(litBy.lights, scene->root, sceneOnGpu->triangles, r.met, nullptr, profiler,
                      r.direct);
    r.gatherPass.prepare(r.met, cullTree, gatherOptions(settings), profiler);
    profiler.owner = owner;
    r.inputs = inputs;
}

void FrameRenderer::Impl::reflect(const Settings& settings, int n, const GBuffer& of,
                                  const FrameCamera& camera, const Side& side, gl::Texture& out) {
    traceReflections(settings, n, of, camera);
    Reflections& r = *reflections;
    GatherOptions options = gatherOptionsOf(settings, side, n);
    if (options.scale == 1 && options.samples > 0) {
        options.seenShares = options.sky.seenShares = &r.met.gloss;
    }
    static const GpuViewMaps kNoMaps;
    const GatherRecords* records = &side.records;
    if (!side.visibility) {
        r.gatherPass.record(cullTree, kNoMaps, profiler, r.records);
        records = &r.records;
    }
    r.gatherPass.gather(r.met, scene->root, mapHierarchy(side),
                        side.visibility ? side.visibility->maps() : kNoMaps, *records, options,
                        profiler, r.gathered);
    tonemapPass.compose(
        {.gbuffer = &r.met, .direct = &r.direct, .irradiance = &r.gathered.irradiance},
        DebugView::final, profiler, r.radiance);
    r.pass.reflect(of, r.met, r.radiance, settings.gather.filter, profiler, out);
}

void FrameRenderer::Impl::reflectCentres(const Settings& settings, int n, Side& side) {
    if (!gbuffer.gloss) {
        side.reflected = {};
        return;
    }
    if (n == 1) return reflect(settings, n, gbuffer, gbufferCamera, side, side.reflected);
    reflect(settings, n, gbuffer, gbufferCamera, side, reflections->set);
    gatherPass.accumulate(reflections->set, n, profiler, side.reflected);
}

}  // namespace mv
