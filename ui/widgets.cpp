#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

#include "ui/format.h"

namespace mv::ui {
namespace {

float widthOf(std::string_view text) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

void put(std::string_view text, ImU32 colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    ImGui::PopStyleColor();
}

const char* ellipsis() {
    return ImGui::GetFont()->FindGlyphNoFallback(0x2026) ? "\xe2\x80\xa6" : "..";
}

bool startsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }

constexpr float kTooltipEm = 26;
void showTooltip(std::string_view title, std::string_view body) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * kTooltipEm);
    ImGui::PushFont(titleFont());
    put(title, palette::kText);
    ImGui::PopFont();
    if (!body.empty()) put(body, palette::kDim);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

// A small open arrow, pointing right or down.
void chevron(Context& c, ImDrawList* draw, ImVec2 middle, bool down, ImU32 colour) {
    const float r = c.px(3.5f);
    if (down) {
        draw->PathLineTo({middle.x - r, middle.y - r / 2});
        draw->PathLineTo({middle.x, middle.y + r / 2});
        draw->PathLineTo({middle.x + r, middle.y - r / 2});
    } else {
        draw->PathLineTo({middle.x - r / 2, middle.y - r});
        draw->PathLineTo({middle.x + r / 2, middle.y});
        draw->PathLineTo({middle.x - r / 2, middle.y + r});
    }
    draw->PathStroke(colour, 0, c.px(1.4f));
}

}  // namespace

void text(Context& c, std::string_view text, ImU32 colour) {
    c.checkFits(text, ImGui::GetContentRegionAvail().x);
    put(text, colour);
}

void rightText(Context& c, std::string_view text, ImU32 colour) {
    const float room = ImGui::GetContentRegionAvail().x;
    c.checkFits(text, room);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(room - widthOf(text), 0.0f));
    put(text, colour);
}

void wrappedText(std::string_view text, ImU32 colour) {
    ImGui::PushTextWrapPos(0);
    put(text, colour);
    ImGui::PopTextWrapPos();
}

std::string elided(std::string_view text, float width) {
    if (widthOf(text) <= width) return std::string(text);
    const float room = width - widthOf(ellipsis());
    std::size_t length = text.size();
    while (length > 0 && (widthOf(text.substr(0, length)) > room ||
                          (length < text.size() && !startsCharacter(text[length])))) {
        --length;
    }
    return std::string(text.substr(0, length)) + ellipsis();
}

std::string elidedFront(std::string_view text, float width) {
    if (widthOf(text) <= width) return std::string(text);
    const float room = width - widthOf(ellipsis());
    std::size_t begin = 0;
    while (begin < text.size() &&
           (widthOf(text.substr(begin)) > room || !startsCharacter(text[begin]))) {
        ++begin;
    }
    return ellipsis() + std::string(text.substr(begin));
}

void elidedText(std::string_view text, float width, ImU32 colour) {
    const std::string shown = elided(text, width);
    put(shown, colour);
    if (shown.size() != text.size() || shown != text) tooltip(text);
}

void sectionTitle(Context& c, const char* title, bool line) {
    ImGui::Dummy({0, c.px(4)});
    ImGui::PushFont(titleFont());
    put(title, palette::kDim);
    ImGui::PopFont();
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    const float y = std::round((low.y + high.y) / 2 + c.px(1));
    if (line && right > high.x + c.px(8)) {
        ImGui::GetWindowDrawList()->AddLine({high.x + c.px(8), y}, {right, y}, palette::kLine);
    }
}

bool groupHeader(Context& c, const std::string& title) {
    const ImGuiID id = ImGui::GetID(title.c_str());
    ImGuiStorage* storage = ImGui::GetStateStorage();
    bool open = storage->GetBool(id, false);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddLine(at, {at.x + ImGui::GetContentRegionAvail().x, at.y}, palette::kLine);
    ImGui::PushID(title.c_str());
    if (ImGui::Selectable("##header", false, 0, {0, height})) {
        open = !open;
        storage->SetBool(id, open);
    }
    ImGui::PopID();
    chevron(c, draw, {at.x + c.px(5), at.y + height / 2}, open,
            open ? palette::kAccent : palette::kDim);
    ImGui::PushFont(titleFont());
    draw->AddText({at.x + c.px(18), at.y + (height - ImGui::GetFontSize()) / 2},
                  open ? palette::kText : palette::kDim, title.c_str());
    ImGui::PopFont();
    return open;
}

bool beginCombo(Context& c, const char* id, const std::string& shown, float width) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float arrow = c.px(18), height = ImGui::GetFrameHeight();
    const std::string fitting = elided(shown, width - ImGui::GetStyle().FramePadding.x - arrow);
    ImGui::SetNextItemWidth(width);
    const bool open = ImGui::BeginCombo(
        id, fitting.c_str(), ImGuiComboFlags_HeightLargest | ImGuiComboFlags_NoArrowButton);
    chevron(c, draw, {at.x + width - arrow / 2 - c.px(1), at.y + height / 2}, true, palette::kDim);
    if (!open && fitting != shown) tooltip(shown);  // above what the caller says
    return open;
}

void tooltip(std::string_view title, std::string_view body) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) showTooltip(title, body);
}

void tooltipBelowMenu(std::string_view title, std::string_view body) {
    const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const float room = display.x - ImGui::GetFontSize() * (kTooltipEm + 2);
    const bool below = display.y - at.y - size.y > at.y;
    ImGui::SetNextWindowPos({std::max(std::min(at.x, room), 0.0f), below ? at.y + size.y : at.y}, 0,
                            {0, below ? 0.0f : 1.0f});
    showTooltip(title, body);
}

