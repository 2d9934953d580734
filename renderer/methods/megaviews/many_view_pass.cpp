#include "renderer/methods/megaviews/many_view_pass.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/methods/manylods/cut_traversal.h"
#include "renderer/methods/megaviews/traversal_job.h"
#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

// By level of the scene node, or a single level of all.
std::vector<PairCounts> countsOf(const std::vector<std::uint32_t>& words) {
    const auto levels = static_cast<std::uint32_t>(words.size() / (kCounterSlots * kCounterWords));
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

// A pass binds its final maps as one storage block: how many these may be.
std::uint64_t mapsAtOnce(const TraversalJob& job) {
    if (job.options.mapsAtOnce > 0) return job.options.mapsAtOnce;
    return static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes) / job.mapBytes();
}

}  // namespace

struct ManyViewPass::Impl {
    TraversalBuffers buffers;
    ListTraversal lists;
    QueueTraversal queue;
    CutTraversal cuts;
    ProgramCache programs;
    gl::Buffer ranges;
    gl::ReadBack statusBack, countsBack;
    std::uint32_t passes = 1;     // of the last frame: the next one starts with as many
    std::uint64_t workBytes = 0;  // of working maps, worked out before the passes that needed most

    // What is known of the last traversal once its status has come back.
    struct Known {
        std::vector<std::uint64_t> occupancy;
        std::vector<PairCounts> levels;
    } known;
    enum class Ran { lists, queue, cuts } ran{};
    std::size_t countedLevels = 0;   // of the scene; 0: all of them together
    std::uint64_t most = 1;          // entries that the last traversal could have had
    PassEnd failed = PassEnd::done;  // how the last traversal failed, as became known late

    ManyViewOptions options;       // of the last render()
    std::vector<PassRange> parts;  // of the last traversal

    explicit Impl(gl::Results results)
        : statusBack("traversal status", results), countsBack("pair counts", results) {}

    PassRange rangeOf(const TraversalJob& job, std::uint32_t pass, std::uint32_t passCount);
    template <typename Organisation>
    void traverse(const TraversalJob& job, Organisation& organisation,
                  MethodStatistics& statistics);
    template <typename Organisation>
    PassOutcome attempt(const TraversalJob& job, Organisation& organisation,
                        std::uint32_t passCount);
    template <typename Organisation>
    std::optional<PassOutcome> run(const TraversalJob& job, Organisation& organisation,
                                   const PassRange& range, bool wait);
    template <typename Organisation>
    void takeSlices(const TraversalJob& job, Organisation& organisation);
    PassOutcome outcomeOf(std::span<const std::uint32_t> status);
    void settle(PassOutcome outcome);
    void report(MethodStatistics& statistics) const;
    void pushMips(const TraversalJob& job);
};

PassRange ManyViewPass::Impl::rangeOf(const TraversalJob& job, std::uint32_t pass,
                                      std::uint32_t passCount) {
    const std::vector<std::uint32_t>& begin = job.views.levelBegin;
    const std::size_t levels = begin.size() - 1;
    const auto cut = [&](std::uint64_t p) {
        return static_cast<std::uint32_t>(p * job.views.aliveCount / passCount);
    };
    PassRange range{cut(pass), cut(pass + 1), {}, {0, job.out.mapCount}};
    if (passCount == 1) {
        for (std::size_t level = 0; level < levels; ++level)
            range.levels.emplace_back(begin[level], begin[level + 1]);
        return range;
    }
    gl::Program& program = programs.get("megaviews/pass_ranges.comp", {job.defines().front()});
    ranges.ensure("pass ranges", 16 * sizeof(glm::uvec2));
    for (std::size_t level = 0; level < begin.size(); ++level)
        program.set("levelBegin[" + std::to_string(level) + "]", begin[level]);
    program.set("levelCount", static_cast<std::uint32_t>(levels));
    program.set("firstView", range.firstView);
    program.set("endView", range.endView);
    job.views.nodes.bindTexels(kUnitViewNodes);
    job.views.mapOfNode.bindTexels(kUnitMapOfNode);
    job.views.leafOfView.bindTexels(kUnitLeafOfView);
    ranges.bindStorage(kBlockPassRanges);
    program.dispatchInvocations(levels + 1);
    range.levels = ranges.read<glm::uvec2>(0, levels + 1);
    if (job.out.fused) range.maps = range.levels.back();
    range.levels.pop_back();
    return range;
}

