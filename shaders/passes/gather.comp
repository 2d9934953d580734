// GBuffer x kept views x maps -> noisy irradiance [Kol19 5.1]. One invocation a pixel, one tile or
// a part of it a work group. A pixel weighs candidates drawn for its part (gather_draw.comp)
// and asks for the visibility of about one a sample. MV_MAPS_DECIDE: what maps decide is checked
// now and then, and what is found counts by the inverse share, so that errors of maps are noise and
// no bias. ASK: where that may be asked of the scene, the questions of all pixels are put into one
// queue, which all invocations work through: a ray costs what it costs, but no lane waits for a
// neighbour's.
#include "shaders/passes/gather_sum.glsl"
#include "shaders/shared/bindings.glsl"

const uint kGroupLanes = uint(MV_TILE_X * MV_TILE_Y);

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
shared Question questions[kGroupLanes * kBatchSamples];
shared uint questionCount;
shared vec3 positions[kGroupLanes], normals[kGroupLanes];
shared uint answers[kGroupLanes];  // a bit a sample: light passes
shared uint countsOfTile[2];
// Samples that could give light, and those of them that asked.
layout(std430, binding = kBlockAskedCounts) buffer AskedCounts { uint askedCounts[2]; };
#endif

// The pixel, and what it reads.
ivec2 pixel;
uint lane;
bool present;  // there is a surface
vec3 position, normal;
uint receiver;
uvec4 list;        // of the receiver: GatherList
uint drawsOfPart;  // the first of its tile's part
uint pixelRank;    // in the tile
bool drawing;      // samples are drawn; else nothing is summed, or all views are
// One of so many samples, a power of two, stands for all; pixels of a row that run together take
// the same.
uint forOne = 1u;
uint chosenOne = 0u;

// What its samples give together.
Gathered sum = Gathered(vec3(0.0), vec3(0.0));
float moment = 0.0;      // of the samples' luminances, squared; of lamps less (lampSpread)
vec2 lamps = vec2(0.0);  // samples of them, and their luminances
float open = 0.0;        // of all samples, if nothing stood between
bool seen = false;       // one of them, whatever maps say of it
uint could = 0u;         // samples that could give light
uint asked = 0u;         // those of them that asked

// The batch at hand, of samples from batchBegin on.
uint batchBegin;
uint inBatch;
uint viewsChosen;  // each for one sample or more
uint views[kBatchSamples];
vec3 gifts[kBatchSamples];   // what each gives if light passes
float given[kBatchSamples];  // luminances of what it does give
uint ofLamps;                // a bit a view
uint waiting;                // a bit a view that asked
float unshadowed;            // luminances of the gifts

// ---------------------------------------------------------------- the pixel

void beginPixel() {
    pixel = origin + ivec2(gl_GlobalInvocationID.xy);
    lane = gl_LocalInvocationIndex;
    uvec4 surface = all(lessThan(pixel, size)) ? texelFetch(surfaces, pixel, 0) : uvec4(kNoSurface);
    present = surface.w != kNoSurface;
    position = uintBitsToFloat(surface.xyz);
    normal = present ? unpackNormal(surface.w) : vec3(0.0);
    uint plane = texelFetch(planes, pixel, 0).x;
    receiverPlane = present ? unpackNormal(plane) : vec3(0.0);
#ifdef MV_GLOSS
    receiverGloss = broadGlossAt(pixel * scale, position, normal, kRoughGloss);
#endif
    uint part = present ? partOfPlane(plane) : 0u;
    uvec2 tile = uvec2(origin + ivec2(gl_WorkGroupID.xy) * ivec2(MV_TILE_X, MV_TILE_Y)) / kTileEdge;
    receiver = receiverOf(tile * kTileEdge, part);
    list = texelFetch(lists, int(receiver));
    drawsOfPart =
        ((tile.y * drawTilesAcross + tile.x - firstDrawTile) * kTileParts + part) * sampleCount;
    pixelRank = tileRank(uint(pixel.x), uint(pixel.y));
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
#endif
}

// Of a pixel whose reflection hides some of its light, fewer samples.
void thinSamples() {
#ifdef MV_SEEN_SHARES
    if (drawing) {
        vec3 shares = texelFetch(seenShares, pixel, 0).rgb;
        forOne = samplesForOne(max(shares.r, max(shares.g, shares.b)));
        chosenOne =
            sampleOffset(seed, uint(pixel.x) / 8u, uint(pixel.y), kNone, accumulationIndex) >> 29u;
        chosenOne &= forOne - 1u;
    }
#endif
}

// ---------------------------------------------------------------- a batch of samples

void beginBatch(uint begin, uint last) {
    batchBegin = begin;
    inBatch = min(kBatchSamples, last - begin);
    viewsChosen = 0u;
    ofLamps = 0u;
    waiting = 0u;
    unshadowed = 0.0;
#ifdef ASK
    answers[lane] = 0u;
    if (lane == 0u) questionCount = 0u;
    barrier();
#endif
}

// The groups of a stratum's candidates.
void addGroupsOfStratum(uint stratum) {
    uint firstDraw = (drawsOfPart + stratum - firstSample) * kDrawRanks;
    uvec4 numbers =
        sampleOffsets(seed ^ kChoiceSeed, uint(pixel.x), uint(pixel.y), stratum, accumulationIndex);
    uint j = 0u;
    uint group = 0u;
    do {
        Choice choice = noChoice(groupNumber(numbers, group));
        uint end = groupEnd(group, candidates);
        do {
            uint i = firstDraw + candidateRank(pixelRank, j, candidates);
            uvec2 draw = texelFetch(draws, int(i)).xy;
            if (draw.x == kNone) continue;
            choice = withCandidate(
                choice, draw.x, candidateWeight(draw.x, uintBitsToFloat(draw.y), position, normal));
        } while (++j < end);
        addGroup(choice);
    } while (++group < candidateGroups(candidates));
}

