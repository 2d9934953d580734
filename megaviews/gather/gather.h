#pragma once
// The gather's reference: the sum over all views of one receiver, the hierarchical culling of
// views that cannot light it, and sampling by power times an importance, with candidates weighed
// by what they would give [Kol19 §5.1]. Formulas in
// shaders/shared/{gather,gather_sampling,shadow_test}.glsl, which the GPU's gather runs too.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "megaviews/gather/receiver.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/settings/settings.h"

namespace mv {

struct GatherReferenceOptions {
    float clampDistance = 0.01f;  // root-cube units
    float worldEdge = 1;          // world length of the root cube
    uint rules = kCorrectedRules;
    float cutoff = 0;  // root-cube units; 0 = none
    float bias = 1;    // times the rules' bias of the shadow test
    // Answers single samples where there are no maps: is the way from the receiver to a view's
    // position, whose normal is given too, blocked? Unset: nothing is.
    std::function<bool(const Receiver&, glm::vec3 position, glm::vec3 normal)> blocked = {};
};

// Irradiance-like sum E (everything but albedo/pi, W/m^2) over all sorted views. maps may be null:
// no visibility. No views give 0.
glm::dvec3 gatherAll(const Receiver& receiver, const ViewHierarchy& views, const ViewMaps* maps,
                     const GatherReferenceOptions& options);
// The summand of one view.
glm::dvec3 gatherOne(const Receiver& receiver, std::uint32_t sortedView, const ViewHierarchy& views,
                     const ViewMaps* maps, const GatherReferenceOptions& options);

// ---------------------------------------------------------------- culling

// Points within a box whose normals lie in a cone; both already widened by the margins of
// gather.glsl. cosCone <= 0: normals of every direction.
struct ReceiverBounds {
    glm::vec3 center{0}, half{0}, axis{0, 0, 1};
    float cosCone = -1, sinCone = 0;
};
// The bounds of a tile whose pixels show these.
ReceiverBounds receiverBounds(std::span<const Receiver> receivers);

// View nodes kept for one receiver: disjoint, at most at `level`, in the order of their views, and
// covering every view within the cutoff (root-cube units, 0 = none) that can light any point and
// normal of the receiver. Far nodes are not refined.
std::vector<std::uint32_t> keptViewNodes(const ReceiverBounds& receiver, const ViewHierarchy& views,
                                         int level, float cutoff = 0);

// ---------------------------------------------------------------- sampling

// Sorted views [first, end) that follow `unitsBefore` units of earlier runs, in units of the list
// (listScale()). Neighbouring kept nodes hold neighbouring views and share a run if they have the
// same importance; runs without power are left out.
struct ViewRun {
    std::uint32_t unitsBefore, first, end, scale;
};
struct KeptViews {
    std::vector<ViewRun> runs;
    std::uint32_t units = 0;  // of all runs
    std::uint32_t views = 0;
};
// Power units before each sorted view; the last entry is the total. N + 1 entries.
std::vector<std::uint32_t> powerPrefix(const std::vector<View>& sortedViews);
KeptViews keptRuns(const ReceiverBounds& receiver, const std::vector<std::uint32_t>& nodes,
                   const ViewHierarchy& views, const std::vector<std::uint32_t>& prefix);
// All views by power alone: what pixels outside every receiver sample from.
KeptViews allRuns(const std::vector<std::uint32_t>& prefix);
// The sorted view that owns what lies `within` a unit in [0, kept.units), in 1 / 2^32; kNone:
// nobody does.
struct PickedView {
    std::uint32_t view = kNone;
    double units = 0;  // that it owns in the list
};
PickedView pickView(const KeptViews& kept, const std::vector<std::uint32_t>& prefix,
                    std::uint32_t unit, std::uint32_t within = 0);

struct GatherSampling {
    std::uint32_t samples = 64;  // 0 or at least the kept views: the full sum over them
    std::uint32_t seed = 0, x = 0, y = 0, accumulationIndex = 0;
    std::uint32_t candidates = 1;  // weighed for each sample, 1 .. kDrawRanks
};
glm::dvec3 gatherSampled(const Receiver& receiver, const KeptViews& kept,
                         const std::vector<std::uint32_t>& prefix, const ViewHierarchy& views,
                         const ViewMaps* maps, const GatherReferenceOptions& options,
                         const GatherSampling& sampling);

}  // namespace mv
