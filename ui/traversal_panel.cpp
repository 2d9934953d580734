// What happened to the pairs of scene and view nodes: in sums, level by level as bars, step by
// step; both sides of a comparison against the same scale [Kol19 fig. 2].

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

struct Decision {
    const char* name;
    ImU32 colour;
    std::uint64_t (*count)(const PairCounts&);
};
// Forced pairs are part of the rendered ones: the bars show them apart.
constexpr Decision kDecisions[] = {
    {"culled", palette::kCulled, [](const PairCounts& p) { return p.culled; }},
    {"rendered", palette::kRendered,
     [](const PairCounts& p) { return p.rendered - std::min(p.rendered, p.forced); }},
    {"forced", palette::kForced, [](const PairCounts& p) { return p.forced; }},
    {"subdivided", palette::kSubdivided, [](const PairCounts& p) { return p.subdivided; }},
    {"skipped", palette::kSkipped, [](const PairCounts& p) { return p.skipped; }},
};

std::uint64_t sumOf(const PairCounts& p) {
    std::uint64_t sum = 0;
    for (const Decision& decision : kDecisions) sum += decision.count(p);
    return sum;
}

void sums(Context& c) {
    const auto& methods = c.statistics.methods;
    if (!beginValues("sums", static_cast<int>(methods.size()), methods.size() > 1 ? 0.38f : 0.5f)) {
        return;
    }
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text(c, "pairs", palette::kDim);
    for (std::size_t side = 0; side < methods.size(); ++side) {
        ImGui::TableNextColumn();
        rightText(c, methodTitle(c.methodOf(side)), sideColour(side));
    }
    const auto row = [&](const char* label, const char* help, const char* place, auto&& value) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(c, label);
        tooltip(label, help);
        for (std::size_t side = 0; side < methods.size(); ++side) {
            ImGui::TableNextColumn();
            const std::string shown = value(methods[side]);
            rightText(c, shown);
            if (place) c.figure(shown, {"/methods/" + std::to_string(side) + place});
        }
    };
    // Every traversal tests at least the pair of the roots.
    using M = MethodStatistics;
    const auto counted = [](const M& m, std::uint64_t n) {
        return m.pairs.processed > 0 ? withThousands(n) : std::string("-");
    };
    row("processed", "Pairs that were tested; each counts once.", "/pairs/processed",
        [&](const M& m) { return counted(m, m.pairs.processed); });
    row("culled", "No view of the node can see the scene node.", "/pairs/culled",
        [&](const M& m) { return counted(m, m.pairs.culled); });
    row("rendered", "Written into the view node's map, for all its views at once.",
        "/pairs/rendered", [&](const M& m) { return counted(m, m.pairs.rendered); });
    row("subdivided", "Replaced by pairs with the children of one of the nodes.",
        "/pairs/subdivided", [&](const M& m) { return counted(m, m.pairs.subdivided); });
    row("skipped", "Leaf pairs whose view stands inside the scene node.", "/pairs/skipped",
        [&](const M& m) { return counted(m, m.pairs.skipped); });
    row("over 1 texel", "Rendered leaf pairs larger than the threshold, of all rendered ones.",
        nullptr, [&](const M& m) { return shareText(m.pairs.forced, m.pairs.rendered); });
    row("views a pair", "How many views share a rendered pair on average; 1 without sharing.",
        "/viewsPerRenderedNode", [](const M& m) {
            return m.pairs.rendered > 0 ? fixedText(m.pairs.viewsPerRenderedNode(), 2)
                                        : std::string("-");
        });
    const bool kept =
        std::any_of(methods.begin(), methods.end(), [](const M& m) { return m.cuts.nodes > 0; });
    if (kept) {
        const auto ofCut = [](std::uint64_t CutCounts::*part) {
            return [part](const M& m) { return shareText(m.cuts.*part, m.cuts.nodes); };
        };
        row("cut nodes", "Scene nodes in the cuts of all views.", "/cuts/nodes",
            [](const M& m) { return countOrDash(m.cuts.nodes); });
        row("kept", "Nodes of the cuts taken over without a test.", nullptr,
            ofCut(&CutCounts::kept));
        row("split", "Nodes replaced by their children, of those of the cuts.", nullptr,
            ofCut(&CutCounts::split));
        row("merged", "Nodes that replaced what was below them, of those of the cuts.", nullptr,
            ofCut(&CutCounts::merged));
        row("too coarse", "Nodes that a lazy cut has not split yet: the share that is wrong.",
            nullptr, ofCut(&CutCounts::coarse));
        row("rounds", "Rounds in which the cuts were brought up to date.", "/cuts/iterations",
            [](const M& m) { return countOrDash(m.cuts.iterations); });
    }
    row("most at once", "Pairs held at once: of the queue, or of the longest lists.",
        "/queuePeakPairs", [](const M& m) { return countOrDash(m.queuePeakPairs); });
    row("passes", "Subsets of the views that were rendered one after another.", "/passes",
        [](const M& m) { return countOrDash(m.passes.made); });
    row("done again", "Passes whose queue or lists overflowed.", "/prediction/overflows",
        [](const M& m) { return countOrDash(m.passes.overflows); });
    endValues();
}

void key(Context& c) {
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    bool first = true;
    for (const Decision& decision : kDecisions) {
        const float wide = ImGui::CalcTextSize(decision.name).x + c.px(20);
        if (!first) {
            ImGui::SameLine(0, c.px(10));
            if (ImGui::GetCursorScreenPos().x + wide > right) ImGui::NewLine();
        }
        first = false;
        swatch(c, decision.colour, decision.name);
    }
}

