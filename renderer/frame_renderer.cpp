#include "renderer/frame_renderer.h"

#include <array>
#include <chrono>
#include <cstring>
#include <stdexcept>

#include <spdlog/spdlog.h>

#include "renderer/passes/gather_pass.h"
#include "renderer/passes/many_view_pass.h"
#include "renderer/passes/scene_hierarchy_upload.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"

namespace mv {
namespace {

// Flux of all particles together, chosen so that a scene of any size is lit alike: W per square
// metre of the root cube's face.
constexpr double kParticleFluxPerFaceWPerM2 = 4.0;

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// What the views of a frame depend on; while it stays the same nothing left of the picture is
// recomputed.
struct ViewsKey {
    std::vector<LightRecord> lights;
    std::int64_t vpls = 0, particles = 0;
    int bounces = 0;
    std::uint32_t seed = 0;
    double timeS = 0;  // particles move with it
    double lightScale = 1;
    std::uint64_t generation = 0;  // of scene and loaded views
    int viewDepth = 0;
    bool operator==(const ViewsKey& o) const {
        return sameBytes(lights, o.lights) && vpls == o.vpls && particles == o.particles &&
               bounces == o.bounces && seed == o.seed && timeS == o.timeS &&
               lightScale == o.lightScale && generation == o.generation && viewDepth == o.viewDepth;
    }
};

struct GBufferKey {
    FrameCamera camera;
    int width = 0, height = 0;
    std::uint64_t generation = 0, particlesVersion = 0;
    bool operator==(const GBufferKey& o) const {
        return camera.position == o.camera.position && camera.forward == o.camera.forward &&
               camera.up == o.camera.up && camera.yfovRad == o.camera.yfovRad &&
               camera.orthoHalfHeight == o.camera.orthoHalfHeight && width == o.width &&
               height == o.height && generation == o.generation &&
               particlesVersion == o.particlesVersion;
    }
};

struct MapsKey {
    Method method = Method::none;
    Traversal traversal = Traversal::lists;
    Rules rules = Rules::corrected;
    int viewRes = 0;
    bool fusion = true, holeFill = true;
    int gpuMemoryMiB = 0, queueMemoryMiB = 0;
    std::uint64_t viewsVersion = 0;
    bool operator==(const MapsKey&) const = default;
};

// One half of a comparison: a method's maps and the light gathered through them.
struct Side {
    MapsKey key;
    GpuViewHierarchy hierarchy;  // own tree where it differs from the cull tree
    bool usesCullTree = true;
    ManyViewPass manyView;
    GpuViewMaps maps;
    MethodStatistics statistics;
    GatherPass gather;
    GatherResult gathered;
    gl::Texture radiance, display;
};

}  // namespace

struct FrameRenderer::Impl {
    gl::Profiler profiler;
    GBufferPass gbufferPass;
    DirectLightPass directPass;
    TonemapPass tonemapPass;
    VplPass vplPass;
    ViewHierarchyPass viewHierarchyPass;

    const Scene* scene = nullptr;
    const TriangleBvh* bvh = nullptr;
    const SceneHierarchy* hierarchy = nullptr;
    std::shared_ptr<const EmissiveSurfaces> emissiveSurfaces;
    std::array<std::optional<GpuSceneHierarchy>, 2> sceneHierarchies;  // by Rules
    std::optional<ViewSet> loadedViews;
    std::uint64_t generation = 0;

    GpuViews views;
    GpuViewHierarchy cullTree;
    std::optional<ViewsKey> viewsKey;
    std::uint64_t viewsVersion = 0;

    GBuffer gbuffer;
    std::optional<GBufferKey> gbufferKey;
    gl::Texture direct;

    std::array<std::unique_ptr<Side>, 2> sides;
    int sideCount = 1;
    gl::Texture display, radiance;  // composed of both sides
    std::optional<double> fittedEv;
    double usedEv = 0;

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
        key.lights = emitters.lights;
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

