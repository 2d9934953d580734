// GBuffer x kept views x maps -> noisy irradiance [Kol19 5.1]. One invocation serves a pixel, one
// work group a tile or a part of one. A pixel weighs candidates drawn for its part
// (gather_draw.comp) and asks for the visibility of about one a sample.
// MV_MAPS_DECIDE: the light is what maps believe of every group of candidates
// (believed_groups.glsl), and samples, taken where maps are in doubt, correct it: control variates,
// whose mean is that of the samples alone, whatever maps believe. The tile's rays tell how much of
// the beliefs is worth taking: of maps that leak, nearly nothing.
// MV_ASKS_SCENE: samples ask the scene. The questions of all pixels are put into one queue, which
// all invocations work through: a ray costs what it costs, but no lane waits for a neighbour's.
#include "shaders/passes/gather_sum.glsl"
#include "shaders/passes/rests.glsl"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_variance.glsl"

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
#ifdef MV_SEEN_SHARES
layout(binding = kUnitReflectionWeight) uniform sampler2D seenShares;
#endif
uniform uint drawTilesAcross;
uniform uint firstDrawTile;
uniform uint viewCount;
uniform ivec2 origin;  // of the first work group
uniform ivec2 size;
uniform int scale;  // G-buffer pixels a pixel, each way

#ifdef MV_ASKS_SCENE
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
uint swaps;        // see rankSwaps()
bool drawing;      // samples are drawn; else nothing is summed, or all views are
// Only each forOne-th stratum (a power of two) is sampled, its light multiplied by forOne; the 8
// pixels of a row segment share chosenOne.
uint forOne = 1u;
uint chosenOne = 0u;

// What its samples give together.
Gathered sum = Gathered(vec3(0.0), vec3(0.0));
// The sums of the samples' luminances and of their squares, in which lamps count less
// (addMoments()).
vec2 moments = vec2(0.0);
vec2 lamps = vec2(0.0);  // what varianceWithLamps() asks of them
float open = 0.0;        // of all samples, if nothing stood between
bool seen = false;       // one of them, whatever maps say of it
uint could = 0u;         // samples, or groups that maps know of, that could give light
uint asked = 0u;         // those of them of which maps are not sure

// The batch at hand, of samples from batchBegin on.
uint batchBegin;
uint inBatch;
uint firstDraw;    // of the stratum at hand
uint viewsChosen;  // each for one sample or more
uint views[kBatchSamples];
vec3 gifts[kBatchSamples];   // what each gives if light passes
float given[kBatchSamples];  // luminances of what it does give
uint ofLamps;                // a bit a view
uint waiting;                // a bit a view that asked
float unshadowed;            // luminances of what all would give

// ---------------------------------------------------------------- the pixel

void beginPixel() {
    pixel = origin + ivec2(gl_GlobalInvocationID.xy);
    lane = gl_LocalInvocationIndex;
    uvec4 surface = all(lessThan(pixel, size)) ? texelFetch(surfaces, pixel, 0) : uvec4(kNoSurface);
    present = surface.w != kNoSurface;
    position = uintBitsToFloat(surface.xyz);
    normal = present ? unpackNormal(surface.w) : vec3(0.0);
    uint plane = texelFetch(planes, pixel, 0).x;
    beginReceiver(pixel * scale, position, normal, present ? unpackNormal(plane) : vec3(0.0));
    uint part = present ? partOfPlane(plane) : 0u;
    uvec2 tile = uvec2(origin + ivec2(gl_WorkGroupID.xy) * ivec2(MV_TILE_X, MV_TILE_Y)) / kTileEdge;
    receiver = receiverOf(tile * kTileEdge, part);
    list = texelFetch(lists, int(receiver));
    drawsOfPart =
        ((tile.y * drawTilesAcross + tile.x - firstDrawTile) * kTileParts + part) * sampleCount;
    pixelRank = tileRank(uint(pixel.x), uint(pixel.y));
    swaps = rankSwaps(pixelRank);
#if MV_VERDICTS > 0
    firstVerdict = (uint(pixel.y) * uint(size.x) + uint(pixel.x)) * verdictWords;
#endif
#ifdef MV_RECORDS_SAMPLES
    if (pixel == chosen) beginRecord();
#endif
#ifdef MV_ASKS_SCENE
    positions[lane] = position;
    normals[lane] = normal;
    if (lane == 0u) {
        countsOfTile[0] = 0u;
        countsOfTile[1] = 0u;
    }
#endif
}

