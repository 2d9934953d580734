#include "renderer/methods/megaviews/many_view_pass.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <string>
#include <utility>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/methods/manylods/cut_traversal.h"
#include "renderer/methods/megaviews/traversal_job.h"
#include "renderer/passes/map_memory.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/types.glsl"

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

// Size limit of the 32-bit buffer in which a pass makes maps before packing them to 16 bits.
constexpr std::uint64_t kUnpackedBytes = 64ull << 20;

// A pass binds its final maps as one storage block: how many these may be.
std::uint64_t mapsAtOnce(const TraversalJob& job) {
    if (job.options.mapsAtOnce > 0) return job.options.mapsAtOnce;
    auto bytes = static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes);
    if (job.out.packed) bytes = std::min(bytes, kUnpackedBytes);
    return bytes / job.mapBytes();
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
    PairTraversal* ran = &lists;  // the one of these three that the last render() asked
    // What all passes together need: final maps of one, and bytes of the buffers of working maps.
    // cut: a pass had to be smaller for it.
    struct Room {
        std::uint64_t maps = 0;
        std::array<std::uint64_t, 2> work{};
        bool cut = false;
        std::uint64_t workBytes() const { return work[0] + work[1]; }
    } room;

    // What is known of the last traversal once its status has come back.
    struct Known {
        PassCounts passes;
        std::vector<std::uint64_t> occupancy;
        std::vector<PairCounts> levels;
    } known;
    std::size_t countedLevels = 0;   // of the scene; 0: all of them together
    std::uint64_t most = 1;          // entries that the last traversal could have had
    PassEnd failed = PassEnd::done;  // how the last traversal failed, as became known late

    ManyViewOptions options;       // of the last render()
    std::vector<PassRange> parts;  // of the last traversal

    explicit Impl(gl::Results results)
        : statusBack("traversal status", results), countsBack("pair counts", results) {}

    // Decides whether the maps are made slice by slice, and allocates them or takes what was there.
    // smaller: the budget than the last one. Throws where it is too small.
    void makeRoomForMaps(TraversalJob& job, bool smaller);
    void makeBuffers(const TraversalJob& job);
    PairTraversal& askedTraversal();
    void readCounts();  // of pairs, where they are asked for
    std::uint64_t counterBytes() const {
        return std::uint64_t{kCounterSlots} * (options.countLevels ? kSceneLevels : 1) *
               kCounterWords * 4;
    }

    PassRange rangeOf(const TraversalJob& job, std::uint32_t firstView, std::uint32_t endView);
    bool takeRoom(const TraversalJob& job, const PassRange& range);
    PassRange nextRange(const TraversalJob& job, std::uint32_t first);
    void makeRoom(const TraversalJob& job, std::uint32_t first, std::uint32_t end, PassEnd ended);
    void traverse(const TraversalJob& job, MethodStatistics& statistics);
    std::optional<PassOutcome> run(const TraversalJob& job, const PassRange& range, bool wait);
    void takeSlices(const TraversalJob& job);
    void settle(const PassOutcome& outcome);
    void report(MethodStatistics& statistics) const;
    void pushMips(const TraversalJob& job);
    void pack(const TraversalJob& job, const PassRange& range);
};

