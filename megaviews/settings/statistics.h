#pragma once
// What a frame reports about itself: written by the renderer, read by panels, JSON and benchmark
// tables. Each number is named, with unit and clock, once in statistics_table.h.

#include <cstdint>
#include <string>
#include <vector>

namespace mv {

// Every tested pair counts once, the root included:
// processed = culled + rendered + subdivided + skipped; forced is part of rendered.
struct PairCounts {
    std::uint64_t processed = 0, culled = 0, rendered = 0, subdivided = 0, skipped = 0;
    std::uint64_t forced = 0;         // leaf pairs rendered although larger than the threshold
    std::uint64_t renderedViews = 0;  // sum over rendered pairs of the view node's views
    bool operator==(const PairCounts&) const = default;
    PairCounts& operator+=(const PairCounts& other) {
        processed += other.processed;
        culled += other.culled;
        rendered += other.rendered;
        subdivided += other.subdivided;
        skipped += other.skipped;
        forced += other.forced;
        renderedViews += other.renderedViews;
        return *this;
    }
    double viewsPerRenderedNode() const {
        return rendered ? static_cast<double>(renderedViews) / static_cast<double>(rendered) : 0.0;
    }
};

PairCounts sumOf(const std::vector<PairCounts>& counts);

// What became of ManyLoDs' cuts that are kept from frame to frame [HREB11 §3.2], of all views.
struct CutCounts {
    std::uint64_t nodes = 0;       // of all cuts
    std::uint64_t kept = 0;        // of these, taken over without a test
    std::uint64_t culled = 0;      // of these, not seen by their views
    std::uint64_t coarse = 0;      // of these, larger than they should be: lazy cuts lag behind
    std::uint64_t split = 0;       // nodes replaced by their children
    std::uint64_t merged = 0;      // nodes that replaced what was below them
    std::uint32_t iterations = 0;  // rounds of tests, the last that found a node to test
    bool operator==(const CutCounts&) const = default;
    CutCounts& operator+=(const CutCounts& other) {
        nodes += other.nodes;
        kept += other.kept;
        culled += other.culled;
        coarse += other.coarse;
        split += other.split;
        merged += other.merged;
        iterations = iterations > other.iterations ? iterations : other.iterations;
        return *this;
    }
    double coarseShare() const {
        return nodes ? static_cast<double>(coarse) / static_cast<double>(nodes) : 0.0;
    }
};

// What a frame spends time on, in its order; each is a row of stageTable() (statistics_table.h).
enum class Stage {
    pose,
    guideViews,
    traceViews,
    chooseViews,
    particles,
    sortViews,
    viewHierarchy,
    gBuffer,
    drawParticles,
    drawSky,
    directLight,
    reflections,
    traverse,
    fill,
    fuse,
    rasterise,
    makePoints,
    splatPoints,
    pullAndPush,
    gatherCull,
    marchTree,
    skyMaps,
    gather,
    nearField,
    skyLight,
    history,
    filter,
    accumulate,
    compose,
    sharing,
    shared,
    difference,
    toneMap,
    overlay,
};

// One stage of the frame. `clock` of the frame says what the milliseconds mean.
struct StageTime {
    Stage stage{};
    double ms = 0;
};

// Subsets of the views that a traversal was split into, and how well what their queues or lists
// take was known before [TSK13 table 2].
struct PassCounts {
    std::uint64_t made = 0;
    std::uint64_t overflows = 0;    // passes that were done again as smaller ones
    std::uint64_t falseAlarms = 0;  // splits between passes that would have fitted as one
    std::uint64_t predicted = 0;    // passes whose entries could be foretold by others'
    double predictionError = 0;     // of these: mean |relative difference|
};

struct MethodStatistics {
    PairCounts pairs;
    CutCounts cuts;                    // of cuts that are kept
    std::uint64_t queuePeakPairs = 0;  // queue: pairs; lists: longest level's entries
    PassCounts passes;
    std::uint64_t queueBytes = 0, mapBytes = 0;
    std::uint64_t workingMapBytes =
        0;  // part of mapBytes: maps of inner view nodes, coarser levels
    // Worked out before anything was allocated. Buffers may be larger: they are kept from frame to
    // frame, and a queue that overflowed has grown.
    std::uint64_t predictedQueueBytes = 0, predictedMapBytes = 0, predictedWorkingMapBytes = 0;
    std::uint64_t sceneHierarchyBytes = 0, viewHierarchyBytes = 0;
    std::uint64_t points = 0;  // that vir made, of all levels of detail
    std::uint64_t maps = 0;    // fused maps = leaf view nodes
    double meanSharing = 0;    // of the picture, while DebugView::sharing is shown; else 0
    // Share of the gather's samples with light to give that the method asked the scene about:
    // with maps, where their texels did not agree. Late where results are.
    double undecidedShare = 0;
    std::vector<StageTime> stages;  // of this frame: none of the maps' if it kept them
    double mapsMs = 0;              // of the stages that made the maps, in the frame that did
    double gatherMs = 0;            // of the gather and its filter, in the last frame that gathered
    std::vector<std::uint64_t> occupancy;  // lists or queue: entries handed on, step by step
    // By level of the scene node; only where FrameInput::countLevels asked for it.
    std::vector<PairCounts> pairsPerLevel;
};

// A buffer or family of buffers. predicted = 0: not predicted.
struct MemoryUse {
    std::string name;  // "scene octree", "maps, left", ...
    std::uint64_t usedBytes = 0, predictedBytes = 0;
};

struct FrameStatistics {
    std::string clock;  // "gpu timer" or "wall clock, synchronised"
    std::uint64_t viewsRequested = 0, viewsAlive = 0;
    std::uint64_t viewNodes = 0, viewLeaves = 0;
    std::vector<std::uint64_t> viewNodesPerLevel;
    std::vector<StageTime> stagesOfBothSides;  // trace, G-buffer, ... common to both methods
    std::vector<MethodStatistics> methods;     // one, or two when comparing
    std::vector<MemoryUse> memory;             // everything on the GPU
    std::uint64_t freeGpuBytes = 0;            // 0: the driver does not say
    int accumulatedFrames = 1;                 // whose samples the picture averages
    double differenceRange = 0;                // end of the colour scale in use
    std::uint64_t badPixels = 0;               // NaN or infinity
    std::uint64_t skyPoints = 0;               // that the maps of the sky's views are made of
    double exposureEv = 0;
    double frameMs = 0;
};

}  // namespace mv
