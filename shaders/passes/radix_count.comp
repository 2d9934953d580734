#include "shaders/passes/radix_digit.glsl"
#include "shaders/shared/bindings.glsl"

layout(std430, binding = kBlockBinCounts) writeonly buffer Counts {
    uint binCounts[];
};  // bin * chunks + chunk

void main() {
    uint chunk = globalIndex();
    if (chunk >= chunks) return;
    uint end = min(elementCount(), (chunk + 1u) * chunkSize);
    Counters c = Counters(uvec4(0u), uvec4(0u), 0u);
    for (uint i = chunk * chunkSize; i < end; ++i) countBin(c, binOf(texelFetch(pairs, int(i)).x));
    for (uint bin = 0u; bin < kSortBins; ++bin) binCounts[bin * chunks + chunk] = countOf(c, bin);
}