PassRange ManyViewPass::Impl::rangeOf(const TraversalJob& job, std::uint32_t firstView,
                                      std::uint32_t endView) {
    const std::vector<std::uint32_t>& begin = job.views.levelBegin;
    const std::size_t levels = begin.size() - 1;
    PassRange range{firstView, endView, {}, {0, job.out.mapCount}};
    if (firstView == 0 && endView == job.views.aliveCount) {
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

// Whether the pass's maps fit beside those of the passes before; if so, `room` has them, too.
bool ManyViewPass::Impl::takeRoom(const TraversalJob& job, const PassRange& range) {
    const std::uint64_t block = std::min<std::uint64_t>(
        static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes),
        4 * static_cast<std::uint64_t>(gl::limits().maxTextureBufferTexels));
    const std::uint64_t maps = range.maps.y - range.maps.x;
    // What is made again and again keeps the room of all passes.
    const std::uint64_t together = std::max(room.maps, maps);
    const std::uint64_t used = (job.sliced ? together : job.out.mapCount) * job.finalBytes() +
                               (job.out.packed ? together * job.mapBytes() : 0) +
                               job.views.leafCount * job.mipBytes();
    const std::array<std::uint64_t, 2> work = ran->workBytes(job, range);
    Room all = room;
    all.maps = together;
    for (std::size_t i = 0; i < work.size(); ++i) all.work[i] = std::max(room.work[i], work[i]);
    if (used + all.workBytes() > job.options.gpuMemoryBytes ||
        std::max(all.work[0], all.work[1]) > block || (job.out.fused && maps > mapsAtOnce(job))) {
        return false;
    }
    room = all;
    return true;
}

// As many views from `first` on as the plan and the room for maps allow.
PassRange ManyViewPass::Impl::nextRange(const TraversalJob& job, std::uint32_t first) {
    std::uint32_t count = job.views.aliveCount - first;
    if (ran->worksInPasses()) {
        count = ran->plan().endFrom(first, most) - first;
        if (job.out.fused) {
            const std::uint64_t views = mapsAtOnce(job) * job.views.aliveCount / job.out.mapCount;
            count = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(views, 1, count));
        }
        if (!parts.empty() && room.cut) {  // what fitted last is a good guess
            const PassRange& last = parts.back();
            count = std::min(count, (last.endView - last.firstView) * 4 / 3 + 1);
        }
    }
    for (;; count -= std::max(1u, count / 4)) {
        PassRange range = rangeOf(job, first, first + count);
        if (takeRoom(job, range)) return range;
        room.cut = true;
        if (!ran->worksInPasses()) {
            throw Error(ExitCode::impossible,
                        "maps of kept cuts are written at once, and these are more than a storage "
                        "block holds: --cut basic takes more passes");
        }
        if (count == 1) {
            throw Error(ExitCode::impossible,
                        "the maps of a single view and of the nodes above it do not fit: "
                        "--gpu-memory allows " +
                            mebibytes(job.options.gpuMemoryBytes));
        }
    }
}

// After a pass over [first, end) that did not come to its end: more room for entries, or fewer
// views.
void ManyViewPass::Impl::makeRoom(const TraversalJob& job, std::uint32_t first, std::uint32_t end,
                                  PassEnd ended) {
    if (ended == PassEnd::again) return;
    if (ran->entries() < most) {
        ran->reserve(job, std::min(most, ran->entries() * 2));
    } else if (!ran->worksInPasses()) {
        throw Error(
            ExitCode::impossible,
            "the cuts of all views have more than " + std::to_string(most) +
                " nodes, which is what --gpu-memory and this driver's storage blocks allow: "
                "--cut basic keeps none");
    } else if (end - first == 1) {
        throw Error(ExitCode::impossible,
                    "the pairs of a single view do not fit: --queue-memory allows " +
                        mebibytes(job.options.queueMemoryBytes));
    } else {
        ran->plan().overflowed(first, end, most);
    }
}

// Nothing where its status is still under way.
std::optional<PassOutcome> ManyViewPass::Impl::run(const TraversalJob& job, const PassRange& range,
                                                   bool wait) {
    const std::uint64_t words = (range.maps.y - range.maps.x) * job.mapBytes() / 4;
    if (!ran->writesEveryTexel()) {
        if (job.out.packed) {
            buffers.unpacked.fill(0, words, kNone);
        } else if (job.sliced) {
            job.out.texels.fill(0, words, kNone);
        }
    }
    ran->run(job, range, buffers, programs);
    if (job.out.packed) pack(job, range);
    statusBack.request(buffers.status, 0, kStatusWords * 4);
    const auto status =
        wait ? statusBack.takeNow<std::uint32_t>() : statusBack.take<std::uint32_t>();
    if (!status) return std::nullopt;
    return ran->outcome(*status);
}

