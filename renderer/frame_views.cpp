// Still pictures of more than one set of views: with --fresh-views each set of gather samples after
// the first has VPLs of its own, and maps of them, so that the mean has neither the blotches nor
// the noise of one choice of views. The frame's own views stay as they are, for everything that is
// read back or measured.

#include <utility>

#include "renderer/frame_state.h"

namespace mv {

bool FrameRenderer::Impl::hasOwnViews(const Settings& settings, int n) const {
    if (n < 2 || !settings.averagesViews() || loadedViews) return false;
    // Both sets of maps are to fit the budget of one.
    for (std::size_t i = 0; i < settings.sideCount(); ++i) {
        const Side& side = *sides[i];
        if (2 * side.statistics.mapBytes > bytesOf(side.settings.maps)) return false;
        if (side.visibility && !side.visibility->maps().slices.empty()) return false;
    }
    return true;
}

bool FrameRenderer::Impl::makeSetViews(const Settings& settings, const FrameInput& input, int n) {
    if (!views.ofSet) views.ofSet = std::make_unique<TracedViews>(results);
    TracedViews& s = *views.ofSet;
    ViewsInput from = *views.frame.input;
    from.seed = viewSeed(settings.seed, n);
    if (s.input != from) {
        s.input.reset();
        s.version = 0;
        traceViews(settings, from, input, lights.emitters, s, s.views);
        s.input = std::move(from);
        placeOwnTrees(s, s.input->settings.octreeDepth);
    }
    if (s.version == 0) {
        const bool placed = s.hierarchyPass.placed() && s.mapViews.placed();
        if (results == gl::Results::late && !placed) return false;
        s.hierarchyPass.build({.levels = s.input->settings.octreeDepth}, profiler, s.tree);
        s.version = ++views.versions;
    }
    bool done = true;
    for (std::size_t i = 0; i < settings.sideCount(); ++i) {
        const gl::OwnerScope owner(profiler, ownerOf(i));
        done &= makeSetMaps(settings, *sides[i]);
    }
    return done;
}

bool FrameRenderer::Impl::makeSetMaps(const Settings& settings, Side& side) {
    if (!side.setMaps) side.setMaps = std::make_unique<SetMaps>();
    SetMaps& own = *side.setMaps;
    // Kept cuts would belong to the views of another set.
    MethodSettings wanted = side.settings;
    wanted.pairs.cut = Cut::basic;
    if (!own.visibility || own.method != wanted.method) {
        own.visibility = mv::makeVisibility(wanted.method, results);
        own.method = wanted.method;
        own.records = {};  // of the maps of another, whose versions count from 1, too
    }
    TracedViews& s = *views.ofSet;
    const MapTree from = treeOfMaps(settings, wanted, s);
    own.visibility->build({.scene = *sceneOnGpu,
                           .views = from.tree,
                           .viewHierarchies = from.pass,
                           .viewDepth = s.input->settings.octreeDepth,
                           .version = from.version,
                           .seed = s.input->seed},
                          wanted, profiler, own.statistics);
    const Proof proof = own.visibility->proof(own.statistics);
    if (proof == Proof::overflowed) own.visibility->forget();
    return proof == Proof::good;
}

void FrameRenderer::Impl::dropSetViews() {
    views.ofSet.reset();
    for (const auto& side : sides) {
        if (side) side->setMaps.reset();
    }
}

SetLight FrameRenderer::Impl::lightOfSet(const Settings& settings, int n, const GBuffer& of,
                                         Side& side) {
    const bool own = hasOwnViews(settings, n);
    SetMaps* maps = own ? side.setMaps.get() : nullptr;
    const TracedViews& traced = own ? *views.ofSet : views.frame;
    const Visibility* visibility = own ? maps->visibility.get() : side.visibility.get();
    SetLight light{.cullTree = traced.tree,
                   .visibility = visibility,
                   .mapViews = traced.mapViews.subsetFor(visibility),
                   .records = own ? maps->records.records : side.records.records,
                   .viewsVersion = traced.version,
                   .mapsVersion = own ? maps->visibility->version() : side.mapsVersion};
    if (!light.visibility) return light;
    {
        const gl::OwnerScope owner(profiler, kBothSides);  // the same for both sides
        cullFor(settings, of, light.cullTree, light.viewsVersion);
    }
    SideRecords& recorded = own ? maps->records : side.records;
    const std::optional<double> clampDistance = settings.gather.clampDistance;
    if (recorded.maps != light.mapsVersion || recorded.views != light.viewsVersion ||
        recorded.clampDistance != clampDistance) {
        gatherPass.record(light.mapHierarchy(), light.maps(), light.mapViews, profiler,
                          recorded.records);
        recorded.maps = light.mapsVersion;
        recorded.views = light.viewsVersion;
        recorded.clampDistance = clampDistance;
    }
    return light;
}

}  // namespace mv
