// The drawn half of ui/widgets.h: bars, columns, legends, pictures.

#include <algorithm>
#include <cmath>

#include "ui/format.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

bool hovered(const Rect& r) {
    return ImGui::IsWindowHovered(ImGuiHoveredFlags_AllowWhenBlockedByActiveItem) &&
           ImGui::IsMouseHoveringRect({r.x, r.y}, {r.right(), r.bottom()});
}

}  // namespace

void bar(const Rect& r, float share01, ImU32 colour, ImU32 ground) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float rounding = std::min(r.height / 2, 2.0f);
    draw->AddRectFilled({r.x, r.y}, {r.right(), r.bottom()}, ground, rounding);
    const float filled = r.width * std::clamp(share01, 0.0f, 1.0f);
    if (filled >= 1) {
        draw->AddRectFilled({r.x, r.y}, {r.x + filled, r.bottom()}, colour, rounding);
    }
}

int stackedBar(const Rect& r, std::span<const Slice> slices, double whole) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled({r.x, r.y}, {r.right(), r.bottom()}, palette::kFrame);
    int under = -1;
    double before = 0;
    for (std::size_t i = 0; i < slices.size() && whole > 0; ++i) {
        const double after = before + slices[i].amount;
        const float x0 = r.x + r.width * static_cast<float>(before / whole);
        const float x1 = r.x + r.width * static_cast<float>(std::min(after / whole, 1.0));
        if (x1 > x0) {
            // What is there at all is at least a pixel wide.
            const Rect part{x0, r.y, std::max(x1 - x0, 1.0f), r.height};
            draw->AddRectFilled({part.x, part.y}, {part.right(), part.bottom()}, slices[i].colour);
            if (hovered(part)) under = static_cast<int>(i);
        }
        before = after;
    }
    return under;
}

int columns(Context& c, const char* id, std::span<const ColumnSeries> series, float height) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton(id, {std::max(width, 1.0f), height});
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + width, at.y + height}, palette::kFrame, c.px(3));
    std::size_t count = 0;
    double top = 0;
    for (const ColumnSeries& s : series) {
        count = std::max(count, s.values.size());
        for (const double v : s.values) top = std::max(top, v);
    }
    if (count == 0 || top <= 0) return -1;
    const float group = width / static_cast<float>(count);
    const float gap = std::min(c.px(2), group * 0.2f);
    const float one = (group - gap) / static_cast<float>(series.size());
    int under = -1;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = at.x + group * static_cast<float>(i) + gap / 2;
        if (hovered({x, at.y, group, height})) {
            under = static_cast<int>(i);
            draw->AddRectFilled({x - gap / 2, at.y}, {x - gap / 2 + group, at.y + height},
                                IM_COL32(255, 255, 255, 16));
        }
        for (std::size_t s = 0; s < series.size(); ++s) {
            if (i >= series[s].values.size() || series[s].values[i] <= 0) continue;
            const float h =
                std::max(static_cast<float>(series[s].values[i] / top) * (height - c.px(4)), 1.0f);
            const float x0 = x + one * static_cast<float>(s);
            draw->AddRectFilled({x0, at.y + height - h}, {x0 + std::max(one, 1.0f), at.y + height},
                                series[s].colour);
        }
    }
    return under;
}

void legend(Context& c, const Legend& l, float width) {
    text(c, l.title, palette::kText);
    if (!l.scale.empty()) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float height = std::round(c.px(10));
        ImDrawList* draw = ImGui::GetWindowDrawList();
        const std::size_t steps = std::max<std::size_t>(l.scale.size() - 1, 1);
        for (std::size_t i = 0; i < steps; ++i) {
            const ImU32 a = toColour(l.scale[i]), b = toColour(l.scale[i + (l.scale.size() > 1)]);
            const float x0 = at.x + width * static_cast<float>(i) / static_cast<float>(steps);
            const float x1 = at.x + width * static_cast<float>(i + 1) / static_cast<float>(steps);
            draw->AddRectFilledMultiColor({x0, at.y}, {x1, at.y + height}, a, b, b, a);
        }
        ImGui::Dummy({width, height});
        // Low, middle and high end, each below its place.
        const double middle = l.logarithmic && l.low > 0 && l.high > 0 ? std::sqrt(l.low * l.high)
                                                                       : (l.low + l.high) / 2;
        const std::string low = shortText(l.low), mid = shortText(middle);
        const std::string high = shortText(l.high) + (l.unit.empty() ? "" : " " + l.unit);
        const ImVec2 below = ImGui::GetCursorScreenPos();
        const float lowEnd = ImGui::CalcTextSize(low.c_str()).x;
        const float highWidth = ImGui::CalcTextSize(high.c_str()).x;
        const float midWidth = ImGui::CalcTextSize(mid.c_str()).x;
        draw->AddText(below, palette::kDim, low.c_str());
        draw->AddText({below.x + width - highWidth, below.y}, palette::kDim, high.c_str());
        const float midAt = (width - midWidth) / 2;
        if (midAt > lowEnd + c.px(8) && midAt + midWidth < width - highWidth - c.px(8)) {
            draw->AddText({below.x + midAt, below.y}, palette::kDim, mid.c_str());
        }
        c.checkFits(low + high + "   ", width);
        ImGui::Dummy({width, ImGui::GetTextLineHeight()});
    }
    for (const LegendEntry& entry : l.entries) {
        const float left = ImGui::GetCursorPosX();
        swatch(c, toColour(entry.colour), entry.label);
        if (!entry.count) continue;
        const std::string count = withThousands(*entry.count);
        ImGui::SameLine();
        ImGui::SetCursorPosX(left + width - ImGui::CalcTextSize(count.c_str()).x);
        text(c, count, palette::kDim);
    }
}

void picture(const Picture& p, ImVec2 size, ImU32 ground) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + size.x, at.y + size.y}, ground);
    if (!p.texture) {
        ImGui::Dummy(size);
    } else if (p.bottomUp) {
        ImGui::Image(p.texture, size, {0, 1}, {1, 0});
    } else {
        ImGui::Image(p.texture, size);
    }
}

}  // namespace mv::ui
