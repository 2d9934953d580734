#pragma once
// Octree over the views (ViewSet -> ViewHierarchy), rebuilt every frame [Kol19 §3.1]. The GPU
// builds it (renderer/passes/view_hierarchy_pass.h); this is its CPU twin and the definition both
// share. Views are sorted by (30-bit Morton key, slot); dead views come last and are not in the
// tree. Nodes lie level by level, in Morton order; children are contiguous.

#include <cstdint>
#include <vector>

#include "shaders/shared/rules.glsl"
#include "shaders/shared/types.glsl"

namespace mv {

struct ViewHierarchyOptions {
    int levels = 11;               // counted with the root, 1..11
    uint rules = kCorrectedRules;  // kRuleBoxes and kRuleLoneViews of them
    // ManyLoDs: no tree. One leaf a view, parentless, box = the view's position, in sorted order.
    bool flat = false;
};

struct ViewHierarchy {
    std::vector<View> sortedViews;          // alive only
    std::vector<std::uint32_t> mortonKeys;  // of sortedViews, at 10 bits an axis
    std::vector<ViewNode> nodes;
    std::vector<std::uint32_t> levelBegin;  // levels + 1 entries into nodes; flat: {0, n}
    std::vector<std::uint32_t> mapOfNode;   // leaves: 0.. in the order of their views; others kNone
    std::vector<std::uint32_t> leafOfView;  // node index of each sorted view's leaf
    std::uint32_t leafCount = 0;

    bool empty() const { return nodes.empty(); }
    static ViewHierarchy build(const std::vector<View>& views, const ViewHierarchyOptions& options);
};

}  // namespace mv