// After a traversal in slices, one of which was a pass: each can be made again.
void ManyViewPass::Impl::takeSlices(const TraversalJob& job) {
    for (const PassRange& range : parts) job.out.slices.push_back(range.maps);
    job.out.firstMap = parts.back().maps.x;
    job.out.makeSlice = [this, job](std::size_t slice) {
        const PassRange& range = parts.at(slice);
        PassEnd end = PassEnd::again;
        while (end == PassEnd::again) end = run(job, range, true)->end;
        if (end != PassEnd::done) {
            throw Error(ExitCode::impossible,
                        "a slice of the maps no longer fits: more --gpu-memory, or fewer --maps");
        }
        job.out.firstMap = range.maps.x;
    };
}

// All passes; only what overflows is done again.
void ManyViewPass::Impl::traverse(const TraversalJob& job, MethodStatistics& statistics) {
    const std::uint32_t views = job.views.aliveCount;
    most = std::max<std::uint64_t>(ran->maxEntries(job), 1);
    statusBack.forget();
    const std::uint64_t usual = job.views.widestLevel() * ran->usualEntries(job.options.rules);
    ran->plan().begin(views, double(usual) / views, job.options.pairs.queueFill);
    const PassEnd before = std::exchange(failed, PassEnd::done);
    if (before != PassEnd::done) makeRoom(job, 0, views, before);

    const std::uint32_t together = ran->worksInPasses() ? ran->plan().endFrom(0, most) : views;
    const auto expected = static_cast<std::uint64_t>(ran->plan().expected(0, together));
    const std::uint64_t guess = std::min(most, expected + 65536);
    statistics.predictedQueueBytes = ran->bytesFor(job, guess);
    const bool suffices = ran->entries() >= std::min(most, expected + 1);
    ran->reserve(job, suffices ? ran->entries() : guess);

    known.occupancy.clear();
    parts.clear();
    room = {};
    if (job.sliced) {  // the longest way down the tree has to fit beside what others take
        PassRange way;
        way.levels.assign(job.views.levelBegin.size() - 1, {0, 1});
        room.work = ran->workBytes(job, way);
    } else if (!job.out.packed && !ran->writesEveryTexel()) {
        // The others only ever take minima; lists write every texel themselves.
        job.out.texels.fill(0, job.out.mapCount * job.mapBytes() / 4, kNone);
    }
    if (job.mips) buffers.mips.fill(kNone);
    buffers.counters.fill(0);
    for (std::uint32_t first = 0; first < views;) {
        const PassRange range = nextRange(job, first);
        if (job.sliced) job.out.texels.ensure("view maps", room.maps * job.finalBytes() / 4);
        if (job.out.packed) {
            buffers.unpacked.ensure("maps not yet packed", room.maps * job.mapBytes());
        }
        buffers.countersBefore.copy(buffers.counters, 0, 0, buffers.counters.bytes());
        // Of several passes each needs to know how the one before ended; of slices, none may take
        // the status of another.
        const bool wait = job.sliced || range.endView - first < views;
        const std::optional<PassOutcome> outcome = run(job, range, wait);
        if (outcome && outcome->end != PassEnd::done) {
            buffers.counters.copy(buffers.countersBefore, 0, 0, buffers.counters.bytes());
            makeRoom(job, first, range.endView, outcome->end);
            continue;
        }
        parts.push_back(range);
        if (outcome) settle(*outcome);
        first = range.endView;
    }
    statistics.queueBytes = ran->bytes();
    if (job.sliced) takeSlices(job);
}

// Of the last pass, which ended well.
void ManyViewPass::Impl::settle(const PassOutcome& outcome) {
    std::uint64_t peak = 0;
    known.occupancy.resize(std::max(known.occupancy.size(), outcome.occupancy.size()));
    for (std::size_t i = 0; i < outcome.occupancy.size(); ++i) {
        known.occupancy[i] = std::max(known.occupancy[i], outcome.occupancy[i]);
        peak = std::max(peak, outcome.occupancy[i]);
    }
    ran->plan().passed(parts.back().firstView, parts.back().endView, peak, most);
    known.passes = ran->plan().counts();
}

