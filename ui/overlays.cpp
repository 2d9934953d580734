// What stands over the picture: the two sides' labels and the handle between them, legends,
// the tour, messages that fade.

#include <algorithm>
#include <string>

#include "megaviews/settings/statistics_table.h"
#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr float kMargin = 12;
constexpr float kToastS = 4, kFadeS = 0.6f;

// What one side is and what it costs.
void sideLabel(Context& c, std::size_t side, bool compact) {
    const MethodSettings& s = (c.model.draft ? *c.model.draft : c.settings).side.at(side);
    const MethodStatistics& m = c.statistics.methods[side];
    const FrameHistory& history = c.state.history;
    const Rect& view = c.layout.picture;
    const float x = side == 0 ? view.x + c.px(kMargin) : view.right() - c.px(kMargin);
    const char* id = side == 0 ? "label-left" : "label-right";
    beginPlate(c, id, x, view.y + c.px(kMargin), {side == 0 ? 0.0f : 1.0f, 0},
               ImGuiWindowFlags_NoInputs);
    // Both labels stand beside each other, whatever room there is.
    const float wide =
        std::min(c.px(compact ? 120 : 178), (view.width - c.px(3 * kMargin)) / 2 - c.px(20));
    elidedText(methodTitle(s.method), wide, sideColour(side));
    if (!compact && makesMaps(s.method)) {
        std::string how = withThousands(static_cast<std::int64_t>(s.maps.resolution)) + " texels";
        if (c.model.draft) how += ", draft";
        if (testsPairs(s.method)) {
            how = nameOfRules(s.rules) + " rules, " + std::string(nameOf(s.pairs.traversal)) +
                  ", " + how;
        }
        text(c, how, palette::kDim);
    }
    // Labels keep the width of large numbers, so that they do not breathe with every frame.
    const float left = ImGui::GetCursorPosX();
    const auto value = [&](const char* name, const std::string& number, const char* what,
                           std::vector<std::string> places) {
        if (!places.empty()) c.figure(number, std::move(places));
        if (!compact) text(c, name, palette::kDim);
        if (!compact) ImGui::SameLine();
        std::string shown = compact ? number + what : number;
        if (ImGui::CalcTextSize(shown.c_str()).x > wide) shown = number;
        ImGui::SetCursorPosX(left + std::max(wide - ImGui::CalcTextSize(shown.c_str()).x, 0.0f));
        text(c, shown);
    };
    const FrameHistory::GroupTime maps = history.medianOf(side + 1, StageGroup::maps);
    const FrameHistory::GroupTime gather = history.medianOf(side + 1, StageGroup::gather);
    const std::string own = "/methods/" + std::to_string(side);
    const auto timesOf = [&](StageGroup group) {
        std::vector<std::string> places;
        if (c.model.frameRun.done == 0) return places;  // medians of frames that are not saved
        for (const FrameHistory::Series& series : history.stages(side + 1)) {
            const StageInfo& info = infoOf(series.stage);
            if (info.group == group) {
                places.push_back(own + "/ms/" + std::string(info.name) + "/median");
            }
        }
        return places;
    };
    const auto msOf = [](const FrameHistory::GroupTime& time) {
        return time.frames > 0 ? fixedText(time.ms, 1) + " ms" : std::string("-");
    };
    value("maps", msOf(maps), " maps", timesOf(StageGroup::maps));
    if (!compact) value("gather, filter", msOf(gather), "", timesOf(StageGroup::gather));
    value("pairs", countOrDash(m.pairs.processed), " pairs", {own + "/pairs/processed"});
    // What these views and maps need; buffers that are kept from before may be larger.
    const std::uint64_t bytes =
        m.predictedQueueBytes + m.predictedMapBytes + m.predictedWorkingMapBytes;
    value("memory", bytes > 0 ? bytesText(bytes) : "-", "",
          {own + "/memoryBytes/predictedQueue", own + "/memoryBytes/predictedMaps"});
    if (!compact) {
        const std::size_t frames = std::max(maps.frames, gather.frames);
        text(c, c.statistics.clock + (frames > 1 ? ", n = " + std::to_string(frames) : ""),
             palette::kDim);
    }
    endPlate(c, id);
}

