// Samples of earlier frames, kept for pixels that show the same surface [Schied et al. 2017, SVGF,
// temporal accumulation].
#ifndef MV_HISTORY_GLSL
#define MV_HISTORY_GLSL
#include "shaders/shared/language.glsl"

MV_BEGIN_NAMESPACE

// The square of what two estimates differ by beyond their noise: by how much the light has changed.
// difference: of their means; variance: of that difference.
MV_FN float changeOfLight(float difference, float variance) {
    return max(0.0f, difference * difference - variance);
}

// The share of this frame's `samples` in their mean with `before` older ones, which are off by
// change2 (squared); variance: of this frame's estimate. It makes the mean's squared error least,
// alpha^2 V + (1 - alpha)^2 (V samples / before + change2): with light that stays, every sample
// counts alike. 1 where nothing is known.
MV_FN float shareOfNew(float samples, float before, float change2, float variance) {
    if (!(before > 0.0f)) return 1.0f;
    float off = samples / before + change2 / max(variance, 1e-30f);
    return off < 1e30f ? off / (1.0f + off) : 1.0f;
}

// How many samples a mean with that share of the new ones is worth, and `most` at most.
MV_FN float worthOfMean(float samples, float share, float most) {
    return min(samples / max(share, 1e-6f), most);
}

// While the light is unchanged, a pixel that remembers enough samples gathers in one of every
// kRestTurns frames, chosen by its tile.
MV_CONST uint kRestTurns = 4u;
MV_FN uint restTurn(uint tileX, uint tileY) { return tileX % 2u + 2u * (tileY % 2u); }

MV_END_NAMESPACE
#endif
