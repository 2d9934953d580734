// Results that come late: what a frame takes over from the one before.

#include <algorithm>
#include <utility>

#include "renderer/frame_state.h"

namespace mv {

bool FrameRenderer::Impl::settle() {
    if (results == gl::Results::waited) return true;
    if (next && !(viewHierarchyPass.placed() && mapViews.placed())) return false;
    for (const auto& side : sides) {
        if (!side || !side->unproved) continue;
        const Proof proof = side->visibility->proof(side->statistics);
        if (proof == Proof::underWay) return false;
        side->unproved = false;
        if (proof == Proof::overflowed) {
            side->visibility->forget();
            side->history = {};
            mapsFailed = true;
        }
    }
    if (!mapsFailed) held = false;
    return true;
}

bool FrameRenderer::Impl::underWay() const {
    return next || held || std::any_of(sides.begin(), sides.end(), [](const auto& side) {
               return side && (side->unproved || side->badCounts.requested());
           });
}

bool FrameRenderer::Impl::lags() const {
    return std::any_of(sides.begin(), sides.end(), [](const auto& side) {
        return side && side->visibility && side->visibility->lags();
    });
}

void FrameRenderer::Impl::holdPicture() {
    mapsFailed = false;  // the maps are others now
    const bool unproved = std::any_of(sides.begin(), sides.end(),
                                      [](const auto& side) { return side && side->unproved; });
    if (!unproved || held) return;
    std::swap(front, overlayCurrent ? overlaid : sideCount == 2 ? display : sides[0]->display);
    held = true;
}

void FrameRenderer::Impl::placeOwnTrees(ViewHierarchyPass& pass, MapViews& chosen, int depth) {
    if (results == gl::Results::waited) return;
    for (const auto& side : sides) {
        const GpuViewHierarchy* tree = side ? &mapHierarchy(*side) : &cullTree;
        if (tree == &cullTree || tree == &mapViews.of.tree || tree->flat) continue;
        (chosen.chosen ? chosen.pass : pass)
            .place({.levels = depth, .rules = side->settings.rules}, profiler);
    }
}

void FrameRenderer::Impl::traceNext(const Settings& settings, const FrameInput& input,
                                    const Emitters& wanted) {
    if (results == gl::Results::waited) return;
    ViewsInput from = wantedViews(settings, input, wanted);
    if (viewsInput == from) return;
    NextViews upcoming{std::move(from), wanted, std::move(spareViews)};
    traceViews(upcoming.input, input, wanted, viewHierarchyPass, upcoming.views);
    beginMapViews(settings, upcoming.input, viewHierarchyPass, mapViews);
    placeOwnTrees(viewHierarchyPass, mapViews, upcoming.input.settings.octreeDepth);
    next = std::move(upcoming);
}

}  // namespace mv
