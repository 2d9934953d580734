#include "renderer/methods/manylods/cut_traversal.h"

#include <algorithm>
#include <limits>
#include <string>

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/types.glsl"

namespace mv {
namespace {

// Two buffers of nodes and of pending ones, which are no more; a quarter as many merge, or are
// large.
constexpr std::uint64_t kEntryBytes =
    2 * sizeof(CutEntry) + 2 * sizeof(CutPending) + 4 + (sizeof(CutMerged) + 8) / 4;

// Words of held_.
constexpr std::uint64_t kHeldWords = 2;

}  // namespace

struct CutTraversal::Frame {
    const TraversalJob& job;
    const PassRange& range;
    TraversalBuffers& buffers;
    ProgramCache& programs;
    // A kernel that updates cuts, with what they all read.
    gl::Program& kernel(const CutTraversal& cuts, const std::string& file,
                        std::uint32_t nextRound) const;
    void dispatchCounted(gl::Program& program, std::uint32_t statusIndex,
                         std::uint64_t capacity) const {
        mv::dispatchCounted(program, statusIndex, capacity, program.groupSize().x, buffers,
                            programs);
    }
};

std::uint64_t CutTraversal::maxEntries(const TraversalJob& job) const {
    const std::uint64_t maps =
        job.out.mapCount * job.mapBytes() + job.views.leafCount * job.mipBytes();
    const std::uint64_t budget = job.options.gpuMemoryBytes;
    return std::min(
        (budget - std::min(maps, budget)) / kEntryBytes,
        static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes) / sizeof(CutEntry));
}

std::uint64_t CutTraversal::bytesFor(const TraversalJob& job, std::uint64_t entries) const {
    return entries * kEntryBytes +
           job.views.slotCount * (2 * sizeof(CutView) + sizeof(CutStep) + 4 * kCutMergedWords) +
           job.scene.nodeCount * sizeof(std::uint32_t);
}

std::uint64_t CutTraversal::mergedCapacity() const { return merged_.bytes() / sizeof(CutMerged); }

void CutTraversal::reserve(const TraversalJob& job, std::uint64_t entries) {
    const std::uint64_t slots = std::max<std::uint64_t>(job.views.slotCount, 1);
    if (entries > entries_ || slots * sizeof(CutView) > views_[0].bytes()) forget();
    entries_ = std::max(entries, entries_);
    for (std::size_t k = 0; k < 2; ++k) {
        nodes_[k].ensure("cuts", entries_);
        views_[k].ensure("views of cuts", slots * sizeof(CutView));
        pending_[k].ensure("pending nodes of cuts", entries_);
    }
    steps_.ensure("steps of cuts", slots);
    chains_.ensure("chains of cuts", entries_);
    lastMerged_.ensure("last merged nodes", slots * kCutMergedWords);
    merged_.ensure("merged nodes of cuts", (entries_ / 4 + 1) * sizeof(CutMerged));
    large_.ensure("large splats", entries_ / 4 + 1);
    held_.ensure("sizes of cuts", kHeldWords * 4);
}

std::uint64_t CutTraversal::bytes() const {
    std::uint64_t sum = steps_.bytes() + chains_.bytes() + lastMerged_.bytes() + merged_.bytes() +
                        held_.bytes() + parents_.bytes() + large_.bytes();
    for (std::size_t k = 0; k < 2; ++k)
        sum += nodes_[k].bytes() + views_[k].bytes() + pending_[k].bytes();
    return sum;
}

// Discards the kept cuts; the next run() starts at the root.
void CutTraversal::forget() { key_.reset(); }

void CutTraversal::findParents(const TraversalJob& job, ProgramCache& programs) {
    if (parents_.size() >= job.scene.nodeCount) return;
    parents_.ensure("parents of scene nodes", job.scene.nodeCount);
    parents_.fill(kNone);
    gl::Program& program = programs.get("manylods/cut_parents.comp");
    program.set("nodeCount", job.scene.nodeCount);
    job.scene.nodes.bindTexels(kUnitSceneNodes);
    parents_.bindStorage(kBlockSceneParents);
    program.dispatchInvocations(job.scene.nodeCount);
}

void CutTraversal::run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                       ProgramCache& programs) {
    const gl::PassScope scope(job.profiler, Stage::traverse);
    findParents(job, programs);
    const Key key{job.options.rules, job.pairResolution()};
    if (key_ != key) {
        views_[0].fill(0);  // kCutNone
        held_.fill(0);
        key_ = key;
    }
    buffers.status.fill(0);
    buffers.status.copy(held_, 0, kStatusOldCutNodes * 4, kHeldWords * 4);
    steps_.fill(kNone);
    lastMerged_.fill(kNone);
    views_[1].fill(0);
    buffers.bind(job, range);
    job.views.sortedViews.bindTexels(kUnitSortedViews);
    parents_.bindTexels(kUnitSceneParents);
    steps_.bindStorage(kBlockCutSteps);
    steps_.bindTexels(kUnitCutSteps);
    lastMerged_.bindTexels(kUnitCutLastMerged);

    const Frame frame{job, range, buffers, programs};
    beginViews(frame);
    testChains(frame);
    placeNodes(frame);
    placeMerged(frame);
    // A descent from the root goes down level by level, and so does one from anywhere.
    rounds_ = static_cast<std::uint32_t>(std::max(job.scene.levels, 1));
    for (std::uint32_t round = 0; round < rounds_; ++round) {
        testRound(frame, round);
        job.profiler.report(Stage::traverse, static_cast<double>(round) / rounds_);
    }
    draw(frame);

    held_.copy(buffers.status, kStatusCutNodes * 4, 0, 4);
    held_.copy(buffers.status, kStatusOverflow * 4, 4, 4);
    std::swap(nodes_[0], nodes_[1]);
    std::swap(views_[0], views_[1]);
}

