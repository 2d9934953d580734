#pragma once
// Exclusive prefix sums on the GPU, for passes that place what they write by counting first.
// Deterministic: sums of integers, no atomics.

#include <cstdint>
#include <vector>

#include "renderer/gl/program.h"
#include "renderer/passes/texel_array.h"

namespace mv {

class PrefixSum {
  public:
    PrefixSum();
    // out[i] = counts[0] + ... + counts[i - 1] for i < count. The counts are R32UI texels that
    // storage writes have just produced; out is to be read behind a barrier.
    void exclusive(const gl::TextureBuffer& counts, std::uint32_t count, const gl::Buffer& out);

  private:
    void run(const gl::TextureBuffer& counts, std::uint32_t count, const gl::Buffer& out,
             std::size_t depth);
    struct Scratch {
        TexelArray totals, bases;
    };
    std::vector<Scratch> scratch_;
    gl::Program reduce_, sum_;
};

}  // namespace mv
