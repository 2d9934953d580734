#pragma once
// Exclusive prefix sums on the GPU, for passes that place what they write by counting first.
// Deterministic: sums of integers, no atomics.

#include <cstdint>
#include <vector>

#include "renderer/gl/program.h"
#include "renderer/gl/texel_buffer.h"

namespace mv {

class PrefixSum {
  public:
    PrefixSum();
    using Counts = gl::TexelBuffer<std::uint32_t>;
    // out[i] = counts[0] + ... + counts[i - 1] for i < count. The counts have just been produced by
    // storage writes; out is to be read behind a barrier.
    void exclusive(const Counts& counts, std::uint32_t count, const gl::Buffer& out);
    std::uint64_t bytes() const;

  private:
    void run(const Counts& counts, std::uint32_t count, const gl::Buffer& out, std::size_t depth);
    struct Scratch {
        Counts totals, bases;
    };
    std::vector<Scratch> scratch_;
    gl::Program reduce_, sum_;
};

}  // namespace mv
