// GBuffer x kept views x maps -> noisy irradiance [Kol19 5.1], where samples may have to ask the
// scene. One invocation a pixel. Those of a tile that ask are put into one queue, which all its
// invocations work through: a ray costs what it costs, but no lane waits for a neighbour's.
#include "shaders/passes/gather_pixel.glsl"

const uint kTileLanes = uint(MV_TILE_X * MV_TILE_Y);
const uint kBatch = 16u;  // samples of a pixel at once

layout(local_size_x = MV_TILE_X, local_size_y = MV_TILE_Y) in;
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;
layout(binding = kImageCandidates, rg32f) uniform restrict image2D candidates;
// Samples that could give light, and those of them that asked.
layout(std430, binding = kBlockAskedCounts) buffer AskedCounts { uint askedCounts[2]; };

uniform uint viewCount;
uniform ivec2 size;

struct Question {
    uint view;
    uint lane, draw;
};
shared Question questions[kTileLanes * kBatch];
shared uint questionCount;
shared vec3 positions[kTileLanes], normals[kTileLanes];
shared uint answers[kTileLanes];  // a bit a sample: light passes
shared uint countsOfTile[2];

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    uint lane = gl_LocalInvocationIndex;
    bool inside = all(lessThan(pixel, size));
    uvec4 surface = inside ? texelFetch(surfaces, pixel, 0) : uvec4(kNoSurface);
    bool present = surface.w != kNoSurface;
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = present ? unpackNormal(surface.w) : vec3(0.0);
    receiverPlane = present ? unpackNormal(texelFetch(planes, pixel, 0).x) : vec3(0.0);
    uint receiver = present ? receiverIndex(texelFetch(receivers, pixel, 0).x) : 0u;
    uvec4 list = texelFetch(lists, int(receiver));
    positions[lane] = position;
    normals[lane] = normal;
    if (lane == 0u) {
        countsOfTile[0] = 0u;
        countsOfTile[1] = 0u;
    }

    Gathered sum = Gathered(vec3(0.0), vec3(0.0));
    bool enabled = present && list.x > 0u;
    bool full = samples == 0u || samples >= list.z;
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);

    uint last = min(samples, lastSample);
    bool drawn = enabled && !full;
    uint block = blockShift(seed, uint(pixel.x), uint(pixel.y), accumulationIndex);
    uint slotShift = guideShift(list.y);
    Strata strata = strataFrom(max(list.y, 1u), max(samples, 1u), firstSample);
    uint could = 0u;
    uint asked = 0u;
    for (uint begin = firstSample; begin < last; begin += kBatch) {
        answers[lane] = 0u;
        if (lane == 0u) questionCount = 0u;
        barrier();

        // What the maps know at once.
        vec3 gifts[kBatch];
        uint waiting = 0u;
        uint inBatch = min(kBatch, last - begin);
        for (uint k = 0u; k < inBatch; ++k) {
            gifts[k] = vec3(0.0);
            if (!drawn) continue;
            float sampled;
            uint view = nextView(strata, receiver, slotShift, block, uvec2(pixel), sampled);
            if (sampled == 0.0) continue;
            Gift gift = giftOf(view, sampled, position, normal);
            if (!gift.way.counts) continue;
            ++could;
            uint known = decide(gift.way);
            vec3 light = gift.flux * gift.term;
            if (known == kLit) sum.clamped += light;
            if (known == kAsk) {
                gifts[k] = light;
                waiting |= 1u << k;
                questions[atomicAdd(questionCount, 1u)] = Question(view, lane, k);
            }
        }
        asked += uint(bitCount(waiting));
        barrier();

        for (uint q = lane; q < questionCount; q += kTileLanes) {
            Question question = questions[q];
            vec3 from = positions[question.lane];
            uvec4 a = texelFetch(records, int(question.view * 3u));
            uint code = texelFetch(records, int(question.view * 3u + 1u)).w;
            vec3 viewNormal = code == kNoSurface ? vec3(0.0) : unpackNormal(code);
            bool visible = isVisible(VisibilitySample(from, normals[question.lane], vec3(0.0),
                                                      uintBitsToFloat(a.xyz) - from, viewNormal,
                                                      kNone, vec3(0.0), true));
            if (visible) atomicOr(answers[question.lane], 1u << question.draw);
        }
        barrier();

        uint passed = answers[lane] & waiting;
        for (uint k = 0u; k < inBatch; ++k) {
            if ((passed >> k & 1u) != 0u) sum.clamped += gifts[k];
        }
    }

    atomicAdd(countsOfTile[0], could);
    atomicAdd(countsOfTile[1], asked);
    barrier();
    if (lane < 2u && countsOfTile[lane] > 0u) atomicAdd(askedCounts[lane], countsOfTile[lane]);

    if (!inside) return;
    vec4 light = vec4(sum.clamped * inverseEdge2, present ? 1.0 : 0.0);
    float kept = present ? float(list.z) / float(viewCount) : 0.0;
    float undecided = could > 0u ? float(asked) / float(could) : 0.0;
    if (firstSample > 0u) light.rgb += imageLoad(irradiance, pixel).rgb;
    imageStore(irradiance, pixel, light);
    imageStore(candidates, pixel, vec4(kept, undecided, 0.0, 0.0));
}
