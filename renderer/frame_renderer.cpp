#include "renderer/frame_renderer.h"

#include "megaviews/settings/statistics_table.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

#include <spdlog/spdlog.h>

#include "megaviews/settings/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_keys.h"
#include "renderer/gl/context.h"
#include "renderer/gl/free_memory.h"
#include "renderer/gl/program.h"
#include "renderer/passes/difference_pass.h"
#include "renderer/passes/gather_pass.h"
#include "renderer/passes/many_view_pass.h"
#include "renderer/passes/overlay_pass.h"
#include "renderer/passes/scene_geometry.h"
#include "renderer/passes/scene_hierarchy_upload.h"
#include "renderer/passes/sharing_pass.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"

namespace mv {
namespace {

// Flux of all particles together, chosen so that a scene of any size is lit alike: W per square
// metre of the root cube's face.
constexpr double kParticleFluxPerFaceWPerM2 = 4.0;

// One half of a comparison: a method's maps and the light gathered through them.
struct Side {
    MapsKey key;
    GpuViewHierarchy hierarchy;  // own tree where it differs from the cull tree
    bool usesCullTree = true;
    ManyViewPass manyView;
    GpuViewMaps maps;
    std::uint64_t mapsVersion = 0;
    MethodStatistics statistics;

    GatherKey gatherKey;
    std::optional<SharingKey> sharingKey;  // while radiance holds a picture of sharing
    GatherRecords records;
    std::uint64_t recordedMaps = 0, recordedViews = 0;  // versions
    GatherResult gathered;
    int sets = 0;                        // of samples: in `gathered`, or averaged in the means
    gl::Texture irradiance, unfiltered;  // means; only where sets > 1
    gl::Texture radiance, display;
    std::uint64_t badPixels = 0;

    bool hasMean() const { return sets > 1 && !isReference(key.method); }
};

void append(std::vector<StageTime>& to, std::vector<StageTime> stages) {
    to.insert(to.end(), std::make_move_iterator(stages.begin()),
              std::make_move_iterator(stages.end()));
}

// Both sides take the same culled views and samples, so these come from the left side.
GatherOptions gatherOptions(const Settings& settings) {
    GatherOptions options;
    options.samples = settings.gatherSamples;
    options.scale = settings.gatherScale;
    options.cullLevel = settings.cullLevel;
    options.cutoff = static_cast<float>(settings.cutoff);
    options.clampDistance = static_cast<float>(settings.clampDistance);
    options.filter = settings.filter;
    options.seed = settings.seed;
    options.measure = false;
    return options;
}

}  // namespace

struct FrameRenderer::Impl {
    gl::Profiler profiler;
    GBufferPass gbufferPass;
    DirectLightPass directPass;
    TonemapPass tonemapPass;
    std::unique_ptr<DifferencePass> differencePass;  // made at first use
    SharingPass sharingPass;
    VplPass vplPass;
    ViewHierarchyPass viewHierarchyPass;

    const Scene* scene = nullptr;
    const TriangleBvh* bvh = nullptr;
    const SceneHierarchy* hierarchy = nullptr;
    std::shared_ptr<const EmissiveSurfaces> emissiveSurfaces;
    std::array<std::optional<GpuSceneHierarchy>, 2> sceneHierarchies;  // by Rules
    std::optional<ViewSet> loadedViews;
    ReferenceSource references;
    std::uint64_t generation = 0;

    GpuViews views;
    GpuViewHierarchy cullTree;
    std::optional<ViewsKey> viewsKey;
    std::uint64_t viewsVersion = 0;

    GBuffer gbuffer;
    std::optional<GBufferKey> gbufferKey;
    std::uint64_t gbufferVersion = 0;
    gl::Texture direct;
    std::optional<DirectKey> directKey;

    GatherPass gatherPass;
    std::optional<CullKey> cullKey;
    std::uint64_t cullVersion = 0;

