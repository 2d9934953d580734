#include "renderer/frame_renderer.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "megaviews/core/error.h"
#include "megaviews/settings/light_placement.h"
#include "megaviews/settings/statistics_table.h"
#include "renderer/frame_state.h"
#include "renderer/gl/context.h"
#include "renderer/gl/free_memory.h"
#include "renderer/gl/program.h"

namespace mv {
namespace {

constexpr double kAdaptsFromEv = 2;  // a fitted exposure, to what the camera sees elsewhere

}  // namespace

FrameRenderer::FrameRenderer(gl::Results results) : impl_(std::make_unique<Impl>(results)) {}
FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::setScene(const Scene& scene, const TriangleBvh& bvh,
                             const SceneHierarchy& hierarchy) {
    impl_->scene = &scene;
    impl_->bvh = &bvh;
    impl_->hierarchy = &hierarchy;
    impl_->emissiveSurfaces = makeEmissiveSurfaces(scene, bvh);
    impl_->poseNumber = scene.poseNumber;
    impl_->gbufferPass.setScene(scene);
    impl_->vplPass.setScene(scene, bvh);
    for (const auto& side : impl_->sides) {
        if (side) side->visibility.reset();
    }
    impl_->dropSetViews();
    impl_->sceneOnGpu = std::make_unique<SceneOnGpu>(bvh, hierarchy, impl_->vplPass.tables());
    impl_->loadedViews.reset();
    for (auto& side : impl_->sides) {
        if (side) side->reference = 0;  // what was wanted was of the old scene
    }
    ++impl_->generation;
    impl_->next.reset();
}

void FrameRenderer::setViews(std::optional<ViewSet> views) {
    impl_->loadedViews = std::move(views);
    ++impl_->generation;
    impl_->next.reset();
}

std::uint64_t FrameRenderer::wantedReference(int index) const {
    const auto& side = impl_->sides.at(static_cast<std::size_t>(index));
    const bool wants = side && side->isReference() && !side->referenceWhole;
    return wants ? side->reference : 0;
}

void FrameRenderer::setReference(int index, std::uint64_t wanted,
                                 std::span<const glm::vec3> irradiance, bool complete) {
    if (wanted == 0 || wanted != wantedReference(index)) return;
    Side& side = *impl_->sides.at(static_cast<std::size_t>(index));
    if (!irradiance.empty()) impl_->setLight(irradiance, side);
    side.referenceWhole = complete;
}

bool FrameRenderer::awaitsReferences() const { return impl_->awaitsReferences(); }

std::uint64_t FrameRenderer::wantedFlip() const {
    const Impl& m = *impl_;
    if (!m.awaitsFlip || !m.shown || m.lightChanged || m.awaitsReferences()) return 0;
    return m.sides[0]->sets >= m.shown->setsWanted() ? m.flipVersion : 0;
}

void FrameRenderer::setFlip(std::uint64_t wanted, std::span<const float> errors) {
    if (wanted == 0 || wanted != wantedFlip()) return;
    impl_->showFlip(errors);
    impl_->awaitsFlip = false;
}

bool FrameRenderer::render(const Settings& settings, const FrameInput& input,
                           FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (!m.scene) throw std::logic_error("FrameRenderer::render before setScene");
    const auto start = std::chrono::steady_clock::now();
    if (!m.settle()) return false;
    m.profiler.owner = kShared;  // a frame that was given up may have left it
    std::optional<gl::WatchScope> watched(std::in_place, m.profiler, input.watch);
    statistics = {};
    statistics.clock = m.profiler.clock();
    if (!input.reuse) m.forget();
    m.pose(input);

    // Views and their hierarchy. Glowing particles replace the scene's own lights.
    Emitters asked;
    if (settings.views.particles == 0) {
        asked = makeEmitters(*m.scene, *m.bvh, m.emissiveSurfaces, input.timeS, input.animation,
                             settings.scene.lightScale,
                             parseLightPlacements(settings.scene.lights, "lights"),
                             {settings.scene.environment, input.environment}, m.litBy.sky);
    }
    m.makeViews(settings, input, asked);
    const Emitters& emitters = m.litBy;
    m.makeGBuffer(settings, m.movingCamera(settings, input), emitters);

    // Maps of each side, then the light gathered through them.
    const int sideCount = settings.compare ? 2 : 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        auto& side = m.sides[i];
        if (!side) side = std::make_unique<Side>(m.results);
        m.profiler.owner = ownerOf(i);
        m.makeVisibility(settings, i, input);
    }
    m.profiler.owner = kShared;
    m.holdPicture();
    m.makeSkyMaps(settings);
    statistics.skyPoints = m.skyMaps ? m.skyMaps->points() : 0;
    m.cullGather(settings);
    const int sets = m.nextSets(settings, input, sideCount);
    if (m.hasOwnViews(settings, sets)) {
        if (!m.makeSetViews(settings, input, sets)) return false;
    } else if (!settings.averagesViews()) {
        m.dropSetViews();
    }
    statistics.accumulatedFrames = sets;
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        m.profiler.owner = ownerOf(i);
        m.gather(settings, sets, *m.sides[i]);
    }

    // The picture, where anything of it changed. Until here the last one stands, whoever looks.
    watched.reset();
    if (sideCount == 1) m.sides[1].reset();
    m.sideCount = sideCount;
    const bool composed = m.mustCompose(settings);
    const bool changed = composed || m.pointsChanged;
    if (changed) m.shown.reset();  // if this throws
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        Side& side = *m.sides[i];
        if (composed) {
            m.profiler.owner = ownerOf(i);
            m.compose(settings, settings.picture.view, side);
        }
        if (!settings.smoothsMotion()) {
            side.temporal = {};
        } else if (m.movingFrames == 0) {
            side.temporal.means.points = 0;  // the next that moves begins anew
        } else if (m.ownSamples) {
            m.profiler.owner = ownerOf(i);
            m.temporalPass.render(side.radiance, m.gbuffer, m.gbufferCamera, m.pointsEv(settings),
                                  m.profiler, side.temporal);
        }
        side.showsPoints =
            side.temporal.means.points > 0 || (settings.averagesPixels() && side.averagesPixels());
        if (changed) m.tonemapPass.countBadPixels(side.shownRadiance(), side.badCounts);
        while (const auto counts = side.badCounts.take<std::uint32_t>()) {
            side.badPixels = TonemapPass::badPixels(*counts);
        }
        statistics.badPixels += side.badPixels;
    }
    m.profiler.owner = kShared;
    if (m.fittedEarly && !m.awaitsReferences()) m.fittedEv.reset();
    if (!settings.display.exposureEv &&
        (!m.fittedEv || m.fittedFor != settings.display.toneMap || input.adaptExposure)) {
        m.fitExposure(settings, kAdaptsFromEv);
    }
    m.usedEv = settings.display.exposureEv.value_or(m.fittedEv.value_or(0));
    const bool mustShow = m.shown != settings || m.shownEv != m.usedEv;
    if (mustShow) m.show(settings);
    const bool asksFlip = sideCount == 2 && settings.display.difference == Difference::flip;
    if (asksFlip && mustShow) ++m.flipVersion;
    m.awaitsFlip = asksFlip && (mustShow || m.awaitsFlip);

    m.traceNext(settings, input, asked);

    gl::throwErrorWhereAsserted();
    const bool timed = m.profiler.endFrame();
    if (timed) statistics.sharedStages = m.profiler.stages(kShared);
    for (std::size_t i = 0; i < static_cast<std::size_t>(sideCount); ++i) {
        MethodStatistics& method = m.sides[i]->statistics;
        method.stages = timed ? m.profiler.stages(ownerOf(i)) : std::vector<StageTime>{};
        if (const double ms = groupMs(method.stages, StageGroup::maps); ms > 0) method.mapsMs = ms;
        if (const double ms = groupMs(method.stages, StageGroup::gather); ms > 0) {
            method.gatherMs = ms;
        }
        statistics.methods.push_back(method);
    }
    statistics.viewsRequested =
        m.loadedViews
            ? m.loadedViews->views.size()
            : static_cast<std::uint64_t>(settings.views.particles > 0 ? settings.views.particles
                                                                      : settings.views.vpls);
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
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count() -
        m.profiler.watchMs();
    if (m.results == gl::Results::late) {
        // Only the submission took that long: the GPU's time is that of the stages.
        if (timed) m.gpuMs = 0;
        for (int owner = kShared; timed && owner <= sideCount; ++owner) {
            for (const StageTime& time : m.profiler.stages(owner)) m.gpuMs += time.ms;
        }
        statistics.frameMs = std::max(statistics.frameMs, m.gpuMs);
    }
    return true;
}

