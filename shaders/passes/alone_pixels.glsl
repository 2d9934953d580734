// Pixels that need more than the others, in any order: upsample.comp lists those whose surface no
// pixel of a gather at a lower resolution shares, second_look.comp those in doubt. A dispatch of
// aloneCommand serves each with an invocation.
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/dispatch.glsl"

layout(std430, binding = kBlockAlonePixels) buffer AlonePixels {
    uvec4 aloneCommand;  // work groups each way, then how many pixels there are
    uint alonePixels[];  // y << 16 | x
};

// Appends a pixel. The command's first number stays what the host wrote.
void addAlonePixel(ivec2 pixel) {
    uint i = atomicAdd(aloneCommand.w, 1u);
    alonePixels[i] = uint(pixel.y) << 16u | uint(pixel.x);
    atomicMax(aloneCommand.y, i / (aloneCommand.x * uint(MV_WORKGROUP_SIZE)) + 1u);
}

// The pixel of this invocation; false if it has none.
bool takeAlonePixel(out ivec2 pixel) {
    uint i = globalIndex();
    if (i >= aloneCommand.w) return false;
    uint place = alonePixels[i];
    pixel = ivec2(place & 0xffffu, place >> 16u);
    return true;
}
