#include "renderer/passes/view_hierarchy_pass.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "renderer/passes/radix_sort.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/cone.glsl"
#include "shaders/shared/morton.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kChunkSize = 32;      // sorted views that one invocation looks at
constexpr std::uint64_t kStorageAlign = 256;  // largest offset alignment that OpenGL allows
constexpr std::uint32_t kAlignNodes = 64;     // nodes whose every per-node array is so aligned

gl::Program program(const std::string& label, const std::string& file,
                    const std::string& define = {}) {
    gl::Defines d;
    if (!define.empty()) d.emplace_back(define, "1");
    return gl::Program(label, {"passes/view_hierarchy_" + file + ".comp"}, d);
}

// Room for a table that a slightly larger frame need not reallocate.
std::uint64_t roomy(std::uint64_t elements) { return elements + elements / 8 + 64; }

std::uint32_t leafLevelOf(const ViewHierarchyOptions& options) {
    return static_cast<std::uint32_t>(options.levels - 1);
}

}  // namespace

std::uint64_t GpuMapViews::bytes() const {
    return views.views.bytes() + tree.bytes() + places.bytes();
}

std::uint64_t GpuViewHierarchy::bytes() const {
    return sortedViews.bytes() + mortonKeys.bytes() + nodes.bytes() + mapOfNode.bytes() +
           leafOfView.bytes();
}

std::uint64_t GpuViewHierarchy::widestLevel() const {
    std::uint32_t widest = 0;
    for (std::size_t level = 0; level + 1 < levelBegin.size(); ++level) {
        widest = std::max(widest, levelBegin[level + 1] - levelBegin[level]);
    }
    return widest;
}

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
    gl::Program choose, borrow;  // made at first use
    RadixSort radix;
    PrefixSum prefixSum;

    // Where nodes of the last sort start, by each table of rules, and the table of levels that
    // comes back.
    struct Placed {
        explicit Placed(gl::Results results) : back("view level table", results) {}
        int levels = 0;  // 0: not of this sort
        gl::TexelBuffer<std::uint32_t> viewLevels, counts, begins;
        gl::Buffer table;
        gl::ReadBack back;
        std::vector<std::uint32_t> values;  // of the table, once it is there
    };

    bool sorted = false;
    std::uint32_t slots = 0;                 // of the last sort
    gl::TextureBuffer viewTexels;            // of the last sort
    std::array<Placed, kNodeTables> placed;  // by viewTable()
    gl::TexelBuffer<glm::uvec4> starts;
    gl::TexelBuffer<glm::vec4> bounds, blocks;

    explicit Impl(gl::Results results)
        : placed{Placed(results), Placed(results), Placed(results), Placed(results)} {}
    void placeNodes(const ViewHierarchyOptions& options);
    // The table of nodes that were placed; waits for it where it is not there.
    const std::vector<std::uint32_t>& tableOf(Placed& p);
    void takeLevels(const ViewHierarchyOptions& options, GpuViewHierarchy& out);
    std::uint32_t aliveCount();
    void gatherViews(GpuViewHierarchy& out);
    void buildFlat(GpuViewHierarchy& out);
    void buildTree(const ViewHierarchyOptions& options, GpuViewHierarchy& out);
    // Steps of buildTree(): sums over blocks of views inside one leaf, the nodes of a level from
    // these or from the level below, and the leaf of every view.
    void sumBlocks(const ViewHierarchyOptions& options, const GpuViewHierarchy& out);
    void makeNodes(std::uint32_t level, const ViewHierarchyOptions& options,
                   const GpuViewHierarchy& out);
    void tellLeaves(const ViewHierarchyOptions& options, const GpuViewHierarchy& out);
    const gl::TexelBuffer<std::uint32_t>& viewLevels(const ViewHierarchyOptions& options) const {
        return placed[viewTable(options.rules)].viewLevels;
    }
};

ViewHierarchyPass::ViewHierarchyPass(gl::Results results)
    : impl_(std::make_unique<Impl>(results)) {}
ViewHierarchyPass::~ViewHierarchyPass() = default;