// Takes fewer samples at a pixel whose reflection hides some of its light.
void thinSamples() {
#ifdef MV_SEEN_SHARES
    if (drawing) {
        vec3 shares = texelFetch(seenShares, pixel * scale, 0).rgb;
        forOne = samplesForOne(max(shares.r, max(shares.g, shares.b)));
        chosenOne =
            sampleOffset(seed, uint(pixel.x) / 8u, uint(pixel.y), kNone, accumulationIndex) >> 29u;
        chosenOne &= forOne - 1u;
    }
#endif
}

// ---------------------------------------------------------------- a batch of samples

// What a view gives if light passes. light: the luminance, in power units.
vec3 giftOf(uint view, float light) {
    return fluxOf(view, light / recordOf(view, 1u).w) * glossWeight(view, position, normal) *
           float(forOne);
}

#ifdef MV_MAPS_DECIDE
#include "shaders/passes/believed_groups.glsl"
#endif

void beginBatch(uint begin, uint last) {
    batchBegin = begin;
    inBatch = min(kBatchSamples, last - begin);
    viewsChosen = 0u;
    ofLamps = 0u;
    waiting = 0u;
    unshadowed = 0.0;
#ifdef MV_MAPS_DECIDE
    believedLight = vec3(0.0);
    believed = vec2(0.0);
    believedSquares = vec3(0.0);
    believedDraws = 0.0;
    squaresOfSamples = 0.0;
#endif
#ifdef MV_ASKS_SCENE
    answers[lane] = 0u;
    if (lane == 0u) questionCount = 0u;
    barrier();
#endif
}

// Candidates of a stratum are draws of the tile's part (gather_draw.comp).
void beginStratum(uint stratum) {
    firstDraw = (drawsOfPart + stratum - firstSample) * drawsOfStratum(candidates);
}

uint drawCandidate(uint j, out float units) {
    uint rank = candidateRank(pixelRank, swaps, j, candidates);
    uvec2 draw = texelFetch(draws, int(firstDraw + (rank >> drawShift(candidates)))).xy;
    units = uintBitsToFloat(draw.y);
    return draw.x;
}

void addChoice(Choice choice, uint number) {
#ifdef MV_MAPS_DECIDE
    addBelievedGroup(choice, number);
#else
    addGroup(choice.chosen, groupWeight(choice));
#endif
}

#include "shaders/passes/candidate_groups.glsl"

// Chooses a group's view for `taken` samples, of as many as there are strata.
void chooseView(uint group, uint taken, uint strata) {
    uint view = groupViews[group];
#ifdef MV_MAPS_DECIDE
    float doubt = doubtOf(view);
    float light = doubtedLight(groupWeights[group], doubt, groupTotal, strata, candidates);
    beliefs[viewsChosen] = beliefOf(view);
    takenOf[viewsChosen] = taken;
    if ((view & kOfLamp) != 0u) ofLamps |= 1u << viewsChosen;
    view = viewOf(view);
#ifdef MV_RECORDS_SAMPLES
    groupsChosen[viewsChosen] = group;
#endif
#else
    float light = sampleLight(groupWeights[group], groupTotal, strata, candidates);
#endif
    views[viewsChosen] = view;
    gifts[viewsChosen] = giftOf(view, float(taken) * light);
    ++viewsChosen;
}

