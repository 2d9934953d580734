// GBuffer x kept views x maps -> noisy irradiance [Kol19 5.1]. One invocation a pixel, one tile or
// a part of it a work group. A pixel weighs candidates drawn for its part (gather_draw.comp)
// and asks for the visibility of one a sample. MV_MAPS_DECIDE: what maps decide is checked now and
// then, and what is found counts by the inverse share, so that errors of maps are noise and no
// bias. ASK: where that may be asked of the scene, the questions of all pixels are put into one
// queue, which all invocations work through: a ray costs what it costs, but no lane waits for a
// neighbour's.
#include "shaders/passes/gather_sum.glsl"
#include "shaders/shared/bindings.glsl"

const uint kGroupLanes = uint(MV_TILE_X * MV_TILE_Y);
const uint kBatch = 16u;  // samples of a pixel at once

layout(local_size_x = MV_TILE_X, local_size_y = MV_TILE_Y) in;
layout(binding = kUnitSurfaces) uniform usampler2D surfaces;  // see gather_surfaces.comp
layout(binding = kUnitPlanes) uniform usampler2D planes;
layout(binding = kUnitDraws) uniform usamplerBuffer draws;  // GatherDraw
layout(binding = kImageIrradiance, rgba32f) uniform restrict image2D irradiance;
layout(binding = kImageCandidates, rgba32f) uniform restrict image2D candidateShares;

#if MV_VERDICTS > 0
uniform uint verdictWords;  // of a pixel
#endif
uniform uint candidates;   // a sample: 1 .. kDrawRanks
uniform uint sampleCount;  // that are drawn: from firstSample on
#ifdef MV_MAPS_DECIDE
uniform float mapCheck;  // share of the decided samples that are asked all the same
#else
const float mapCheck = 0.0;
#endif
#ifdef MV_SEEN_SHARES
layout(binding = kUnitReflectionWeight) uniform sampler2D seenShares;
#endif
uniform uint drawTilesAcross;
uniform uint firstDrawTile;
uniform uint viewCount;
uniform ivec2 origin;  // of the first work group
uniform ivec2 size;
#ifdef MV_GLOSS
uniform int scale;  // G-buffer pixels a pixel, each way
#endif

#ifdef ASK
struct Question {
    uint view;
    uint lane, draw;
};
shared Question questions[kGroupLanes * kBatch];
shared uint questionCount;
shared vec3 positions[kGroupLanes], normals[kGroupLanes];
shared uint answers[kGroupLanes];  // a bit a sample: light passes
shared uint countsOfTile[2];
// Samples that could give light, and those of them that asked.
layout(std430, binding = kBlockAskedCounts) buffer AskedCounts { uint askedCounts[2]; };
#endif

