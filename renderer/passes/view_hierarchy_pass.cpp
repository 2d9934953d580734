#include "renderer/passes/view_hierarchy_pass.h"

#include <algorithm>
#include <cassert>

#include "renderer/gl/context.h"
#include "renderer/passes/radix_sort.h"
#include "shaders/shared/cone.glsl"
#include "shaders/shared/morton.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kChunkSize = 32;      // sorted views that one invocation looks at
constexpr std::uint64_t kStorageAlign = 256;  // largest offset alignment that OpenGL allows
constexpr std::uint32_t kAlignNodes = 64;     // nodes whose every per-node array is so aligned

gl::Program program(const std::string& label, const std::string& file,
                    const std::string& define = {}) {
    gl::Defines d = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}};
    if (!define.empty()) d.emplace_back(define, "1");
    return gl::Program(label, {"passes/view_hierarchy_" + file + ".comp"}, d);
}

// Keeps a result's texel view in step with its buffer, which other passes may have replaced.
void ensureTexels(gl::TextureBuffer& texels, gl::Buffer& buffer, const std::string& label,
                  GLenum format, std::uint64_t bytes) {
    if (texels && buffer && buffer.bytes() >= bytes) return;
    buffer.ensure(label, bytes);
    texels = gl::TextureBuffer(label, format, buffer);
}

// Room for a table that a slightly larger frame need not reallocate.
std::uint64_t roomy(std::uint64_t elements) { return elements + elements / 8 + 64; }

}  // namespace

struct ViewHierarchyPass::Impl {
    gl::Program keys = program("view keys", "keys");
    gl::Program levels = program("view levels", "levels");
    gl::Program countStarts = program("view nodes, count", "starts", "MV_COUNT");
    gl::Program emitStarts = program("view nodes, place", "starts");
    gl::Program table = program("view levels, table", "table");
    gl::Program gather = program("views, sorted", "gather");
    gl::Program innerNodes = program("view nodes", "nodes");
    gl::Program leafNodes = program("view leaves", "nodes", "MV_LEAF_LEVEL");
    gl::Program blocksOfViews = program("view blocks", "blocks");
    gl::Program leavesOfViews = program("leaf of view", "leaves");
    gl::Program flat = program("view nodes, flat", "flat");
    RadixSort radix;
    PrefixSum prefixSum;

    bool sorted = false;
    gl::TextureBuffer viewTexels;  // of the last sort
    TexelArray viewLevels, counts, begins, starts, bounds, blocks;
    gl::Buffer tableBuffer;
    gl::TextureBuffer sortedViewTexels, keyTexels;

    void placeNodes(const ViewHierarchyOptions& options, GpuViewHierarchy& out);
    void gatherViews(GpuViewHierarchy& out);
    void buildFlat(GpuViewHierarchy& out);
    void buildTree(const ViewHierarchyOptions& options, GpuViewHierarchy& out);
};

ViewHierarchyPass::ViewHierarchyPass() : impl_(std::make_unique<Impl>()) {}
ViewHierarchyPass::~ViewHierarchyPass() = default;

void ViewHierarchyPass::sort(const GpuViews& views, gl::Profiler& profiler) {
    const gl::PassScope scope(profiler, Stage::sortViews);
    Impl& m = *impl_;
    m.sorted = true;
    m.radix.resize(views.count);
    if (views.count > 0) {
        assert(views.views.bytes() >= std::uint64_t{views.count} * sizeof(View));
        m.viewTexels = gl::TextureBuffer("views", GL_RGBA32UI, views.views);
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: VplPass or ParticlePass
        m.keys.set("count", views.count);
        m.viewTexels.bind(0);
        m.radix.pairs().buffer.bindStorage(0);
        m.keys.dispatchInvocations(views.count);
    }
    m.radix.sort();
}