// Chooses views for as many samples as there are strata, begin <= stratum < end.
void chooseViews(uint begin, uint end) {
    beginGroups(uvec2(pixel), begin);
#ifdef MV_MAPS_DECIDE
    squaresOfGroups = 0.0;
#endif
#if defined(MV_MAPS_DECIDE) && defined(MV_RECORDS_SAMPLES)
    groupsLeft = 0u;
#endif
    uint strata = 0u;
    uint stratum = begin;
    do {
        if ((stratum & (forOne - 1u)) != chosenOne) continue;
        addGroupsOfStratum(stratum, candidates, uvec2(pixel), position, normal);
        ++strata;
    } while (++stratum < end);
#ifdef MV_MAPS_DECIDE
    // A group takes strata * weight / groupTotal samples in the mean, each for as much more light.
    if (strata > 0u) squaresOfSamples += squaresOfGroups * groupTotal / float(strata);
#endif
    for (uint group = 0u; group < groupCount; ++group) {
        uint taken = takeSamples(group, strata);
        if (taken > 0u) chooseView(group, taken, strata);
#if defined(MV_MAPS_DECIDE) && defined(MV_RECORDS_SAMPLES)
        if (taken == 0u) groupsLeft |= 1u << group;
#endif
    }
}

#ifdef MV_ASKS_SCENE
// Puts the question of sample k, whose answer the scene gives, into the queue.
void askSample(uint k) {
#ifndef MV_MAPS_DECIDE
    VisibilitySample way = sampleOf(views[k], position, normal, receiverPlane);
    if (way.ofLamp) ofLamps |= 1u << k;
    unshadowed += luminance(gifts[k]);
    ++could;
    ++asked;
#endif
    given[k] = 0.0;
    waiting |= 1u << k;
    questions[atomicAdd(questionCount, 1u)] = Question(views[k], lane, k);
}

// Answers the questions of the whole tile, then sums the pixel's own by their answers.
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
#ifdef MV_MAPS_DECIDE
    float trust = trustOfTile(passed);
    sum.clamped += trust * believedLight;
    believed.y *= trust;
    believedSquares *= vec3(1.0, trust, trust * trust);
    believedDraws *= trust * trust;
#endif
    for (uint k = 0u; k < viewsChosen; ++k) {
        float light = float(passed >> k & 1u);
#ifdef MV_MAPS_DECIDE
        beliefs[k] *= trust;
        light -= beliefs[k];
#endif
        sum.clamped += light * gifts[k];
        given[k] = light * luminance(gifts[k]);
    }
#ifdef MV_RECORDS_SAMPLES
#ifdef MV_MAPS_DECIDE
    recordGroupsLeft(trust);
#endif
    for (uint k = 0u; recording && k < viewsChosen; ++k) {
        float passes = float(passed >> k & 1u);
#ifdef MV_MAPS_DECIDE
        vec3 open = giftOf(views[k], groupLights[groupsChosen[k]]);
        vec3 light = beliefs[k] * open + (passes - beliefs[k]) * gifts[k];
#else
        vec3 open = gifts[k];
        vec3 light = passes * open;
#endif
        recordSample(views[k], open, light, passes > 0.0);
    }
#endif
}
#else
// Sums sample k by the answer of a map, or where there are no maps as lit.
void sumSample(uint k) {
    VisibilitySample way = sampleOf(views[k], position, normal, receiverPlane);
    if (way.ofLamp) ofLamps |= 1u << k;
    unshadowed += luminance(gifts[k]);
#ifdef MV_MAPS_DECIDE
    bool lit = false;  // what they believe is written down
#else
    uint verdict = known(way, batchBegin + k);
    bool lit = isSure(verdict) ? verdict == kVerdictLit : isVisible(way);
#endif
    given[k] = lit ? luminance(gifts[k]) : 0.0;
    if (lit) {
        sum.clamped += gifts[k];
        seen = true;
    }
#ifdef MV_RECORDS_SAMPLES
    recordSample(views[k], gifts[k], lit ? gifts[k] : vec3(0.0), lit);
#endif
}
#endif

// How much the batch's samples of lamps count in the sum of squares (lampsSpread()), told from
// those that follow each other in the order of their strata.
float spreadOfLamps() {
    uint before = kNone;
    uvec2 pairs = uvec2(0u);  // all, and those on different lamps
    for (uint k = 0u; k < viewsChosen; ++k) {
        if ((ofLamps >> k & 1u) == 0u) continue;
        uint view = views[k];
        if (before != kNone) {
            bool one = isOneLamp(position, recordOf(before, 0u).xyz, recordOf(before, 1u).xyz,
                                 recordOf(view, 0u).xyz, recordOf(view, 1u).xyz);
            pairs += uvec2(1u, one ? 0u : 1u);
        }
        before = view;
    }
    return lampsSpread(max(samples, 1u), float(pairs.y) / float(max(pairs.x, 1u)));
}

