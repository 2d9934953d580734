// What maps believe of the groups of candidates of a batch (gather.comp), and how much of that is
// worth taking.

uniform float mapCheck;  // how far maps are doubted where they are sure
#ifdef MV_ASKS_SCENE
shared vec2 borneOut[kGroupLanes];  // see trustOfTile()
#endif

float beliefs[kBatchSamples];  // in the views
uint takenOf[kBatchSamples];   // samples, of each
vec3 believedLight;
// What maps believe of the batch, without lamps: sums of luminances if light passed and of these
// times the beliefs; then sums of the first squared, of both multiplied and of the second squared.
vec2 believed;
vec3 believedSquares;
float believedDraws;  // variance of what the groups' candidates give, of those that are drawn
// The squares of what is believed of the groups over their weights, and of the samples in the mean:
// samplesSquare().
float squaresOfGroups;
float squaresOfSamples;
#ifdef MV_RECORDS_SAMPLES
float groupLights[kBatchSamples * kCandidateGroups];  // luminances, in power units
uint groupsChosen[kBatchSamples];                     // of the views
uint groupsLeft;                                      // a bit a group that takes no samples
#endif

// A group's view and what maps say of it, in one word.
const uint kViewBits = 31u - kVerdictBits;
const uint kOfLamp = 1u << 31u;
uint viewOf(uint group) { return group & ((1u << kViewBits) - 1u); }
uint verdictOf(uint group) { return group >> kViewBits & kVerdictMask; }
// A lamp's edge of shadow is finer than a map: where maps are checked at all, nothing is believed.
bool isBelieved(uint group) { return (group & kOfLamp) == 0u || mapCheck == 0.0; }
float beliefOf(uint group) { return isBelieved(group) ? beliefIn(verdictOf(group)) : 0.0; }
float doubtOf(uint group) { return isBelieved(group) ? doubtIn(verdictOf(group), mapCheck) : 1.0; }

// The light that maps believe a group to give. number: of the pixel's groups.
void addBelievedGroup(Choice choice, uint number) {
    bool gives = choice.chosen != kNone;
    uint view = gives ? choice.chosen : 0u;
    VisibilitySample way = sampleOf(view, position, normal, receiverPlane);
    uint verdict = known(way, number);
    uint group = view | verdict << kViewBits | (way.ofLamp ? kOfLamp : 0u);
#ifdef MV_RECORDS_SAMPLES
    groupLights[groupCount] = choice.total / float(candidates);
#endif
    addGroup(group, doubtedWeight(choice, doubtOf(group)));
    if (!gives) return;

    ++could;
    if (!isSure(verdict)) ++asked;
    vec3 gift = giftOf(view, choice.total / float(candidates));
    float light = luminance(gift);
    float belief = beliefOf(group);
    believedLight += gift * belief;
    float weight = groupWeights[groupCount - 1u];
    if (weight > 0.0) squaresOfGroups += light * light * (belief * belief / weight);
    unshadowed += light;
    if (!way.ofLamp) {
        believed += light * vec2(1.0, belief);
        believedSquares += light * light * vec3(1.0, belief, belief * belief);
        // The weight of one that is chosen by it, times the sum of all weights, is in the mean the
        // sum of their squares.
        float spread =
            choice.weight / choice.total - float(candidateGroups(candidates)) / float(candidates);
        believedDraws += light * light * belief * belief * spread;
    }
}

// The variance of what maps believe, told from how much their beliefs in the batch differ, and
// what candidates give within a group.
float believedVariance() {
    float mean = believed.x > 0.0 ? believed.y / believed.x : 0.0;
    float ofBeliefs =
        believedSquares.z - 2.0 * mean * believedSquares.y + mean * mean * believedSquares.x;
    float ofThinning = believed.y * believed.y * float(forOne - 1u) / float(inBatch);
    return max(ofBeliefs, 0.0) + max(believedDraws, 0.0) + ofThinning;
}

#ifdef MV_ASKS_SCENE
// How much of what maps believe is worth taking: the factor by which the samples' beliefs come
// nearest to what their rays found, over all other pixels of the tile. Its own samples would leave
// a bias: they would not take back what was believed of the pixels that did not ask. What others
// believe is known of all their groups, sampled or not. Maps that are not checked where they are
// sure are believed whole.
float trustOfTile(uint passed) {
    float found = 0.0;
    for (uint k = 0u; k < viewsChosen; ++k) {
        float light = luminance(gifts[k]);
        if ((passed >> k & 1u) != 0u) found += light * light * beliefs[k] / float(takenOf[k]);
    }
    borneOut[lane] = vec2(found, squaresOfSamples);
    barrier();
    vec2 others = vec2(0.0);
    for (uint i = 0u; i < kGroupLanes; ++i) others += i == lane ? vec2(0.0) : borneOut[i];
    return mapCheck > 0.0 && others.y > 0.0 ? min(others.x / others.y, 1.0) : 1.0;
}

#ifdef MV_RECORDS_SAMPLES
// Records what maps believe of groups that take no samples.
void recordGroupsLeft(float trust) {
    for (uint group = 0u; recording && group < groupCount; ++group) {
        if ((groupsLeft >> group & 1u) == 0u || !(groupLights[group] > 0.0)) continue;
        float belief = trust * beliefOf(groupViews[group]);
        uint view = viewOf(groupViews[group]);
        vec3 light = giftOf(view, groupLights[group]);
        recordSample(view, light, light * belief, belief > 0.5);
    }
}
#endif
#endif
