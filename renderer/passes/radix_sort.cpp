#include "renderer/passes/radix_sort.h"

#include <algorithm>

#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr std::uint32_t kDigitBits = 5, kBins = 33, kPasses = 6;

std::uint32_t chunkSizeFor(std::uint32_t count) { return count <= (1u << 16) ? 32 : 128; }

gl::Defines defines() {
    return {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}};
}

}  // namespace

RadixSort::RadixSort()
    : countDigits_("radix sort, count", {"passes/radix_count.comp"}, defines()),
      scatter_("radix sort, scatter", {"passes/radix_scatter.comp"}, defines()) {}

void RadixSort::resize(std::uint32_t count) {
    count_ = count;
    for (TexelArray& p : pairs_)
        p.ensure("radix sort pairs", GL_RG32UI, std::uint64_t{std::max(count, 1u)} * 8);
    alive_.ensure("radix sort alive", GL_R32UI, 16);
}

void RadixSort::sort() {
    if (count_ == 0) {
        alive_.buffer.fill(0);
        return;
    }
    const std::uint32_t chunkSize = chunkSizeFor(count_);
    const std::uint32_t chunks = (count_ + chunkSize - 1) / chunkSize;
    counts_.ensure("radix sort counts", GL_R32UI, std::uint64_t{kBins} * chunks * 4);
    begins_.ensure("radix sort begins", GL_R32UI, std::uint64_t{kBins} * chunks * 4);
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
        const TexelArray& from = pairs_[pass % 2];
        const TexelArray& to = pairs_[(pass + 1) % 2];
        for (gl::Program* program : {&countDigits_, &scatter_}) {
            program->set("chunkSize", chunkSize);
            program->set("chunks", chunks);
            program->set("shift", pass * kDigitBits);
            program->set("capacity", count_);
            program->set("firstPass", pass == 0 ? 1 : 0);
        }
        // Producer: the caller, or the pass before.
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);
        from.texels.bind(0);
        alive_.texels.bind(1);
        counts_.buffer.bindStorage(0);
        countDigits_.dispatchInvocations(chunks);
        prefixSum_.exclusive(counts_.texels, kBins * chunks, begins_.buffer);
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the prefix sum
        from.texels.bind(0);
        alive_.texels.bind(1);
        begins_.texels.bind(2);
        to.buffer.bindStorage(0);
        alive_.buffer.bindStorage(1);
        scatter_.dispatchInvocations(chunks);
    }
    static_assert(kPasses % 2 == 0, "the result ends in pairs_[0]");
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // producer: the last scatter
}

}  // namespace mv
