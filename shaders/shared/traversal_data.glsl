// What the host and the kernels of the GPU traversal say to each other beside trees and maps.
#ifndef MV_TRAVERSAL_DATA_GLSL
#define MV_TRAVERSAL_DATA_GLSL
#include "shaders/shared/bindings.glsl"

// Lanes of the largest work group: counts of eight children a lane are summed in ten bits.
#define MV_MOST_LANES 127

MV_BEGIN_NAMESPACE

// Words of the status buffer: did anything overflow; how many large splats were left over; how
// many work groups of a list level were suspended, in turn; then entries appended to list level k
// or queue k, past the capacity too.
MV_CONST uint kStatusOverflow = 0u;
MV_CONST uint kStatusLarge = 1u;
MV_CONST uint kStatusSuspended = 2u;
MV_CONST uint kFirstStatusCounter = 4u;
MV_CONST uint kStatusWords = 64u;

// Pair counters: work groups spread over kCounterSlots sums, which the CPU adds up. A sum has
// kPairCounters 64-bit numbers a level of the scene node (or for all levels together), padded to
// kCounterWords words.
MV_CONST uint kCounterSlots = 64u;
MV_CONST uint kCounterWords = 16u;
MV_CONST uint kCountCulled = 0u;
MV_CONST uint kCountRendered = 1u;  // the forced ones included
MV_CONST uint kCountForced = 2u;
MV_CONST uint kCountSubdivided = 3u;
MV_CONST uint kCountSkipped = 4u;
MV_CONST uint kPairCounters = 5u;
MV_CONST uint kCountRenderedViews = 5u;  // counted apart

// A pair in a queue: (scene node | kPairFlag, view node). The flag says, where the pair is to be
// split, that the scene is; where it is to be drawn, that it is forced.
MV_CONST uint kPairFlag = 0x80000000u;

// A list is a chain of chunks of one buffer: [entries, next chunk, entry...].
MV_CONST uint kChunkHeader = 2u;

// A work group of traverse_lists.comp that goes on in a later dispatch.
struct Suspended {
    uint node, newest, nextChunk, listAt, listLeft;
    uint stackChunk, stackEntries, largeChunk, largeEntries;
};

MV_END_NAMESPACE

#ifdef __cplusplus
static_assert(sizeof(mv::Suspended) == 36);
#endif
#endif