    std::array<std::unique_ptr<Side>, 2> sides;
    int sideCount = 1;
    bool lightChanged = true;       // since the radiances were composed
    std::optional<Settings> shown;  // what the picture shows
    std::optional<double> shownEv;
    double differenceRange = 0;     // of the picture shown
    gl::Texture display, radiance;  // composed of both sides
    std::optional<double> fittedEv;
    double usedEv = 0;

    // Lines over the picture; empty while there are none.
    std::unique_ptr<OverlayPass> overlayPass;
    gl::Texture overlaid;
    std::uint64_t overlayVersion = 0;
    bool overlayCurrent = false;  // overlaid shows this picture

    // The next frame takes nothing from those before.
    void forget() {
        viewsKey.reset();  // and with the views their maps
        gbufferKey.reset();
    }

    GpuSceneHierarchy& sceneNodes(Rules rules) {
        auto& slot = sceneHierarchies[rules == Rules::corrected ? 1 : 0];
        if (!slot) slot = uploadSceneHierarchy(*hierarchy, rules);
        return *slot;
    }

    const GpuViewHierarchy& mapHierarchy(const Side& side) const {
        return side.usesCullTree ? cullTree : side.hierarchy;
    }

    void makeViews(const Settings& settings, const FrameInput& input, const Emitters& emitters) {
        ViewsKey key;
        key.lights = {emitters.lights};
        key.vpls = settings.vpls;
        key.particles = settings.particles;
        key.bounces = settings.bounces;
        key.seed = settings.seed;
        key.timeS = settings.particles > 0 ? input.timeS : 0;
        key.lightScale = settings.lightScale;
        key.generation = generation;
        key.viewDepth = settings.viewDepth;
        if (viewsKey == key) return;

        if (loadedViews) {
            upload(*loadedViews, views);
        } else if (settings.particles > 0) {
            const gl::PassScope scope(profiler, "particles");
            const double edge = scene->root.edge;
            upload(makeParticles(*scene, static_cast<std::uint64_t>(settings.particles),
                                 settings.seed, input.timeS,
                                 kParticleFluxPerFaceWPerM2 * edge * edge * settings.lightScale),
                   views);
        } else {
            vplPass.trace(
                emitters,
                {static_cast<std::uint64_t>(settings.vpls), settings.bounces, settings.seed},
                profiler, views);
        }
        viewHierarchyPass.sort(views, profiler);
        viewHierarchyPass.build({settings.viewDepth, false, false}, profiler, cullTree);
        viewsKey = std::move(key);
        ++viewsVersion;
    }

