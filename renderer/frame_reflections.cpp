// What glossy surfaces reflect, and what is seen through clear ones. The surfaces that their rays
// meet are a second and a third G-buffer, which are lit as the first: directly, and through the
// side's own views and maps. Each set of samples has rays of its own. The light of references is
// known for the first G-buffer alone: theirs are lit by the views, with shadow rays.

#include "renderer/frame_state.h"

namespace mv {
namespace {

// Surfaces that the pixels of a tile reflect lie far apart: nearly all views may light some of
// them, and a finer search for those that do not takes longer than it saves. Coarser nodes than
// these miss surfaces near the mirror, which shows as rows of bright dashes (in the bathroom). A
// second look does not pay either: surfaces that are hardly seen get so few samples that a fifth of
// the pixels have none that is lit.
constexpr int kCullLevel = 4;
GatherOptions ofReflected(GatherOptions options) {
    options.cull.level = std::min(options.cull.level, kCullLevel);
    options.secondLook = false;
    return options;
}

}  // namespace

std::uint64_t Reflections::bytes() const {
    return gatherPass.bytes() + met.bytes() + direct.bytes() + radiance.bytes() +
           records.records.bytes() + gathered.bytes();
}

std::uint64_t ReflectionStage::bytes() const {
    std::uint64_t sum = pass.bytes() + ofSet.bytes();
    for (const auto& r : met) sum += r ? r->bytes() : 0;
    return sum;
}

Reflections& FrameRenderer::Impl::traceReflections(Follow what, const Settings& settings, int n,
                                                   const GBuffer& of, const SetLight& light) {
    std::unique_ptr<Reflections>& own = reflections.met[static_cast<std::size_t>(what)];
    if (!own) own = std::make_unique<Reflections>();
    Reflections& r = *own;
    const std::uint32_t before = sequence.ownSamples ? sequence.setsBefore : 0;
    const ReflectionInputs inputs{.drawing = of.drawing,
                                  .set = n,
                                  .setsBefore = before,
                                  .seed = settings.seed,
                                  .cull = culled.version,
                                  .views = light.viewsVersion,
                                  .lights = lights.emitters.lights,
                                  .lightScale = lights.emitters.lightScale};
    if (r.inputs == inputs) return r;
    r.inputs.reset();
    const gl::OwnerScope owner(profiler, kBothSides);  // both sides have the same rays
    const auto set = static_cast<std::uint32_t>(n - 1) + before;
    reflections.pass.trace(what, of,
                           {.triangles = sceneOnGpu->triangles,
                            .sky = lights.sky.sky() ? &lights.sky : nullptr,
                            .lamps = lights.emitters.surfaces,
                            .lampScale = lights.emitters.lightScale,
                            .rootEdge = scene->root.edge},
                           settings.seed, set, profiler, r.met);
    directPass.render(lights.punctual, scene->root, sceneOnGpu->triangles, r.met, profiler,
                      r.direct);
    r.gatherPass.prepare(r.met, light.cullTree, ofReflected(gatherOptions(settings)), profiler);
    r.inputs = inputs;
    return r;
}

void FrameRenderer::Impl::reflect(const Settings& settings, int n, const GBuffer& of,
                                  const Side& side, const SetLight& light, gl::Texture& out) {
    reflect(Follow::gloss, settings, n, of, side, light, out);
    if (of.clear) reflect(Follow::clear, settings, n, of, side, light, out);
}

void FrameRenderer::Impl::reflect(Follow what, const Settings& settings, int n, const GBuffer& of,
                                  const Side& side, const SetLight& light, gl::Texture& out) {
    Reflections& r = traceReflections(what, settings, n, of, light);
    GatherOptions options = ofReflected(gatherOptionsOf(settings, side, light.visibility, n));
    if (options.samples > 0) options.seenShares = options.sky.seenShares = &r.met.gloss;
    const GatherRecords* records = &light.records;
    if (!light.visibility) {
        r.gatherPass.record(light.cullTree, light.maps(), nullptr, profiler, r.records);
        records = &r.records;
    }
    r.gatherPass.gather({.gbuffer = r.met,
                         .root = scene->root,
                         .mapHierarchy = light.gatherHierarchy(),
                         .maps = light.maps(),
                         .records = *records,
                         .options = options},
                        profiler, r.gathered);
    composePass.render(
        {.gbuffer = &r.met, .direct = &r.direct, .irradiance = &r.gathered.irradiance},
        DebugView::final, profiler, r.radiance);
    reflections.pass.reflect(what, of, r.met, r.radiance, settings.gather.filter, profiler, out);
}

void FrameRenderer::Impl::reflectCentres(const Settings& settings, int n, const SetLight& light,
                                         Side& side) {
    if (!surfaces.gbuffer.reflects) {
        side.reflected = {};
        return;
    }
    if (n == 1) return reflect(settings, n, surfaces.gbuffer, side, light, side.reflected);
    reflect(settings, n, surfaces.gbuffer, side, light, reflections.ofSet);
    gatherPass.accumulate(reflections.ofSet, n, profiler, side.reflected);
}

}  // namespace mv