void ManyViewPass::Impl::report(MethodStatistics& statistics) const {
    statistics.passes = known.passes;
    statistics.occupancy = known.occupancy;
    statistics.queuePeakPairs = 0;
    for (const std::uint64_t entries : known.occupancy) {
        statistics.queuePeakPairs = std::max(statistics.queuePeakPairs, entries);
    }
    statistics.cuts = ran->counts();
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
    program.dispatchInvocations(job.out.mapCount * (job.mapBytes() / 4));
}

void ManyViewPass::Impl::pack(const TraversalJob& job, const PassRange& range) {
    const gl::PassScope scope(job.profiler, Stage::traverse);
    gl::Program& program = programs.get("megaviews/pack_maps.comp", {job.defines().front()});
    const std::uint64_t bytes = (range.maps.y - range.maps.x) * job.finalBytes();
    buffers.unpacked.bindStorage(kBlockMaps);
    job.out.texels.bindStorage(kBlockPackedMaps, job.sliced ? 0 : range.maps.x * job.finalBytes(),
                               bytes);
    program.set("wordCount", static_cast<std::uint32_t>(bytes / 4));
    program.dispatchInvocations(bytes / 4);
}

ManyViewPass::ManyViewPass(gl::Results results) : impl_(std::make_unique<Impl>(results)) {}
ManyViewPass::~ManyViewPass() = default;

void ManyViewPass::Impl::makeRoomForMaps(TraversalJob& job, bool smaller) {
    const MapSettings& maps = options.maps;
    GpuViewMaps& out = job.out;
    if (out.packed && (!out.fused || job.mips || options.pairs.cut != Cut::basic)) {
        throw Error(ExitCode::impossible,
                    "--depth-bits 16 is for maps that are finished pass by pass: not without "
                    "fusion, filled by coarser levels, or of cuts that are kept");
    }
    const FinalMaps wanted{.count = out.mapCount,
                           .mapRes = maps.resolution,
                           .workBytes = job.mipBytes(),
                           .inRanges = out.fused,
                           .packed = out.packed};
    const bool sliceable =
        out.fused && !job.mips && options.pairs.cut == Cut::basic && job.hasPairs();
    // Beside the final maps, a single view needs working maps of all nodes above it.
    FinalMaps least = wanted;
    if (job.fuse) least.count += kTreeLevels * (out.packed ? 2 : 1);
    if (out.packed) least.count += 2;  // and its own before it is packed
    job.sliced = sliceable && !fit(least, options.gpuMemoryBytes);
    if (job.sliced || smaller) {  // what larger budgets have left gives way
        out.texels = {};
        buffers.work = {};
        buffers.unpacked = {};
    }
    if (!job.sliced) {
        checkFinalMaps(wanted, options.gpuMemoryBytes);
        // While lights move, leaves grow more and fewer: an eighth more where memory is not short.
        const std::uint64_t words = std::max<std::uint64_t>(out.mapCount * job.finalBytes() / 4, 4);
        const bool isShort = words * 4 > options.gpuMemoryBytes / 2;
        out.texels.ensure("view maps", words, isShort ? 0 : words / 8 / 64 * 64);
    }
    out.inQuads = areTooLong(out.texels);
}

void ManyViewPass::Impl::makeBuffers(const TraversalJob& job) {
    buffers.counters.ensure("pair counters", counterBytes());
    buffers.countersBefore.ensure("pair counters before", buffers.counters.bytes());
    buffers.status.ensure("traversal status", kStatusWords * 4);
    if (job.mips) buffers.mips.ensure("coarser map levels", job.views.leafCount * job.mipBytes());
}

