// What the host and the kernels of kept cuts (shaders/methods/manylods) say to each other.
#ifndef MV_CUT_DATA_GLSL
#define MV_CUT_DATA_GLSL
#include "shaders/shared/cut.glsl"
#include "shaders/shared/types.glsl"

MV_BEGIN_NAMESPACE

// A node of a cut and the slot of its view; the cuts of all views lie mixed in one array.
struct CutEntry {
    CutNode node;
    uint slot;
};
// A scene node to be tested in the next round, | kCutUnlimited where its view had no cut before,
// so that its descent has no limit of rounds.
struct CutPending {
    uint node;
    uint slot;
    float above;  // as of CutNode
    uint unused;
};
MV_CONST uint kCutUnlimited = 0x80000000u;
// In CutNode::node of an old cut: its chain has been tested in this frame.
MV_CONST uint kCutChainTested = 0x80000000u;
// By slot: what a frame knows of a view.
struct CutStep {
    uint viewNode;       // kNone: the view is gone
    float displacement;  // displacementOf(); negative: its old cut is dropped
};
// An ancestor that takes the place of what is below it: one of a list for each view and level.
struct CutMerged {
    CutEntry entry;
    uint before;  // kNone: there is none
};
// By slot the last of each level, and a word whose set bits are the levels that have none.
MV_CONST uint kCutMergedWords = kSceneLevels + 1u;

// Words of the status buffer beside those of traversal_data.glsl: how many nodes the cuts hold and
// held, whether those were all of them, how many chains are tested and how many ancestors merged;
// then a CutCounts.
MV_CONST uint kStatusCutNodes = 40u;
MV_CONST uint kStatusOldCutNodes = 41u;
MV_CONST uint kStatusOldOverflow = 42u;
MV_CONST uint kStatusCutChains = 43u;
MV_CONST uint kStatusCutMerged = 44u;
MV_CONST uint kStatusCutCounts = 45u;

// What happened to a node, as bits of a mask and as places in the status buffer.
MV_CONST uint kCutCountKept = 0u;
MV_CONST uint kCutCountCulled = 1u;
MV_CONST uint kCutCountCoarse = 2u;
MV_CONST uint kCutCountSplit = 3u;
MV_CONST uint kCutCountMerged = 4u;
MV_CONST uint kCutCounters = 5u;

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::CutEntry) == 16);
static_assert(sizeof(mv::CutPending) == 16);
static_assert(sizeof(mv::CutStep) == 8);
static_assert(sizeof(mv::CutMerged) == 20);
#endif
#endif