void main() {
    ivec2 pixel = origin + ivec2(gl_GlobalInvocationID.xy);
    uint lane = gl_LocalInvocationIndex;
    bool inside = all(lessThan(pixel, size));
    uvec4 surface = inside ? texelFetch(surfaces, pixel, 0) : uvec4(kNoSurface);
    bool present = surface.w != kNoSurface;
    vec3 position = uintBitsToFloat(surface.xyz);
    vec3 normal = present ? unpackNormal(surface.w) : vec3(0.0);
    uint plane = texelFetch(planes, pixel, 0).x;
    receiverPlane = present ? unpackNormal(plane) : vec3(0.0);
#ifdef MV_GLOSS
    receiverGloss = broadGlossAt(pixel * scale, position, normal, kRoughGloss);
#endif
    uint part = present ? partOfPlane(plane) : 0u;
    uvec2 tile = uvec2(origin + ivec2(gl_WorkGroupID.xy) * ivec2(MV_TILE_X, MV_TILE_Y)) / kTileEdge;
    uint receiver = receiverOf(tile * kTileEdge, part);
    uvec4 list = texelFetch(lists, int(receiver));
    uint drawsOfTile =
        ((tile.y * drawTilesAcross + tile.x - firstDrawTile) * kTileParts + part) * sampleCount;
#if MV_VERDICTS > 0
    firstVerdict = (uint(pixel.y) * uint(size.x) + uint(pixel.x)) * verdictWords;
#endif
#ifdef SAMPLES
    if (pixel == chosen) beginRecord();
#endif
#ifdef ASK
    positions[lane] = position;
    normals[lane] = normal;
    if (lane == 0u) {
        countsOfTile[0] = 0u;
        countsOfTile[1] = 0u;
    }
    uint could = 0u;
    uint asked = 0u;
#endif

    Gathered sum = Gathered(vec3(0.0), vec3(0.0));
    bool enabled = present && list.x > 0u;
    float moment = 0.0;      // of the samples' luminances, squared; of lamps less (lampSpread)
    vec2 lamps = vec2(0.0);  // samples of them, and their luminances
    float open = 0.0;        // of all samples, if nothing stood between
    bool seen = false;       // one of them, whatever maps say of it
    bool full = samples == 0u || samples >= list.z;
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);

    // The same for all pixels, which meet at barriers, though lists differ between a tile's parts.
    uint last = min(samples, lastSample);
    bool drawing = enabled && !full;
    float spread = lampSpread(max(samples, 1u));
    uint pixelRank = tileRank(uint(pixel.x), uint(pixel.y));
    // One of so many samples, a power of two, stands for all; pixels of a row that run together
    // take the same.
    uint forOne = 1u;
    uint chosenOne = 0u;
#ifdef MV_SEEN_SHARES
    if (drawing) {
        vec3 seen = texelFetch(seenShares, pixel, 0).rgb;
        forOne = samplesForOne(max(seen.r, max(seen.g, seen.b)));
        chosenOne =
            sampleOffset(seed, uint(pixel.x) / 8u, uint(pixel.y), kNone, accumulationIndex) >> 29u;
        chosenOne &= forOne - 1u;
    }
