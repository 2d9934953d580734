// Where the time goes: the last frames as a plot with a budget, stages with median, 95th percentile
// and maximum over the last 256 frames. Every figure names its clock.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr double kLeastBudgetMs = 1, kMostBudgetMs = 60000;

// A top for the plot that stays while values change a little: 1, 2 or 5 times a power of ten.
double roundTop(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-3))));
    for (const double step : {1.0, 2.0, 5.0, 10.0}) {
        if (value <= step * power) return step * power;
    }
    return value;
}

void plot(Context& c) {
    const std::vector<float>& frames = c.state.history.frameMs();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = c.px(120);
    ImGui::InvisibleButton("plot", {width, height});
    c.named("profiler.plot");
    const bool held = ImGui::IsItemActive(), under = ImGui::IsItemHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + width, at.y + height}, palette::kFrame, c.px(3));
    // What most frames take sets the scale: a few long ones may leave the plot.
    const double usual = percentile(frames, 0.9);
    const double top = roundTop(std::max(usual, c.model.budgetMs) * 1.15);
    const auto yOf = [&](double ms) {
        return at.y + height * (1 - static_cast<float>(std::min(ms / top, 1.0)));
    };
    for (int i = 1; i < 4; ++i) {
        const float y = std::round(at.y + height * static_cast<float>(i) / 4);
        draw->AddLine({at.x, y}, {at.x + width, y}, palette::kLine);
    }
    const float step = width / static_cast<float>(kPlottedFrames);
    const float first = at.x + width - step * static_cast<float>(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const float x = first + step * static_cast<float>(i);
        const auto ms = static_cast<double>(frames[i]);
        draw->AddRectFilled({x, yOf(ms)}, {x + std::max(step, 1.0f), at.y + height},
                            ms > c.model.budgetMs ? palette::kNotice : palette::kAccent);
    }
    const float budgetY = yOf(c.model.budgetMs);
    draw->AddLine({at.x, budgetY}, {at.x + width, budgetY}, palette::kText, c.px(1));
    const std::string budget = "budget " + fixedText(c.model.budgetMs, 1) + " ms";
    draw->AddText({at.x + c.px(6),
                   budgetY < at.y + c.px(20) ? budgetY + c.px(1) : budgetY - ImGui::GetFontSize()},
                  palette::kText, budget.c_str());
    const std::string topText = fixedText(top, 0) + " ms";
    draw->AddText({at.x + width - ImGui::CalcTextSize(topText.c_str()).x - c.px(6), at.y + c.px(2)},
                  palette::kDim, topText.c_str());
    if (held) {
        const double share =
            static_cast<double>((at.y + height - ImGui::GetIO().MousePos.y) / height);
        c.model.budgetMs = std::clamp(share * top, kLeastBudgetMs, kMostBudgetMs);
    } else if (under) {
        const auto i = static_cast<std::ptrdiff_t>((ImGui::GetIO().MousePos.x - first) / step);
        if (i >= 0 && i < static_cast<std::ptrdiff_t>(frames.size())) {
            const auto ms = static_cast<double>(frames[static_cast<std::size_t>(i)]);
            tooltip(fixedText(ms, 2) + " ms, wall clock",
                    "Frame " + std::to_string(static_cast<std::ptrdiff_t>(frames.size()) - i) +
                        " from the newest. Drag to set the budget.");
        }
    }
}

// Saved numbers have the same as frames that were measured.
bool measured(const Context& c) { return c.model.frameRun.done > 0 && !c.model.frameRun.running; }

void stageRow(Context& c, const std::string& name, const std::vector<double>& ms, double whole,
              ImU32 colour, const char* help, const std::string& place) {
    const Summary s = summarize(ms);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    // The stage's share of its frame as a bar below its name.
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight();
    if (whole > 0) {
        const float filled = width * static_cast<float>(std::min(s.median / whole, 1.0));
        ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + line - c.px(2)},
                                                  {at.x + filled, at.y + line}, colour);
    }
    text(c, name);
    tooltip(name, std::string(help) + " (" + std::to_string(s.count) + " frames)");
    const auto column = [&](const char* which, double value) {
        ImGui::TableNextColumn();
        const std::string shown = fixedText(value, 2);
        rightText(c, shown);
        if (measured(c)) c.figure(shown, {place + "/ms/" + name + "/" + which});
    };
    column("median", s.median);
    column("p95", s.p95);
    column("max", s.max);
}

