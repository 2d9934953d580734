#pragma once
// Stable sort of (30-bit key, index) pairs on the GPU: least significant digit first, five bits a
// pass, counting and scattering runs of elements without atomics, so that the order never depends
// on timing. Elements with key kMortonDead are dropped.

#include <array>
#include <cstdint>

#include "renderer/gl/program.h"
#include "renderer/passes/prefix_sum.h"

namespace mv {

class RadixSort {
  public:
    RadixSort();
    // Room for `count` pairs; the caller then writes them into pairs().
    void resize(std::uint32_t count);
    // Sorts what was written; pairs() and alive() then hold the result, behind a fetch barrier.
    void sort();
    gl::TexelBuffer<glm::uvec2>& pairs() { return pairs_[0]; }
    // One number: how many pairs are left.
    gl::TexelBuffer<std::uint32_t>& alive() { return alive_; }
    std::uint32_t count() const { return count_; }
    std::uint64_t bytes() const {
        return pairs_[0].bytes() + pairs_[1].bytes() + counts_.bytes() + begins_.bytes() +
               alive_.bytes() + prefixSum_.bytes();
    }

  private:
    std::uint32_t count_ = 0;
    std::array<gl::TexelBuffer<glm::uvec2>, 2> pairs_;
    gl::TexelBuffer<std::uint32_t> counts_, begins_, alive_;
    PrefixSum prefixSum_;
    gl::Program countDigits_, scatter_;
};

}  // namespace mv