#endif
    for (uint begin = firstSample; begin < last; begin += kBatch) {
        uint inBatch = min(kBatch, last - begin);
#ifdef ASK
        answers[lane] = 0u;
        if (lane == 0u) questionCount = 0u;
        barrier();
#endif

        // What each sample gives if light passes.
        uint views[kBatch];
        vec3 gifts[kBatch];
        float numbers[kBatch];
        float given[kBatch];  // luminances of what does
        uint ofLamps = 0u;    // a bit a sample
        float unshadowed = 0.0;
        uint waiting = 0u;
        uint k = 0u;
        do {
            views[k] = kNone;
            given[k] = 0.0;
            if (!drawing || ((begin + k) & (forOne - 1u)) != chosenOne) continue;
            Choice choice = noChoice(unitFloat(
                sampleOffset(seed, uint(pixel.x), uint(pixel.y), begin + k, accumulationIndex)));
            uint firstDraw = (drawsOfTile + begin + k - firstSample) * kDrawRanks;
            uint j = 0u;
            do {
                uint i = firstDraw + candidateRank(pixelRank, j, candidates);
                uvec2 draw = texelFetch(draws, int(i)).xy;
                if (draw.x == kNone) continue;
                float power = recordOf(draw.x, 1u).w;
                choice = withCandidate(
                    choice, i, uintBitsToFloat(draw.y) * power * termOf(draw.x, position, normal));
            } while (++j < candidates);
            if (choice.chosen == kNone) continue;
            uvec2 draw = texelFetch(draws, int(choice.chosen)).xy;
            views[k] = draw.x;
            numbers[k] = choice.number;
            gifts[k] = fluxOf(draw.x, uintBitsToFloat(draw.y)) *
                       glossWeight(draw.x, position, normal) * float(forOne) *
                       (termOf(draw.x, position, normal) * choice.total /
                        (choice.weight * float(candidates)));
            unshadowed += luminance(gifts[k]);
        } while (++k < inBatch);
        open += unshadowed * float(forOne);
        k = 0u;
        do {
            if (views[k] == kNone) continue;
            uint view = views[k];
            vec3 light = gifts[k];
            VisibilitySample way = sampleOf(view, position, normal, receiverPlane);
            if (way.ofLamp) ofLamps |= 1u << k;
#ifdef ASK
            // A lamp's edge of shadow is finer than a map: where maps are checked at all, not by
            // chance.
            uint verdict = way.ofLamp && mapCheck > 0.0 ? kAsk : known(way, begin + k);
            ++could;
            if (verdict == kAsk) ++asked;
            float share = checkShare(mapCheck, luminance(light), unshadowed / float(inBatch));
            bool checked = verdict != kAsk && numbers[k] < share;
            float weight = checked ? 1.0 / share : 1.0;
            if (checked || verdict == kAsk) {
                gifts[k] = light * weight;
                waiting |= 1u << k;
                questions[atomicAdd(questionCount, 1u)] = Question(view, lane, k);
            }
            if (verdict == kAsk || (checked && verdict == kBlocked)) continue;
            if (checked) light *= 1.0 - weight;
#else
            uint verdict = known(way, begin + k);
            if (verdict == kAsk) verdict = isVisible(way) ? kLit : kBlocked;
            if (verdict == kLit) seen = true;
#endif
            if (verdict == kLit) {
                sum.clamped += light;
                given[k] = luminance(light);
            }
#ifdef SAMPLES
            recordSample(view, light, verdict == kLit);
#endif
        } while (++k < inBatch);
#ifdef ASK
        barrier();

        for (uint q = lane; q < questionCount; q += kGroupLanes) {
            Question question = questions[q];
            vec3 from = positions[question.lane];
            VisibilitySample way = sampleOf(question.view, from, normals[question.lane], vec3(0.0));
            if (isVisible(way)) atomicOr(answers[question.lane], 1u << question.draw);
        }
        barrier();

        uint passed = answers[lane] & waiting;
        if (passed != 0u) seen = true;
        for (uint k = 0u; k < inBatch; ++k) {
            if ((passed >> k & 1u) == 0u) continue;
            sum.clamped += gifts[k];
            given[k] += luminance(gifts[k]);
        }
#ifdef SAMPLES
        for (uint q = 0u; recording && q < questionCount; ++q) {
            if (questions[q].lane != lane) continue;
            uint k = questions[q].draw;
            recordSample(questions[q].view, gifts[k], (passed >> k & 1u) != 0u);
        }
#endif
#endif
        for (uint k = 0u; k < inBatch; ++k) {
            bool onLamp = (ofLamps >> k & 1u) != 0u;
            moment += given[k] * given[k] * (onLamp ? spread : 1.0);
            if (onLamp) lamps += vec2(float(forOne), given[k] * inverseEdge2);
        }
    }

#ifdef SAMPLES
    endRecord();
#elif MV_VERDICTS != 1
#ifdef ASK
    atomicAdd(countsOfTile[0], could);
    atomicAdd(countsOfTile[1], asked);
    barrier();
    if (lane < 2u && countsOfTile[lane] > 0u) atomicAdd(askedCounts[lane], countsOfTile[lane]);
    float undecided = could > 0u ? float(asked) / float(could) : 0.0;
#else
    float undecided = 0.0;
#endif
    if (!inside) return;
    vec4 light = vec4(sum.clamped * inverseEdge2, moment * inverseEdge2 * inverseEdge2);
    float kept = present ? float(list.z) / float(viewCount) : 0.0;
    if (firstSample > 0u) light += imageLoad(irradiance, pixel);
    // Between the parts of a set of samples, the second image holds what is known of lamps.
    open *= inverseEdge2;
    if (firstSample > 0u && drawing) {
        vec4 before = imageLoad(candidateShares, pixel);
        lamps += before.xy;
        open += before.z;
        if (before.z == 0.0) seen = true;
    }
    if (seen) open = 0.0;
    if (last > 0u && last == samples) {
        light.a = varianceWithLamps(luminance(light.rgb), light.a, lamps, samples);
    }
    bool more = drawing && last < samples;
    imageStore(irradiance, pixel, light);
    imageStore(candidateShares, pixel,
               vec4(more ? lamps : vec2(kept, undecided), open, luminance(light.rgb)));
#endif
}
