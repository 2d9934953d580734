// The traversal one step at a time: which step is drawn, what happened to its pairs, and the pair
// of nodes it starts from [Kol19 fig. 2].

#include <algorithm>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {

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
        std::uint64_t most = 1;
        for (const LegendEntry& d : data.decisions) most = std::max(most, d.count.value_or(0));
        if (beginValues("decisions", 2, 0.34f)) {
            for (const LegendEntry& d : data.decisions) {
                const std::uint64_t count = d.count.value_or(0);
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                swatch(c, toColour(d.colour), d.label);
                ImGui::TableNextColumn();
                const ImVec2 at = ImGui::GetCursorScreenPos();
                const float width = ImGui::GetContentRegionAvail().x;
                const float line = ImGui::GetTextLineHeight();
                bar({at.x, at.y + line * 0.25f, width, line * 0.5f},
                    static_cast<float>(static_cast<double>(count) / static_cast<double>(most)),
                    toColour(d.colour));
                ImGui::TableNextColumn();
                rightText(c, withThousands(count));
            }
            endValues();
        }
        const bool all = data.drawn >= data.pairs;
        wrappedText(all ? "All " + withThousands(data.pairs) + " pairs are drawn."
                        : withThousands(data.drawn) + " of " + withThousands(data.pairs) +
                              " pairs are drawn; start lower in the trees to see all.",
                    all ? palette::kDim : palette::kNotice);
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

    sectionTitle(c, "Start");
    settingRow(c, "step-scene");
    if (!data.sceneNode.empty()) wrappedText(data.sceneNode, palette::kDim);
    settingRow(c, "step-view");
    if (!data.viewNode.empty()) wrappedText(data.viewNode, palette::kDim);
    if (s.inspect.stepScene != 0 || s.inspect.stepView != 0) {
        if (button(c, "steps.roots", "Start from the roots"))
            s.inspect.stepScene = s.inspect.stepView = 0;
    }
    sectionTitle(c, "Octrees");
    settingRow(c, "show-octree");
    settingRow(c, "show-view-octree");
}

}  // namespace mv::ui