void handle(Context& c) {
    const Rect& view = c.layout.picture;
    const float x = view.x + view.width * static_cast<float>(c.settings.display.split);
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->AddLine({x, view.y}, {x, view.bottom()}, IM_COL32(0, 0, 0, 150), c.px(4));
    draw->AddLine({x, view.y}, {x, view.bottom()}, IM_COL32(255, 255, 255, 220), c.px(1.5f));
    // A thin window of its own, so that dragging it does not turn the camera.
    const float wide = c.px(22), tall = c.px(44);
    ImGui::SetNextWindowPos({x - wide / 2, view.y + (view.height - tall) / 2});
    ImGui::SetNextWindowSize({wide, tall});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, 0u);
    ImGui::Begin("##split", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav);
    ImGui::InvisibleButton("handle", {wide, tall});
    c.named("split.handle");
    const bool active = ImGui::IsItemActive();
    if (active || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (!active) tooltip("Drag to move the split", "Shift+Left and Shift+Right move it too.");
    ImDrawList* top = ImGui::GetWindowDrawList();
    const ImVec2 m(x, view.y + view.height / 2);
    const ImU32 colour =
        active || ImGui::IsItemHovered() ? palette::kAccent : IM_COL32(245, 247, 250, 255);
    top->AddRectFilled({m.x - c.px(8), m.y - c.px(18)}, {m.x + c.px(8), m.y + c.px(18)}, colour,
                       c.px(8));
    for (const float side : {-1.0f, 1.0f}) {
        top->AddTriangleFilled({m.x + side * c.px(2), m.y - c.px(4)},
                               {m.x + side * c.px(2), m.y + c.px(4)}, {m.x + side * c.px(6), m.y},
                               IM_COL32(30, 34, 40, 255));
    }
    if (active) {
        const float share = (ImGui::GetIO().MousePos.x - view.x) / view.width;
        c.settings.display.split = static_cast<double>(std::clamp(share, 0.0f, 1.0f));
    }
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

// Which side fills the picture while the key is held.
void heldLabel(Context& c) {
    const Rect& view = c.layout.picture;
    beginPlate(c, "held", view.x + view.width / 2, view.y + c.px(kMargin), {0.5f, 0},
               ImGuiWindowFlags_NoInputs);
    const auto side = static_cast<std::size_t>(c.settings.display.smallerSide());
    text(c, std::string(side == 0 ? "Left: " : "Right: ") + methodTitle(c.methodOf(side)),
         sideColour(side));
    endPlate(c, "held");
}

void differenceLegend(Context& c) {
    const Rect& view = c.layout.picture;
    const float width = std::min(c.px(320), view.width - c.px(2 * kMargin + 20));
    beginPlate(c, "difference", view.x + view.width / 2, view.bottom() - c.px(kMargin), {0.5f, 1});
    legend(c, *c.model.difference, width);
    Settings& s = c.settings;
    const float lock = ImGui::GetFrameHeight() + c.px(6);
    const bool locked = s.display.differenceRange.has_value();
    settingField(c, "difference-range", width - lock - c.px(4));
    ImGui::SameLine(0, c.px(4));
    if (iconButton(c, "difference.lock", locked ? Icon::lock : Icon::unlock, lock,
                   locked ? "The range stays; a click lets it follow the picture."
                          : "The range follows the picture; a click keeps it as it is.",
                   locked)) {
        if (locked) {
            s.display.differenceRange.reset();
        } else if (c.statistics.differenceRange > 0) {
            s.display.differenceRange = c.statistics.differenceRange;
        }
    }
    endPlate(c, "difference");
}

}  // namespace

void splitOverlay(Context& c) {
    if (!c.comparing()) return;
    const bool difference = c.settings.display.difference != Difference::off;
    if (c.model.otherSide) {
        heldLabel(c);
        return;
    }
    const bool compact = c.layout.picture.width < c.px(2 * (200 + 2 * kMargin)) ||
                         c.layout.picture.height < c.px(460);
    if (difference || c.settings.display.split > 0) sideLabel(c, 0, compact);
    if (difference || c.settings.display.split < 1) sideLabel(c, 1, compact);
    if (!difference) handle(c);
}