// One row a level, one bar a side, all against one scale or each against itself.
void levels(Context& c) {
    const auto& methods = c.statistics.methods;
    std::size_t count = 0;
    std::uint64_t most = 0;
    for (const MethodStatistics& m : methods) {
        for (std::size_t level = 0; level < m.pairsPerLevel.size(); ++level) {
            const std::uint64_t sum = sumOf(m.pairsPerLevel[level]);
            if (sum > 0) count = std::max(count, level + 1);  // the deepest that has any
            most = std::max(most, sum);
        }
    }
    if (count == 0) {
        wrappedText("Levels are counted from the next rendered frame on.", palette::kDim);
        return;
    }
    key(c);
    bool& shares = c.state.traversalShares;
    if (toggleButton(c, "traversal.counts", "Counts", !shares)) shares = false;
    ImGui::SameLine(0, c.px(4));
    if (toggleButton(c, "traversal.shares", "Shares", shares)) shares = true;
    tooltip("Shares", "Every level fills its bar; else all levels have one scale.");

    const float label = ImGui::CalcTextSize("11 ").x;
    const float number = ImGui::CalcTextSize("000,000,000").x;
    const float width = ImGui::GetContentRegionAvail().x - label - number;
    const float thick = std::round(methods.size() > 1 ? c.px(7) : c.px(11));
    const float pitch =
        std::max(ImGui::GetTextLineHeight() * static_cast<float>(methods.size()), c.px(16));
    for (std::size_t level = 0; level < count; ++level) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImDrawList* draw = ImGui::GetWindowDrawList();
        const std::string name = std::to_string(level + 1);
        draw->AddText({at.x, at.y + (pitch - ImGui::GetTextLineHeight()) / 2}, palette::kDim,
                      name.c_str());
        ImGui::Dummy({label + width + number, pitch});
        for (std::size_t side = 0; side < methods.size(); ++side) {
            const auto& perLevel = methods[side].pairsPerLevel;
            const PairCounts pairs = level < perLevel.size() ? perLevel[level] : PairCounts{};
            std::array<Slice, std::size(kDecisions)> slices;
            for (std::size_t i = 0; i < slices.size(); ++i) {
                slices[i] = {static_cast<double>(kDecisions[i].count(pairs)), kDecisions[i].colour};
            }
            const std::uint64_t sum = sumOf(pairs);
            const float line = pitch / static_cast<float>(methods.size());
            const float y = at.y + line * static_cast<float>(side);
            const int under = stackedBar({at.x + label, y + (line - thick) / 2, width, thick},
                                         slices, static_cast<double>(shares ? sum : most));
            if (under >= 0) {
                const auto i = static_cast<std::size_t>(under);
                ImGui::SetTooltip(
                    "level %s, %s: %s %s", name.c_str(), methodTitle(c.methodOf(side)),
                    withThousands(kDecisions[i].count(pairs)).c_str(), kDecisions[i].name);
            }
            const std::string text = withThousands(sum);
            draw->AddText({at.x + label + width + number - ImGui::CalcTextSize(text.c_str()).x,
                           y + (line - ImGui::GetTextLineHeight()) / 2},
                          methods.size() > 1 ? sideColour(side) : palette::kText, text.c_str());
            c.figure(text, {"/methods/" + std::to_string(side) + "/pairsPerLevel/" +
                            std::to_string(level) + "/processed"});
        }
    }
}

void occupancy(Context& c) {
    std::vector<std::vector<double>> values;
    std::vector<ColumnSeries> series;
    for (const MethodStatistics& m : c.statistics.methods) {
        values.emplace_back(m.occupancy.begin(), m.occupancy.end());
    }
    std::size_t steps = 0;
    for (std::size_t side = 0; side < values.size(); ++side) {
        steps = std::max(steps, values[side].size());
        series.push_back({values[side], sideColour(side)});
    }
    if (steps == 0) return;
    const bool queue = c.settings.side[0].pairs.traversal == Traversal::queue;
    sectionTitle(c, queue ? "Queue after each step, pairs" : "Lists after each step, entries");
    const int under = columns(c, "occupancy", series, c.px(72));
    if (under >= 0) {
        std::string tip = "step " + std::to_string(under + 1);
        for (std::size_t side = 0; side < values.size(); ++side) {
            const auto i = static_cast<std::size_t>(under);
            const auto n =
                i < values[side].size() ? static_cast<std::uint64_t>(values[side][i]) : 0;
            tip += "\n" + std::string(methodTitle(c.methodOf(side))) + ": " + withThousands(n);
        }
        ImGui::SetTooltip("%s", tip.c_str());
    }
    text(c, "step 1", palette::kDim);
    ImGui::SameLine();
    rightText(c, "step " + std::to_string(steps), palette::kDim);
}

}  // namespace

void traversalPanel(Context& c) {
    if (c.statistics.methods.empty()) {
        wrappedText("Nothing has been rendered yet.", palette::kDim);
        return;
    }
    sums(c);
    bool anyPairs = false;
    for (std::size_t side = 0; side < c.statistics.methods.size(); ++side) {
        anyPairs = anyPairs || testsPairs(c.methodOf(side));
    }
    if (!anyPairs) {
        wrappedText("Nothing is traversed: only MegaViews and ManyLoDs test pairs.", palette::kDim);
        return;
    }
    sectionTitle(c, "Pairs by level of the scene node");
    levels(c);
    occupancy(c);
}

}  // namespace mv::ui