void stages(Context& c) {
    const FrameHistory& h = c.state.history;
    ImGui::Dummy({0, c.px(4)});
    sectionTitle(c, "Stages");
    const std::string clock =
        "ms by " + (h.clock().empty() ? std::string("no clock yet") : h.clock()) + ", last " +
        std::to_string(kSummarisedFrames) + " frames that ran the stage";
    wrappedText(clock, palette::kDim);
    if (!beginValues("stages", 3, 0.43f)) return;
    valueHeads(c, "stage", {"median", "p95", "max"});
    double whole = 0;
    for (std::size_t g = 0; g < 3; ++g) whole += h.medianOf(g).ms;
    for (std::size_t g = 0; g < 3; ++g) {
        if (h.stages(g).empty()) continue;
        const ImU32 colour = g == 0 ? palette::kAccent : sideColour(g - 1);
        const std::string title =
            g == 0 ? "Shared by both"
                   : std::string(c.comparing() ? (g == 1 ? "Left: " : "Right: ") : "") +
                         methodTitle(c.methodOf(g - 1));
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        text(c, g == 0 && !c.comparing() ? std::string("Beside the method") : title, colour);
        for (const FrameHistory::Series& series : h.stages(g)) {
            const StageInfo& info = infoOf(series.stage);
            stageRow(c, std::string(info.name), series.ms, whole, colour, info.description.data(),
                     g == 0 ? "/shared" : "/methods/" + std::to_string(g - 1));
        }
        // Not every frame runs every stage: what one that does takes is the sum of the rows.
        valueRow(c, "together", {fixedText(h.medianOf(g).ms, 2), "", ""}, palette::kDim);
    }
    endValues();
}

// Whole frames, all else being equal: what a figure that is quoted is the median of.
void wholeFrames(Context& c) {
    FrameRun& run = c.model.frameRun;
    sectionTitle(c, "Whole frames");
    const ActionInfo& measure = infoOf(Action::measureFrames);
    const float width = c.px(90);
    if (button(c, "profiler.measure", run.running ? "Stop" : "Measure", width)) {
        c.act(measure.action);
    }
    tooltip(std::string(measure.name), std::string(measure.help));
    ImGui::SameLine();
    if (run.running) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const std::string done = std::to_string(run.done) + " of " + std::to_string(run.wanted);
        const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(done.c_str()).x;
        bar({at.x, at.y + c.px(9), room - c.px(8), c.px(6)},
            static_cast<float>(run.done) / static_cast<float>(run.wanted), palette::kAccent);
        ImGui::AlignTextToFramePadding();
        rightText(c, done);
    } else {
        ImGui::SetNextItemWidth(c.px(110));
        ImGui::DragInt("##frames", &run.wanted, 0.2f, 1, static_cast<int>(kSummarisedFrames),
                       run.wanted == 1 ? "%d frame" : "%d frames", ImGuiSliderFlags_AlwaysClamp);
        c.named("profiler.frames");
        tooltip("Frames", "So many are measured, after one to warm up.");
    }
    if (run.done > 0 && !run.running) {
        wrappedText("The figures are of " + withThousands(std::uint64_t(run.done)) +
                        " whole frames of this picture. Save numbers (Ctrl+Shift+S) writes them.",
                    palette::kDim);
    }
}

}  // namespace

void profilerPanel(Context& c) {
    const std::vector<float>& frames = c.state.history.frameMs();
    ImGui::AlignTextToFramePadding();
    const std::string count = withThousands(std::uint64_t{frames.size()});
    const char* freeze = c.state.frozen ? "Frozen" : "Freeze";
    const float width = c.px(72);
    elidedText("Frame, ms by wall clock, last " + count,
               ImGui::GetContentRegionAvail().x - width - c.px(6), palette::kDim);
    ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width, 0);
    if (toggleButton(c, "profiler.freeze", freeze, c.state.frozen, width)) {
        c.state.frozen = !c.state.frozen;
    }
    tooltip("Freeze", "Keeps the figures as they are; new frames are not counted.");
    plot(c);
    if (beginValues("frame", 4, 0.2f)) {
        valueHeads(c, "", {"median", "p95", "p99", "max"});
        const Summary s = summarize({frames.begin(), frames.end()});
        valueRow(c, "ms",
                 {fixedText(s.median, 1), fixedText(s.p95, 1),
                  fixedText(percentile(frames, 0.99), 1), fixedText(s.max, 1)});
        if (measured(c)) {
            c.figure(fixedText(s.median, 1), {"/frameMs/median"});
            c.figure(fixedText(s.p95, 1), {"/frameMs/p95"});
            c.figure(fixedText(s.max, 1), {"/frameMs/max"});
        }
        endValues();
    }
    ImGui::AlignTextToFramePadding();
    text(c, "Budget", palette::kDim);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(c.px(110));
    double& budget = c.model.budgetMs;
    ImGui::DragScalar("##budget", ImGuiDataType_Double, &budget, 0.1f, &kLeastBudgetMs,
                      &kMostBudgetMs, "%.1f ms", ImGuiSliderFlags_AlwaysClamp);
    c.named("profiler.budget");
    tooltip("Budget", "Where the line in the plot stands; frames above it are yellow.");
    std::size_t over = 0;
    for (const float ms : frames) over += static_cast<double>(ms) > budget ? 1 : 0;
    ImGui::SameLine();
    rightText(c, withThousands(std::uint64_t{over}) + " of " + count + " above",
              over > 0 ? palette::kNotice : palette::kDim);
    wholeFrames(c);
    stages(c);
}

}  // namespace mv::ui
