#include "renderer/passes/radix_sort.h"

#include <algorithm>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/sort.glsl"

namespace mv {
namespace {

constexpr std::uint32_t kPasses = kSortKeyBits / kDigitBits;

std::uint32_t chunkSizeFor(std::uint32_t count) { return count <= (1u << 16) ? 32 : 128; }

}  // namespace

RadixSort::RadixSort()
    : countDigits_("radix sort, count", {"passes/radix_count.comp"}),
      scatter_("radix sort, scatter", {"passes/radix_scatter.comp"}) {}

void RadixSort::resize(std::uint32_t count) {
    count_ = count;
    for (auto& pairs : pairs_) pairs.ensure("radix sort pairs", std::max(count, 1u));
    alive_.ensure("radix sort alive", 4);
}

void RadixSort::sort() {
    if (count_ == 0) {
        alive_.fill(0);
        return;
    }
    const std::uint32_t chunkSize = chunkSizeFor(count_);
    const std::uint32_t chunks = (count_ + chunkSize - 1) / chunkSize;
    counts_.ensure("radix sort counts", std::uint64_t{kSortBins} * chunks);
    begins_.ensure("radix sort begins", std::uint64_t{kSortBins} * chunks);
    for (std::uint32_t pass = 0; pass < kPasses; ++pass) {
        const auto& from = pairs_[pass % 2];
        const auto& to = pairs_[(pass + 1) % 2];
        for (gl::Program* program : {&countDigits_, &scatter_}) {
            program->set("chunkSize", chunkSize);
            program->set("chunks", chunks);
            program->set("shift", pass * kDigitBits);
            program->set("capacity", count_);
            program->set("firstPass", pass == 0 ? 1 : 0);
        }
        from.bindTexels(kUnitSortPairs);
        alive_.bindTexels(kUnitSortAlive);
        counts_.bindStorage(kBlockBinCounts);
        countDigits_.dispatchInvocations(chunks);
        prefixSum_.exclusive(counts_, kSortBins * chunks, begins_);
        from.bindTexels(kUnitSortPairs);
        alive_.bindTexels(kUnitSortAlive);
        begins_.bindTexels(kUnitBinBegins);
        to.bindStorage(kBlockSortPairs);
        alive_.bindStorage(kBlockSortAlive);
        scatter_.dispatchInvocations(chunks);
    }
    static_assert(kPasses % 2 == 0, "the result ends in pairs_[0]");
}

}  // namespace mv
