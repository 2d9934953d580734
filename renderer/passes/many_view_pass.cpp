#include "renderer/passes/many_view_pass.h"

#include <algorithm>
#include <cassert>
#include <string>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/passes/map_memory.h"
#include "renderer/passes/traversal_job.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

// By level of the scene node, or a single level of all.
std::vector<PairCounts> readCounts(const gl::Buffer& counters, std::uint32_t levels) {
    const auto words =
        counters.read<std::uint32_t>(0, std::uint64_t{kCounterSlots} * levels * kCounterWords);
    std::vector<PairCounts> out(levels);
    for (std::uint32_t slot = 0; slot < kCounterSlots; ++slot) {
        for (std::uint32_t level = 0; level < levels; ++level) {
            PairCounts& c = out[level];
            std::uint64_t* const sums[] = {&c.culled,     &c.rendered, &c.forced,
                                           &c.subdivided, &c.skipped,  &c.renderedViews};
            const std::uint32_t* w = &words[(slot * levels + level) * kCounterWords];
            for (std::uint64_t* sum : sums) {
                *sum += w[0] | static_cast<std::uint64_t>(w[1]) << 32;
                w += 2;
            }
        }
    }
    for (PairCounts& c : out) c.processed = c.culled + c.rendered + c.subdivided + c.skipped;
    return out;
}

}  // namespace

struct ManyViewPass::Impl {
    TraversalBuffers buffers;
    ListTraversal lists;
    QueueTraversal queue;
    ProgramCache programs;
    gl::Buffer ranges;
    std::uint32_t passes = 1;     // of the last frame: the next one starts with as many
    std::uint64_t workBytes = 0;  // of working maps, worked out before the passes that needed most

    PassRange rangeOf(const TraversalJob& job, std::uint32_t pass, std::uint32_t passCount);
    template <typename Organisation>
    void traverse(const TraversalJob& job, Organisation& organisation,
                  MethodStatistics& statistics);
    template <typename Organisation>
    PassOutcome attempt(const TraversalJob& job, Organisation& organisation,
                        std::uint32_t passCount);
    void pushMips(const TraversalJob& job);
};

PassRange ManyViewPass::Impl::rangeOf(const TraversalJob& job, std::uint32_t pass,
                                      std::uint32_t passCount) {
    const std::vector<std::uint32_t>& begin = job.views.levelBegin;
    const std::size_t levels = begin.size() - 1;
    const auto cut = [&](std::uint64_t p) {
        return static_cast<std::uint32_t>(p * job.views.aliveCount / passCount);
    };
    PassRange range{cut(pass), cut(pass + 1), {}};
    if (passCount == 1) {
        for (std::size_t level = 0; level < levels; ++level)
            range.levels.emplace_back(begin[level], begin[level + 1]);
        return range;
    }
    gl::Program& program = programs.get("pass_ranges.comp", {job.defines().front()});
    ranges.ensure("pass ranges", 16 * sizeof(glm::uvec2));
    for (std::size_t level = 0; level < begin.size(); ++level)
        program.set("levelBegin[" + std::to_string(level) + "]", begin[level]);
    program.set("levelCount", static_cast<std::uint32_t>(levels));
    program.set("firstView", range.firstView);
    program.set("endView", range.endView);
    job.views.nodes.bindTexels(kUnitViewNodes);
    ranges.bindStorage(kBlockPassRanges);
    program.dispatchInvocations(levels);
    range.levels = ranges.read<glm::uvec2>(0, levels);
    return range;
}

// All passes once, up to the first that does not end well.
template <typename Organisation>
PassOutcome ManyViewPass::Impl::attempt(const TraversalJob& job, Organisation& organisation,
                                        std::uint32_t passCount) {
    const std::uint64_t block = std::min<std::uint64_t>(
        static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes),
        4 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels));
    const std::uint64_t used =
        job.out.mapCount * job.mapBytes() + job.views.leafCount * job.mipBytes();
    std::vector<std::uint64_t> occupancy;
    buffers.counters.fill(0);
    if constexpr (std::is_same_v<Organisation, QueueTraversal>) {
        // The queue only ever takes minima; lists write every texel themselves.
        job.out.texels.fill(0, job.out.mapCount * job.mapBytes() / 4, kNone);
    }
    if (job.mips) buffers.mips.fill(kNone);
    for (std::uint32_t pass = 0; pass < passCount; ++pass) {
        const PassRange range = rangeOf(job, pass, passCount);
        if (range.firstView == range.endView) continue;
        const auto [larger, smaller] = Organisation::workBytes(job, range);
        if (larger > block || used + larger + smaller > job.options.gpuMemoryBytes) {
            return {PassEnd::workTooLarge, {}};
        }
        workBytes = std::max(workBytes, larger + smaller);
        const PassOutcome outcome = organisation.run(job, range, buffers, programs);
        if (outcome.end != PassEnd::done) return outcome;
        occupancy.resize(std::max(occupancy.size(), outcome.occupancy.size()));
        for (std::size_t i = 0; i < outcome.occupancy.size(); ++i)
            occupancy[i] = std::max(occupancy[i], outcome.occupancy[i]);
    }
    return {PassEnd::done, std::move(occupancy)};
}