PairTraversal& ManyViewPass::Impl::askedTraversal() {
    if (options.pairs.cut != Cut::basic) return cuts;
    if (options.pairs.traversal == Traversal::queue) return queue;
    return lists;
}

void ManyViewPass::Impl::readCounts() {
    countsBack.forget();
    if (!options.countPairs && !options.countLevels) {
        known.levels.clear();
        return;
    }
    countsBack.request(buffers.counters, 0, counterBytes());
    if (const auto words = countsBack.take<std::uint32_t>()) known.levels = countsOf(*words);
}

void ManyViewPass::render(const GpuSceneHierarchy& scene, const GpuViewHierarchy& views,
                          const ManyViewOptions& options, gl::Profiler& profiler, GpuViewMaps& out,
                          MethodStatistics& statistics) {
    const auto res = static_cast<uint>(options.maps.resolution);
    assert(options.maps.resolution >= 8 && options.maps.resolution <= 256 &&
           (res & (res - 1)) == 0);
    assert(options.pairs.cut == Cut::basic || views.flat);
    Impl& impl = *impl_;
    const bool smaller = options.gpuMemoryBytes < impl.options.gpuMemoryBytes;
    impl.options = options;

    out.present = true;
    out.mapRes = options.maps.resolution;
    out.fused = options.pairs.fusion || views.flat;
    out.mapCount = out.fused ? views.leafCount : views.nodeCount;
    out.packed = options.maps.depthBits == 16;
    out.slices.clear();
    out.firstMap = 0;
    TraversalJob job{scene, views, impl.options, profiler, out};
    job.fuse = options.pairs.fusion && !views.flat;
    job.mips = out.fused && mipFilled(options.rules, options.pairs.holeFill, res);
    impl.makeRoomForMaps(job, smaller);

    impl.countedLevels =
        options.countLevels
            ? std::max<std::size_t>(kTreeLevels, static_cast<std::size_t>(job.scene.levels))
            : 0;
    statistics.queueBytes = statistics.predictedQueueBytes = 0;
    statistics.workingMapBytes = statistics.predictedWorkingMapBytes = 0;
    statistics.predictedMapBytes = out.mapCount * job.finalBytes();
    statistics.maps = out.mapCount;
    if (!job.hasPairs()) {
        out.texels.fill(0, out.mapCount * job.finalBytes() / 4, kNone);
        statistics.mapBytes = out.texels.bytes();
        impl.known = {};
        impl.report(statistics);
        statistics.cuts = {};
        return;
    }

    impl.makeBuffers(job);
    impl.ran = &impl.askedTraversal();
    impl.traverse(job, statistics);
    if (job.mips) impl.pushMips(job);
    impl.readCounts();
    impl.report(statistics);
    statistics.workingMapBytes = impl.buffers.mapBytes();
    statistics.predictedWorkingMapBytes = impl.room.workBytes() + views.leafCount * job.mipBytes() +
                                          (out.packed ? impl.room.maps * job.mapBytes() : 0);
    if (job.sliced) {
        statistics.predictedMapBytes = out.texels.bytes();
        out.inQuads = areTooLong(out.texels);
    }
    statistics.mapBytes = out.texels.bytes() + statistics.workingMapBytes;
}

bool ManyViewPass::mapsLag() const { return impl_->ran->counts().coarse > 0; }

Proof ManyViewPass::proof(MethodStatistics& statistics, bool wait) {
    Impl& m = *impl_;
    if (!wait && !(m.statusBack.arrived() && m.countsBack.arrived())) return Proof::underWay;
    if (const auto status = m.statusBack.takeNow<std::uint32_t>()) {
        const PassOutcome outcome = m.ran->outcome(*status);
        if (outcome.end != PassEnd::done) {
            m.failed = outcome.end;
            return Proof::overflowed;
        }
        m.settle(outcome);
    }
    if (const auto words = m.countsBack.takeNow<std::uint32_t>()) m.known.levels = countsOf(*words);
    m.report(statistics);
    return Proof::good;
}

}  // namespace mv
