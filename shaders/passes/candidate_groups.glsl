// The groups of a stratum's candidates (gather_sampling.glsl). Who includes this says which these
// are, and what is done with the choices:
//     void beginStratum(uint stratum)
//     uint drawCandidate(uint j, out float units)   the view; kNone: nobody's. units: of power
//     void addChoice(Choice choice, uint number)    number: of the pixel's groups
void addGroupsOfStratum(uint stratum, uint candidatesOfOne, uvec2 pixel, vec3 position,
                        vec3 normal) {
    beginStratum(stratum);
    uvec4 numbers = sampleOffsets(seed ^ kChoiceSeed, pixel.x, pixel.y, stratum, accumulationIndex);
    uint j = 0u;
    uint group = 0u;
    do {
        Choice choice = noChoice(groupNumber(numbers, group));
        uint end = groupEnd(group, candidatesOfOne);
        do {
            float units;
            uint view = drawCandidate(j, units);
            if (view == kNone) continue;
            choice = withCandidate(choice, view, candidateWeight(view, units, position, normal));
        } while (++j < end);
        addChoice(choice, stratum * kCandidateGroups + group);
    } while (++group < candidateGroups(candidatesOfOne));
}