template <typename Organisation>
void ManyViewPass::Impl::traverse(const TraversalJob& job, Organisation& organisation,
                                  MethodStatistics& statistics) {
    const std::uint64_t most = std::max<std::uint64_t>(organisation.maxEntries(job), 1);
    // A first guess from what view nodes usually keep; an overflow corrects it.
    std::uint64_t widest = 0;
    for (std::size_t level = 0; level + 1 < job.views.levelBegin.size(); ++level)
        widest = std::max<std::uint64_t>(
            widest, job.views.levelBegin[level + 1] - job.views.levelBegin[level]);
    const std::uint64_t guess =
        widest / passes * (job.options.rules == Rules::published ? 512 : 64) + 65536;
    const auto reserve = [&](std::uint64_t entries) {
        organisation.reserve(job, std::min(most, entries));
    };
    statistics.predictedQueueBytes = Organisation::bytesFor(job, std::min(most, guess));
    workBytes = 0;
    reserve(std::max(guess, organisation.entries()));

    passes = std::clamp<std::uint32_t>(passes, 1, job.views.aliveCount);
    PassOutcome outcome;
    while ((outcome = attempt(job, organisation, passes)).end != PassEnd::done) {
        if (outcome.end == PassEnd::again) continue;
        if (outcome.end == PassEnd::full && organisation.entries() < most) {
            reserve(organisation.entries() * 2);
            continue;
        }
        if (passes >= job.views.aliveCount) {
            throw Error(ExitCode::impossible,
                        outcome.end == PassEnd::workTooLarge
                            ? "the maps of a single view and of the nodes above it do not fit: "
                              "--gpu-memory allows " +
                                  mebibytes(job.options.gpuMemoryBytes)
                            : "the pairs of a single view do not fit: --queue-memory allows " +
                                  mebibytes(job.options.queueMemoryBytes));
        }
        passes = std::min(passes * 2, job.views.aliveCount);
    }
    const std::uint64_t peak =
        outcome.occupancy.empty()
            ? 0
            : *std::max_element(outcome.occupancy.begin(), outcome.occupancy.end());
    statistics.occupancy = std::move(outcome.occupancy);
    statistics.passes = static_cast<int>(passes);
    statistics.queuePeakPairs = peak;
    statistics.queueBytes = organisation.bytes();
    if (peak * 3 < most && passes > 1) passes = (passes + 1) / 2;  // try fewer next time
}

void ManyViewPass::Impl::pushMips(const TraversalJob& job) {
    const gl::PassScope scope(job.profiler, Stage::fill);
    gl::Program& program = programs.get("push_mips.comp", job.defines());
    job.out.texels.bindStorage(kBlockMaps);
    buffers.mips.bindStorage(kBlockMips);
    program.set("mapCount", job.out.mapCount);
    // Producer: the traversal and the fusion.
    gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program.dispatchInvocations(job.out.mapCount * (job.mapBytes() / 4));
}

ManyViewPass::ManyViewPass() : impl_(std::make_unique<Impl>()) {}
ManyViewPass::~ManyViewPass() = default;

void ManyViewPass::render(const GpuSceneHierarchy& scene, const GpuViewHierarchy& views,
                          const ManyViewOptions& options, gl::Profiler& profiler, GpuViewMaps& out,
                          MethodStatistics& statistics) {
    const auto res = static_cast<uint>(options.viewRes);
    assert(options.viewRes >= 8 && options.viewRes <= 256 && (res & (res - 1)) == 0);
    const bool published = options.rules == Rules::published;

    out.present = true;
    out.viewRes = options.viewRes;
    out.fused = options.fusion || views.flat;
    out.mapCount = out.fused ? views.leafCount : views.nodeCount;
    TraversalJob job{scene, views, options, profiler, out};
    job.fuse = options.fusion && !views.flat;
    job.mips = out.fused && mipFilled(published, options.holeFill, res);
    checkFinalMaps(out.mapCount, options.viewRes, job.mipBytes(), options.gpuMemoryBytes);
    out.texels.ensure("view maps", std::max<std::uint64_t>(out.mapCount * job.mapBytes() / 4, 4));

    statistics.pairs = {};
    statistics.pairsPerLevel.clear();
    statistics.occupancy.clear();
    statistics.queuePeakPairs = statistics.queueBytes = statistics.predictedQueueBytes = 0;
    statistics.workingMapBytes = statistics.predictedWorkingMapBytes = 0;
    statistics.predictedMapBytes = out.mapCount * job.mapBytes();
    statistics.passes = 1;
    statistics.maps = out.mapCount;
    if (views.nodeCount == 0 || scene.nodeCount == 0) {
        out.texels.fill(0, out.mapCount * job.mapBytes() / 4, kNone);
        statistics.mapBytes = out.texels.bytes();
        return;
    }

    Impl& impl = *impl_;
    const std::uint32_t countedLevels = options.countLevels ? kTreeLevels : 1;
    impl.buffers.counters.ensure("pair counters",
                                 kCounterSlots * countedLevels * kCounterWords * 4);
    impl.buffers.status.ensure("traversal status", kStatusWords * 4);
    if (job.mips) {
        impl.buffers.mips.ensure("coarser map levels", views.leafCount * job.mipBytes());
    }
    if (options.traversal == Traversal::queue) {
        impl.traverse(job, impl.queue, statistics);
    } else {
        impl.traverse(job, impl.lists, statistics);
    }
    if (job.mips) impl.pushMips(job);
    if (options.countPairs || options.countLevels) {
        auto levels = readCounts(impl.buffers.counters, countedLevels);
        statistics.pairs = sumOf(levels);
        if (options.countLevels) statistics.pairsPerLevel = std::move(levels);
    }
    statistics.workingMapBytes = impl.buffers.mapBytes();
    statistics.predictedWorkingMapBytes = impl.workBytes + views.leafCount * job.mipBytes();
    statistics.mapBytes = out.texels.bytes() + statistics.workingMapBytes;
}

}  // namespace mv
