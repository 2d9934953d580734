// The traversal one step at a time: which step is drawn, what happened to its pairs, why one of
// them was decided as it was, and the pair of nodes it starts from [Kol19 fig. 2].

#include <algorithm>
#include <cmath>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

// A row an outcome, which a click hides in the picture or shows again.
void outcomes(Context& c) {
    const StepsData& data = c.model.steps;
    std::uint64_t most = 1;
    for (const LegendEntry& d : data.decisions) most = std::max(most, d.count.value_or(0));
    if (!beginValues("decisions", 2, 0.34f)) return;
    for (std::size_t i = 0; i < std::min(data.decisions.size(), kOutcomeNames.size()); ++i) {
        const LegendEntry& d = data.decisions[i];
        bool& hidden = c.settings.inspect.stepHidden[i];
        const ImU32 colour = hidden ? palette::kFaint : toColour(d.colour);
        const std::uint64_t count = d.count.value_or(0);
        const std::string name = "outcome:" + std::string(kOutcomeNames[i]);
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const ImVec2 cursor = ImGui::GetCursorPos();
        if (ImGui::Selectable(("##" + name).c_str(), false, ImGuiSelectableFlags_SpanAllColumns)) {
            hidden = !hidden;
        }
        c.named(name);
        tooltip(d.label, hidden ? "Hidden in the picture; a click shows them."
                                : "A click hides them in the picture.");
        ImGui::SetCursorPos(cursor);
        swatch(c, colour, d.label, hidden ? palette::kFaint : palette::kText);
        ImGui::TableNextColumn();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x;
        const float line = ImGui::GetTextLineHeight();
        bar({at.x, at.y + line * 0.25f, width, line * 0.5f},
            static_cast<float>(static_cast<double>(count) / static_cast<double>(most)), colour);
        ImGui::TableNextColumn();
        rightText(c, withThousands(count), hidden ? palette::kFaint : palette::kText);
    }
    endValues();
}

// Which pairs are drawn, and how many of how many.
void drawnPairs(Context& c) {
    const StepsData& data = c.model.steps;
    const StepPairs show = c.settings.inspect.stepPairs;
    settingRow(c, "step-pairs");
    if (data.eligible == 0) {
        wrappedText(
            show == StepPairs::ofPair && !data.picked
                ? "No pair is picked: choose others and click one in the picture."
            : show == StepPairs::ofViews && !(c.settings.inspect.pickA || c.settings.inspect.pickB)
                ? "No view is picked: the Views panel picks them."
                : "None of the step's pairs is drawn.",
            palette::kNotice);
        return;
    }
    const bool all = data.drawn >= data.pairs;
    std::string said =
        all ? "All " + withThousands(data.pairs) + " pairs are drawn"
            : withThousands(data.drawn) + " of " + withThousands(data.pairs) + " pairs are drawn";
    if (data.drawn < data.eligible) {
        said += show == StepPairs::largest ? ", the largest" : ", evenly spread";
        if (data.eligible < data.pairs) said += " over " + withThousands(data.eligible);
    }
    if (data.links < data.drawn) said += "; " + withThousands(data.links) + " with their link";
    wrappedText(said + ".", data.drawn >= data.eligible ? palette::kDim : palette::kNotice);
}

void pickedPair(Context& c) {
    const StepsData& data = c.model.steps;
    InspectSettings& inspect = c.settings.inspect;
    sectionTitle(c, "Picked pair");
    if (!data.picked) {
        wrappedText(inspect.pairScene && inspect.pairView
                        ? "There is no such pair of nodes."
                        : "A click in the picture picks a pair by its link or its boxes.",
                    palette::kDim);
        return;
    }
    const PickedPair& pair = *data.picked;
    swatch(c, toColour(pair.colour), pair.decision);
    wrappedText(pair.reason);
    if (beginValues("pair", 1, 0.5f)) {
        for (const auto& [what, numbers] : pair.comparisons) valueRow(c, what, {numbers});
        endValues();
    }
    wrappedText("Scene " + pair.scene + "; view " + pair.view + ". Lengths in root edges.",
                palette::kDim);
    const float gap = c.px(4), none = c.px(60);
    if (button(c, "steps.from-pair", "Start from this pair",
               ImGui::GetContentRegionAvail().x - none - gap)) {
        inspect.stepScene = *inspect.pairScene;
        inspect.stepView = *inspect.pairView;
        inspect.step = 1;
    }
    tooltip("Start from this pair", "The first step is this pair, the next ones what it becomes.");
    ImGui::SameLine(0, gap);
    if (button(c, "steps.no-pair", "None", none)) {
        inspect.pairScene.reset();
        inspect.pairView.reset();
    }
}

