#pragma once
// All lines that Settings ask for over the picture, and the numbers that panels show beside them.
// Inspector keeps what takes time to make between frames: hierarchies on the CPU and the lines.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/inspect/lines.h"
#include "megaviews/inspect/shared_pairs.h"
#include "megaviews/inspect/steps.h"
#include "megaviews/inspect/view_map_image.h"
#include "megaviews/inspect/view_pairs.h"
#include "megaviews/settings/settings.h"

namespace mv {

// The hierarchy that the left side's method traverses; method none: the one the gather culls with.
ViewHierarchyOptions viewHierarchyOptions(const Settings& settings);

struct OverlayInput {
    std::span<const SceneNode> sceneNodes;  // of the settings' rules
    std::span<const std::uint32_t> sceneLevelBegin;
    const ViewHierarchy* views = nullptr;  // null: nothing that needs views is drawn
};

struct InspectedPick {
    std::optional<std::uint32_t> sortedView;  // nullopt: none picked, or the slot is dead
    PairCounts counts;                        // of the view nodes above it
    std::uint64_t chainNodes = 0;
};

struct Overlay {
    std::vector<Line> lines;
    std::uint64_t version = 0;  // Inspector: another number for other lines
    DrawnCount sceneNodes, viewNodes, views;
    InspectedPick a, b;
    // Where both are picked.
    std::uint64_t pairsOfBoth = 0, pairsOfAAlone = 0, pairsOfBAlone = 0;
    DrawnCount sharedBoxes;
    // Where inspect.step is not 0.
    int step = 0;  // shown: the one asked for or the last there is
    bool stepFinished = false, stepStopped = false;
    std::vector<PairCounts> countsPerStep;
    DrawnCount stepPairs;         // drawn, of those that are eligible
    std::uint64_t stepLinks = 0;  // drawn
    std::vector<NodePair> stepDrawn;
    std::array<std::uint64_t, 7> stepDecisions{};  // pairs of that step, by kPair*
};

// The picked pair and its decision; nullopt where none is picked or the trees lack such nodes.
std::optional<NodePair> pickedPair(std::span<const SceneNode> sceneNodes,
                                   const ViewHierarchy& views, const Settings& settings);

bool overlayWanted(const Settings& settings);
bool overlayNeedsViews(const Settings& settings);

Overlay makeOverlay(const OverlayInput& input, const Settings& settings);

// The same with what it needs: give it the scene once, views whenever they change (they are only
// needed where overlayNeedsViews or a panel asks), and ask it each frame. Everything is made when
// it is first asked for and kept until what it was made from changes.
class Inspector {
  public:
    Inspector();
    ~Inspector();
    void setScene(const SceneHierarchy& hierarchy);  // outlives the inspector or the next setScene
    void setViews(std::vector<View> views);          // by slot, as FrameRenderer::readViews
    void clearViews();                               // frees them and what was made of them

    const Overlay& overlay(const Settings& settings);
    std::span<const SceneNode> sceneNodes(uint rules);
    const ViewHierarchy& viewHierarchy(const Settings& settings);  // empty without views
    // What the left side's method makes of a view; nullptr if the slot holds no living one.
    struct InspectedView {
        ViewPairs pairs;
        ViewMapsOfView maps;
    };
    const InspectedView* inspectView(const Settings& settings, std::int64_t slot);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