void ViewHierarchyPass::sort(const GpuViews& views, gl::Profiler& profiler) {
    const gl::PassScope scope(profiler, Stage::sortViews);
    Impl& m = *impl_;
    m.sorted = true;
    for (Impl::Placed& placed : m.placed) {
        placed.levels = 0;
        placed.back.forget();
    }
    m.slots = views.count;
    m.radix.resize(views.count);
    if (views.count > 0) {
        // The texels are the buffer's alone: whoever holds the views may hand them on.
        m.viewTexels = gl::TextureBuffer("views", GL_RGBA32UI, views.views);
        assert(views.views.bytes() >= std::uint64_t{views.count} * sizeof(View));
        m.keys.set("count", views.count);
        m.viewTexels.bind(kUnitViews);
        m.radix.pairs().bindStorage(kBlockSortPairs);
        m.keys.dispatchInvocations(views.count);
    }
    m.radix.sort();
}

void ViewHierarchyPass::chooseForMaps(std::uint32_t most, gl::Profiler& profiler, GpuViews& out) {
    assert(impl_->sorted && "sort first");
    const gl::PassScope scope(profiler, Stage::sortViews);
    Impl& m = *impl_;
    if (!m.choose) m.choose = program("views with maps", "choose");
    out.count = std::min(most, m.slots);
    out.views.ensure("views with maps", roomy(out.count));
    if (out.count == 0) return;
    m.choose.set("most", out.count);
    m.radix.pairs().bindTexels(kUnitSortPairs);
    m.radix.alive().bindTexels(kUnitSortAlive);
    m.viewTexels.bind(kUnitViews);
    out.views.bindStorage(kBlockViews);
    m.choose.dispatchInvocations(out.count);
}

void ViewHierarchyPass::borrowMaps(const GpuViewHierarchy& all, gl::Profiler& profiler,
                                   GpuMapViews& out) {
    const gl::PassScope scope(profiler, Stage::viewHierarchy);
    gl::Program& p = impl_->borrow;
    if (!p) p = program("map borrowing", "borrow");
    out.all = &all;
    out.places.ensure("places of maps", roomy(all.aliveCount));
    p.set("viewCount", all.aliveCount);
    p.set("maps", out.tree.aliveCount);
    all.sortedViews.bindTexels(kUnitSortedViews);
    out.tree.sortedViews.bindTexels(kUnitViews);
    out.places.bindStorage(kBlockPlaces);
    p.dispatchInvocations(all.aliveCount);
}

// Counts where nodes start, and asks for the table of levels.
void ViewHierarchyPass::Impl::placeNodes(const ViewHierarchyOptions& options) {
    Placed& p = placed[viewTable(options.rules)];
    if (p.levels == options.levels) return;
    p.levels = options.levels;
    p.values.clear();
    p.back.forget();
    const std::uint32_t capacity = radix.count();
    const auto levelCount = static_cast<std::uint32_t>(options.levels);
    const std::uint32_t chunks = std::max(1u, (capacity + kChunkSize - 1) / kChunkSize);
    const std::uint32_t runs = levelCount * chunks;
    const std::uint32_t sums = runs + chunks + 1;

    // Levels of every view.
    p.viewLevels.ensure("view levels", roomy(capacity));
    levels.set("capacity", capacity);
    levels.set("leafLevel", levelCount - 1);
    levels.set("rules", options.rules);
    radix.pairs().bindTexels(kUnitSortPairs);
    radix.alive().bindTexels(kUnitSortAlive);
    p.viewLevels.bindStorage(kBlockViewLevels);
    levels.dispatchInvocations(capacity);

    // Nodes of every (level, chunk), then leaves of every chunk; one more for the total.
    p.counts.ensure("view node counts", roomy(sums));
    p.begins.ensure("view node begins", roomy(sums));
    countStarts.set("chunkSize", kChunkSize);
    for (gl::Program* program : {&countStarts, &table}) {
        program->set("chunks", chunks);
        program->set("levelCount", levelCount);
    }
    p.viewLevels.bindTexels(kUnitViewLevels);
    radix.alive().bindTexels(kUnitSortAlive);
    p.counts.bindStorage(kBlockNodeCounts);
    countStarts.dispatchInvocations(runs);
    prefixSum.exclusive(p.counts, sums, p.begins);

    p.table.ensure("view level table", 64);
    p.begins.bindTexels(kUnitNodeBegins);
    radix.alive().bindTexels(kUnitSortAlive);
    p.table.bindStorage(kBlockLevelTable);
    table.dispatchInvocations(levelCount + 3);
    p.back.request(p.table, 0, (levelCount + 3) * 4);
}

