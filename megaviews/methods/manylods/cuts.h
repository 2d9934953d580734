#pragma once
// Incremental and lazy cuts of ManyLoDs [HREB11 §3.2, §3.3] (SceneHierarchy x flat ViewHierarchy ->
// ViewMaps): the views keep their cuts through the scene octree from frame to frame. This is the
// readable definition that renderer/methods/manylods reproduces; decisions come from
// shaders/shared/pair.glsl, what is kept of them from shaders/shared/cut.glsl.
//
// The paper's rule is local: a node whose parent is valid merges, one that is not valid splits. It
// stands still at the cut of the basic method only where validity is monotone from ancestors to
// descendants, which it is not quite: a child may be hardly smaller than its parent, but nearer.
// Here a cut is done only when the decisions of all ancestors are known, each by one of the cut's
// nodes; clearances tell them, and the nodes' own, without tests while views move little.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/maps/view_maps.h"
#include "megaviews/methods/megaviews/pairs.h"
#include "megaviews/settings/statistics.h"
#include "shaders/shared/cut.glsl"

namespace mv {

struct CutOptions {
    MethodSettings method;
    // Levels by which one update may descend below a node of the old cut, at least 1 [HREB11 §3.3].
    // Views without a cut descend as far as they need.
    std::uint32_t iterations = std::numeric_limits<std::uint32_t>::max();
};

struct CutUpdate {
    ViewMaps leafMaps;  // one a view, in the order of the hierarchy
    PairCounts counts;  // of the pairs that were tested
    CutCounts cuts;
};

class ViewCuts {
  public:
    // Cuts go through one octree: its nodes may be refitted between updates, but not change places.
    // movingBegin: by level the first node that moves, as in MovingSurface; empty: none does.
    explicit ViewCuts(std::span<const SceneNode> sceneNodes,
                      std::vector<std::uint32_t> movingBegin = {});

    // Takes each view's cut to where the view stands now and renders it. A view is known again by
    // its slot; views that are gone lose their cuts. Other settings start from the root. views:
    // flat. sceneNodes: those of the rules.
    CutUpdate update(std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                     const CutOptions& options);

  private:
    struct Cut {
        CutView view{};
        std::vector<CutNode> nodes;
    };
    class Update;
    std::vector<std::uint32_t> parents_, movingBegin_;
    std::vector<Cut> cuts_;  // by slot
    MethodSettings made_;    // what the cuts were made with
};

}  // namespace mv