// Adds what varianceWithLamps() is told of the batch.
void addMoments() {
    float spread = spreadOfLamps();
    for (uint k = 0u; k < viewsChosen; ++k) {
        bool onLamp = (ofLamps >> k & 1u) != 0u;
        float light = given[k] * inverseEdge2;
        moments += light * vec2(1.0, light * (onLamp ? spread : 1.0));
        if (onLamp) lamps += (1.0 - spread) * vec2(float(forOne), light);
    }
#ifdef MV_MAPS_DECIDE
    // Less by the factor that varianceWithLamps() gives to squares.
    float ofBeliefs = believedVariance() * inverseEdge2 * inverseEdge2;
    moments.y += samples > 1u ? ofBeliefs * float(samples - 1u) / float(samples) : ofBeliefs;
#endif
}

void sumBatch() {
#ifdef MV_MAPS_DECIDE
    uint together = kBatchSamples;
#else
    uint together = resampledTogether(candidates);
#endif
    if (drawing) {
        for (uint k = 0u; k < inBatch; k += together) {
            chooseViews(batchBegin + k, batchBegin + min(k + together, inBatch));
        }
    }
    for (uint k = 0u; k < viewsChosen; ++k) {
#ifdef MV_ASKS_SCENE
        askSample(k);
#else
        sumSample(k);
#endif
    }
    open += unshadowed;
#ifdef MV_ASKS_SCENE
    askScene();
#endif
    addMoments();
}

// ---------------------------------------------------------------- end

// The share of what could give light of which maps are not sure. Adds the pixel's counts to the
// tile's.
float undecidedShare() {
#ifdef MV_ASKS_SCENE
    atomicAdd(countsOfTile[0], could);
    atomicAdd(countsOfTile[1], asked);
    barrier();
    if (lane < 2u && countsOfTile[lane] > 0u) atomicAdd(askedCounts[lane], countsOfTile[lane]);
#endif
    return could > 0u ? float(asked) / float(could) : 0.0;
}

// Adds the sums to what earlier parts of the samples gave. last: the end of those summed so far.
void storePixel(uint last, float undecided) {
    if (!all(lessThan(pixel, size))) return;
    vec4 light = vec4(sum.clamped * inverseEdge2, moments.y);
    float kept = present ? float(list.z) / float(viewCount) : 0.0;
    if (firstSample > 0u) light += imageLoad(irradiance, pixel);
    // Between the parts of a set of samples, the second image holds what is known of lamps, what
    // samples in the dark could have found, below 0 if one was lit, and the samples' sum.
    open *= inverseEdge2;
    if (firstSample > 0u && drawing) {
        vec4 before = imageLoad(candidateShares, pixel);
        lamps += before.xy;
        open += max(before.z, 0.0);
        moments.x += before.w;
        seen = seen || before.z < 0.0;
    }
    if (last > 0u && last == samples) {
        light.a = varianceWithLamps(moments.x, light.a, lamps, samples);
    }
    bool more = drawing && last < samples;
    imageStore(irradiance, pixel, light);
    imageStore(candidateShares, pixel,
               more ? vec4(lamps, seen ? -1.0 : open, moments.x)
                    : vec4(kept, undecided, seen ? 0.0 : open, luminance(light.rgb)));
}

void main() {
    beginPixel();
    bool enabled = present && list.x > 0u;
    bool full = samples == 0u || samples >= list.z;
    drawing = enabled && !full && !rests(pixel);
    if (full && enabled) sumRuns(receiver * capacity, list.x, position, normal, sum);
    thinSamples();
    // All pixels, which meet at barriers, go through the same batches, though lists differ between
    // a tile's parts.
    uint last = min(samples, lastSample);
    for (uint begin = firstSample; begin < last; begin += kBatchSamples) {
        beginBatch(begin, last);
        sumBatch();
    }
#ifdef MV_RECORDS_SAMPLES
    endRecord();
#elif MV_VERDICTS != 1
    storePixel(last, undecidedShare());
#endif
}
