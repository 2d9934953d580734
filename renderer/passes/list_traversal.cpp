#include <algorithm>

#include "renderer/gl/context.h"
#include "renderer/passes/traversal_job.h"

namespace mv {
namespace {

std::uint32_t sizeOf(glm::uvec2 range) { return range.y - range.x; }

}  // namespace

std::pair<std::uint64_t, std::uint64_t> ListTraversal::workBytes(const TraversalJob& job,
                                                                 const PassRange& range) {
    if (!job.fuse) return {0, 0};
    std::uint64_t nodes[2] = {0, 0};
    for (std::size_t level = 0; level + 1 < range.levels.size(); ++level) {  // the last has leaves
        nodes[level & 1] = std::max<std::uint64_t>(nodes[level & 1], sizeOf(range.levels[level]));
    }
    return {std::max(nodes[0], nodes[1]) * job.mapBytes(),
            std::min(nodes[0], nodes[1]) * job.mapBytes()};
}

std::uint64_t ListTraversal::maxEntries(const TraversalJob& job) const {
    const gl::Limits& limits = gl::limits();
    const std::uint64_t bytes = std::min<std::uint64_t>(
        job.options.queueMemoryBytes / 2, static_cast<std::uint64_t>(limits.maxStorageBlockBytes));
    return std::min<std::uint64_t>(bytes / 4,
                                   static_cast<std::uint64_t>(limits.maxTextureBufferTexels));
}

void ListTraversal::reserve(const TraversalJob& job, std::uint64_t entries) {
    entries_ = entries;
    for (TexelBuffer& list : lists_) list.ensure("view node lists", GL_R32UI, entries * 4);
    heads_.ensure("list heads", std::max<std::uint64_t>(1, job.views.nodeCount) * 4);
}

std::uint64_t ListTraversal::bytes() const {
    return lists_[0].buffer.bytes() + lists_[1].buffer.bytes() + heads_.bytes();
}

PassOutcome ListTraversal::run(const TraversalJob& job, const PassRange& range,
                               TraversalBuffers& buffers, ProgramCache& programs) {
    const gl::PassScope scope(job.profiler, "traverse");
    // The map in shared memory needs 2 R^2 words of it; larger ones are worked on where they are.
    const bool shared = job.options.viewRes <= 32;
    gl::Defines defines = job.defines();
    defines.emplace_back("MV_MAP_SHARED", shared ? "1" : "0");
    defines.emplace_back("MV_SHARED_ENTRIES", std::to_string(job.options.sharedEntries));
    gl::Program& program = programs.get("traverse_lists.comp", defines);

    for (std::size_t parity = 0; parity < 2; ++parity) {
        std::uint64_t nodes = 0;
        for (std::size_t level = parity; job.fuse && level + 1 < range.levels.size(); level += 2)
            nodes = std::max<std::uint64_t>(nodes, sizeOf(range.levels[level]));
        buffers.work[parity].ensure("working maps", GL_R32UI,
                                    std::max<std::uint64_t>(nodes * job.mapBytes(), 16));
    }
    buffers.status.fill(0);
    buffers.bind(job);
    heads_.bindStorage(3);
    job.views.mapOfNode.bindStorage(4);
    program.set("firstOwnedView", range.firstView);
    program.set("listCapacity", static_cast<std::uint32_t>(entries_));

    for (std::size_t level = 0; level < range.levels.size(); ++level) {
        const std::size_t own = level & 1, above = own ^ 1;
        lists_[own].buffer.bindStorage(2);
        buffers.work[own].buffer.bindStorage(6);
        lists_[above].texels.bind(2);
        buffers.work[above].texels.bind(3);
        program.set("firstNode", range.levels[level].x);
        program.set("nodeCount", sizeOf(range.levels[level]));
        program.set("firstParentNode", level ? range.levels[level - 1].x : 0u);
        program.set("statusIndex", kFirstStatusCounter + static_cast<std::uint32_t>(level));
        // Producer: the level above (lists, heads, working maps), or the pass before (leaf maps).
        gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
        program.dispatchGroups(sizeOf(range.levels[level]));
    }

    const auto status = buffers.status.read<std::uint32_t>(0, kStatusWords);
    return {status[0] != 0, *std::max_element(status.begin() + kFirstStatusCounter, status.end())};
}

}  // namespace mv