// Counts where nodes start and places them all; reads back the table of levels.
void ViewHierarchyPass::Impl::placeNodes(const ViewHierarchyOptions& options,
                                         GpuViewHierarchy& out) {
    const std::uint32_t capacity = radix.count();
    const auto levelCount = static_cast<std::uint32_t>(options.levels);
    const std::uint32_t chunks = std::max(1u, (capacity + kChunkSize - 1) / kChunkSize);
    const std::uint32_t runs = levelCount * chunks;

    // Levels of every view.
    viewLevels.ensure("view levels", GL_R32UI, roomy(capacity) * 4);
    levels.set("capacity", capacity);
    levels.set("leafLevel", levelCount - 1);
    levels.set("published", options.published ? 1 : 0);
    radix.pairs().texels.bind(0);
    radix.alive().texels.bind(1);
    viewLevels.buffer.bindStorage(0);
    levels.dispatchInvocations(capacity);

    // Nodes, then leaves, of every (level, chunk); one more for the total.
    counts.ensure("view node counts", GL_R32UI, roomy(2 * runs + 1) * 4);
    begins.ensure("view node begins", GL_R32UI, roomy(2 * runs + 1) * 4);
    for (gl::Program* p : {&countStarts, &emitStarts, &table}) {
        p->set("chunkSize", kChunkSize);
        p->set("chunks", chunks);
        p->set("levelCount", levelCount);
    }
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: view levels
    viewLevels.texels.bind(0);
    radix.alive().texels.bind(1);
    counts.buffer.bindStorage(0);
    countStarts.dispatchInvocations(runs);
    prefixSum.exclusive(counts.texels, 2 * runs + 1, begins.buffer);

    // The table comes back; sizes are known from here on.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: prefix sum
    tableBuffer.ensure("view level table", 64);
    begins.texels.bind(0);
    radix.alive().texels.bind(1);
    tableBuffer.bindStorage(0);
    table.dispatchInvocations(levelCount + 3);
    const std::vector<std::uint32_t> values = tableBuffer.read<std::uint32_t>(0, levelCount + 3);
    out.levelBegin.assign(values.begin(), values.begin() + levelCount + 1);
    out.nodeCount = values[levelCount];
    out.leafCount = values[levelCount + 1];
    out.aliveCount = values[levelCount + 2];

    starts.ensure("view node starts", GL_RGBA32UI, roomy(out.nodeCount) * 16);
    viewLevels.texels.bind(0);
    radix.alive().texels.bind(1);
    begins.texels.bind(2);
    starts.buffer.bindStorage(0);
    if (out.nodeCount > 0) emitStarts.dispatchInvocations(runs);
}

void ViewHierarchyPass::Impl::gatherViews(GpuViewHierarchy& out) {
    const std::uint64_t n = roomy(out.aliveCount);
    out.sortedViews.ensure("sorted views", n * sizeof(View));
    out.mortonKeys.ensure("view keys", n * 4);
    out.leafOfView.ensure("leaf of view", n * 4);
    sortedViewTexels = gl::TextureBuffer("sorted views", GL_RGBA32UI, out.sortedViews);
    keyTexels = gl::TextureBuffer("view keys", GL_R32UI, out.mortonKeys);
    gather.set("count", out.aliveCount);
    radix.pairs().texels.bind(0);
    viewTexels.bind(1);
    out.sortedViews.bindStorage(0);
    out.mortonKeys.bindStorage(1);
    if (out.aliveCount > 0) gather.dispatchInvocations(out.aliveCount);
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the views just gathered
}

void ViewHierarchyPass::Impl::buildFlat(GpuViewHierarchy& out) {
    out.aliveCount = radix.alive().buffer.read<std::uint32_t>(0, 1)[0];
    out.nodeCount = out.leafCount = out.aliveCount;
    out.levelBegin = {0, out.aliveCount};
    gatherViews(out);
    const std::uint64_t n = roomy(out.nodeCount);
    ensureTexels(out.nodesTexels, out.nodes, "view nodes", GL_RGBA32UI, n * sizeof(ViewNode));
    out.mapOfNode.ensure("map of view node", n * 4);
    flat.set("count", out.nodeCount);
    sortedViewTexels.bind(0);
    out.nodes.bindStorage(0);
    out.mapOfNode.bindStorage(1);
    out.leafOfView.bindStorage(2);
    if (out.nodeCount > 0) flat.dispatchInvocations(out.nodeCount);
}