void legendOverlay(Context& c) {
    if (c.comparing() && c.settings.display.difference != Difference::off && c.model.difference) {
        differenceLegend(c);
    }
    if (c.model.legends.empty()) return;
    const Rect& view = c.layout.picture;
    const float width = std::min(c.px(210), view.width - c.px(2 * kMargin + 20));
    float top = view.y + c.px(kMargin);  // below what stands there already
    for (const Rect& plate : c.state.plates) {
        if (plate.y < view.y + view.height / 2) top = std::max(top, plate.bottom());
    }
    const float line = ImGui::GetTextLineHeightWithSpacing();
    float room = view.bottom() - top - c.px(2 * kMargin + 14);
    beginPlate(c, "legend", view.x + c.px(kMargin), view.bottom() - c.px(kMargin), {0, 1},
               ImGuiWindowFlags_NoInputs);
    for (std::size_t i = 0; i < c.model.legends.size(); ++i) {
        const Legend& l = c.model.legends[i];
        if (i > 0) ImGui::Dummy({0, c.px(4)});
        const std::size_t lines = 1 + (l.scale.empty() ? 0 : 2) + l.entries.size();
        room -= line * static_cast<float>(lines) + c.px(4);
        if (i > 0 && room < 0) {
            elidedText(l.title + ": no room", width, palette::kNotice);
        } else {
            legend(c, l, width);
        }
    }
    endPlate(c, "legend");
}

void outsideHint(Context& c) {
    if (!c.model.outside) return;
    const Rect& view = c.layout.picture;
    beginPlate(c, "outside", view.x + view.width / 2, view.bottom() - c.px(kMargin), {0.5f, 1},
               ImGuiWindowFlags_NoInputs);
    text(c, "outside of the rooms; Enter returns", palette::kNotice);
    endPlate(c, "outside");
}

void tour(Context& c) {
    if (!c.model.tour) return;
    const TourStep& step = *c.model.tour;
    const Rect& view = c.layout.picture;
    const float width = std::min(c.px(420), view.width - c.px(2 * kMargin + 20));
    beginPlate(c, "tour", view.x + view.width / 2, view.bottom() - c.px(kMargin), {0.5f, 1});
    ImGui::PushFont(titleFont());
    text(c, step.title, palette::kAccent);
    ImGui::PopFont();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
    ImGui::TextUnformatted(step.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::Dummy({width, c.px(2)});
    const float each = std::min(c.px(76), (width - 2 * ImGui::GetStyle().ItemSpacing.x) / 3);
    const auto go = [&](const char* name, const char* label, int by, bool there) {
        if (!there) return;
        if (button(c, name, label, each)) c.requests.tour = by;
        ImGui::SameLine();
    };
    go("tour.back", "Back", -1, step.back);
    go("tour.next", "Next", 1, step.next);
    if (button(c, "tour.leave", "Leave", each)) c.requests.leaveTour = true;
    tooltip("Leave the tour", "What stood before comes back.");
    endPlate(c, "tour");
}

void toasts(Context& c) {
    auto& all = c.model.toasts;
    for (Toast& toast : all) toast.ageS += ImGui::GetIO().DeltaTime;
    std::erase_if(all, [](const Toast& t) { return t.ageS > kToastS + kFadeS; });
    const Rect& view = c.layout.picture;
    const float widest = std::min(c.px(460), view.width - c.px(2 * kMargin + 20));
    for (std::size_t i = all.size(); i-- > 0;) {  // the newest lowest
        const std::string id = "toast-" + std::to_string(i);
        const float alpha = std::clamp((kToastS + kFadeS - all[i].ageS) / kFadeS, 0.0f, 1.0f);
        if (alpha < 1) c.requests.redraw = true;
        ImGui::PushStyleVar(ImGuiStyleVar_Alpha, std::max(alpha, 0.02f));
        beginPlate(c, id.c_str(), view.right() - c.px(kMargin), view.bottom() - c.px(kMargin),
                   {1, 1}, ImGuiWindowFlags_NoInputs);
        const float full = ImGui::CalcTextSize(all[i].text.c_str()).x;
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::min(full + 1, widest));
        ImGui::TextUnformatted(all[i].text.c_str());
        ImGui::PopTextWrapPos();
        endPlate(c, id.c_str());
        ImGui::PopStyleVar();
    }
}

}  // namespace mv::ui
