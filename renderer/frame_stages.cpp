#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "megaviews/core/error.h"
#include "megaviews/settings/light_placement.h"
#include "renderer/frame_state.h"
#include "renderer/passes/scene_geometry.h"
#include "shaders/shared/map_borrowing.glsl"

namespace mv {
namespace {

// Flux of all particles together, chosen so that a scene of any size is lit alike: W per square
// metre of the root cube's face.
constexpr double kParticleFluxPerFaceWPerM2 = 4.0;

// Views stay while less than this share of their importance has moved elsewhere.
constexpr double kSteadyImportance = 0.1;

}  // namespace

ViewsInput FrameRenderer::Impl::wantedViews(const Settings& settings, const FrameInput& input,
                                            const Emitters& wanted) {
    const double timeS = settings.views.particles > 0 ? input.timeS : 0;
    ViewsInput from{.settings = settings.views,
                    .lights = wanted.lights,
                    .sky = wanted.sky,
                    .lightScale = settings.scene.lightScale,
                    .gloss = settings.scene.materials == Materials::full && scene->needsFull(),
                    .seed = settings.seed,
                    .timeS = timeS,
                    .generation = generation,
                    .poseNumber = poseNumber,
                    .camera = {}};
    const bool chosen = settings.views.placement == Placement::importance &&
                        settings.views.particles == 0 && !loadedViews;
    if (!chosen) return from;
    from.camera =
        ImportanceCamera{input.camera, static_cast<float>(settings.resolution.width) /
                                           static_cast<float>(settings.resolution.height)};
    if (!input.moving || !views.frame.input || !views.frame.input->camera) return from;
    ViewsInput kept = from;
    kept.camera = views.frame.input->camera;
    if (kept != *views.frame.input || from == kept) return from;
    if (views.steadyFrom != from.camera) {
        const auto seen = [&](const ImportanceCamera& camera) {
            return importancePoints(*bvh, camera, from.seed);
        };
        if (importanceChange(*bvh, wanted, seen(*kept.camera), seen(*from.camera),
                             from.settings.bounces, from.seed) > kSteadyImportance) {
            return from;
        }
        views.steadyFrom = from.camera;
    }
    return kept;
}

Emitters FrameRenderer::Impl::emittersAsked(const Settings& settings,
                                            const FrameInput& input) const {
    if (settings.views.particles > 0) return {};
    const SceneSettings& of = settings.scene;
    return makeEmitters(*scene, *bvh, emissiveSurfaces,
                        {.timeS = input.timeS,
                         .animation = input.animation,
                         .scale = of.lightScale,
                         .placements = parseLightPlacements(of.lights, "lights"),
                         .environment = {of.environment, input.environment}},
                        views.next ? views.next->emitters.sky : lights.emitters.sky);
}

std::optional<int> FrameRenderer::Impl::makeLight(const Settings& settings, const FrameInput& input,
                                                  const Emitters& asked) {
    sequence.begin(settings, input, picture.shown, results);
    makeViews(settings, input, asked);
    makeGBuffer(settings, sequence.movingCamera(settings, input), lights.emitters);
    const std::size_t count = settings.compare ? 2 : 1;
    for (std::size_t i = 0; i < count; ++i) {
        if (!sides[i]) sides[i] = std::make_unique<Side>(results);
        const gl::OwnerScope owner(profiler, ownerOf(i));
        makeVisibility(settings, i, input);
    }
    holdPicture();
    makeSkyMaps(settings);
    cullGather(settings);
    const int sets = nextSets(settings, static_cast<int>(count));
    if (hasOwnViews(settings, sets)) {
        if (!makeSetViews(settings, input, sets)) return std::nullopt;
    } else if (!settings.averagesViews()) {
        dropSetViews();
    }
    for (std::size_t i = 0; i < count; ++i) {
        const gl::OwnerScope owner(profiler, ownerOf(i));
        gather(settings, sets, *sides[i]);
    }
    return sets;
}

void FrameRenderer::Impl::pose(const FrameInput& input) {
    gbufferPass.rest();
    if (!input.pose) return;
    const gl::PassScope scope(profiler, Stage::pose);
    input.pose();
    if (scene->poseNumber == poseNumber) return;
    gbufferPass.setPose(*scene);
    vplPass.setPose(*scene, *bvh);
    sceneOnGpu->setPose(*scene);
    const bool emits = emissiveSurfaces && emissiveSurfaces->moves;
    if (emits) emissiveSurfaces = makeEmissiveSurfaces(*scene, *bvh);
    poseNumber = scene->poseNumber;  // set last: an upload may throw
}

void FrameRenderer::Impl::forget() {
    views.forget();
    surfaces.inputs.reset();
    lights.skyMapsInputs.reset();
}

void FrameRenderer::Impl::makeViews(const Settings& settings, const FrameInput& input,
                                    const Emitters& wanted) {
    std::optional<ViewsInput> made;  // becomes views.frame.input once the tree is built
    if (views.next) {
        views.spare = std::exchange(views.frame.views, std::move(views.next->views));
        made = std::move(views.next->input);
        lights.emitters = std::move(views.next->emitters);
        views.next.reset();
    } else {
        ViewsInput from = wantedViews(settings, input, wanted);
        if (views.frame.input == from) return;
        // Where results come late, other views of the same scene may come with the next frame.
        const bool mayLag = results == gl::Results::late && views.frame.input &&
                            views.frame.input->generation == generation;
        if (mayLag) return;
        views.frame.input.reset();
        traceViews(settings, from, input, wanted, views.frame, views.frame.views);
        made = std::move(from);
        lights.emitters = wanted;
    }
    views.frame.input.reset();
    views.steadyFrom.reset();  // it was about the replaced views
    views.frame.hierarchyPass.build({.levels = made->settings.octreeDepth}, profiler,
                                    views.frame.tree);
    views.frame.input = std::move(made);
    views.frame.version = ++views.versions;
}

void FrameRenderer::Impl::traceViews(const Settings& settings, const ViewsInput& from,
                                     const FrameInput& input, const Emitters& emitters,
                                     TracedViews& with, GpuViews& out) {
    const ViewSettings& wanted = from.settings;
    const double edge = scene->root.edge;
    const double powerW = kParticleFluxPerFaceWPerM2 * edge * edge * from.lightScale;
    const auto vpls = static_cast<std::uint64_t>(wanted.vpls);
    if (loadedViews) {
        upload(*loadedViews, out);
    } else if (wanted.particles > 0) {
        const gl::PassScope scope(profiler, Stage::particles);
        upload(makeParticles(*scene, static_cast<std::uint64_t>(wanted.particles), from.seed,
                             input.timeS, powerW),
               out);
    } else if (wanted.placement == Placement::random) {
        const gl::PassScope scope(profiler, Stage::traceViews);
        upload(makeRandomViews(sceneBounds(*scene), vpls, from.seed, powerW), out);
    } else {
        if (from.camera) {
            chooseViews(from, emitters, out);
        } else {
            vplPass.trace(emitters, {vpls, wanted.bounces, from.seed, from.gloss}, nullptr,
                          profiler, out);
        }
    }
    with.hierarchyPass.sort(out, profiler);
    with.hierarchyPass.place({.levels = wanted.octreeDepth}, profiler);
    beginMapViews(settings, from, with);
}

std::uint64_t FrameRenderer::Impl::requestedViews(const ViewSettings& settings) const {
    if (loadedViews) return loadedViews->views.size();
    return static_cast<std::uint64_t>(settings.particles > 0 ? settings.particles : settings.vpls);
}

bool FrameRenderer::Impl::borrowsMaps(const Settings& settings,
                                      const MethodSettings& method) const {
    const GatherSettings& gather = settings.gather;
    const bool corrected = gather.samples > 0 && gather.mapCheck > 0 &&
                           gather.undecided == Undecided::rays &&
                           hasRule(method.rules, kRuleFootprint);
    const bool fused =
        !testsPairs(method.method) || (method.pairs.fusion && method.pairs.cut == Cut::basic);
    const auto maps = static_cast<std::uint64_t>(settings.views.maps);
    const bool some = maps > 0 && maps < requestedViews(settings.views);
    return some && makesMaps(method.method) && corrected && fused;
}

void FrameRenderer::Impl::beginMapViews(const Settings& settings, const ViewsInput& from,
                                        TracedViews& with) {
    with.mapViews.chosen = false;
    const auto wanted = std::span(settings.side).first(settings.sideCount());
    const bool borrows = std::any_of(wanted.begin(), wanted.end(), [&](const auto& method) {
        return borrowsMaps(settings, method);
    });
    if (borrows) chooseMapViews(from, with);
}

void FrameRenderer::Impl::chooseMapViews(const ViewsInput& from, TracedViews& with) {
    MapViews& out = with.mapViews;
    out.chosen = true;
    with.hierarchyPass.chooseForMaps(static_cast<std::uint32_t>(from.settings.maps), profiler,
                                     out.subset.views);
    out.pass.sort(out.subset.views, profiler);
    out.pass.place({.levels = from.settings.octreeDepth}, profiler);
}

FrameRenderer::Impl::MapTree FrameRenderer::Impl::treeOfMaps(const Settings& settings,
                                                             const MethodSettings& method,
                                                             TracedViews& of) {
    const ViewsInput& from = *of.input;
    MapViews& out = of.mapViews;
    const std::uint32_t count = of.tree.aliveCount;
    if (!borrowsMaps(settings, method) || from.settings.maps >= count ||
        count >= kMaxBorrowingViews) {
        return {of.tree, of.hierarchyPass, of.version};
    }
    if (out.ofViews != of.version) {
        const gl::OwnerScope owner(profiler, kBothSides);
        if (!out.chosen) chooseMapViews(from, of);
        out.chosen = false;
        out.pass.build({.levels = from.settings.octreeDepth}, profiler, out.subset.tree);
        of.hierarchyPass.borrowMaps(of.tree, profiler, out.subset);
        out.ofViews = of.version;
        out.version = ++views.versions;
    }
    return {out.subset.tree, out.pass, out.version};
}

void FrameRenderer::Impl::chooseViews(const ViewsInput& from, const Emitters& emitters,
                                      GpuViews& out) {
    const auto wanted = static_cast<std::uint64_t>(from.settings.vpls);
    ViewGuide guide;
    {
        const gl::PassScope scope(profiler, Stage::guideViews);
        guide = makeViewGuide(*bvh, emitters, *from.camera, from.settings.bounces, from.seed);
    }
    vplPass.trace(emitters,
                  {candidateCount(guide, wanted), from.settings.bounces, from.seed, from.gloss},
                  &guide, profiler, out);
    thinViewsPass.thin(guide.importance, wanted, from.seed, profiler, out);
}

void FrameRenderer::Impl::makeGBuffer(const Settings& settings, const FrameCamera& camera,
                                      const Emitters& emitters) {
    const bool drawParticles = settings.views.particles > 0 && !loadedViews;
    lights.sky.set(emitters.sky);
    const GBufferInputs inputs{.camera = camera,
                               .resolution = settings.resolution,
                               .generation = generation,
                               .pose = poseNumber,
                               .particles = drawParticles ? views.frame.version : 0,
                               .sky = emitters.sky,
                               .materials = settings.scene.materials};
    if (surfaces.inputs != inputs) {
        surfaces.inputs.reset();
        drawGBuffer(settings, camera, surfaces.gbuffer);
        surfaces.inputs = inputs;
        surfaces.camera = camera;
        ++surfaces.version;
        picture.lightChanged = true;
    }
    // Also where the G-buffer is kept: then nothing has moved.
    surfaces.gbuffer.largestStep = gbufferPass.geometry().largestStep();
    DirectInputs lit{emitters.lights, surfaces.version};
    if (surfaces.directInputs == lit) return;
    lights.punctual.set(emitters.lights);
    directPass.render(lights.punctual, scene->root, sceneOnGpu->triangles, surfaces.gbuffer,
                      profiler, surfaces.direct);
    surfaces.directInputs = std::move(lit);
    picture.lightChanged = true;
}

void FrameRenderer::Impl::drawGBuffer(const Settings& settings, const FrameCamera& camera,
                                      GBuffer& out) {
    const int width = settings.resolution.width, height = settings.resolution.height;
    try {
        gbufferPass.render(camera, width, height, settings.scene.materials, profiler, out);
    } catch (const Error& error) {
        if (error.code != ExitCode::impossible) throw;
        const auto half = [](int n) { return std::to_string(std::max(n / 2, 1)); };
        throw Error(error.code, std::string(error.what()) + "; --resolution " + half(width) + "x" +
                                    half(height) + " needs a quarter of it");
    }
    if (settings.views.particles > 0 && !loadedViews) {
        gbufferPass.drawParticles(views.frame.views, scene->root, camera, profiler, out);
    }
    if (lights.sky.sky()) gbufferPass.drawSky(lights.sky, camera, profiler, out);
}

void FrameRenderer::Impl::makeVisibility(const Settings& settings, std::size_t index,
                                         const FrameInput& input) {
    Side& side = *sides[index];
    const MethodSettings& wanted = settings.side.at(index);
    const bool same = side.settings.method == wanted.method;
    if (!same || (!side.visibility && !mv::isReference(wanted.method))) {
        side.visibility.reset();
        side.statistics = {};
        ++side.mapsVersion;
        if (!mv::isReference(wanted.method)) {
            side.visibility = mv::makeVisibility(wanted.method, results);
        }
    }
    side.settings = wanted;
    side.unproved = false;
    if (!side.visibility) {
        side.statistics.viewHierarchyBytes = views.frame.tree.bytes();
        return;
    }
    const std::uint64_t before = side.visibility->version();
    // The first picture is waited for, since there is none to show in its place.
    const bool wait = !picture.shown && !late.held;
    const MapTree from = treeOfMaps(settings, wanted, views.frame);
    side.visibility->build({.scene = *sceneOnGpu,
                            .views = from.tree,
                            .viewHierarchies = from.pass,
                            .viewDepth = views.frame.input->settings.octreeDepth,
                            .version = from.version,
                            .seed = settings.seed,
                            .countLevels = input.countLevels,
                            .wait = wait,
                            .refineLaggingMaps = input.refineLaggingMaps},
                           wanted, profiler, side.statistics);
    side.unproved = side.visibility->proof(side.statistics) == Proof::underWay;
    if (side.visibility->version() != before) ++side.mapsVersion;
}

void FrameRenderer::Impl::makeSkyMaps(const Settings& settings) {
    const GatherSettings& gather = settings.gather;
    if (!lights.sky.sky() || gather.skyViews == 0) {
        lights.skyMaps.reset();
        return;
    }
    const std::uint64_t budget = bytesOf(settings.side[0].maps);
    const SkyMapsInputs inputs{.sky = lights.emitters.sky,
                               .generation = generation,
                               .pose = poseNumber,
                               .views = gather.skyViews,
                               .resolution = gather.skyMapRes,
                               .budget = budget};
    if (lights.skyMaps && lights.skyMapsInputs == inputs) return;
    lights.skyMapsInputs.reset();
    if (!lights.skyMaps) lights.skyMaps = std::make_unique<SkyMaps>();
    lights.skyMaps->make(sceneOnGpu->triangles, *bvh, *lights.emitters.sky, gather.skyViews,
                         gather.skyMapRes, budget, profiler);
    lights.skyMapsInputs = inputs;
}

}  // namespace mv