    void makeGBuffer(const Settings& settings, const FrameInput& input, const Emitters& emitters) {
        const bool drawParticles = settings.particles > 0 && !loadedViews;
        const GBufferKey key{input.camera, settings.width, settings.height, generation,
                             drawParticles ? viewsVersion : 0};
        if (gbufferKey != key) {
            gbufferKey.reset();
            gbufferPass.render(input.camera, settings.width, settings.height, profiler, gbuffer);
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

    void makeMaps(const Settings& settings, bool countLevels, Side& side) {
        const MapsKey key{settings.method,       settings.traversal,      settings.rules,
                          settings.viewRes,      settings.fusion,         settings.holeFill,
                          settings.gpuMemoryMiB, settings.queueMemoryMiB, countLevels,
                          viewsVersion};
        // Counting by level changes no map.
        MapsKey uncounted = side.key;
        uncounted.countLevels = countLevels;
        const bool sameMaps = uncounted == key;
        if (sameMaps && side.key.countLevels >= countLevels) return;
        side.key = {};
        side.statistics = {};
        side.maps.present = false;
        if (!sameMaps) ++side.mapsVersion;
        const bool published = settings.rules == Rules::published;
        side.usesCullTree =
            !makesMaps(settings.method) || (settings.method == Method::megaviews && !published);
        if (!side.usesCullTree) {
            viewHierarchyPass.build(
                {settings.viewDepth, published, settings.method == Method::manylods}, profiler,
                side.hierarchy);
        }
        const GpuViewHierarchy& tree = mapHierarchy(side);
        GpuSceneHierarchy& nodes = sceneNodes(settings.rules);
        if (makesMaps(settings.method)) {
            ManyViewOptions options;
            options.traversal = settings.traversal;
            options.rules = settings.rules;
            options.viewRes = settings.viewRes;
            options.countLevels = countLevels;
            options.fusion = settings.fusion;
            options.holeFill = settings.holeFill;
            options.gpuMemoryBytes = static_cast<std::uint64_t>(settings.gpuMemoryMiB) << 20;
            options.queueMemoryBytes = static_cast<std::uint64_t>(settings.queueMemoryMiB) << 20;
            side.manyView.render(nodes, tree, options, profiler, side.maps, side.statistics);
        }
        side.statistics.sceneHierarchyBytes = nodes.nodes.bytes();
        side.statistics.viewHierarchyBytes = tree.bytes();
        side.key = key;
    }

    // What each receiver keeps of the views, for both sides.
    void cullGather(const Settings& settings) {
        const CullKey key{viewsVersion, gbufferVersion, settings.gatherScale, settings.cullLevel,
                          settings.cutoff};
        if (cullKey == key) return;
        cullKey.reset();
        gatherPass.prepare(gbuffer, sceneNodes(Rules::corrected), cullTree, gatherOptions(settings),
                           profiler);
        cullKey = key;
        ++cullVersion;
    }

    // How many sets of samples this frame's picture averages: the same on both sides, which are
    // compared set by set, so that a change of either begins both anew.
    int nextSets(const Settings& settings, int count) {
        int fewest = std::numeric_limits<int>::max(), most = 0;
        for (int i = 0; i < count; ++i) {
            Side& side = *sides[static_cast<std::size_t>(i)];
            const GatherKey key{cullVersion,
                                side.mapsVersion,
                                side.key.rules,
                                settings.gatherSamples,
                                settings.clampDistance,
                                settings.filter,
                                settings.seed,
                                isReference(side.key.method) ? settings.referenceSamples : 0};
            if (side.gatherKey != key) side.sets = 0;
            side.gatherKey = key;
            fewest = std::min(fewest, side.sets);
            most = std::max(most, side.sets);
        }
        const int wanted = settings.gatherSamples == 0 ? 1 : settings.accumulate;
        return fewest == 0 || most > wanted ? 1 : std::min(fewest + 1, wanted);
    }

    static GatherOptions gatherOptionsOf(const Settings& settings, const Side& side, int set) {
        GatherOptions options = gatherOptions(settings);
        options.rules = side.key.rules;
        options.accumulationIndex = static_cast<std::uint32_t>(set - 1);
        return options;
    }

    // The irradiance of a reference method, which has no samples to average.
    void takeReference(const Settings& settings, const FrameInput& input, const Emitters& emitters,
                       Side& side) {
        if (!references) {
            throw Error(ExitCode::usage, "method " + std::string(nameOf(settings.method)) +
                                             ": references are made by 'megaviews --headless'");
        }
        const std::vector<Receiver> receivers = readReceivers();
        const auto viewList = views.views.read<View>(0, views.count);
        const std::vector<glm::vec3> light =
            references({settings, input, emitters, viewList, receivers});
        std::vector<float> texels(4 * receivers.size(), 0), kept(receivers.size(), 0);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            if (receivers[i].normal == glm::vec3(0)) continue;
            for (int c = 0; c < 3; ++c) texels[4 * i + static_cast<std::size_t>(c)] = light[i][c];
            texels[4 * i + 3] = kept[i] = 1;
        }
        side.irradiance = {};
        side.unfiltered = {};
        for (gl::Texture* texture : {&side.gathered.irradiance, &side.gathered.unfiltered}) {
            texture->ensure("reference irradiance", GL_TEXTURE_2D, GL_RGBA32F, gbuffer.width,
                            gbuffer.height);
            texture->writeFloats(4, texels);
        }
        side.gathered.candidates.ensure("reference candidates", GL_TEXTURE_2D, GL_R32F,
                                        gbuffer.width, gbuffer.height);
        side.gathered.candidates.writeFloats(1, kept);
        lightChanged = true;
    }

    std::vector<Receiver> readReceivers() const {
        const std::vector<float> positions = gbuffer.position.readFloats(4);
        const std::vector<float> normals = gbuffer.normal.readFloats(4);
        std::vector<Receiver> out(positions.size() / 4);
        for (std::size_t i = 0; i < out.size(); ++i) {
            const float *p = &positions[4 * i], *n = &normals[4 * i];
            if (p[3] == 0) continue;
            out[i] = {{p[0], p[1], p[2]}, normalizeOr({n[0], n[1], n[2]}, glm::vec3(0))};
        }
        return out;
    }

    // Gathers the n-th set of samples into the side's mean.
    void gather(const Settings& settings, const FrameInput& input, const Emitters& emitters, int n,
                Side& side) {
        if (side.sets == n) return;
        if (isReference(side.key.method)) {
            if (side.sets == 0) takeReference(settings, input, emitters, side);
            side.sets = n;
            return;
        }
        side.sets = 0;  // if this throws
        if (side.recordedMaps != side.mapsVersion || side.recordedViews != viewsVersion) {
            gatherPass.record(mapHierarchy(side), side.maps, profiler, side.records);
            side.recordedMaps = side.mapsVersion;
            side.recordedViews = viewsVersion;
        }
        if (n == 1 && settings.accumulate == 1) {
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

    // What the traversal's pairs mean for the surfaces in sight, instead of light.
    void composeSharing(const Settings& settings, Side& side) {
        const bool picks = settings.view == DebugView::shared;
        const SharingKey key{settings.view,
                             side.mapsVersion,
                             gbufferVersion,
                             settings.seed,
                             picks ? settings.pickA : -1,
                             picks ? settings.pickB : -1};
        if (side.sharingKey == key) return;
        const SharingInput input{
            gbuffer,        sceneNodes(side.key.rules), mapHierarchy(side),
            side.key.rules, side.key.viewRes,           makesMaps(side.key.method)};
        side.statistics.meanSharing = 0;
        if (picks) {
            sharingPass.shared(input, gbufferKey->camera, settings.pickA, settings.pickB, profiler,
                               side.radiance);
        } else {
            // Paths are long: without a GPU every fourth pixel must do.
            const int grid = gl::limits().software ? 2 : 1;
            sharingPass.sharing(input, settings.seed, grid, profiler, side.radiance);
            side.statistics.meanSharing = SharingPass::meanSharing(side.radiance);
        }
        side.sharingKey = key;
    }

    void compose(const Settings& settings, DebugView view, Side& side) {
        if (view == DebugView::sharing || view == DebugView::shared) {
            composeSharing(settings, side);
            return;
        }
        side.sharingKey.reset();
        side.statistics.meanSharing = 0;
        composeLight(view, side, side.radiance);
    }

    void composeLight(DebugView view, const Side& side, gl::Texture& out) {
        TonemapPass::Input light;
        light.gbuffer = &gbuffer;
        light.direct = &direct;
        light.irradiance = side.hasMean() ? &side.irradiance : &side.gathered.irradiance;
        light.unfilteredIrradiance = side.hasMean() ? &side.unfiltered : &side.gathered.unfiltered;
        light.candidates = &side.gathered.candidates;
        tonemapPass.compose(light, view, profiler, out);
    }

    // Exposure is fitted once, on the first frame and to the whole picture whatever view of it is
    // asked for, and shared by both sides.
    void fitExposure(const Settings& settings) {
        const Side& side = *sides[0];
        gl::Texture light;
        const bool isFinal = settings.view == DebugView::final;
        if (!isFinal) composeLight(DebugView::final, side, light);
        fittedEv = tonemapPass.fitExposure(isFinal ? side.radiance : light, gbuffer);
        spdlog::info("exposure fitted: {:+.2f} EV", *fittedEv);
    }

    const gl::Texture& picture() const { return sideCount == 2 ? display : sides[0]->display; }

    bool mustCompose(const Settings& settings) const {
        return lightChanged || !shown || withoutDisplay(*shown) != withoutDisplay(settings);
    }

    // The sides' radiance as the picture.
    void show(const Settings& settings) {
        shown.reset();
        differenceRange = 0;
        if (sideCount == 2 && settings.difference != Difference::off) {
            if (!differencePass) differencePass = std::make_unique<DifferencePass>();
            differenceRange = differencePass->render(sides[0]->radiance, sides[1]->radiance,
                                                     settings.difference, settings.differenceRange,
                                                     usedEv, profiler, radiance, display);
        } else {
            for (const auto& side : sides) {
                if (!side) continue;
                tonemapPass.tonemap(side->radiance, usedEv, settings.toneMap, settings.view,
                                    profiler, side->display);
            }
            if (sideCount == 2) joinSides(settings);
        }
        lightChanged = false;
        overlayCurrent = false;
        shown = settings;
        shownEv = usedEv;
    }

    // Everything on the GPU.
    std::vector<MemoryUse> memory() const {
        std::vector<MemoryUse> out;
        const auto add = [&](std::string name, std::uint64_t used, std::uint64_t predicted = 0) {
            if (used > 0) out.push_back({std::move(name), used, predicted});
        };
        const std::uint64_t geometry = gbufferPass.geometry().bytes();
        add("scene geometry", geometry + vplPass.bytes());
        add("textures", gbufferPass.bytes() - geometry);
        add("shadow maps", directPass.bytes());
        std::uint64_t octree = 0;
        for (const auto& nodes : sceneHierarchies) {
            if (nodes) {
                octree +=
                    nodes->nodes.bytes() + nodes->attributes.bytes() + nodes->mortonKeys.bytes();
            }
        }
        add("scene octree", octree);
        add("views", views.views.bytes());
        std::uint64_t viewTrees = cullTree.bytes(), gather = gatherPass.bytes();
        std::uint64_t picture = display.bytes() + radiance.bytes() + direct.bytes() +
                                overlaid.bytes() + (differencePass ? differencePass->bytes() : 0);
        for (const auto& side : sides) {
            if (!side) continue;
            viewTrees += side->hierarchy.bytes();
            gather += side->records.records.bytes();
            for (const gl::Texture* t :
                 {&side->gathered.irradiance, &side->gathered.unfiltered,
                  &side->gathered.candidates, &side->irradiance, &side->unfiltered}) {
                gather += t->bytes();
            }
            picture += side->radiance.bytes() + side->display.bytes();
        }
        add("view octree", viewTrees);
        for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
            const MethodStatistics& s = sides[i]->statistics;
            const std::string which = sideCount == 1 ? "" : i == 0 ? ", left" : ", right";
            const bool queue = sides[i]->key.traversal == Traversal::queue;
            add((queue ? "pair queue" : "lists") + which, s.queueBytes, s.predictedQueueBytes);
            add("working maps" + which, s.workingMapBytes, s.predictedWorkingMapBytes);
            add("final maps" + which, s.mapBytes - s.workingMapBytes, s.predictedMapBytes);
        }
        add("G-buffer", gbuffer.bytes());
        add("gather", gather);
        add("picture", picture);
        return out;
    }

    // Left part from side 0, right part from side 1.
    void joinSides(const Settings& settings) {
        const int w = settings.width, h = settings.height;
        const int x = std::clamp(static_cast<int>(settings.split * w + 0.5), 0, w);
        if (!display || display.width() != w || display.height() != h) {
            display = gl::Texture("display, both sides", GL_TEXTURE_2D, GL_RGBA8, w, h);
            radiance = gl::Texture("radiance, both sides", GL_TEXTURE_2D, GL_RGBA32F, w, h);
        }
        const auto copy = [&](const gl::Texture& from, const gl::Texture& to, int x0, int width) {
            if (width > 0) {
                glCopyImageSubData(from.id(), GL_TEXTURE_2D, 0, x0, 0, 0, to.id(), GL_TEXTURE_2D, 0,
                                   x0, 0, 0, width, h, 1);
            }
        };
        copy(sides[0]->display, display, 0, x);
        copy(sides[1]->display, display, x, w - x);
        copy(sides[0]->radiance, radiance, 0, x);
        copy(sides[1]->radiance, radiance, x, w - x);
    }
};

FrameRenderer::FrameRenderer() : impl_(std::make_unique<Impl>()) {}
FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::setScene(const Scene& scene, const TriangleBvh& bvh,
                             const SceneHierarchy& hierarchy) {
    impl_->scene = &scene;
    impl_->bvh = &bvh;
    impl_->hierarchy = &hierarchy;
    impl_->emissiveSurfaces = makeEmissiveSurfaces(scene, bvh);
    impl_->sceneHierarchies = {};
    impl_->gbufferPass.setScene(scene);
    impl_->vplPass.setScene(scene, bvh);
    impl_->loadedViews.reset();
    impl_->fittedEv.reset();
    ++impl_->generation;
}

void FrameRenderer::setViews(std::optional<ViewSet> views) {
    impl_->loadedViews = std::move(views);
    ++impl_->generation;
}

void FrameRenderer::setReferences(ReferenceSource source) { impl_->references = std::move(source); }

void FrameRenderer::render(const Settings& settings, const FrameInput& input,
                           FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (!m.scene) throw std::logic_error("FrameRenderer::render before setScene");
    const auto start = std::chrono::steady_clock::now();
    statistics = {};
    statistics.clock = m.profiler.clock();
    if (!input.reuse) m.forget();

    // Views and their hierarchy. Glowing particles replace the scene's own lights.
    Emitters emitters;
    if (settings.particles == 0) {
        emitters = makeEmitters(*m.scene, *m.bvh, m.emissiveSurfaces, input.timeS, input.animation,
                                settings.lightScale);
        placeLights(emitters, m.scene->root, parseLightPlacements(settings.lights, "lights"));
    }
    m.makeViews(settings, input, emitters);
    m.makeGBuffer(settings, input, emitters);
    statistics.sharedStages = m.profiler.take();

    // Maps of each side, then the light gathered through them.
    const int sideCount = settings.compare ? 2 : 1;
    const Settings settingsOf[2] = {settings, comparedSide(settings)};
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        auto& side = m.sides[i];
        if (!side) side = std::make_unique<Side>();
        m.makeMaps(settingsOf[i], input.countLevels, *side);
        side->statistics.stages = m.profiler.take();
        if (!side->statistics.stages.empty()) {
            side->statistics.mapsMs = visibilityMs(side->statistics.stages);
        }
    }
    m.cullGather(settings);
    append(statistics.sharedStages, m.profiler.take());
    const int sets = m.nextSets(settings, sideCount);
    statistics.accumulatedFrames = sets;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        m.gather(settingsOf[i], input, emitters, sets, *m.sides[i]);
        const std::vector<StageTime> stages = m.profiler.take();
        if (!stages.empty()) m.sides[i]->statistics.gatherMs = totalMs(stages);
        append(m.sides[i]->statistics.stages, stages);
    }