bool beginValues(const char* id, int columns, float labelShare) {
    if (!ImGui::BeginTable(id, columns + 1, ImGuiTableFlags_RowBg | ImGuiTableFlags_NoPadOuterX)) {
        return false;
    }
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, labelShare);
    for (int i = 0; i < columns; ++i) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch,
                                (1 - labelShare) / static_cast<float>(columns));
    }
    return true;
}

void valueHeads(Context& c, std::string_view label, std::initializer_list<std::string> heads) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text(c, label, palette::kDim);
    for (const std::string& head : heads) {
        ImGui::TableNextColumn();
        rightText(c, head, palette::kDim);
    }
}

void valueRow(Context& c, std::string_view label, std::span<const std::string> values,
              ImU32 colour) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    text(c, label, colour);
    for (const std::string& value : values) {
        ImGui::TableNextColumn();
        rightText(c, value, colour);
    }
}

void swatch(Context& c, ImU32 colour, std::string_view label, ImU32 textColour) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float size = std::round(ImGui::GetFontSize() * 0.62f);
    const float y = at.y + std::round((ImGui::GetTextLineHeight() - size) / 2);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, y}, {at.x + size, y + size}, colour, c.px(2));
    ImGui::Dummy({size, ImGui::GetTextLineHeight()});
    ImGui::SameLine(0, c.px(6));
    text(c, label, textColour);
}

bool button(Context& c, std::string_view name, const char* label, float width) {
    if (width > 0) c.checkFits(label, width - ImGui::GetStyle().FramePadding.x);
    ImGui::PushID(name.data(), name.data() + name.size());  // labels may be alike
    const bool pressed = ImGui::Button(label, {width, 0});
    ImGui::PopID();
    c.named(name);
    return pressed;
}

bool toggleButton(Context& c, std::string_view name, const char* label, bool on, float width) {
    if (on) {
        ImGui::PushStyleColor(ImGuiCol_Button, palette::kAccentDeep);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, palette::kAccentDeep);
    }
    const bool pressed = button(c, name, label, width);
    if (on) ImGui::PopStyleColor(2);
    return pressed;
}

void pickButton(Context& c, Picking picking, std::string_view name, const char* label,
                const char* asked, float width) {
    const bool active = c.model.picking == picking;
    if (toggleButton(c, name, active ? asked : label, active, width)) {
        c.model.picking = active ? Picking::none : picking;
    }
}

void actionTooltip(const ActionInfo& action) {
    std::string title(action.name);
    if (!action.key.empty()) title += "   (" + std::string(action.key) + ")";
    tooltip(title, action.help);
}

bool actionButton(Context& c, Action action, const char* label, float width) {
    const ActionInfo& info = infoOf(action);
    const bool pressed = button(c, idOf(info), label, width);
    if (pressed) c.act(action);
    actionTooltip(info);
    return pressed;
}

bool iconButton(Context& c, std::string_view name, Icon icon, float width, std::string_view help,
                bool on) {
    const float height = ImGui::GetFrameHeight();
    ImGui::PushID(name.data(), name.data() + name.size());
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, palette::kAccentDeep);
    const bool pressed = ImGui::Button("##icon", {width, height});
    if (on) ImGui::PopStyleColor();
    ImGui::PopID();
    c.named(name);
    tooltip(help);
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 m(low.x + width / 2, low.y + height / 2);
    const float r = std::round(height * 0.22f);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 colour = palette::kText;
    const auto triangle = [&](float x, float side) {
        draw->AddTriangleFilled({x - side * r * 0.8f, m.y - r}, {x - side * r * 0.8f, m.y + r},
                                {x + side * r * 0.8f, m.y}, colour);
    };
    const auto upright = [&](float x) {
        draw->AddRectFilled({x - r * 0.22f, m.y - r}, {x + r * 0.22f, m.y + r}, colour);
    };
    switch (icon) {
        case Icon::play:
            triangle(m.x, 1);
            break;
        case Icon::pause:
            upright(m.x - r * 0.5f);
            upright(m.x + r * 0.5f);
            break;
        case Icon::backward:
            triangle(m.x - r * 0.2f, -1);
            upright(m.x + r * 0.9f);
            break;
        case Icon::forward:
            upright(m.x - r * 0.9f);
            triangle(m.x + r * 0.2f, 1);
            break;
        case Icon::toStart:
            upright(m.x - r * 1.1f);
            triangle(m.x, -1);
            break;
        case Icon::slower:
            draw->AddRectFilled({m.x - r, m.y - r * 0.2f}, {m.x + r, m.y + r * 0.2f}, colour);
            break;
        case Icon::faster:
            draw->AddRectFilled({m.x - r, m.y - r * 0.2f}, {m.x + r, m.y + r * 0.2f}, colour);
            draw->AddRectFilled({m.x - r * 0.2f, m.y - r}, {m.x + r * 0.2f, m.y + r}, colour);
            break;
        case Icon::close:
            draw->AddLine({m.x - r, m.y - r}, {m.x + r, m.y + r}, colour, c.px(1.5f));
            draw->AddLine({m.x - r, m.y + r}, {m.x + r, m.y - r}, colour, c.px(1.5f));
            break;
        case Icon::lock:
        case Icon::unlock: {
            draw->AddRectFilled({m.x - r, m.y - r * 0.1f}, {m.x + r, m.y + r}, colour, r * 0.2f);
            const float shift = icon == Icon::lock ? 0 : r * 0.9f;
            draw->PathArcTo({m.x + shift, m.y - r * 0.1f}, r * 0.62f, 3.14159265f, 6.2831853f);
            draw->PathStroke(colour, 0, c.px(1.5f));
            break;
        }
    }
    return pressed;
}

}  // namespace mv::ui