// All passes once, up to the first that does not end well.
template <typename Organisation>
PassOutcome ManyViewPass::Impl::attempt(const TraversalJob& job, Organisation& organisation,
                                        std::uint32_t passCount) {
    const std::uint64_t block = std::min<std::uint64_t>(
        static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes),
        4 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels));
    // Whether every pass fits is known before the first one runs.
    parts.clear();
    std::uint64_t mostMaps = 0, mostWork = 0;  // of a pass
    for (std::uint32_t pass = 0; pass < passCount; ++pass) {
        const PassRange& range = parts.emplace_back(rangeOf(job, pass, passCount));
        const std::uint64_t maps = range.maps.y - range.maps.x;
        const std::uint64_t used = (job.sliced ? maps : job.out.mapCount) * job.mapBytes() +
                                   job.views.leafCount * job.mipBytes();
        const auto [larger, smaller] = Organisation::workBytes(job, range);
        if (larger > block || used + larger + smaller > job.options.gpuMemoryBytes ||
            (job.out.fused && maps > mapsAtOnce(job))) {
            return {PassEnd::workTooLarge, {}};
        }
        workBytes = std::max(workBytes, larger + smaller);
        mostMaps = std::max(mostMaps, maps);
        mostWork = std::max(mostWork, larger);
    }
    // What is made again and again keeps the room of all passes, in two buffers for working maps.
    if (job.sliced && mostMaps * job.mapBytes() + 2 * mostWork > job.options.gpuMemoryBytes) {
        return {PassEnd::workTooLarge, {}};
    }
    std::vector<std::uint64_t> occupancy;
    buffers.counters.fill(0);
    if (job.sliced) {
        job.out.texels.ensure("view maps", mostMaps * job.mapBytes() / 4);
    } else if constexpr (!std::is_same_v<Organisation, ListTraversal>) {
        // The others only ever take minima; lists write every texel themselves.
        job.out.texels.fill(0, job.out.mapCount * job.mapBytes() / 4, kNone);
    }
    if (job.mips) buffers.mips.fill(kNone);
    for (const PassRange& range : parts) {
        // Of several passes each needs to know how the one before ended.
        const std::optional<PassOutcome> ended = run(job, organisation, range, passCount > 1);
        if (!ended) return {PassEnd::unknown, {}};
        const PassOutcome& outcome = *ended;
        if (outcome.end != PassEnd::done) return outcome;
        occupancy.resize(std::max(occupancy.size(), outcome.occupancy.size()));
        for (std::size_t i = 0; i < outcome.occupancy.size(); ++i)
            occupancy[i] = std::max(occupancy[i], outcome.occupancy[i]);
    }
    return {PassEnd::done, std::move(occupancy)};
}

// Nothing where its status is still under way.
template <typename Organisation>
std::optional<PassOutcome> ManyViewPass::Impl::run(const TraversalJob& job,
                                                   Organisation& organisation,
                                                   const PassRange& range, bool wait) {
    if constexpr (!std::is_same_v<Organisation, ListTraversal>) {
        const std::uint64_t maps = range.maps.y - range.maps.x;
        if (job.sliced) job.out.texels.fill(0, maps * job.mapBytes() / 4, kNone);
    }
    organisation.run(job, range, buffers, programs);
    statusBack.request(buffers.status, 0, kStatusWords * 4);
    const auto status =
        wait ? statusBack.takeNow<std::uint32_t>() : statusBack.take<std::uint32_t>();
    if (!status) return std::nullopt;
    return organisation.outcome(*status);
}

// After a traversal in slices, one of which was a pass: each can be made again.
template <typename Organisation>
void ManyViewPass::Impl::takeSlices(const TraversalJob& job, Organisation& organisation) {
    for (const PassRange& range : parts) job.out.slices.push_back(range.maps);
    job.out.firstMap = parts.back().maps.x;
    job.out.makeSlice = [this, job, &organisation](std::size_t slice) {
        const PassRange& range = parts.at(slice);
        PassEnd end = PassEnd::again;
        while (end == PassEnd::again) end = run(job, organisation, range, true)->end;
        if (end != PassEnd::done) throw std::logic_error("maps that fitted do not fit again");
        job.out.firstMap = range.maps.x;
    };
}