gl::Program& CutTraversal::Frame::kernel(const CutTraversal& cuts, const std::string& file,
                                         std::uint32_t nextRound) const {
    gl::Program& program = programs.get("manylods/" + file, job.defines());
    for (std::size_t level = 0; level < kSceneLevels; ++level) {
        const std::vector<std::uint32_t>& moving = job.scene.movingBegin;
        program.set("movingBegin[" + std::to_string(level) + "]",
                    level < moving.size() ? moving[level] : kNone);
    }
    program.set("pairRes", job.pairResolution());
    program.set("iterations", job.options.pairs.cut == Cut::lazy
                                  ? static_cast<std::uint32_t>(job.options.pairs.lazyIterations)
                                  : std::numeric_limits<std::uint32_t>::max());
    program.set("cutCapacity", static_cast<std::uint32_t>(cuts.entries_));
    program.set("pendingCapacity", static_cast<std::uint32_t>(cuts.entries_));
    program.set("nextRound", nextRound);
    cuts.nodes_[1].bindStorage(kBlockCutNodes);
    cuts.pending_[nextRound & 1].bindStorage(kBlockCutPending);
    return program;
}

void CutTraversal::beginViews(const Frame& frame) {
    gl::Program& program = frame.kernel(*this, "cut_views.comp", 1);
    views_[0].bindStorage(kBlockOldCutViews);
    views_[1].bindStorage(kBlockNewCutViews);
    program.set("viewCount", frame.job.views.nodeCount);
    program.dispatchInvocations(frame.job.views.nodeCount);
}

void CutTraversal::testChains(const Frame& frame) {
    gl::Program& expired = frame.programs.get("manylods/cut_expired.comp", frame.job.defines());
    expired.set("cutCapacity", static_cast<std::uint32_t>(entries_));
    nodes_[0].bindTexels(kUnitCutNodes);
    chains_.bindStorage(kBlockCutChains);
    frame.dispatchCounted(expired, kStatusOldCutNodes, entries_);

    gl::Program& program = frame.kernel(*this, "cut_chains.comp", 0);
    chains_.bindTexels(kUnitCutChains);
    nodes_[0].bindStorage(kBlockOldCutNodes);
    merged_.bindStorage(kBlockCutMerged);
    lastMerged_.bindStorage(kBlockCutLastMerged);
    program.set("mergedCapacity", static_cast<std::uint32_t>(mergedCapacity()));
    frame.dispatchCounted(program, kStatusCutChains, entries_);
}

void CutTraversal::placeNodes(const Frame& frame) {
    gl::Program& program = frame.kernel(*this, "cut_nodes.comp", 0);
    nodes_[0].bindTexels(kUnitCutNodes);
    merged_.bindStorage(kBlockCutMerged);
    frame.dispatchCounted(program, kStatusOldCutNodes, entries_);
}

void CutTraversal::placeMerged(const Frame& frame) {
    gl::Program& program = frame.kernel(*this, "cut_merged.comp", 0);
    merged_.bindStorage(kBlockCutMerged);
    program.set("mergedCapacity", static_cast<std::uint32_t>(mergedCapacity()));
    frame.dispatchCounted(program, kStatusCutMerged, mergedCapacity());
}

void CutTraversal::testRound(const Frame& frame, std::uint32_t round) {
    gl::Program& program = frame.kernel(*this, "cut_round.comp", round + 1);
    pending_[round & 1].bindTexels(kUnitCutNodes);
    frame.dispatchCounted(program, kFirstStatusCounter + round, entries_);
}

void CutTraversal::draw(const Frame& frame) {
    gl::Program& program = frame.programs.get("manylods/cut_draw.comp", frame.job.defines());
    frame.buffers.bind(frame.job, frame.range);
    nodes_[1].bindTexels(kUnitCutNodes);
    large_.bindStorage(kBlockLargePairs);
    program.set("firstMap", frame.range.maps.x);
    program.set("cutCapacity", static_cast<std::uint32_t>(entries_));
    program.set("largeCapacity", static_cast<std::uint32_t>(large_.size()));
    frame.dispatchCounted(program, kStatusCutNodes, entries_);

    splatLarge(frame.job, frame.range, large_, frame.buffers, frame.programs);
}

PassOutcome CutTraversal::outcome(std::span<const std::uint32_t> status) {
    const auto pending = status.subspan(kFirstStatusCounter, rounds_);
    const std::uint32_t* counts = &status[kStatusCutCounts];
    counts_ = {.nodes = status[kStatusCutNodes],
               .kept = counts[kCutCountKept],
               .culled = counts[kCutCountCulled],
               .coarse = counts[kCutCountCoarse],
               .split = counts[kCutCountSplit],
               .merged = counts[kCutCountMerged],
               .iterations = status[kStatusCutNodes] > 0};
    for (std::uint32_t round = 0; round < rounds_; ++round) {
        if (pending[round] > 0) counts_.iterations = round + 1;
    }
    return {status[kStatusOverflow] != 0 ? PassEnd::full : PassEnd::done,
            {pending.begin(), pending.end()}};
}

}  // namespace mv