// The pair of nodes that the steps start from.
void start(Context& c) {
    const StepsData& data = c.model.steps;
    InspectSettings& inspect = c.settings.inspect;
    sectionTitle(c, "Start");
    settingRow(c, "step-scene");
    if (!data.sceneNode.empty()) wrappedText(data.sceneNode, palette::kDim);
    settingRow(c, "step-view");
    if (!data.viewNode.empty()) wrappedText(data.viewNode, palette::kDim);
    const float gap = c.px(4);
    const float half = std::floor((ImGui::GetContentRegionAvail().x - gap) / 2);
    pickButton(c, Picking::sceneNode, "steps.pick-scene", "Pick scene node", "click a surface",
               half);
    tooltip("Pick scene node",
            "The next click on the picture starts from the scene octree's leaf there, or from its "
            "node of the level that is drawn.");
    ImGui::SameLine(0, gap);
    pickButton(c, Picking::viewNode, "steps.pick-view", "Pick view node", "click a view", half);
    tooltip("Pick view node",
            "The next click on the picture starts from the view octree's leaf of the nearest view, "
            "or from its node of the level that is drawn.");
    if (inspect.stepScene != 0 || inspect.stepView != 0) {
        if (button(c, "steps.roots", "Start from the roots", ImGui::GetContentRegionAvail().x)) {
            inspect.stepScene = inspect.stepView = 0;
        }
    }
}

}  // namespace

void stepsPanel(Context& c) {
    const StepsData& data = c.model.steps;
    Settings& s = c.settings;
    if (!testsPairs(s.side[0].method)) {
        wrappedText("This method tests no pairs: these are those of a traversal of the same views.",
                    palette::kDim);
    }
    const float side = c.px(34), gap = c.px(4);
    const ActionInfo& back = infoOf(Action::stepTraversalBack);
    const ActionInfo& on = infoOf(Action::stepTraversal);
    if (iconButton(c, idOf(back), Icon::backward, side, back.help)) c.act(back.action);
    ImGui::SameLine(0, gap);
    const int last = std::max(data.steps, 1);
    int step = std::clamp(s.inspect.step, 0, last);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - side - gap);
    const std::string shown = step == 0
                                  ? "no step drawn"
                                  : "step " + std::to_string(step) +
                                        (data.last ? " of " + std::to_string(data.steps) : "");
    if (ImGui::SliderInt("##step", &step, 0, last, shown.c_str(),
                         ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput)) {
        s.inspect.step = step;
    }
    c.named("step");
    tooltip("Traversal step", settingTooltip(c, *findSetting("step")));
    ImGui::SameLine(0, gap);
    if (iconButton(c, idOf(on), Icon::forward, side, on.help)) c.act(on.action);

    if (s.inspect.step > 0) {
        sectionTitle(c, "Pairs of this step");
        outcomes(c);
        drawnPairs(c);
        if (data.last) {
            wrappedText(data.finished
                            ? "The traversal ends with this step: no pair is left to split."
                            : "The traversal goes on, but the next step has more pairs than are "
                              "followed here; start lower in the trees to see its end.",
                        data.finished ? palette::kDim : palette::kNotice);
        }
    } else {
        ImGui::Dummy({0, c.px(2)});
        wrappedText(
            "Go to the first step to see the pair of both roots; each further step shows what its "
            "subdivided pairs became, drawn as links between scene node and view node.",
            palette::kDim);
    }
    if (s.inspect.step > 0 || data.picked) pickedPair(c);
    start(c);
    sectionTitle(c, "Octrees");
    settingRow(c, "show-octree");
    settingRow(c, "show-view-octree");
}

}  // namespace mv::ui