const std::vector<std::uint32_t>& ViewHierarchyPass::Impl::tableOf(Placed& p) {
    if (p.values.empty()) p.values = *p.back.takeNow<std::uint32_t>();
    return p.values;
}

// Sizes from the table, and the nodes' starts in place.
void ViewHierarchyPass::Impl::takeLevels(const ViewHierarchyOptions& options,
                                         GpuViewHierarchy& out) {
    Placed& p = placed[viewTable(options.rules)];
    const std::vector<std::uint32_t>& values = tableOf(p);
    const auto levelCount = static_cast<std::uint32_t>(options.levels);
    const std::uint32_t chunks = std::max(1u, (radix.count() + kChunkSize - 1) / kChunkSize);
    const std::uint32_t runs = levelCount * chunks;
    out.levelBegin.assign(values.begin(), values.begin() + levelCount + 1);
    out.nodeCount = values[levelCount];
    out.leafCount = values[levelCount + 1];
    out.aliveCount = values[levelCount + 2];

    starts.ensure("view node starts", roomy(out.nodeCount));
    for (const auto& [name, value] :
         {std::pair("chunkSize", kChunkSize), std::pair("chunks", chunks),
          std::pair("levelCount", levelCount)}) {
        emitStarts.set(name, value);
    }
    p.viewLevels.bindTexels(kUnitViewLevels);
    radix.alive().bindTexels(kUnitSortAlive);
    p.begins.bindTexels(kUnitNodeBegins);
    starts.bindStorage(kBlockNodeStarts);
    if (out.nodeCount > 0) emitStarts.dispatchInvocations(runs);
}

void ViewHierarchyPass::Impl::gatherViews(GpuViewHierarchy& out) {
    const std::uint64_t n = roomy(out.aliveCount);
    out.sortedViews.ensure("sorted views", n);
    out.mortonKeys.ensure("view keys", n);
    out.leafOfView.ensure("leaf of view", n);
    gather.set("count", out.aliveCount);
    radix.pairs().bindTexels(kUnitSortPairs);
    viewTexels.bind(kUnitViews);
    out.sortedViews.bindStorage(kBlockSortedViews);
    out.mortonKeys.bindStorage(kBlockViewKeys);
    if (out.aliveCount > 0) gather.dispatchInvocations(out.aliveCount);
}

// Any table of this sort says it; without one it is waited for.
std::uint32_t ViewHierarchyPass::Impl::aliveCount() {
    for (Placed& p : placed) {
        if (p.levels > 0) return tableOf(p)[static_cast<std::size_t>(p.levels) + 2];
    }
    return radix.alive().read(0, 1)[0];
}

void ViewHierarchyPass::Impl::buildFlat(GpuViewHierarchy& out) {
    out.aliveCount = aliveCount();
    out.slotCount = slots;
    out.nodeCount = out.leafCount = out.aliveCount;
    out.levelBegin = {0, out.aliveCount};
    gatherViews(out);
    const std::uint64_t n = roomy(out.nodeCount);
    out.nodes.ensure("view nodes", n);
    out.mapOfNode.ensure("map of view node", n);
    flat.set("count", out.nodeCount);
    out.sortedViews.bindTexels(kUnitSortedViews);
    out.nodes.bindStorage(kBlockViewNodes);
    out.mapOfNode.bindStorage(kBlockMapOfNode);
    out.leafOfView.bindStorage(kBlockLeafOfView);
    if (out.nodeCount > 0) flat.dispatchInvocations(out.nodeCount);
}

void ViewHierarchyPass::Impl::buildTree(const ViewHierarchyOptions& options,
                                        GpuViewHierarchy& out) {
    placeNodes(options);
    takeLevels(options, out);
    gatherViews(out);
    const std::uint64_t n = roomy(out.nodeCount);
    out.nodes.ensure("view nodes", n);
    out.mapOfNode.ensure("map of view node", n);
    bounds.ensure("view node bounds", n * 2);
    sumBlocks(options, out);
    for (std::uint32_t level = leafLevelOf(options) + 1; level-- > 0;) {  // bottom-up
        makeNodes(level, options, out);
    }
    tellLeaves(options, out);
}

