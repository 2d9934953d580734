#include "renderer/passes/prefix_sum.h"

#include "renderer/gl/context.h"

namespace mv {
namespace {

// Short enough for many invocations, long enough for few passes: 64^3 counts take five.
constexpr std::uint32_t kSegment = 64;

gl::Defines defines(bool reduce) {
    gl::Defines d = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
                     {"MV_SUM_SEGMENT", std::to_string(kSegment)}};
    if (reduce) d.emplace_back("MV_SUM_REDUCE", "1");
    return d;
}

}  // namespace

PrefixSum::PrefixSum()
    : reduce_("prefix sum, totals", {"passes/prefix_sum.comp"}, defines(true)),
      sum_("prefix sum", {"passes/prefix_sum.comp"}, defines(false)) {}

void PrefixSum::exclusive(const gl::TextureBuffer& counts, std::uint32_t count,
                          const gl::Buffer& out) {
    // Producer: the caller's counting pass.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    std::size_t depth = 0;
    for (std::uint32_t n = count; n > kSegment; n = (n + kSegment - 1) / kSegment) ++depth;
    if (scratch_.size() < depth) scratch_.resize(depth);
    run(counts, count, out, 0);
}

void PrefixSum::run(const gl::TextureBuffer& counts, std::uint32_t count, const gl::Buffer& out,
                    std::size_t depth) {
    if (count == 0) return;
    const std::uint32_t segments = (count + kSegment - 1) / kSegment;
    const bool hasBase = segments > 1;
    if (hasBase) {
        Scratch& s = scratch_[depth];
        s.totals.ensure("prefix sum totals", GL_R32UI, std::uint64_t{segments} * 4);
        s.bases.ensure("prefix sum bases", GL_R32UI, std::uint64_t{segments} * 4);
        reduce_.set("count", count);
        counts.bind(0);
        s.totals.buffer.bindStorage(0);
        reduce_.dispatchInvocations(segments);
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the totals just written
        run(s.totals.texels, segments, s.bases.buffer, depth + 1);
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the bases just written
        s.bases.texels.bind(1);
    }
    sum_.set("count", count);
    sum_.set("hasBase", hasBase ? 1 : 0);
    counts.bind(0);
    out.bindStorage(0);
    sum_.dispatchInvocations(segments);
}

}  // namespace mv
