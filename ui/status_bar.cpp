// One line at the bottom: what is shown left, how fast it is right, and what a user must know in
// yellow. What does not fit goes, the least important first.

#include <algorithm>
#include <string>
#include <vector>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

struct Part {
    std::string text;
    int importance = 0;
    ImU32 colour = palette::kDim;
    const char* widest = nullptr;  // room to keep, so that nothing beside it moves
    std::string help = {};
    const char* opens = nullptr;         // name of the button that it is
    Action action = Action::aboutScene;  // that a click performs
    float width() const {
        return std::max(ImGui::CalcTextSize(text.c_str()).x,
                        widest ? ImGui::CalcTextSize(widest).x : 0.0f);
    }
};

std::vector<Part> leftParts(const Context& c) {
    const Model& m = c.model;
    std::vector<Part> parts;
    const float most = c.layout.status.width * 0.3f;
    parts.push_back(
        {m.sceneName.empty() ? "no scene" : elidedFront(m.sceneName, most), 9, palette::kText});
    if (!m.sceneSummary.empty()) parts.push_back({m.sceneSummary, 2});
    const auto list = [&](std::size_t count, const char* one, const char* several, int importance,
                          ImU32 colour) {
        if (count == 0) return;
        parts.push_back({withThousands(std::uint64_t{count}) + (count == 1 ? one : several),
                         importance, colour, nullptr, "A click shows them.", "about-scene"});
    };
    list(m.warnings.size(), " warning", " warnings", 8, palette::kNotice);
    list(m.ignored.size(), " feature not used", " features not used", 4, palette::kNotice);
    list(m.notes.size(), " note", " notes", 3, palette::kDim);
    if (c.statistics.badPixels > 0) {
        parts.push_back({withThousands(c.statistics.badPixels) + " bad pixels", 8,
                         palette::kTrouble, nullptr,
                         "Pixels whose radiance is NaN or infinite; the debug view nan shows "
                         "where."});
    }
    return parts;
}

std::vector<Part> rightParts(Context& c) {
    const Model& m = c.model;
    std::vector<Part> parts;
    if (m.software) {
        std::string help = "The graphics driver computes on the CPU: " + m.renderer;
        for (const std::string& notice : m.notices) help += "\n" + notice;
        parts.push_back({"software rendering", 7, palette::kNotice, nullptr, help});
    } else {
        for (const std::string& notice : m.notices) {
            parts.push_back({notice, 6, palette::kNotice});
        }
    }
    if (!m.referenceStage.empty()) {
        const int percent = static_cast<int>(100 * m.referenceFraction);
        std::string how = m.referenceStage;
        if (m.referenceFraction >= 0) how += " " + std::to_string(percent) + " %";
        const std::string left = c.state.reference.after(m.referenceStage, m.referenceFraction);
        if (!left.empty()) how += ", " + left;
        parts.push_back({how, 9, palette::kNotice, nullptr,
                         "A reference is made by rays; a picture row by row from the bottom. Esc "
                         "gives up and keeps the rows that are done."});
    }
    if (m.draft) {
        const Settings& d = *m.draft;
        const int scale = d.gather.cull.scale;
        parts.push_back(
            {"draft", 7, palette::kNotice, nullptr,
             "While something moves: " + std::to_string(d.resolution.width) + " x " +
                 std::to_string(d.resolution.height) + " pixels, maps of " +
                 std::to_string(d.side[0].maps.resolution) + " texels, " +
                 (d.gather.samples > 0 ? std::to_string(d.gather.samples) : "all") + " samples" +
                 (scale > 1 ? " for every " + std::to_string(scale * scale) + " of them."
                            : " a pixel.")});
    }
    if (!c.layout.controlsShown && !m.instrument) {
        parts.push_back({"no room for the controls", 10, palette::kNotice, nullptr,
                         "A wider window shows them, or a smaller interface: a click makes it so.",
                         "no-room", Action::smallerInterface});
    }
    if (m.renderingPaused) parts.push_back({"rendering paused", 7, palette::kNotice});
    const int accumulated = c.statistics.accumulatedFrames;
    const int wanted = c.model.setsWanted;
    if (wanted > 1 || accumulated > 1) {
        parts.push_back({withThousands(static_cast<std::uint64_t>(std::max(accumulated, 1))) +
                             " / " + withThousands(static_cast<std::int64_t>(wanted)) + " frames",
                         5, palette::kDim, "1,024 / 1,024 frames",
                         "Frames whose samples the picture averages, of those asked for."});
    }
    const double frameMs = c.statistics.frameMs;
    if (c.model.frameRun.done == 0) c.figure(fixedText(frameMs, 1), {"/frameMs/median"});
    const std::string help =
        "The last rendered frame by the wall clock, and how many such frames a second has. Stages "
        "are timed by: " +
        c.statistics.clock;
    if (m.atRest) {
        parts.push_back({"at rest", 6, palette::kDim, nullptr,
                         "The picture is whole and nothing changes: no frame is made."});
    } else {
        if (frameMs > 0) {
            parts.push_back(
                {fixedText(1000 / frameMs, 1) + " fps", 4, palette::kDim, "0000.0 fps", help});
        }
        parts.push_back({fixedText(frameMs, 1) + " ms a frame", 6, palette::kText,
                         "00,000.0 ms a frame", help});
    }
    if (!c.statistics.clock.empty()) parts.push_back({c.statistics.clock, 1});
    return parts;
}

}  // namespace

void statusBar(Context& c) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {c.px(12), 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(22, 24, 28, 255));
    beginFixed(
        c, "status", c.layout.status,
        ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
    std::vector<Part> left = leftParts(c), right = rightParts(c);
    const float gap = c.px(18);
    const float room = c.layout.status.width - 2 * c.px(12);
    const auto total = [&] {
        float sum = -gap;
        for (const auto* parts : {&left, &right}) {
            for (const Part& part : *parts) sum += part.width() + gap;
        }
        return sum;
    };
    while (total() > room && left.size() + right.size() > 1) {
        auto* from = &left;
        auto least = left.end();
        for (auto* parts : {&left, &right}) {
            for (auto it = parts->begin(); it != parts->end(); ++it) {
                if (least == from->end() || it->importance < least->importance) {
                    from = parts;
                    least = it;
                }
            }
        }
        from->erase(least);
    }
    const float y = (c.layout.status.height - ImGui::GetTextLineHeight()) / 2;
    const auto put = [&](const Part& part, float x, bool alignRight) {
        const float slack = part.width() - ImGui::CalcTextSize(part.text.c_str()).x;
        ImGui::SetCursorPos({x + (alignRight ? slack : 0), y});
        text(c, part.text, part.colour);
        if (part.opens) {
            c.named(part.opens);
            if (ImGui::IsItemClicked()) c.act(part.action);
        }
        if (!part.help.empty()) tooltip(part.text, part.help);
    };
    float x = c.px(12);
    for (const Part& part : left) {
        put(part, x, false);
        x += part.width() + gap;
    }
    x = c.layout.status.width - c.px(12);
    for (const Part& part : right) {
        x -= part.width();
        put(part, x, true);
        x -= gap;
    }
    endFixed();
}

}  // namespace mv::ui
