#include <algorithm>

#include "renderer/gl/context.h"
#include "renderer/gl/workarounds.h"
#include "renderer/methods/megaviews/traversal_job.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

// Workaround::loopLimit: iterations that a work group may take. Beside the rounds the kernel loads
// and stores its map, writes its entries, and may go over by a round and one large splat.
std::uint32_t loopBudgetOf(const ManyViewOptions& options) {
    if (options.loopBudget > 0) return options.loopBudget;
    if (!gl::isOn(gl::Workaround::loopLimit)) return 1u << 30;
    const auto lanes = static_cast<std::uint32_t>(gl::limits().workGroupSize);
    const auto res = static_cast<std::uint32_t>(options.maps.resolution);
    const std::uint32_t texelLoops = 3 * mapTexels(res) / lanes;
    const std::uint32_t entryLoops = 4 * options.sharedEntries / lanes + 512;
    return 65000 - std::min(texelLoops + entryLoops, 64000u);
}

}  // namespace

std::array<std::uint64_t, 2> ListTraversal::workBytes(const TraversalJob& job,
                                                      const PassRange& range) const {
    if (!job.fuse) return {0, 0};
    std::array<std::uint64_t, 2> bytes{};
    for (std::size_t level = 0; level + 1 < range.levels.size(); ++level) {  // the last has leaves
        bytes[level & 1] = std::max(bytes[level & 1], sizeOf(range.levels[level]) * job.mapBytes());
    }
    return bytes;
}

std::uint64_t ListTraversal::maxEntries(const TraversalJob& job) const {
    // Two buffers of 4 bytes an entry.
    const gl::Limits& limits = gl::limits();
    return std::min({job.options.queueMemoryBytes / 8,
                     static_cast<std::uint64_t>(limits.maxStorageBlockBytes) / 4,
                     static_cast<std::uint64_t>(limits.maxTextureBufferTexels)});
}

std::uint64_t ListTraversal::bytesFor(const TraversalJob& job, std::uint64_t entries) const {
    return 8 * entries + 4 * std::max<std::uint64_t>(1, job.views.nodeCount) +
           2 * job.views.widestLevel() * sizeof(Suspended);
}

void ListTraversal::reserve(const TraversalJob& job, std::uint64_t entries) {
    entries_ = entries;
    for (auto& list : lists_) list.ensure("view node lists", entries);
    heads_.ensure("list heads", std::max<std::uint64_t>(1, job.views.nodeCount) * 4);
}

std::uint64_t ListTraversal::bytes() const {
    return lists_[0].bytes() + lists_[1].bytes() + heads_.bytes() + suspended_[0].bytes() +
           suspended_[1].bytes();
}

void ListTraversal::bindLevel(const TraversalJob& job, const PassRange& range, std::size_t level,
                              TraversalBuffers& buffers, gl::Program& program) {
    const std::size_t own = level & 1, above = own ^ 1;
    buffers.bind(job, range);
    lists_[own].bindStorage(kBlockLists);
    heads_.bindStorage(kBlockListHeads);
    buffers.work[own].bindStorage(kBlockWorkMaps);
    lists_[above].bindTexels(kUnitParentLists);
    buffers.work[above].bindTexels(kUnitParentMaps);
    lists_[own].bindTexels(kUnitOwnLists);
    suspended_[0].bindStorage(kBlockSuspended);
    program.set("firstNode", range.levels[level].x);
    program.set("firstMap", range.maps.x);
    program.set("nodeCount", sizeOf(range.levels[level]));
    program.set("firstParentNode", level ? range.levels[level - 1].x : 0u);
    program.set("statusIndex", kFirstStatusCounter + static_cast<std::uint32_t>(level));
    program.set("resume", 0u);
    program.set("suspendIndex", kStatusSuspended);
}

// Work groups of the level just dispatched that spent their budget go on, until none is left.
void ListTraversal::resumeSuspended(TraversalBuffers& buffers, gl::Program& program) {
    for (std::uint32_t from = 0;; from ^= 1) {
        const auto status = buffers.status.read<std::uint32_t>(0, kFirstStatusCounter);
        const std::uint32_t count = status[kStatusSuspended + from];
        buffers.status.fill(kStatusSuspended, 2, 0);
        if (count == 0 || status[kStatusOverflow] != 0) return;
        suspended_[from].bindStorage(kBlockResumed);
        suspended_[from ^ 1].bindStorage(kBlockSuspended);
        program.set("resume", 1u);
        program.set("nodeCount", count);
        program.set("suspendIndex", kStatusSuspended + (from ^ 1));
        program.dispatchGroups(count);
    }
}

void ListTraversal::run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                        ProgramCache& programs) {
    const gl::PassScope scope(job.profiler, Stage::traverse);
    // The map in shared memory needs 2 R^2 words of it; larger ones are worked on where they are.
    const bool shared = job.options.maps.resolution <= 32;
    gl::Defines defines = job.defines();
    defines.emplace_back("MV_MAP_SHARED", shared ? "1" : "0");
    defines.emplace_back("MV_SHARED_ENTRIES", std::to_string(job.options.sharedEntries));
    gl::Program& program = programs.get("megaviews/traverse_lists.comp", defines);

    std::uint64_t widest = 0;
    std::array<std::uint64_t, 2> maps{};
    for (std::size_t level = 0; level < range.levels.size(); ++level) {
        const std::uint64_t nodes = sizeOf(range.levels[level]);
        widest = std::max(widest, nodes);
        const bool inner = level + 1 < range.levels.size();
        if (job.fuse && inner) maps[level & 1] = std::max(maps[level & 1], nodes);
    }
    for (std::size_t parity = 0; parity < 2; ++parity) {
        buffers.work[parity].ensure("working maps",
                                    std::max<std::uint64_t>(maps[parity] * job.mapBytes() / 4, 4));
        suspended_[parity].ensure("suspended work groups", widest * sizeof(Suspended));
    }
    program.set("pairRes", job.pairResolution());
    program.set("firstOwnedView", range.firstView);
    program.set("listCapacity", static_cast<std::uint32_t>(entries_));
    program.set("loopBudget", loopBudgetOf(job.options));

    buffers.status.fill(0);
    for (std::size_t level = 0; level < range.levels.size(); ++level) {
        bindLevel(job, range, level, buffers, program);
        program.dispatchGroups(sizeOf(range.levels[level]));
        if (careful_) resumeSuspended(buffers, program);
        job.profiler.report(Stage::traverse, static_cast<double>(level + 1) /
                                                 static_cast<double>(range.levels.size()));
    }
    levels_ = range.levels.size();
}

PassOutcome ListTraversal::outcome(std::span<const std::uint32_t> status) {
    const auto counters = status.subspan(kFirstStatusCounter, levels_);
    PassOutcome outcome;
    outcome.occupancy.assign(counters.begin(), counters.end());
    if (status[kStatusOverflow] != 0) {
        outcome.end = PassEnd::full;
    } else if (status[kStatusSuspended] != 0) {
        careful_ = true;
        outcome.end = PassEnd::again;
    }
    return outcome;
}

}  // namespace mv
