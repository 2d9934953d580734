#include "megaviews/gather/gather.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/map_store.glsl"
#include "shaders/shared/parametrisation.glsl"
#include "shaders/shared/shadow_test.glsl"

namespace mv {
namespace {

bool seesReceiver(const Receiver& receiver, std::uint32_t sortedView, const ViewHierarchy& views,
                  const ViewMaps& maps, const GatherReferenceOptions& options) {
    const std::uint32_t map = views.mapOfNode[views.leafOfView[sortedView]];
    assert(map != kNone);
    const auto res = static_cast<uint>(maps.mapRes);
    const vec3 offset = receiver.position - maps.centers[map];
    const uint bits = loadMapTexel(MapStore{res}, maps.texels, map, texelOfDirection(offset, res));
    return isLit(bits, offset, receiver.normal, res, hasRule(options.rules, kRuleFootprint),
                 options.bias);
}

}  // namespace

glm::dvec3 gatherOne(const Receiver& receiver, std::uint32_t sortedView, const ViewHierarchy& views,
                     const ViewMaps* maps, const GatherReferenceOptions& options) {
    const View& v = views.sortedViews[sortedView];
    const vec3 toView = viewPosition(v) - receiver.position;
    const float term =
        gatherTerm(toView, receiver.normal, viewNormal(v), v.flags == kViewOmnidirectional,
                   options.clampDistance, options.cutoff);
    if (!(term > 0)) return glm::dvec3(0);
    if (maps && !seesReceiver(receiver, sortedView, views, *maps, options)) {
        return glm::dvec3(0);
    }
    if (options.blocked && options.blocked(receiver, viewPosition(v), viewNormal(v))) {
        return glm::dvec3(0);
    }
    const double perArea = double{term} / (double{options.worldEdge} * double{options.worldEdge});
    return perArea * glm::dvec3(viewFlux(v));
}

glm::dvec3 gatherAll(const Receiver& receiver, const ViewHierarchy& views, const ViewMaps* maps,
                     const GatherReferenceOptions& options) {
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < views.sortedViews.size(); ++i) {
        sum += gatherOne(receiver, i, views, maps, options);
    }
    return sum;
}

ReceiverBounds receiverBounds(std::span<const Receiver> receivers) {
    ReceiverBounds bounds;
    if (receivers.empty()) return bounds;
    vec3 low = receivers[0].position, high = low, sum(0);
    for (const Receiver& r : receivers) {
        low = min(low, r.position);
        high = max(high, r.position);
        sum += r.normal;
    }
    bounds.center = 0.5f * (low + high);
    bounds.half = 0.5f * (high - low) + vec3(kReceiverMargin);
    bounds.axis = normalizeOr(sum, vec3(0, 1, 0));
    float c = 1;
    for (const Receiver& r : receivers) c = std::min(c, dot(bounds.axis, r.normal));
    if (!(c > 0)) return bounds;
    const float s = std::sqrt(std::max(0.0f, 1 - c * c));
    bounds.cosCone = widenedCos(c, s);
    bounds.sinCone = widenedSin(c, s);
    return bounds;
}

std::vector<std::uint32_t> keptViewNodes(const ReceiverBounds& receiver, const ViewHierarchy& views,
                                         int level, float cutoff) {
    std::vector<std::uint32_t> kept;
    if (views.empty()) return kept;
    // Depth first, children in Morton order; a flat hierarchy is a forest of leaves.
    std::vector<std::uint32_t> stack;
    for (std::uint32_t root = views.levelBegin[1]; root-- > 0;) stack.push_back(root);
    while (!stack.empty()) {
        const std::uint32_t index = stack.back();
        stack.pop_back();
        const ViewNode& node = views.nodes[index];
        if (!viewsReachReceiver(node, receiver.center, receiver.half, receiver.axis,
                                receiver.cosCone, receiver.sinCone, cutoff)) {
            continue;
        }
        if (isLeaf(node) || node.level >= static_cast<uint>(level) ||
            !refineViewNode(node, receiver.center, receiver.half, kRefineShare)) {
            kept.push_back(index);
            continue;
        }
        for (uint child = childCountOf(node.children); child-- > 0;) {
            stack.push_back(firstChildOf(node.children) + child);
        }
    }
    return kept;
}

std::vector<std::uint32_t> powerPrefix(const std::vector<View>& sortedViews) {
    float total = 0;
    for (const View& v : sortedViews) total += gatherPower(viewFlux(v));
    const auto count = static_cast<uint>(sortedViews.size());
    std::vector<std::uint32_t> prefix(sortedViews.size() + 1, 0);
    for (std::size_t i = 0; i < sortedViews.size(); ++i) {
        const View& v = sortedViews[i];
        const float power = gatherPower(viewFlux(v));
        prefix[i + 1] = prefix[i] + powerUnits(power, total, count);
    }
    return prefix;
}

KeptViews keptRuns(const ReceiverBounds& receiver, const std::vector<std::uint32_t>& nodes,
                   const ViewHierarchy& views, const std::vector<std::uint32_t>& prefix) {
    KeptViews kept;
    float sum = 0;
    for (const std::uint32_t index : nodes) {
        const ViewNode& node = views.nodes[index];
        const std::uint32_t end = node.firstView + node.viewCount;
        const uint shift = importanceShift(node, receiver.center, receiver.half, receiver.axis,
                                           receiver.cosCone, receiver.sinCone);
        const std::uint32_t power = prefix[end] - prefix[node.firstView];
        kept.views += node.viewCount;
        if (power == 0) continue;
        sum += static_cast<float>(power) * static_cast<float>(1u << shift);
        if (!kept.runs.empty() && kept.runs.back().end == node.firstView &&
            kept.runs.back().scale == shift) {
            kept.runs.back().end = end;
        } else {
            kept.runs.push_back({0, node.firstView, end, shift});  // until the sum is known
        }
    }
    for (ViewRun& run : kept.runs) {
        run.unitsBefore = kept.units;
        run.scale = listScale(run.scale, sum);
        kept.units += listUnits(prefix[run.end] - prefix[run.first], run.scale);
    }
    return kept;
}

