#include "renderer/passes/prefix_sum.h"

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/sort.glsl"

namespace mv {

PrefixSum::PrefixSum()
    : reduce_("prefix sum, totals", {"passes/prefix_sum.comp"}, {{"MV_SUM_REDUCE", "1"}}),
      sum_("prefix sum", {"passes/prefix_sum.comp"}) {}

void PrefixSum::exclusive(const Counts& counts, std::uint32_t count, const gl::Buffer& out) {
    std::size_t depth = 0;
    for (std::uint32_t n = count; n > kSumSegment; n = (n + kSumSegment - 1) / kSumSegment) ++depth;
    if (scratch_.size() < depth) scratch_.resize(depth);
    run(counts, count, out, 0);
}

void PrefixSum::run(const Counts& counts, std::uint32_t count, const gl::Buffer& out,
                    std::size_t depth) {
    if (count == 0) return;
    const std::uint32_t segments = (count + kSumSegment - 1) / kSumSegment;
    const bool hasBase = segments > 1;
    if (hasBase) {
        Scratch& s = scratch_[depth];
        s.totals.ensure("prefix sum totals", segments);
        s.bases.ensure("prefix sum bases", segments);
        reduce_.set("count", count);
        counts.bindTexels(kUnitCounts);
        s.totals.bindStorage(kBlockSums);
        reduce_.dispatchInvocations(segments);
        run(s.totals, segments, s.bases, depth + 1);
        s.bases.bindTexels(kUnitSumBases);
    }
    sum_.set("count", count);
    sum_.set("hasBase", hasBase ? 1 : 0);
    counts.bindTexels(kUnitCounts);
    out.bindStorage(kBlockSums);
    sum_.dispatchInvocations(segments);
}

std::uint64_t PrefixSum::bytes() const {
    std::uint64_t sum = 0;
    for (const Scratch& scratch : scratch_) sum += scratch.totals.bytes() + scratch.bases.bytes();
    return sum;
}

}  // namespace mv
