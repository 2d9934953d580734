// Results that come late: what a frame takes over from the one before.

#include <algorithm>
#include <optional>
#include <utility>

#include "renderer/frame_state.h"

namespace mv {

bool FrameRenderer::Impl::settle() {
    if (results == gl::Results::waited) return true;
    if (views.next && !(views.frame.hierarchyPass.placed() && views.frame.mapViews.placed()))
        return false;
    for (const auto& side : sides) {
        if (!side || !side->unproved) continue;
        const Proof proof = side->visibility->proof(side->statistics);
        if (proof == Proof::underWay) return false;
        side->unproved = false;
        if (proof == Proof::overflowed) {
            side->visibility->forget();
            side->history = {};
            late.mapsFailed = true;
        }
    }
    if (!late.mapsFailed) late.held = false;
    return true;
}

bool FrameRenderer::Impl::underWay() const {
    return views.next || late.held || std::any_of(sides.begin(), sides.end(), [](const auto& side) {
               return side && (side->unproved || side->badCounts.requested());
           });
}

bool FrameRenderer::Impl::mapsLag() const {
    return std::any_of(sides.begin(), sides.end(), [](const auto& side) {
        return side && side->visibility && side->visibility->mapsLag();
    });
}

void FrameRenderer::Impl::holdPicture() {
    late.mapsFailed = false;  // this frame has made its maps anew
    const bool unproved = std::any_of(sides.begin(), sides.end(),
                                      [](const auto& side) { return side && side->unproved; });
    if (!unproved || late.held) return;
    std::swap(late.front, overlay.current  ? overlay.picture
                          : sideCount == 2 ? picture.display
                                           : sides[0]->display);
    late.held = true;
}

void FrameRenderer::Impl::placeOwnTrees(TracedViews& with, int depth) {
    if (results == gl::Results::waited) return;
    for (const auto& side : sides) {
        const GpuViewHierarchy* tree = side ? &mapHierarchy(*side) : &views.frame.tree;
        if (tree == &views.frame.tree || tree == &views.frame.mapViews.subset.tree || tree->flat)
            continue;
        (with.mapViews.chosen ? with.mapViews.pass : with.hierarchyPass)
            .place({.levels = depth, .rules = side->settings.rules}, profiler);
    }
}

void FrameRenderer::Impl::traceNext(const Settings& settings, const FrameInput& input,
                                    const Emitters& wanted) {
    if (results == gl::Results::waited) return;
    ViewsInput from = wantedViews(settings, input, wanted);
    if (views.frame.input == from) return;
    NextViews upcoming{std::move(from), wanted, std::move(views.spare)};
    // The sort and the places of the frame's views are overwritten: what fails on the way leaves
    // none.
    std::optional<ViewsInput> shown = std::exchange(views.frame.input, std::nullopt);
    traceViews(settings, upcoming.input, input, wanted, views.frame, upcoming.views);
    placeOwnTrees(views.frame, upcoming.input.settings.octreeDepth);
    views.frame.input = std::move(shown);
    views.next = std::move(upcoming);
}

}  // namespace mv
