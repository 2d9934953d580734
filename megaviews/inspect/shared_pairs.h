#pragma once
// What two views share [Kol19 fig. 1c]: pairs rendered once for both, because the view node holds
// both, and pairs of each alone.

#include "megaviews/inspect/lines.h"
#include "megaviews/inspect/view_pairs.h"

namespace mv {

struct SharedPairs {
    // Rendered pairs; the scene nodes of each.
    std::vector<NodePair> both, aAlone, bAlone;
};

SharedPairs sharedPairs(const ViewPairs& a, const ViewPairs& b);

// The boxes of their scene nodes in the colours of sharingLegend(), each of the three up to a cap.
DrawnCount appendSharedPairs(const SharedPairs& shared, std::span<const SceneNode> sceneNodes,
                             std::vector<Line>& lines, std::uint64_t cap = kMaxDrawnNodes);

}  // namespace mv
