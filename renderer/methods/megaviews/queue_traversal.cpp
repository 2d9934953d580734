#include <algorithm>
#include <cassert>

#include "renderer/gl/context.h"
#include "renderer/methods/megaviews/traversal_job.h"
#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

constexpr std::uint64_t kFewestLarge = 4096;  // large splats there is always room for

}  // namespace

// The queue visits pairs of all levels at once: every internal node of the pass keeps its map.
std::array<std::uint64_t, 2> QueueTraversal::workBytes(const TraversalJob& job,
                                                       const PassRange& range) const {
    std::uint64_t nodes = 0;
    for (std::size_t level = 0; job.fuse && level + 1 < range.levels.size(); ++level)
        nodes += sizeOf(range.levels[level]);
    return {nodes * job.mapBytes(), 0};
}

std::uint64_t QueueTraversal::maxEntries(const TraversalJob& job) const {
    // Two buffers of 8 bytes an entry, and 2 bytes for the large splats.
    const gl::Limits& limits = gl::limits();
    return std::min({job.options.queueMemoryBytes / 18,
                     static_cast<std::uint64_t>(limits.maxStorageBlockBytes) / 8,
                     static_cast<std::uint64_t>(limits.maxTextureBufferTexels)});
}

std::uint64_t QueueTraversal::bytesFor(const TraversalJob&, std::uint64_t entries) const {
    return 16 * entries + 8 * std::max(entries / 4, kFewestLarge);
}

void QueueTraversal::reserve(const TraversalJob&, std::uint64_t entries) {
    entries_ = entries;
    for (auto& queue : queues_) queue.ensure("pair queue", entries);
    large_.ensure("large splats", std::max(entries / 4, kFewestLarge));
}

std::uint64_t QueueTraversal::bytes() const {
    return queues_[0].bytes() + queues_[1].bytes() + large_.bytes();
}

void QueueTraversal::run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                         ProgramCache& programs) {
    // Working maps of all levels but the last, one after the other: map of node n is n + offset.
    std::vector<std::uint32_t> offsets(range.levels.size(), 0);
    std::uint32_t maps = 0;
    for (std::size_t level = 0; job.fuse && level + 1 < range.levels.size(); ++level) {
        offsets[level] = maps - range.levels[level].x;
        maps += sizeOf(range.levels[level]);
    }
    buffers.work[0].ensure("working maps", std::max<std::uint64_t>(maps * job.mapBytes() / 4, 4));
    {
        const gl::PassScope scope(job.profiler, Stage::traverse);
        buffers.work[0].fill(0, maps * job.mapBytes() / 4, kNone);
        traverse(job, range, offsets, buffers, programs);
        splatLarge(job, range, large_, buffers, programs);
    }
    if (job.fuse) fuse(job, range, offsets, buffers, programs);
}

void QueueTraversal::traverse(const TraversalJob& job, const PassRange& range,
                              const std::vector<std::uint32_t>& offsets, TraversalBuffers& buffers,
                              ProgramCache& programs) {
    gl::Defines defines = job.defines();
    defines.emplace_back("MV_SEED", "1");
    gl::Program& seed = programs.get("megaviews/traverse_queue.comp", defines);
    defines.back().second = "0";
    gl::Program& program = programs.get("megaviews/traverse_queue.comp", defines);

    // A pair splits one tree at a time, so this many iterations empty the queue; those that find
    // it empty cost next to nothing.
    const int splits =
        std::max(job.scene.levels - 1, 0) + static_cast<int>(range.levels.size()) - 1;
    assert(splits + 1 + static_cast<int>(kFirstStatusCounter) <= static_cast<int>(kStatusWords));
    buffers.status.fill(0);
    buffers.bind(job, range);
    buffers.work[0].bindStorage(kBlockWorkMaps);
    large_.bindStorage(kBlockLargePairs);
    for (gl::Program* p : {&seed, &program}) {
        p->set("pairRes", job.pairResolution());
        p->set("firstOwnedView", range.firstView);
        p->set("firstMap", range.maps.x);
        p->set("endOwnedView", range.endView);
        p->set("queueCapacity", static_cast<std::uint32_t>(entries_));
        p->set("largeCapacity", static_cast<std::uint32_t>(large_.size()));
        for (std::size_t level = 0; level < offsets.size(); ++level)
            p->set("workMapOffset[" + std::to_string(level) + "]", offsets[level]);
    }
    seed.set("firstNode", range.levels[0].x);
    seed.set("nodeCount", sizeOf(range.levels[0]));
    seed.set("statusIndex", kFirstStatusCounter);
    queues_[0].bindStorage(kBlockPairQueue);
    seed.dispatchInvocations(sizeOf(range.levels[0]));

    for (int k = 0; k < splits; ++k) {
        const std::uint32_t in = kFirstStatusCounter + static_cast<std::uint32_t>(k);
        queues_[k & 1].bindTexels(kUnitPairQueue);
        program.set("statusIndex", in + 1);
        queues_[(k & 1) ^ 1].bindStorage(kBlockPairQueue);
        dispatchCounted(program, in, entries_, program.groupSize().x, buffers, programs);
        job.profiler.report(Stage::traverse, (k + 1.0) / splits);
    }
    steps_ = static_cast<std::size_t>(splits) + 1;
}

PassOutcome QueueTraversal::outcome(std::span<const std::uint32_t> status) {
    const auto counters = status.subspan(kFirstStatusCounter, steps_);
    return {status[kStatusOverflow] != 0 ? PassEnd::full : PassEnd::done,
            {counters.begin(), counters.end()}};
}

void QueueTraversal::fuse(const TraversalJob& job, const PassRange& range,
                          const std::vector<std::uint32_t>& offsets, TraversalBuffers& buffers,
                          ProgramCache& programs) {
    const gl::PassScope scope(job.profiler, Stage::fuse);
    gl::Program& program = programs.get(
        "megaviews/fuse.comp", {{"MV_MAP_RES", std::to_string(job.options.maps.resolution) + "u"}});
    buffers.bind(job, range);
    buffers.work[0].bindStorage(kBlockWorkMaps);
    for (std::size_t level = 1; level < range.levels.size(); ++level) {
        program.set("firstNode", range.levels[level].x);
        program.set("nodeCount", sizeOf(range.levels[level]));
        program.set("workMapOffset", offsets[level]);
        program.set("firstMap", range.maps.x);
        program.set("parentWorkMapOffset", offsets[level - 1]);
        program.dispatchInvocations(sizeOf(range.levels[level]) * (job.mapBytes() / 4));
    }
}

}  // namespace mv