    void makeMaps(const Settings& settings, Method method, Side& side) {
        const MapsKey key{
            method,          settings.traversal, settings.rules,        settings.viewRes,
            settings.fusion, settings.holeFill,  settings.gpuMemoryMiB, settings.queueMemoryMiB,
            viewsVersion};
        if (side.key == key) return;
        side.key = {};
        side.statistics = {};
        side.maps.present = false;
        const bool published = settings.rules == Rules::published;
        side.usesCullTree = method == Method::none || (method == Method::megaviews && !published);
        if (!side.usesCullTree) {
            viewHierarchyPass.build({settings.viewDepth, published, method == Method::manylods},
                                    profiler, side.hierarchy);
        }
        const GpuViewHierarchy& tree = mapHierarchy(side);
        GpuSceneHierarchy& nodes = sceneNodes(settings.rules);
        if (method != Method::none) {
            ManyViewOptions options;
            options.traversal = settings.traversal;
            options.rules = settings.rules;
            options.viewRes = settings.viewRes;
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

    void gatherAndCompose(const Settings& settings, const FrameInput& input, Side& side) {
        GatherOptions options;
        options.samples = settings.gatherSamples;
        options.scale = settings.gatherScale;
        options.cullLevel = settings.cullLevel;
        options.cutoff = static_cast<float>(settings.cutoff);
        options.clampDistance = static_cast<float>(settings.clampDistance);
        options.rules = settings.rules;
        options.filter = settings.filter;
        options.seed = settings.seed;
        options.accumulationIndex = input.accumulationIndex;
        side.gather.render(gbuffer, scene->root, sceneNodes(Rules::corrected), cullTree,
                           mapHierarchy(side), side.maps, options, profiler, side.gathered);

        compose(settings.view, side);
    }

    void compose(DebugView view, Side& side) {
        TonemapPass::Input light;
        light.gbuffer = &gbuffer;
        light.direct = &direct;
        light.irradiance = &side.gathered.irradiance;
        light.unfilteredIrradiance = &side.gathered.unfiltered;
        light.candidates = &side.gathered.candidates;
        tonemapPass.compose(light, view, profiler, side.radiance);
    }

    // Exposure is fitted once, on the first frame and to the whole picture whatever view of it is
    // asked for, and shared by both sides.
    void fitExposure(DebugView view) {
        Side& side = *sides[0];
        if (view != DebugView::final) compose(DebugView::final, side);
        fittedEv = tonemapPass.fitExposure(side.radiance, gbuffer);
        if (view != DebugView::final) compose(view, side);
        spdlog::info("exposure fitted: {:+.2f} EV", *fittedEv);
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

void FrameRenderer::render(const Settings& settings, const FrameInput& input,
                           FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (!m.scene) throw std::logic_error("FrameRenderer::render before setScene");
    const auto start = std::chrono::steady_clock::now();
    statistics = {};
    statistics.clock = m.profiler.clock();
    if (!input.reuse) {
        m.viewsKey.reset();  // and with the views their maps
        m.gbufferKey.reset();
    }

    // Views and their hierarchy. Glowing particles replace the scene's own lights.
    Emitters emitters;
    if (settings.particles == 0) {
        emitters = makeEmitters(*m.scene, *m.bvh, m.emissiveSurfaces, input.timeS, input.animation,
                                settings.lightScale);
    }
    m.makeViews(settings, input, emitters);

    // What the camera sees, and direct light on it.
    const bool drawParticles = settings.particles > 0 && !m.loadedViews;
    const GBufferKey gbufferKey{input.camera, settings.width, settings.height, m.generation,
                                drawParticles ? m.viewsVersion : 0};
    if (m.gbufferKey != gbufferKey) {
        m.gbufferPass.render(input.camera, settings.width, settings.height, m.profiler, m.gbuffer);
        if (drawParticles) {
            m.gbufferPass.drawParticles(m.views, m.scene->root, input.camera, m.profiler,
                                        m.gbuffer);
        }
        m.gbufferKey = gbufferKey;
    }
    m.directPass.render(emitters.lights, m.scene->root, m.gbufferPass, m.gbuffer, m.profiler,
                        m.direct);
    statistics.sharedStages = m.profiler.take();

    // Maps and gather of each method.
    const int sideCount = settings.compare ? 2 : 1;
    for (int i = 0; i < sideCount; ++i) {
        auto& side = m.sides[static_cast<std::size_t>(i)];
        if (!side) side = std::make_unique<Side>();
        m.makeMaps(settings, i == 0 ? settings.method : *settings.compare, *side);
        m.gatherAndCompose(settings, input, *side);
        side->statistics.stages = m.profiler.take();
        statistics.methods.push_back(side->statistics);
        statistics.badPixels += m.tonemapPass.countBadPixels(side->radiance);
    }
    if (sideCount == 1) m.sides[1].reset();
    m.sideCount = sideCount;

    if (!settings.exposureEv && !m.fittedEv) m.fitExposure(settings.view);
    m.usedEv = settings.exposureEv.value_or(m.fittedEv.value_or(0));
    for (int i = 0; i < sideCount; ++i) {
        Side& side = *m.sides[static_cast<std::size_t>(i)];
        m.tonemapPass.tonemap(side.radiance, m.usedEv, settings.toneMap, settings.view, m.profiler,
                              side.display);
    }
    if (sideCount == 2) m.joinSides(settings);
    for (const StageTime& stage : m.profiler.take()) statistics.sharedStages.push_back(stage);

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
    statistics.frameMs =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

const gl::Texture& FrameRenderer::display() const {
    return impl_->sideCount == 2 ? impl_->display : impl_->sides[0]->display;
}
const gl::Texture& FrameRenderer::radiance() const {
    return impl_->sideCount == 2 ? impl_->radiance : impl_->sides[0]->radiance;
}
double FrameRenderer::exposureEv() const { return impl_->usedEv; }
void FrameRenderer::forgetExposure() { impl_->fittedEv.reset(); }

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
