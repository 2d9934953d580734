#include <algorithm>
#include <limits>
#include <utility>

#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_state.h"
#include "renderer/passes/scene_hierarchy_upload.h"

namespace mv {
namespace {

// Flux of all particles together, chosen so that a scene of any size is lit alike: W per square
// metre of the root cube's face.
constexpr double kParticleFluxPerFaceWPerM2 = 4.0;

// The surface's points are the same whatever views are drawn.
constexpr std::uint32_t kSurfacePointsSeed = 1;

// Both sides take the same culled views and samples, so these come from the left side.
GatherOptions gatherOptions(const Settings& settings) {
    GatherOptions options;
    options.samples = settings.gather.samples;
    options.scale = settings.gather.cull.scale;
    options.cullLevel = settings.gather.cull.level;
    options.cutoff = static_cast<float>(settings.gather.cull.cutoff);
    options.clampDistance = static_cast<float>(settings.gather.clampDistance);
    options.bias = static_cast<float>(settings.gather.bias);
    options.filter = settings.gather.filter;
    options.seed = settings.seed;
    options.measure = false;
    return options;
}

// What the settings say of the maps; a setting that the method does not use changes nothing.
MapsKey mapsKey(const Settings& s, bool countLevels, std::uint64_t viewsVersion) {
    MapsKey key;
    key.method = s.side[0].method;
    key.viewRes = s.side[0].maps.resolution;
    key.gpuMemoryMiB = s.side[0].maps.memoryMiB;
    key.viewsVersion = viewsVersion;
    key.countLevels = true;  // where there is nothing to count
    if (s.side[0].method == Method::ism) {
        key.ismPoints = s.side[0].ism.points;
        key.ismPool = s.side[0].ism.pool;
        key.seed = s.seed;
    }
    if (!testsPairs(s.side[0].method)) return key;
    key.rules = s.side[0].rules;
    key.traversal = s.side[0].pairs.traversal;
    key.fusion = s.side[0].pairs.fusion;
    key.holeFill = s.side[0].pairs.holeFill;
    key.pairSize = s.side[0].pairs.size;
    key.queueMemoryMiB = s.side[0].pairs.queueMemoryMiB;
    key.countLevels = countLevels;
    return key;
}

}  // namespace

ViewsKey viewsKeyOf(const Settings& settings, const FrameInput& input, const Emitters& emitters,
                    std::uint64_t generation) {
    ViewsKey key;
    key.lights = {emitters.lights};
    key.vpls = settings.views.vpls;
    key.particles = settings.views.particles;
    key.bounces = settings.views.bounces;
    key.placement = settings.views.placement;
    key.seed = settings.seed;
    key.timeS = settings.views.particles > 0 ? input.timeS : 0;
    key.lightScale = settings.scene.lightScale;
    key.generation = generation;
    key.viewDepth = settings.views.octreeDepth;
    return key;
}

void FrameRenderer::Impl::forget() {
    viewsKey.reset();  // and with the views their maps
    next.reset();
    gbufferKey.reset();
}

GpuSceneHierarchy& FrameRenderer::Impl::sceneNodes(Rules rules) {
    auto& slot = sceneHierarchies[rules == Rules::corrected ? 1 : 0];
    if (!slot) slot = uploadSceneHierarchy(*hierarchy, rules);
    return *slot;
}

const GpuSurfacePoints& FrameRenderer::Impl::surfacePointsFor(const Settings& settings) {
    const auto count = static_cast<std::uint32_t>(
        std::max(settings.side[0].ism.pool, settings.side[0].ism.points));
    if (!surfacePoints || surfacePoints->requested != count) {
        surfacePoints.reset();
        surfacePoints = upload(makeSurfacePoints(*bvh, count, kSurfacePointsSeed));
        surfacePoints->requested = count;
    }
    return *surfacePoints;
}

void FrameRenderer::Impl::makeViews(const Settings& settings, const FrameInput& input,
                                    const Emitters& wanted) {
    if (next) {
        spareViews = std::exchange(views, std::move(next->views));
        viewsKey = std::move(next->key);
        litBy = std::move(next->emitters);
        next.reset();
    } else {
        ViewsKey key = viewsKeyOf(settings, input, wanted, generation);
        if (viewsKey == key) return;
        // Of the same scene they may come with the next frame.
        const bool mayLag =
            results == gl::Results::late && viewsKey && viewsKey->generation == generation;
        if (mayLag) return;
        traceViews(key, settings, input, wanted, views);
        viewsKey = std::move(key);
        litBy = wanted;
    }
    viewHierarchyPass.build({viewsKey->viewDepth, false, false}, profiler, cullTree);
    ++viewsVersion;
}

void FrameRenderer::Impl::traceViews(const ViewsKey& key, const Settings& settings,
                                     const FrameInput& input, const Emitters& from, GpuViews& out) {
    const double edge = scene->root.edge;
    const double powerW = kParticleFluxPerFaceWPerM2 * edge * edge * settings.scene.lightScale;
    if (loadedViews) {
        upload(*loadedViews, out);
    } else if (settings.views.particles > 0) {
        const gl::PassScope scope(profiler, Stage::particles);
        upload(makeParticles(*scene, static_cast<std::uint64_t>(settings.views.particles),
                             settings.seed, input.timeS, powerW),
               out);
    } else if (settings.views.placement == Placement::random) {
        const gl::PassScope scope(profiler, Stage::traceViews);
        upload(makeRandomViews(sceneBounds(*scene), static_cast<std::uint64_t>(settings.views.vpls),
                               settings.seed, powerW),
               out);
    } else {
        vplPass.trace(from,
                      {static_cast<std::uint64_t>(settings.views.vpls), settings.views.bounces,
                       settings.seed},
                      profiler, out);
    }
    viewHierarchyPass.sort(out, profiler);
    viewHierarchyPass.place({key.viewDepth, false, false}, profiler);
}

void FrameRenderer::Impl::makeGBuffer(const Settings& settings, const FrameInput& input,
                                      const Emitters& emitters) {
    const bool drawParticles = settings.views.particles > 0 && !loadedViews;
    const GBufferKey key{input.camera, settings.picture.width, settings.picture.height, generation,
                         drawParticles ? viewsVersion : 0};
    if (gbufferKey != key) {
        gbufferKey.reset();
        gbufferPass.render(input.camera, settings.picture.width, settings.picture.height, profiler,
                           gbuffer);
        if (drawParticles) {
            gbufferPass.drawParticles(views, scene->root, input.camera, profiler, gbuffer);
        }
        gbufferKey = key;
        ++gbufferVersion;
        lightChanged = true;
    }
    DirectKey lit{{emitters.lights}, gbufferVersion};
    if (directKey == lit) return;
    directPass.render(emitters.lights, scene->root, gbufferPass, gbuffer, profiler, direct);
    directKey = std::move(lit);
    lightChanged = true;
}

void FrameRenderer::Impl::makeMaps(const Settings& settings, bool countLevels, Side& side) {
    const MapsKey key = mapsKey(settings, countLevels, viewsVersion);
    side.rules = settings.side[0].rules;
    // Counting by level changes no map.
    MapsKey uncounted = side.key;
    uncounted.countLevels = key.countLevels;
    const bool sameMaps = uncounted == key;
    if (sameMaps && side.key.countLevels >= key.countLevels) return;
    side.key = {};
    side.statistics = {};
    side.maps.present = false;
    side.unproved = false;
    if (!sameMaps) ++side.mapsVersion;
    // MegaViews' tree by the published rules, or a leaf for each view alone.
    const bool published = key.rules == Rules::published;
    const bool flat =
        makesMaps(settings.side[0].method) && settings.side[0].method != Method::megaviews;
    side.usesCullTree = !flat && !published;
    if (!side.usesCullTree) {
        viewHierarchyPass.build({viewsKey->viewDepth, published, flat}, profiler, side.hierarchy);
    }
    const GpuViewHierarchy& tree = mapHierarchy(side);
    GpuSceneHierarchy& nodes = sceneNodes(key.rules);
    const std::uint64_t gpuMemoryBytes = static_cast<std::uint64_t>(settings.side[0].maps.memoryMiB)
                                         << 20;
    if (settings.side[0].method == Method::raster) {
        side.rasterMaps.render(vplPass.tables(), tree, settings.side[0].maps.resolution,
                               gpuMemoryBytes, profiler, side.maps, side.statistics);
    } else if (settings.side[0].method == Method::ism) {
        const IsmOptions options{
            .viewRes = settings.side[0].maps.resolution,
            .pointsPerView = static_cast<std::uint32_t>(settings.side[0].ism.points),
            .seed = settings.seed};
        side.ism.render(surfacePointsFor(settings), tree, options, gpuMemoryBytes, profiler,
                        side.maps, side.statistics);
    } else if (testsPairs(settings.side[0].method)) {
        ManyViewOptions options;
        options.traversal = settings.side[0].pairs.traversal;
        options.rules = settings.side[0].rules;
        options.viewRes = settings.side[0].maps.resolution;
        options.countLevels = countLevels;
        options.fusion = settings.side[0].pairs.fusion;
        options.holeFill = settings.side[0].pairs.holeFill;
        options.pairSize = static_cast<float>(settings.side[0].pairs.size);
        options.gpuMemoryBytes = gpuMemoryBytes;
        options.queueMemoryBytes = static_cast<std::uint64_t>(settings.side[0].pairs.queueMemoryMiB)
                                   << 20;
        side.manyView.render(nodes, tree, options, profiler, side.maps, side.statistics);
        // Where there is nothing yet to show in its place, the first picture is waited for.
        const bool wait = !shown && !held;
        ManyViewPass::Proof proof{};
        while ((proof = side.manyView.proof(side.statistics, wait)) ==
               ManyViewPass::Proof::overflowed) {
            side.manyView.render(nodes, tree, options, profiler, side.maps, side.statistics);
        }
        side.unproved = proof == ManyViewPass::Proof::underWay;
    }
    side.statistics.sceneHierarchyBytes = nodes.nodes.bytes();
    side.statistics.viewHierarchyBytes = tree.bytes();
    side.key = key;
}

void FrameRenderer::Impl::cullGather(const Settings& settings) {
    const CullKey key{viewsVersion, gbufferVersion, settings.gather.cull.scale,
                      settings.gather.cull.level, settings.gather.cull.cutoff};
    if (cullKey == key) return;
    cullKey.reset();
    gatherPass.prepare(gbuffer, sceneNodes(Rules::corrected), cullTree, gatherOptions(settings),
                       profiler);
    cullKey = key;
    ++cullVersion;
}

int FrameRenderer::Impl::nextSets(const Settings& settings, int count) {
    int fewest = std::numeric_limits<int>::max(), most = 0;
    for (int i = 0; i < count; ++i) {
        Side& side = *sides[static_cast<std::size_t>(i)];
        const GatherKey key{cullVersion,
                            side.mapsVersion,
                            side.rules,
                            settings.gather.samples,
                            settings.gather.clampDistance,
                            settings.gather.bias,
                            settings.gather.filter,
                            settings.seed,
                            isReference(side.key.method) ? settings.side[0].referenceSamples : 0};
        if (side.gatherKey != key) side.sets = 0;
        side.gatherKey = key;
        fewest = std::min(fewest, side.sets);
        most = std::max(most, side.sets);
    }
    const int wanted = settings.gather.samples == 0 ? 1 : settings.picture.accumulate;
    return fewest == 0 || most > wanted ? 1 : std::min(fewest + 1, wanted);
}

GatherOptions FrameRenderer::Impl::gatherOptionsOf(const Settings& settings, const Side& side,
                                                   int set) const {
    GatherOptions options = gatherOptions(settings);
    options.rules = side.rules;
    if (side.key.method == Method::rays) options.march = &*march;
    options.accumulationIndex = static_cast<std::uint32_t>(set - 1);
    return options;
}

void FrameRenderer::Impl::setLight(std::span<const glm::vec3> irradiance, Side& side) {
    std::vector<float> texels, candidates(irradiance.size(), 1);  // the picture masks them
    texels.reserve(4 * irradiance.size());
    for (const glm::vec3& e : irradiance) texels.insert(texels.end(), {e.x, e.y, e.z, 1});
    side.irradiance = {};
    side.unfiltered = {};
    for (gl::Texture* texture : {&side.gathered.irradiance, &side.gathered.unfiltered}) {
        texture->ensure("reference irradiance", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width,
                        gbuffer.height);
        texture->writeFloats(4, texels);
    }
    side.gathered.candidates.ensure("reference candidates", GL_TEXTURE_2D, GL_R32F, gbuffer.width,
                                    gbuffer.height);
    side.gathered.candidates.writeFloats(1, candidates);
    lightChanged = true;
}

bool FrameRenderer::Impl::awaitsReferences() const {
    return std::any_of(sides.begin(), sides.end(), [](const auto& side) {
        return side && isReference(side->key.method) && !side->referenceWhole;
    });
}

void FrameRenderer::Impl::gather(const Settings& settings, int n, Side& side) {
    if (isReference(side.key.method)) {
        if (side.sets == 0) {
            side.reference = ++references;
            side.referenceWhole = false;
            const auto pixels =
                static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height);
            setLight(std::vector<glm::vec3>(pixels), side);
        }
        side.sets = n;
        return;
    }
    if (side.sets == n) return;
    side.sets = 0;  // if this throws
    if (side.key.method == Method::rays && !march) {
        const gl::PassScope scope(profiler, Stage::marchTree);
        march = uploadMarchTree(*hierarchy);
    }
    if (side.recordedMaps != side.mapsVersion || side.recordedViews != viewsVersion) {
        gatherPass.record(mapHierarchy(side), side.maps, profiler, side.records);
        side.recordedMaps = side.mapsVersion;
        side.recordedViews = viewsVersion;
    }
    if (n == 1 && settings.picture.accumulate == 1) {
        side.irradiance = {};
        side.unfiltered = {};
    }
    if (n == 2) {  // the first set becomes the mean
        std::swap(side.irradiance, side.gathered.irradiance);
        std::swap(side.unfiltered, side.gathered.unfiltered);
    }
    gatherPass.gather(gbuffer, scene->root, mapHierarchy(side), side.maps, side.records,
                      gatherOptionsOf(settings, side, n), profiler, side.gathered);
    if (n > 1) {
        gatherPass.accumulate(side.gathered.irradiance, n, profiler, side.irradiance);
        gatherPass.accumulate(side.gathered.unfiltered, n, profiler, side.unfiltered);
    }
    side.sets = n;
    lightChanged = true;
}

}  // namespace mv