    // The picture, where anything of it changed.
    if (sideCount == 1) m.sides[1].reset();
    m.sideCount = sideCount;
    const bool composed = m.mustCompose(settings);
    if (composed) m.shown.reset();  // if this throws
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        Side& side = *m.sides[i];
        if (composed) {
            m.compose(settings, settings.view, side);
            append(side.statistics.stages, m.profiler.take());
            side.badPixels = m.tonemapPass.countBadPixels(side.radiance);
        }
        statistics.methods.push_back(side.statistics);
        statistics.badPixels += side.badPixels;
    }
    if (!settings.exposureEv && !m.fittedEv) m.fitExposure(settings);
    m.usedEv = settings.exposureEv.value_or(m.fittedEv.value_or(0));
    if (m.shown != settings || m.shownEv != m.usedEv) m.show(settings);
    append(statistics.sharedStages, m.profiler.take());

    statistics.viewsRequested =
        m.loadedViews ? m.loadedViews->views.size()
                      : static_cast<std::uint64_t>(settings.particles > 0 ? settings.particles
                                                                          : settings.vpls);
    statistics.viewsAlive = m.cullTree.aliveCount;
    statistics.viewNodes = m.cullTree.nodeCount;
    statistics.viewLeaves = m.cullTree.leafCount;
    for (std::size_t l = 0; l + 1 < m.cullTree.levelBegin.size(); ++l) {
        statistics.viewNodesPerLevel.push_back(m.cullTree.levelBegin[l + 1] -
                                               m.cullTree.levelBegin[l]);
    }
    statistics.exposureEv = m.usedEv;
    statistics.differenceRange = m.differenceRange;
    statistics.memory = m.memory();
    statistics.freeGpuBytes = gl::freeVideoMemory();
    statistics.frameMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

const gl::Texture& FrameRenderer::display() const {
    return impl_->overlayCurrent ? impl_->overlaid : impl_->picture();
}
const gl::Texture& FrameRenderer::radiance() const {
    return impl_->sideCount == 2 ? impl_->radiance : impl_->sides[0]->radiance;
}
double FrameRenderer::exposureEv() const { return impl_->usedEv; }
std::vector<std::string> FrameRenderer::reloadShaders() {
    auto messages = gl::reloadPrograms();
    impl_->forget();
    return messages;
}
void FrameRenderer::forgetExposure() { impl_->fittedEv.reset(); }

void FrameRenderer::drawOverlay(std::span<const Line> lines, std::uint64_t version,
                                FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (lines.empty()) {
        m.overlayPass.reset();
        m.overlaid = {};
        m.overlayCurrent = false;
        return;
    }
    if (m.overlayCurrent && version != 0 && version == m.overlayVersion) return;
    if (!m.shown || !m.gbufferKey)
        throw std::logic_error("FrameRenderer::drawOverlay before render");
    if (!m.overlayPass) m.overlayPass = std::make_unique<OverlayPass>();
    m.overlayPass->draw(lines, m.gbufferKey->camera, m.gbuffer.depth, {}, m.profiler, m.picture(),
                        m.overlaid);
    m.overlayVersion = version;
    m.overlayCurrent = true;
    append(statistics.sharedStages, m.profiler.take());
}

std::uint64_t FrameRenderer::viewsVersion() const { return impl_->viewsVersion; }

ViewSet FrameRenderer::readViews() const {
    ViewSet out;
    out.views = impl_->views.views.read<View>(0, impl_->views.count);
    return out;
}

ReadMaps FrameRenderer::readMaps(int sideIndex) const {
    ReadMaps out;
    const auto& side = impl_->sides.at(static_cast<std::size_t>(sideIndex));
    if (!side || !side->maps.present) return out;
    const GpuViewHierarchy& tree = impl_->mapHierarchy(*side);
    const auto nodes = tree.nodes.read<ViewNode>(0, tree.nodeCount);
    const auto mapOfNode = tree.mapOfNode.read<std::uint32_t>(0, tree.nodeCount);
    const auto leafOfView = tree.leafOfView.read<std::uint32_t>(0, tree.aliveCount);
    const auto sorted = tree.sortedViews.read<View>(0, tree.aliveCount);

    const std::uint64_t texelsPerMap = 2ull * static_cast<std::uint64_t>(side->maps.viewRes) *
                                       static_cast<std::uint64_t>(side->maps.viewRes);
    out.maps.viewRes = side->maps.viewRes;
    out.maps.texels = side->maps.texels.read<std::uint32_t>(0, side->maps.mapCount * texelsPerMap);
    out.maps.centers.resize(side->maps.mapCount);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const std::uint32_t map = side->maps.fused ? mapOfNode[n] : static_cast<std::uint32_t>(n);
        if (map != kNone) {
            out.maps.centers[map] = {nodes[n].centerX, nodes[n].centerY, nodes[n].centerZ};
        }
    }
    out.mapOfSlot.assign(impl_->views.count, kNone);
    for (std::size_t v = 0; v < sorted.size(); ++v) {
        out.mapOfSlot[sorted[v].slot] = side->maps.fused ? mapOfNode[leafOfView[v]] : leafOfView[v];
    }
    return out;
}

