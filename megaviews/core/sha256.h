#pragma once
// SHA-256 (FIPS 180-4): names the content of scenes and keys the octree cache. Takes data in
// parts, any number of times.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace mv {

class Sha256 {
  public:
    Sha256& add(std::span<const std::byte> bytes);
    Sha256& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }
    // 64 lower-case hexadecimal digits. Ends the sum: nothing may be added afterwards.
    std::string hex();

  private:
    void addBlock(const std::uint8_t* block);
    std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<std::uint8_t, 64> pending_{};
    std::size_t pendingBytes_ = 0;
    std::uint64_t totalBytes_ = 0;
};

}  // namespace mv