bool FrameRenderer::underWay() const { return impl_->underWay(); }
bool FrameRenderer::lags() const { return impl_->lags(); }

const gl::Texture& FrameRenderer::display() const {
    if (impl_->held) return impl_->front;
    return impl_->overlayCurrent ? impl_->overlaid : impl_->picture();
}
const gl::Texture& FrameRenderer::radiance() const {
    return impl_->sideCount == 2 ? impl_->radiance : impl_->sides[0]->shownRadiance();
}
const gl::Texture& FrameRenderer::radianceOf(int side) const {
    return impl_->sides.at(static_cast<std::size_t>(side))->shownRadiance();
}
double FrameRenderer::exposureEv() const { return impl_->usedEv; }
std::vector<std::string> FrameRenderer::reloadShaders() {
    auto messages = gl::reloadPrograms();
    impl_->forget();
    for (const auto& side : impl_->sides) {
        if (!side) continue;
        side->history = {};
        side->showsHistory = false;
    }
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
    if (!m.shown || !m.gbufferInputs.known())
        throw std::logic_error("FrameRenderer::drawOverlay before render");
    if (!m.overlayPass) m.overlayPass = std::make_unique<OverlayPass>();
    FrameCamera camera = m.gbufferCamera;
    if (m.movingFrames > 0) camera.offset = {};  // as the picture's mean is
    m.overlayPass->draw(lines, camera, m.gbuffer.depth, {}, m.profiler, m.picture(), m.overlaid);
    m.overlayVersion = version;
    m.overlayCurrent = true;
    const std::vector<StageTime> times = m.profiler.take();
    statistics.sharedStages.insert(statistics.sharedStages.end(), times.begin(), times.end());
}

std::uint64_t FrameRenderer::viewsVersion() const { return impl_->viewsVersion; }
std::uint64_t FrameRenderer::mapsVersion(int side) const {
    const auto& kept = impl_->sides.at(static_cast<std::size_t>(side));
    return kept ? kept->mapsVersion : 0;
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
