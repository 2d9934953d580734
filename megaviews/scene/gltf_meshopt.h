#pragma once
// Buffer views that EXT_meshopt_compression packs, unpacked by meshoptimizer. Its decoder is only
// called with sizes that its codecs have. Serves the first stage, file -> Scene.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mv {

// What the extension says of one buffer view, in its own words.
struct MeshoptView {
    std::string mode;              // ATTRIBUTES, TRIANGLES or INDICES
    std::string filter = "NONE";   // NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL
    std::uint64_t count = 0;       // elements, below 2^32
    std::uint64_t byteStride = 0;  // bytes of one, at most 256
};

// Why no `compressedBytes` bytes can decode to such a view: a size that its codec lacks, or more
// elements than that many bytes can stand for. Empty: decoding can be tried.
std::string meshoptViewError(const MeshoptView& view, std::uint64_t compressedBytes);

// Writes count * byteStride bytes to `out`, which has that size. Returns why it cannot, or "".
// Safe to call from several threads.
std::string decodeMeshopt(const MeshoptView& view, std::span<const std::uint8_t> compressed,
                          std::span<std::uint8_t> out);

}  // namespace mv