template <typename Organisation>
void ManyViewPass::Impl::traverse(const TraversalJob& job, Organisation& organisation,
                                  MethodStatistics& statistics) {
    most = std::max<std::uint64_t>(organisation.maxEntries(job), 1);
    statusBack.forget();
    // A first guess from what view nodes usually keep; an overflow corrects it.
    std::uint64_t widest = 0;
    for (std::size_t level = 0; level + 1 < job.views.levelBegin.size(); ++level)
        widest = std::max<std::uint64_t>(
            widest, job.views.levelBegin[level + 1] - job.views.levelBegin[level]);
    const std::uint64_t guess =
        widest / passes * Organisation::usualEntries(job.options.rules) + 65536;
    const auto reserve = [&](std::uint64_t entries) {
        organisation.reserve(job, std::min(most, entries));
    };
    statistics.predictedQueueBytes = Organisation::bytesFor(job, std::min(most, guess));
    workBytes = 0;
    reserve(std::max(guess, organisation.entries()));

    const std::uint64_t least =
        job.out.fused ? (job.out.mapCount + mapsAtOnce(job) - 1) / mapsAtOnce(job) : 1;
    passes = std::clamp(passes, static_cast<std::uint32_t>(least), job.views.aliveCount);
    if (!Organisation::kInPasses) passes = 1;
    PassOutcome outcome{std::exchange(failed, PassEnd::done), {}};
    if (outcome.end == PassEnd::done) outcome = attempt(job, organisation, passes);
    for (; outcome.end != PassEnd::done && outcome.end != PassEnd::unknown;
         outcome = attempt(job, organisation, passes)) {
        if (outcome.end == PassEnd::again) continue;
        if (outcome.end == PassEnd::full && organisation.entries() < most) {
            reserve(organisation.entries() * 2);
            continue;
        }
        if (!Organisation::kInPasses) {
            throw Error(ExitCode::impossible,
                        outcome.end == PassEnd::workTooLarge
                            ? "maps of kept cuts are written at once, and these are more than a "
                              "storage block holds: --cut basic takes more passes"
                            : "the cuts of all views have more than " + std::to_string(most) +
                                  " nodes, which is what --gpu-memory and this driver's storage "
                                  "blocks allow: --cut basic keeps none");
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
    statistics.passes = static_cast<int>(passes);
    statistics.queueBytes = organisation.bytes();
    if (job.sliced) takeSlices(job, organisation);
    if (outcome.end == PassEnd::done) settle(std::move(outcome));
}

PassOutcome ManyViewPass::Impl::outcomeOf(std::span<const std::uint32_t> status) {
    switch (ran) {
        case Ran::lists:
            return lists.outcome(status);
        case Ran::queue:
            return queue.outcome(status);
        case Ran::cuts:
            return cuts.outcome(status);
    }
    assert(false);
    return {};
}

// Of a traversal that ended well.
void ManyViewPass::Impl::settle(PassOutcome outcome) {
    known.occupancy = std::move(outcome.occupancy);
    std::uint64_t peak = 0;
    for (const std::uint64_t entries : known.occupancy) peak = std::max(peak, entries);
    if (peak * 3 < most && passes > 1) passes = (passes + 1) / 2;  // try fewer next time
}

void ManyViewPass::Impl::report(MethodStatistics& statistics) const {
    statistics.occupancy = known.occupancy;
    statistics.queuePeakPairs = 0;
    for (const std::uint64_t entries : known.occupancy) {
        statistics.queuePeakPairs = std::max(statistics.queuePeakPairs, entries);
    }
    statistics.cuts = ran == Ran::cuts ? cuts.counts() : CutCounts{};
    statistics.pairs = sumOf(known.levels);
    statistics.pairsPerLevel.clear();
    if (countedLevels > 0) {
        statistics.pairsPerLevel = known.levels;
        statistics.pairsPerLevel.resize(std::min(known.levels.size(), countedLevels));
    }
}

void ManyViewPass::Impl::pushMips(const TraversalJob& job) {
    const gl::PassScope scope(job.profiler, Stage::fill);
    gl::Program& program = programs.get("megaviews/push_mips.comp", job.defines());
    job.out.texels.bindStorage(kBlockMaps);
    buffers.mips.bindStorage(kBlockMips);
    program.set("mapCount", job.out.mapCount);
    // Producer: the traversal and the fusion.
    gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT);
    program.dispatchInvocations(job.out.mapCount * (job.mapBytes() / 4));
}

ManyViewPass::ManyViewPass(gl::Results results) : impl_(std::make_unique<Impl>(results)) {}
ManyViewPass::~ManyViewPass() = default;

void ManyViewPass::render(const GpuSceneHierarchy& scene, const GpuViewHierarchy& views,
                          const ManyViewOptions& options, gl::Profiler& profiler, GpuViewMaps& out,
                          MethodStatistics& statistics) {
    const auto res = static_cast<uint>(options.maps.resolution);
    assert(options.maps.resolution >= 8 && options.maps.resolution <= 256 &&
           (res & (res - 1)) == 0);

    out.present = true;
    out.viewRes = options.maps.resolution;
    out.fused = options.pairs.fusion || views.flat;
    out.mapCount = out.fused ? views.leafCount : views.nodeCount;
    out.slices.clear();
    out.firstMap = 0;
    Impl& impl = *impl_;
    impl.options = options;
    TraversalJob job{scene, views, impl.options, profiler, out};
    job.fuse = options.pairs.fusion && !views.flat;
    job.mips = out.fused && mipFilled(options.rules, options.pairs.holeFill, res);
    const FinalMaps wanted{out.mapCount, options.maps.resolution, job.mipBytes(), out.fused};
    const bool sliceable = options.inSlices && out.fused && !job.mips &&
                           options.pairs.cut == Cut::basic && views.nodeCount > 0 &&
                           scene.nodeCount > 0;
    // Beside the final maps, a single view needs working maps of all nodes above it.
    FinalMaps least = wanted;
    if (job.fuse) least.count += kTreeLevels;
    job.sliced = sliceable && !fit(least, options.gpuMemoryBytes);
    if (job.sliced) {  // what larger budgets have left gives way
        out.texels = {};
        impl.buffers.work = {};
    } else {
        checkFinalMaps(wanted, options.gpuMemoryBytes);
        // While lights move, leaves grow more and fewer: an eighth more where memory is not short.
        const std::uint64_t words = std::max<std::uint64_t>(out.mapCount * job.mapBytes() / 4, 4);
        const bool isShort = words * 4 > options.gpuMemoryBytes / 2;
        out.texels.ensure("view maps", words, isShort ? 0 : words / 8 / 64 * 64);
    }
    const auto isLarge = [&] {
        return out.texels.size() > static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels);
    };
    out.inQuads = isLarge();

    impl.countedLevels =
        options.countLevels
            ? std::max<std::size_t>(kTreeLevels, static_cast<std::size_t>(job.scene.levels))
            : 0;
    statistics.queueBytes = statistics.predictedQueueBytes = 0;
    statistics.workingMapBytes = statistics.predictedWorkingMapBytes = 0;
    statistics.predictedMapBytes = out.mapCount * job.mapBytes();
    statistics.passes = 1;
    statistics.maps = out.mapCount;
    if (views.nodeCount == 0 || scene.nodeCount == 0) {
        out.texels.fill(0, out.mapCount * job.mapBytes() / 4, kNone);
        statistics.mapBytes = out.texels.bytes();
        impl.known = {};
        impl.report(statistics);
        statistics.cuts = {};
        return;
    }

    const std::uint32_t countedLevels = options.countLevels ? kSceneLevels : 1;
    impl.buffers.counters.ensure("pair counters",
                                 kCounterSlots * countedLevels * kCounterWords * 4);
    impl.buffers.status.ensure("traversal status", kStatusWords * 4);
    if (job.mips) {
        impl.buffers.mips.ensure("coarser map levels", views.leafCount * job.mipBytes());
    }
    if (options.pairs.cut != Cut::basic) {
        assert(views.flat);
        impl.ran = Impl::Ran::cuts;
        impl.traverse(job, impl.cuts, statistics);
    } else if (options.pairs.traversal == Traversal::queue) {
        impl.ran = Impl::Ran::queue;
        impl.traverse(job, impl.queue, statistics);
    } else {
        impl.ran = Impl::Ran::lists;
        impl.traverse(job, impl.lists, statistics);
    }
    if (job.mips) impl.pushMips(job);
    impl.countsBack.forget();
    if (options.countPairs || options.countLevels) {
        impl.countsBack.request(impl.buffers.counters, 0,
                                kCounterSlots * countedLevels * kCounterWords * 4);
        if (const auto words = impl.countsBack.take<std::uint32_t>()) {
            impl.known.levels = countsOf(*words);
        }
    } else {
        impl.known.levels.clear();
    }
    impl.report(statistics);
    statistics.workingMapBytes = impl.buffers.mapBytes();
    statistics.predictedWorkingMapBytes = impl.workBytes + views.leafCount * job.mipBytes();
    if (job.sliced) {
        statistics.predictedMapBytes = out.texels.bytes();
        out.inQuads = isLarge();
    }
    statistics.mapBytes = out.texels.bytes() + statistics.workingMapBytes;
}

bool ManyViewPass::lags() const {
    return impl_->ran == Impl::Ran::cuts && impl_->cuts.counts().coarse > 0;
}

Proof ManyViewPass::proof(MethodStatistics& statistics, bool wait) {
    Impl& m = *impl_;
    if (!wait && !(m.statusBack.arrived() && m.countsBack.arrived())) return Proof::underWay;
    if (const auto status = m.statusBack.takeNow<std::uint32_t>()) {
        PassOutcome outcome = m.outcomeOf(*status);
        if (outcome.end != PassEnd::done) {
            m.failed = outcome.end;
            return Proof::overflowed;
        }
        m.settle(std::move(outcome));
    }
    if (const auto words = m.countsBack.takeNow<std::uint32_t>()) m.known.levels = countsOf(*words);
    m.report(statistics);
    return Proof::good;
}

}  // namespace mv