void ViewHierarchyPass::Impl::buildTree(const ViewHierarchyOptions& options,
                                        GpuViewHierarchy& out) {
    placeNodes(options, out);
    gatherViews(out);
    const std::uint64_t n = roomy(out.nodeCount);
    ensureTexels(out.nodesTexels, out.nodes, "view nodes", GL_RGBA32UI, n * sizeof(ViewNode));
    out.mapOfNode.ensure("map of view node", n * 4);
    bounds.ensure("view node bounds", GL_RGBA32F, n * 32);

    // Sums over blocks of views inside one leaf.
    const std::uint32_t blockCount = out.aliveCount / kViewBlock;
    const auto leafLevel = static_cast<std::uint32_t>(options.levels - 1);
    blocks.ensure("view blocks", GL_RGBA32F, roomy(blockCount) * 64);
    blocksOfViews.set("count", blockCount);
    blocksOfViews.set("leafLevel", leafLevel);
    sortedViewTexels.bind(0);
    viewLevels.texels.bind(1);
    blocks.buffer.bindStorage(0);
    blocksOfViews.dispatchInvocations(blockCount);

    // Bottom-up. A storage block may be smaller than the node array: bind a level's part of it.
    for (std::uint32_t l = leafLevel + 1; l-- > 0;) {
        const std::uint32_t begin = out.levelBegin[l], end = out.levelBegin[l + 1];
        if (begin == end) continue;
        const bool last = l == leafLevel;
        gl::Program& p = last ? leafNodes : innerNodes;
        const std::uint32_t outputBegin = begin / kAlignNodes * kAlignNodes;
        p.set("level", l);
        p.set("leafLevel", leafLevel);
        p.set("levelBegin", begin);
        p.set("count", end - begin);
        p.set("childrenEnd", last ? end : out.levelBegin[l + 2]);
        p.set("outputBegin", outputBegin);
        p.set("viewCount", out.aliveCount);
        p.set("published", options.published ? 1 : 0);
        // Producers: the placed starts, the blocks, the level below.
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        sortedViewTexels.bind(0);
        starts.texels.bind(1);
        viewLevels.texels.bind(2);
        keyTexels.bind(3);
        out.nodesTexels.bind(4);
        bounds.texels.bind(5);
        blocks.texels.bind(6);
        const auto bindLevel = [&](const gl::Buffer& b, GLuint binding, std::uint64_t bytes) {
            static_assert(kAlignNodes * 4 % kStorageAlign == 0);
            b.bindStorage(binding, outputBegin * bytes, (end - outputBegin) * bytes);
        };
        bindLevel(out.nodes, 0, sizeof(ViewNode));
        out.mapOfNode.bindStorage(1);
        bindLevel(bounds.buffer, 2, 32);
        out.leafOfView.bindStorage(3);
        p.dispatchInvocations(end - begin);
    }

    // Leaves wrote themselves beside their first view: now beside the others.
    leavesOfViews.set("count", out.aliveCount);
    leavesOfViews.set("leafLevel", leafLevel);
    gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT);  // producer: view nodes
    viewLevels.texels.bind(0);
    keyTexels.bind(1);
    out.leafOfView.bindStorage(0);
    leavesOfViews.dispatchInvocations(out.aliveCount);
}

void ViewHierarchyPass::build(const ViewHierarchyOptions& options, gl::Profiler& profiler,
                              GpuViewHierarchy& out) {
    assert(impl_->sorted && "sort first");
    assert(options.levels >= 1 && options.levels <= static_cast<int>(kMortonLevels) + 1);
    const gl::PassScope scope(profiler, Stage::viewHierarchy);
    out.flat = options.flat;
    if (options.flat)
        impl_->buildFlat(out);
    else
        impl_->buildTree(options, out);
    // Consumers read nodes and views as texels or storage.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

}  // namespace mv