// A view, and the unshadowed luminance that its samples stand for, in power units.
void addGift(uint view, float light) {
    views[viewsChosen] = view;
    gifts[viewsChosen] = fluxOf(view, light / recordOf(view, 1u).w) *
                         glossWeight(view, position, normal) * float(forOne);
    unshadowed += luminance(gifts[viewsChosen]);
    ++viewsChosen;
}

// Views for as many samples as there are strata, begin <= stratum < end.
void chooseViews(uint begin, uint end) {
    beginGroups(uvec2(pixel), begin);
    uint strata = 0u;
    uint stratum = begin;
    do {
        if ((stratum & (forOne - 1u)) != chosenOne) continue;
        addGroupsOfStratum(stratum);
        ++strata;
    } while (++stratum < end);
    for (uint group = 0u; group < groupCount; ++group) {
        uint taken = takeSamples(group, strata);
        if (taken == 0u) continue;
        addGift(groupViews[group],
                float(taken) * sampleLight(groupWeights[group], groupTotal, strata, candidates));
    }
}

#ifdef ASK
float checkNumber(uint sampleIndex) {
    return unitFloat(sampleOffset(seed ^ kCheckSeed, uint(pixel.x), uint(pixel.y), sampleIndex,
                                  accumulationIndex));
}

// What the maps say of the sample, in so far as it is believed: what is left of its light until
// the scene has answered. kAsk: nothing.
uint believed(VisibilitySample way, uint k, inout vec3 light) {
    // A lamp's edge of shadow is finer than a map: where maps are checked at all, not by chance.
    uint verdict = way.ofLamp && mapCheck > 0.0 ? kAsk : known(way, batchBegin + k);
    ++could;
    if (verdict == kAsk) ++asked;
    float share = checkShare(mapCheck, luminance(light), unshadowed / float(inBatch));
    bool checked = verdict != kAsk && checkNumber(batchBegin + k) < share;
    float weight = checked ? 1.0 / share : 1.0;
    if (checked || verdict == kAsk) {
        gifts[k] = light * weight;
        waiting |= 1u << k;
        questions[atomicAdd(questionCount, 1u)] = Question(views[k], lane, k);
    }
    if (checked) light *= 1.0 - weight;
    return checked && verdict == kBlocked ? kAsk : verdict;
}
#else
uint believed(VisibilitySample way, uint k, inout vec3 light) {
    uint verdict = known(way, batchBegin + k);
    if (verdict == kAsk) verdict = isVisible(way) ? kLit : kBlocked;
    if (verdict == kLit) seen = true;
    return verdict;
}
#endif

void sumSample(uint k) {
    given[k] = 0.0;
    vec3 light = gifts[k];
    VisibilitySample way = sampleOf(views[k], position, normal, receiverPlane);
    if (way.ofLamp) ofLamps |= 1u << k;
    uint verdict = believed(way, k, light);
    if (verdict == kAsk) return;
    if (verdict == kLit) {
        sum.clamped += light;
        given[k] = luminance(light);
    }
#ifdef SAMPLES
    recordSample(views[k], light, verdict == kLit);
#endif
}

#ifdef ASK
// The questions of the whole tile, and what the pixel's own were answered.
void askScene() {
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
    for (uint k = 0u; k < viewsChosen; ++k) {
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
    barrier();  // before the questions of the next batch
#endif
}
#endif

void sumBatch() {
    uint together = resampledTogether(candidates);
    if (drawing) {
        for (uint k = 0u; k < inBatch; k += together) {
            chooseViews(batchBegin + k, batchBegin + min(k + together, inBatch));
        }
    }
    open += unshadowed * float(forOne);
    for (uint k = 0u; k < viewsChosen; ++k) sumSample(k);
#ifdef ASK
    askScene();
#endif
    float spread = lampSpread(max(samples, 1u));
    for (uint k = 0u; k < viewsChosen; ++k) {
        bool onLamp = (ofLamps >> k & 1u) != 0u;
        moment += given[k] * given[k] * (onLamp ? spread : 1.0);
        if (onLamp) lamps += vec2(float(forOne), given[k] * inverseEdge2);
    }
}

// ---------------------------------------------------------------- end

// The share of the samples that maps did not decide; counts those of the tile.
float undecidedShare() {
#ifdef ASK
    atomicAdd(countsOfTile[0], could);
    atomicAdd(countsOfTile[1], asked);
    barrier();
    if (lane < 2u && countsOfTile[lane] > 0u) atomicAdd(askedCounts[lane], countsOfTile[lane]);
#endif
    return could > 0u ? float(asked) / float(could) : 0.0;
}

// Adds to what parts of the samples before gave. last: the end of those summed so far.
void storePixel(uint last, float undecided) {
    if (!all(lessThan(pixel, size))) return;
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
}

void main() {
    beginPixel();
    bool enabled = present && list.x > 0u;
    bool full = samples == 0u || samples >= list.z;
    drawing = enabled && !full;
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);
    thinSamples();
    // The same for all pixels, which meet at barriers, though lists differ between a tile's parts.
    uint last = min(samples, lastSample);
    for (uint begin = firstSample; begin < last; begin += kBatchSamples) {
        beginBatch(begin, last);
        sumBatch();
    }
#ifdef SAMPLES
    endRecord();
#elif MV_VERDICTS != 1
    storePixel(last, undecidedShare());
#endif
}