PixelValues FrameRenderer::readPixel(int x, int y) const {
    const Impl& m = *impl_;
    PixelValues out;
    if (!m.shown || x < 0 || y < 0 || x >= m.gbuffer.width || y >= m.gbuffer.height) return out;
    const auto texel = [&](const gl::Texture& texture) {
        const auto t = texture.readTexel(x, y);
        return glm::vec4(t[0], t[1], t[2], t[3]);
    };
    const glm::vec4 position = texel(m.gbuffer.position), normal = texel(m.gbuffer.normal);
    out.surface = position.w != 0;
    if (out.surface) {
        out.position = glm::vec3(position);
        out.normal = glm::vec3(normal);
        out.depth = normal.w;
        out.albedo = glm::vec3(texel(m.gbuffer.albedo));
    }
    glm::vec3 direct(texel(m.gbuffer.emission));
    if (out.surface) direct += glm::vec3(texel(m.direct));
    out.sideCount = m.sideCount;
    for (int i = 0; i < m.sideCount; ++i) {
        const Side& side = *m.sides[static_cast<std::size_t>(i)];
        PixelSide& values = out.sides[static_cast<std::size_t>(i)];
        values.direct = values.radiance = direct;
        if (!out.surface) continue;
        const bool mean = side.hasMean();
        const glm::vec3 irradiance(texel(mean ? side.irradiance : side.gathered.irradiance));
        values.unfiltered = glm::vec3(texel(mean ? side.unfiltered : side.gathered.unfiltered));
        values.indirect = out.albedo * (1 / kPi) * irradiance;
        values.radiance += values.indirect;
    }
    const glm::vec4 display = texel(m.picture());
    for (int c = 0; c < 3; ++c) {
        out.display[static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::lround(255 * display[c]));
    }
    return out;
}

