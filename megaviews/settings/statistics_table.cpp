#include "megaviews/settings/statistics_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

namespace mv {
namespace {

using Json = nlohmann::ordered_json;
using Frame = FrameStatistics;
using OneMethod = MethodStatistics;

double number(std::uint64_t n) { return static_cast<double>(n); }

constexpr double kNotCounted = std::numeric_limits<double>::quiet_NaN();

const StatisticInfo<Frame> kFrame[] = {
    {"/views/requested", "Views requested", "views", "Slots asked for, dead ones included.",
     [](const Frame& f) { return number(f.viewsRequested); }},
    {"/views/alive", "Views alive", "views",
     "Views that light the scene; paths that left it or were absorbed leave dead slots.",
     [](const Frame& f) { return number(f.viewsAlive); }},
    {"/views/nodes", "View nodes", "nodes", "Nodes of the octree over the views.",
     [](const Frame& f) { return number(f.viewNodes); }},
    {"/views/leaves", "View leaves", "nodes", "Leaves of the octree over the views.",
     [](const Frame& f) { return number(f.viewLeaves); }},
    {"/sky/points", "Sky points", "points", "Points that the maps of the sky's views are made of.",
     [](const Frame& f) { return f.skyPoints > 0 ? number(f.skyPoints) : kNotCounted; }},
    {"/picture/badPixels", "Bad pixels", "pixels", "Pixels whose radiance is NaN or infinite.",
     [](const Frame& f) { return number(f.badPixels); }},
    {"/picture/exposureEv", "Exposure", "EV", "Exposure in use, given or fitted.",
     [](const Frame& f) { return f.exposureEv; }, false},
    {"/picture/accumulatedFrames", "Sets of samples", "sets",
     "Sets of gather samples that the picture averages.",
     [](const Frame& f) { return static_cast<double>(f.accumulatedFrames); }},
    {"/picture/differenceRange", "Difference range", "",
     "End of the colour scale of the difference view; 0 without one.",
     [](const Frame& f) { return f.differenceRange; }, false},
    {"/frameMs", "Frame", "ms", "The whole frame by the wall clock, submission included.",
     [](const Frame& f) { return f.frameMs; }, false},
};

// Every traversal tests at least the pair of the roots: without one there is nothing to count.
double counted(const OneMethod& m, std::uint64_t n) {
    return m.pairs.processed > 0 ? number(n) : kNotCounted;
}

double inCuts(const OneMethod& m, std::uint64_t n) {
    return m.cuts.nodes > 0 ? number(n) : kNotCounted;
}

const StatisticInfo<OneMethod> kOneMethod[] = {
    {"/pairs/processed", "Pairs processed", "pairs",
     "Pairs of a scene node and a view node that were tested; each counts once.",
     [](const OneMethod& m) { return counted(m, m.pairs.processed); }},
    {"/pairs/culled", "Pairs culled", "pairs",
     "Pairs dropped because no view of the node can see the scene node.",
     [](const OneMethod& m) { return counted(m, m.pairs.culled); }},
    {"/pairs/rendered", "Pairs rendered", "pairs",
     "Pairs written into the view node's map, for all its views at once.",
     [](const OneMethod& m) { return counted(m, m.pairs.rendered); }},
    {"/pairs/subdivided", "Pairs subdivided", "pairs",
     "Pairs replaced by pairs with the children of one of their nodes.",
     [](const OneMethod& m) { return counted(m, m.pairs.subdivided); }},
    {"/pairs/skipped", "Pairs skipped", "pairs",
     "Leaf pairs in which the view stands inside the scene node.",
     [](const OneMethod& m) { return counted(m, m.pairs.skipped); }},
    {"/pairs/forced", "Pairs forced", "pairs",
     "Rendered leaf pairs that are larger than the threshold.",
     [](const OneMethod& m) { return counted(m, m.pairs.forced); }},
    {"/viewsPerRenderedNode", "Views a rendered pair", "views",
     "How many views share a rendered pair on average; 1 without sharing.",
     [](const OneMethod& m) {
         return m.pairs.processed > 0 ? m.pairs.viewsPerRenderedNode() : kNotCounted;
     },
     false},
    {"/meanSharing", "Views that share a pixel", "views",
     "How many views share the pair that shows a pixel, on average; 0 unless the debug view "
     "sharing is shown.",
     [](const OneMethod& m) { return m.meanSharing; }, false},
    {"/undecidedShare", "Undecided samples", "share",
     "Of the views that a pixel looks up, those that their maps are not sure of: the four nearest "
     "texels did not agree. Without maps all samples.",
     [](const OneMethod& m) { return m.undecidedShare; }, false},
    {"/cuts/nodes", "Cut nodes", "nodes",
     "Scene nodes in the cuts of all views; of cuts that are kept from frame to frame.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.nodes); }},
    {"/cuts/kept", "Cut nodes kept", "nodes", "Nodes taken over without a test.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.kept); }},
    {"/cuts/culled", "Cut nodes culled", "nodes", "Nodes that their view does not see.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.culled); }},
    {"/cuts/coarse", "Cut nodes too coarse", "nodes",
     "Nodes that a lazy cut has not split yet: the share that is wrong.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.coarse); }},
    {"/cuts/split", "Cut nodes split", "nodes", "Nodes replaced by their children.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.split); }},
    {"/cuts/merged", "Cut nodes merged", "nodes", "Nodes that replaced what was below them.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.merged); }},
    {"/cuts/iterations", "Rounds of tests", "",
     "Rounds in which cuts were brought up to date, the last that found a node to test.",
     [](const OneMethod& m) { return inCuts(m, m.cuts.iterations); }},
    {"/queuePeakPairs", "Queue peak", "pairs",
     "Most pairs held at once: of a queue, or of the lists of one level.",
     [](const OneMethod& m) { return counted(m, m.queuePeakPairs); }},
    {"/passes", "Passes", "", "Subsets of the views that were rendered one after another.",
     [](const OneMethod& m) { return number(m.passes.made); }},
    {"/prediction/overflows", "Passes done again", "",
     "Passes whose queue or lists overflowed: smaller ones, or more memory, took their place.",
     [](const OneMethod& m) { return number(m.passes.overflows); }},
    {"/prediction/falseAlarms", "Needless splits", "",
     "Neighbouring passes whose queues or lists would have fitted together.",
     [](const OneMethod& m) { return number(m.passes.falseAlarms); }},
    {"/prediction/error", "Prediction error", "",
     "Entries predicted of a pass beside those that it had: mean relative difference.",
     [](const OneMethod& m) {
         return m.passes.predicted > 0 ? m.passes.predictionError : kNotCounted;
     },
     false},
    {"/points", "Points", "points",
     "Points made of the triangles for all views; only view-independent rasterisation does.",
     [](const OneMethod& m) { return m.points > 0 ? number(m.points) : kNotCounted; }},
    {"/maps", "Maps", "maps", "Depth maps kept for the gather.",
     [](const OneMethod& m) { return number(m.maps); }},
    {"/memoryBytes/queue", "Queue memory", "bytes", "Pair queues, lists, or cuts that are kept.",
     [](const OneMethod& m) { return number(m.queueBytes); }},
    {"/memoryBytes/maps", "Map memory", "bytes", "Depth maps, working ones included.",
     [](const OneMethod& m) { return number(m.mapBytes); }},
    {"/memoryBytes/predictedQueue", "Queue memory, predicted", "bytes",
     "What pair queues or lists were expected to take.",
     [](const OneMethod& m) { return number(m.predictedQueueBytes); }},
    {"/memoryBytes/predictedMaps", "Map memory, predicted", "bytes",
     "What depth maps were worked out to take before they were allocated.",
     [](const OneMethod& m) { return number(m.predictedMapBytes + m.predictedWorkingMapBytes); }},
    {"/memoryBytes/sceneHierarchy", "Scene hierarchy memory", "bytes",
     "Nodes of the scene tree that the traversal reads; 0 without one.",
     [](const OneMethod& m) { return number(m.sceneHierarchyBytes); }},
    {"/memoryBytes/viewHierarchy", "View hierarchy memory", "bytes",
     "Nodes of the view octree and the sorted views.",
     [](const OneMethod& m) { return number(m.viewHierarchyBytes); }},
};

template <typename Source, std::size_t size>
Json layOut(const StatisticInfo<Source> (&table)[size], const Source& source) {
    Json out = Json::object();
    for (const auto& info : table) {
        const double value = info.value(source);
        Json& place = out[Json::json_pointer(std::string(info.path))];
        if (std::isnan(value)) {
            place = nullptr;
        } else if (info.whole) {
            place = static_cast<std::uint64_t>(value);
        } else {
            place = value;
        }
    }
    return out;
}

}  // namespace

std::span<const StatisticInfo<FrameStatistics>> frameStatistics() { return kFrame; }
std::span<const StatisticInfo<MethodStatistics>> methodStatistics() { return kOneMethod; }

PairCounts sumOf(const std::vector<PairCounts>& counts) {
    PairCounts sum;
    for (const PairCounts& c : counts) sum += c;
    return sum;
}

Json toJson(const FrameStatistics& statistics) {
    Json out = layOut(kFrame, statistics);
    out["views"]["nodesPerLevel"] = statistics.viewNodesPerLevel;
    out["memory"] = Json::array();
    for (const MemoryUse& use : statistics.memory) {
        Json row = {{"name", use.name}, {"usedBytes", use.usedBytes}};
        if (use.predictedBytes > 0) row["predictedBytes"] = use.predictedBytes;
        out["memory"].push_back(std::move(row));
    }
    if (statistics.freeGpuBytes > 0) out["freeGpuBytes"] = statistics.freeGpuBytes;
    return out;
}

Json toJson(const MethodStatistics& statistics) {
    Json out = layOut(kOneMethod, statistics);
    out["occupancy"] = statistics.occupancy;
    if (!statistics.pairsPerLevel.empty()) {
        Json& levels = out["pairsPerLevel"] = Json::array();
        for (const PairCounts& c : statistics.pairsPerLevel) {
            levels.push_back({{"processed", c.processed},
                              {"culled", c.culled},
                              {"rendered", c.rendered},
                              {"subdivided", c.subdivided},
                              {"skipped", c.skipped},
                              {"forced", c.forced},
                              {"renderedViews", c.renderedViews}});
        }
    }
    return out;
}

Summary summarize(std::vector<double> samples) {
    Summary s;
    s.count = samples.size();
    if (samples.empty()) return s;
    std::sort(samples.begin(), samples.end());
    const std::size_t n = samples.size();
    s.min = samples.front();
    s.max = samples.back();
    s.median = n % 2 ? samples[n / 2] : 0.5 * (samples[n / 2 - 1] + samples[n / 2]);
    s.p95 = samples[(n * 95 + 99) / 100 - 1];
    s.mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(n);
    double squares = 0;
    for (const double x : samples) squares += (x - s.mean) * (x - s.mean);
    if (n > 1) s.sd = std::sqrt(squares / static_cast<double>(n - 1));
    return s;
}

Json toJson(const Summary& s) {
    return {{"median", s.median}, {"p95", s.p95},   {"min", s.min},
            {"max", s.max},       {"mean", s.mean}, {"sd", s.sd}};
}

void StageSamples::add(const std::vector<StageTime>& stages) {
    ++frames_;
    for (const StageTime& time : stages) {
        auto it = std::find_if(stages_.begin(), stages_.end(),
                               [&](const Series& s) { return s.stage == time.stage; });
        if (it == stages_.end()) it = stages_.insert(stages_.end(), Series{time.stage, {}});
        // One sample a frame: a stage that appears twice in it is their sum, one that is missing
        // from a frame took no time there.
        it->ms.resize(frames_, 0.0);
        it->ms.back() += time.ms;
    }
    for (Series& series : stages_) series.ms.resize(frames_, 0.0);
}

Json StageSamples::toJson() const {
    Json out = Json::object();
    for (const Series& series : stages_) {
        out[std::string(infoOf(series.stage).name)] = mv::toJson(summarize(series.ms));
    }
    return out;
}

}  // namespace mv