void ViewHierarchyPass::Impl::sumBlocks(const ViewHierarchyOptions& options,
                                        const GpuViewHierarchy& out) {
    const std::uint32_t blockCount = out.aliveCount / kViewBlock;
    blocks.ensure("view blocks", roomy(blockCount) * 4);
    blocksOfViews.set("count", blockCount);
    blocksOfViews.set("leafLevel", leafLevelOf(options));
    out.sortedViews.bindTexels(kUnitSortedViews);
    viewLevels(options).bindTexels(kUnitViewLevels);
    blocks.bindStorage(kBlockViewBlocks);
    blocksOfViews.dispatchInvocations(blockCount);
}

void ViewHierarchyPass::Impl::makeNodes(std::uint32_t level, const ViewHierarchyOptions& options,
                                        const GpuViewHierarchy& out) {
    const std::uint32_t leafLevel = leafLevelOf(options);
    const std::uint32_t begin = out.levelBegin[level], end = out.levelBegin[level + 1];
    if (begin == end) return;
    const bool last = level == leafLevel;
    gl::Program& p = last ? leafNodes : innerNodes;
    const std::uint32_t outputBegin = begin / kAlignNodes * kAlignNodes;
    p.set("level", level);
    p.set("leafLevel", leafLevel);
    p.set("levelBegin", begin);
    p.set("count", end - begin);
    p.set("childrenEnd", last ? end : out.levelBegin[level + 2]);
    p.set("outputBegin", outputBegin);
    p.set("viewCount", out.aliveCount);
    p.set("rules", options.rules);
    out.sortedViews.bindTexels(kUnitSortedViews);
    starts.bindTexels(kUnitNodeStarts);
    viewLevels(options).bindTexels(kUnitViewLevels);
    out.mortonKeys.bindTexels(kUnitViewKeys);
    out.nodes.bindTexels(kUnitViewNodes);
    bounds.bindTexels(kUnitNodeBounds);
    blocks.bindTexels(kUnitViewBlocks);
    // A storage block may be smaller than the node array: a level's part of it is bound.
    const auto bindLevel = [&](const gl::Buffer& b, GLuint binding, std::uint64_t bytes) {
        static_assert(kAlignNodes * 4 % kStorageAlign == 0);
        b.bindStorage(binding, outputBegin * bytes, (end - outputBegin) * bytes);
    };
    bindLevel(out.nodes, kBlockViewNodes, sizeof(ViewNode));
    out.mapOfNode.bindStorage(kBlockMapOfNode);
    bindLevel(bounds, kBlockNodeBounds, 2 * sizeof(glm::vec4));
    out.leafOfView.bindStorage(kBlockLeafOfView);
    p.dispatchInvocations(end - begin);
}

// Leaves wrote themselves beside their first view: now beside the others.
void ViewHierarchyPass::Impl::tellLeaves(const ViewHierarchyOptions& options,
                                         const GpuViewHierarchy& out) {
    leavesOfViews.set("count", out.aliveCount);
    leavesOfViews.set("leafLevel", leafLevelOf(options));
    viewLevels(options).bindTexels(kUnitViewLevels);
    out.mortonKeys.bindTexels(kUnitViewKeys);
    out.leafOfView.bindStorage(kBlockLeafOfView);
    leavesOfViews.dispatchInvocations(out.aliveCount);
}

void ViewHierarchyPass::place(const ViewHierarchyOptions& options, gl::Profiler& profiler) {
    assert(impl_->sorted && "sort first");
    const gl::PassScope scope(profiler, Stage::viewHierarchy);
    impl_->placeNodes(options);
}

bool ViewHierarchyPass::placed() {
    return std::all_of(impl_->placed.begin(), impl_->placed.end(),
                       [](Impl::Placed& p) { return p.back.arrived(); });
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
}

std::uint64_t ViewHierarchyPass::bytes() const {
    const Impl& m = *impl_;
    std::uint64_t sum = m.radix.bytes() + m.prefixSum.bytes() + m.starts.bytes() +
                        m.bounds.bytes() + m.blocks.bytes();
    for (const Impl::Placed& p : m.placed) {
        sum += p.viewLevels.bytes() + p.counts.bytes() + p.begins.bytes() + p.table.bytes();
    }
    return sum;
}

}  // namespace mv