std::vector<GatheredSample> FrameRenderer::readSamples(int x, int y, int sideIndex) const {
    const Impl& m = *impl_;
    if (!m.shown || sideIndex < 0 || sideIndex >= m.sideCount) return {};
    const Side& side = *m.sides[static_cast<std::size_t>(sideIndex)];
    if (side.sets == 0 || isReference(side.key.method)) return {};
    return impl_->gatherPass.readSamples(m.gbuffer, m.scene->root, m.mapHierarchy(side), side.maps,
                                         side.records, m.gatherOptionsOf(*m.shown, side, side.sets),
                                         {x, y});
}

std::uint64_t FrameRenderer::sceneBytes() const {
    return impl_->gbufferPass.bytes() + impl_->vplPass.bytes();
}

FrameCamera frameCamera(const PosedCamera& camera, const RootCube& root) {
    FrameCamera out;
    out.position = root.rootFromWorld(camera.position);
    out.forward = glm::vec3(camera.forward);
    out.up = glm::vec3(camera.up);
    out.yfovRad = static_cast<float>(camera.camera.yfovRad);
    if (camera.camera.orthoHalfHeight) {
        out.orthoHalfHeight = static_cast<float>(*camera.camera.orthoHalfHeight / root.edge);
    }
    return out;
}

}  // namespace mv
