#include "renderer/frame_renderer.h"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "renderer/frame_state.h"
#include "renderer/gl/context.h"
#include "renderer/gl/program.h"

namespace mv {

FrameRenderer::FrameRenderer(gl::Results results) : impl_(std::make_unique<Impl>(results)) {}
FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::setScene(const Scene& scene, const TriangleBvh& bvh,
                             const SceneHierarchy& hierarchy) {
    impl_->scene = &scene;
    impl_->bvh = &bvh;
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
        if (side) side->reference = 0;  // it named light of the old scene
    }
    ++impl_->generation;
    impl_->views.next.reset();
}

void FrameRenderer::setViews(std::optional<ViewSet> views) {
    impl_->loadedViews = std::move(views);
    ++impl_->generation;
    impl_->views.next.reset();
}

std::optional<ViewSet> FrameRenderer::takeViews() {
    return std::exchange(impl_->loadedViews, std::nullopt);
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
    if (!m.picture.awaitsFlip || !m.picture.shown || m.picture.lightChanged || m.awaitsReferences())
        return 0;
    return m.sides[0]->sets >= m.picture.shown->setsWanted() ? m.picture.flipVersion : 0;
}

void FrameRenderer::setFlip(std::uint64_t wanted, std::span<const float> errors) {
    if (wanted == 0 || wanted != wantedFlip()) return;
    impl_->showFlip(errors);
    impl_->picture.awaitsFlip = false;
}

bool FrameRenderer::render(const Settings& settings, const FrameInput& input,
                           FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (!m.scene) throw std::logic_error("FrameRenderer::render before setScene");
    const auto start = std::chrono::steady_clock::now();
    if (!m.settle()) return false;
    statistics = {};
    Emitters asked;
    {
        const gl::WatchScope watched(m.profiler, input.watch);
        if (!input.reuse) m.forget();
        m.pose(input);
        asked = m.emittersAsked(settings, input);
        const bool readable = std::exchange(m.picture.readable, false);
        const std::optional<int> sets = m.makeLight(settings, input, asked);
        if (!sets) {
            m.picture.readable = readable;
            return false;
        }
        statistics.accumulatedFrames = *sets;
    }
    // Up to here the last picture stands, also for a watch that looks at it.
    m.makePicture(settings, input);
    m.picture.readable = true;
    m.traceNext(settings, input, asked);
    gl::throwErrorWhereAsserted();
    m.tell(settings, start, statistics);
    return true;
}

bool FrameRenderer::underWay() const { return impl_->underWay(); }
bool FrameRenderer::mapsLag() const { return impl_->mapsLag(); }

const gl::Texture& FrameRenderer::picture() const {
    return impl_->late.held ? impl_->late.front : impl_->newestPicture();
}
const gl::Texture& FrameRenderer::display() const {
    return !impl_->late.held && impl_->overlay.current ? impl_->overlay.picture : picture();
}
const gl::Texture& FrameRenderer::radiance() const {
    return impl_->sideCount == 2 ? impl_->picture.radiance : impl_->sides[0]->shownRadiance();
}
const gl::Texture& FrameRenderer::radianceOf(int side) const {
    return impl_->sides.at(static_cast<std::size_t>(side))->shownRadiance();
}
double FrameRenderer::exposureEv() const { return impl_->exposure.usedEv; }
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
void FrameRenderer::forgetExposure() { impl_->exposure.fittedEv.reset(); }

void FrameRenderer::drawOverlay(std::span<const Line> lines, std::uint64_t version,
                                FrameStatistics& statistics) {
    Impl& m = *impl_;
    if (lines.empty()) {
        m.overlay = {};
        return;
    }
    if (m.overlay.current && version != 0 && version == m.overlay.version) return;
    if (!m.picture.shown || !m.surfaces.inputs)
        throw std::logic_error("FrameRenderer::drawOverlay before render");
    if (!m.overlay.pass) m.overlay.pass = std::make_unique<OverlayPass>();
    FrameCamera camera = m.surfaces.camera;
    if (m.sequence.movingFrames > 0) camera.offset = {};  // the picture is a mean over offsets
    m.overlay.pass->draw(lines, camera, m.surfaces.gbuffer.depth, {}, m.profiler, m.newestPicture(),
                         m.overlay.picture);
    m.overlay.version = version;
    m.overlay.current = true;
    const std::vector<StageTime> times = m.profiler.take();
    statistics.stagesOfBothSides.insert(statistics.stagesOfBothSides.end(), times.begin(),
                                        times.end());
    statistics.memory = m.memory();
}

std::uint64_t FrameRenderer::viewsVersion() const { return impl_->views.frame.version; }
std::uint64_t FrameRenderer::mapViewsVersion(int side) const {
    const auto& kept = impl_->sides.at(static_cast<std::size_t>(side));
    return kept && impl_->mapViewsOf(*kept) ? impl_->views.frame.mapViews.version
                                            : impl_->views.frame.version;
}
std::uint64_t FrameRenderer::mapsVersion(int side) const {
    const auto& kept = impl_->sides.at(static_cast<std::size_t>(side));
    return kept ? kept->mapsVersion : 0;
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
