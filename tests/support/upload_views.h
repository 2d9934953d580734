#pragma once
// The CPU's view hierarchy on the GPU.

#include <algorithm>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

inline GpuViewHierarchy upload(const ViewHierarchy& h) {
    GpuViewHierarchy out;
    out.sortedViews = {"sorted views", h.sortedViews};
    out.mortonKeys = {"view keys", h.mortonKeys};
    out.nodes = {"view nodes", h.nodes};
    out.mapOfNode = {"map of view node", h.mapOfNode};
    out.leafOfView = {"leaf of view", h.leafOfView};
    out.aliveCount = static_cast<std::uint32_t>(h.sortedViews.size());
    out.nodeCount = static_cast<std::uint32_t>(h.nodes.size());
    out.leafCount = h.leafCount;
    for (const View& view : h.sortedViews) out.slotCount = std::max(out.slotCount, view.slot + 1);
    out.levelBegin = h.levelBegin;
    // One view a node and no parents: a flat forest. A tree of one view is the same but for its
    // table of levels.
    out.flat = h.levelBegin.size() == 2 && h.leafCount == h.nodes.size() &&
               h.nodes.size() == h.sortedViews.size();
    return out;
}

}  // namespace mv
