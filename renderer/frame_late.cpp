// Results that come late: what a frame takes over from the one before.

#include <algorithm>
#include <utility>

#include "renderer/frame_state.h"

namespace mv {

bool FrameRenderer::Impl::settle() {
    if (results == gl::Results::waited) return true;
    if (next && !viewHierarchyPass.placed()) return false;
    for (const auto& side : sides) {
        if (!side || !side->unproved) continue;
        const ManyViewPass::Proof proof = side->manyView.proof(side->statistics);
        if (proof == ManyViewPass::Proof::underWay) return false;
        side->unproved = false;
        if (proof == ManyViewPass::Proof::overflowed) {
            side->key = {};
            mapsFailed = true;
        }
    }
    if (!mapsFailed) held = false;
    if (!gatherPass.listsFit()) cullKey.reset();
    return true;
}

bool FrameRenderer::Impl::underWay() const {
    return next || held || gatherPass.listsUnderWay() ||
           std::any_of(sides.begin(), sides.end(), [](const auto& side) {
               return side && (side->unproved || side->badCounts.requested());
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

void FrameRenderer::Impl::traceNext(const Settings& settings, const FrameInput& input,
                                    const Emitters& wanted) {
    if (results == gl::Results::waited) return;
    ViewsKey key = viewsKeyOf(settings, input, wanted, generation);
    if (viewsKey == key) return;
    NextViews upcoming{std::move(key), wanted, std::move(spareViews)};
    traceViews(upcoming.key, settings, input, wanted, upcoming.views);
    for (const auto& side : sides) {
        const bool ownTree = side && !side->usesCullTree && !side->hierarchy.flat;
        if (ownTree) viewHierarchyPass.place({upcoming.key.viewDepth, true, false}, profiler);
    }
    next = std::move(upcoming);
}

}  // namespace mv