KeptViews allRuns(const std::vector<std::uint32_t>& prefix) {
    KeptViews all;
    all.views = static_cast<std::uint32_t>(prefix.size()) - 1;
    all.units = prefix.back();
    if (all.units > 0) all.runs.push_back({0, 0, all.views, kMaxImportanceShift});
    return all;
}

PickedView pickView(const KeptViews& kept, const std::vector<std::uint32_t>& prefix,
                    std::uint32_t unit, std::uint32_t within) {
    assert(unit < kept.units);
    const auto run = std::prev(
        std::upper_bound(kept.runs.begin(), kept.runs.end(), unit,
                         [](std::uint32_t u, const ViewRun& r) { return u < r.unitsBefore; }));
    const std::uint32_t global =
        prefix[run->first] + powerAtUnit(unit - run->unitsBefore, within, run->scale);
    if (global >= prefix[run->end]) return {};
    // The last view that begins at or before the unit: views without power own nothing.
    const auto next =
        std::upper_bound(prefix.begin() + run->first, prefix.begin() + run->end, global);
    const auto view = static_cast<std::uint32_t>(next - prefix.begin()) - 1;
    return {view, (prefix[view + 1] - prefix[view]) / double{powerOfListUnit(run->scale)}};
}

glm::dvec3 gatherSampled(const Receiver& receiver, const KeptViews& kept,
                         const std::vector<std::uint32_t>& prefix, const ViewHierarchy& views,
                         const ViewMaps* maps, const GatherReferenceOptions& options,
                         const GatherSampling& sampling) {
    glm::dvec3 sum(0);
    if (sampling.samples == 0 || sampling.samples >= kept.views) {
        for (const ViewRun& run : kept.runs) {
            for (std::uint32_t v = run.first; v < run.end; ++v) {
                sum += gatherOne(receiver, v, views, maps, options);
            }
        }
        return sum;
    }
    if (kept.units == 0) return sum;
    GatherReferenceOptions unshadowed = options;
    unshadowed.blocked = {};
    const auto perView = [&](const PickedView& v, std::uint32_t width) {
        return static_cast<double>(width) / v.units;
    };
    const auto luminanceOf = [](const glm::dvec3& e) {
        return static_cast<float>(luminance(vec3(e)));
    };
    struct Group {
        PickedView view;
        float weight;
    };
    std::vector<Group> groups;
    const uint pixelRank = tileRank(sampling.x, sampling.y);
    const uint swaps = rankSwaps(pixelRank);
    const auto addGroupsOf = [&](uint i) {
        const uint begin = stratumBegin(kept.units, sampling.samples, i);
        const uint width = stratumBegin(kept.units, sampling.samples, i + 1) - begin;
        if (width == 0) return;
        const uvec4 numbers = sampleOffsets(sampling.seed ^ kChoiceSeed, sampling.x, sampling.y, i,
                                            sampling.accumulationIndex);
        uint j = 0;
        for (uint group = 0; group < candidateGroups(sampling.candidates); ++group) {
            Choice choice = noChoice(groupNumber(numbers, group));
            PickedView chosen{};
            for (; j < groupEnd(group, sampling.candidates); ++j) {
                const uint rank = candidateRank(pixelRank, swaps, j, sampling.candidates);
                const uint offset =
                    drawOffset(sampling.seed, sampling.x / kTileEdge, sampling.y / kTileEdge, i,
                               rank, sampling.accumulationIndex);
                const PickedView v =
                    pickView(kept, prefix, begin + mulHigh(offset, width), offset * width);
                if (v.view == kNone) continue;
                const glm::dvec3 open = gatherOne(receiver, v.view, views, nullptr, unshadowed);
                choice = withCandidate(choice, j, luminanceOf(perView(v, width) * open));
                if (choice.chosen == j) chosen = v;
            }
            groups.push_back({chosen, groupWeight(choice)});
        }
    };
    const uint together = resampledTogether(sampling.candidates);
    for (uint begin = 0; begin < sampling.samples; begin += together) {
        const uint strata = std::min(together, sampling.samples - begin);
        groups.clear();
        for (uint i = 0; i < strata; ++i) addGroupsOf(begin + i);
        float total = 0, before = 0;
        for (const Group& g : groups) total += g.weight;
        const float number = unitFloat(sampleOffset(sampling.seed ^ kResampleSeed, sampling.x,
                                                    sampling.y, begin, sampling.accumulationIndex));
        uint taken = 0;
        for (const Group& g : groups) {
            before += g.weight;
            const uint upTo = samplesUpTo(before, total, strata, number);
            if (upTo == taken) continue;
            const double light =
                double{sampleLight(g.weight, total, strata, sampling.candidates)} * (upTo - taken);
            const glm::dvec3 open = gatherOne(receiver, g.view.view, views, nullptr, unshadowed);
            sum += light / luminance(open) * gatherOne(receiver, g.view.view, views, maps, options);
            taken = upTo;
        }
    }
    return sum;
}

}  // namespace mv
