#include "shaders/passes/radix_digit.glsl"
#include "shaders/shared/bindings.glsl"

layout(binding = kUnitBinBegins) uniform
    usamplerBuffer binBegins;  // prefix sums of radix_count's counts
layout(std430, binding = kBlockSortPairs) writeonly buffer Sorted { uvec2 sorted[]; };
layout(std430, binding = kBlockSortAlive) writeonly buffer Alive { uint alive[]; };

void main() {
    uint chunk = globalIndex();
    if (chunk >= chunks) return;
    if (firstPass && chunk == 0u) alive[0] = texelFetch(binBegins, int(kDigits * chunks)).x;
    uint end = min(elementCount(), (chunk + 1u) * chunkSize);
    Counters c = Counters(uvec4(0u), uvec4(0u), 0u);
    for (uint i = chunk * chunkSize; i < end; ++i) {
        uvec2 pair = texelFetch(pairs, int(i)).xy;
        uint bin = binOf(pair.x);
        sorted[texelFetch(binBegins, int(bin * chunks + chunk)).x + countOf(c, bin)] = pair;
        countBin(c, bin);
    }
}
