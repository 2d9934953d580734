#include "ui/style.h"

#include <algorithm>
#include <cmath>

#include "ui/font_data.h"
#include "ui/interface.h"

namespace mv::ui {
namespace {

// Digits of one width: numbers that change do not jump.
void alignDigits(ImFont& font) {
    float widest = 0;
    for (ImWchar c = '0'; c <= '9'; ++c) widest = std::max(widest, font.GetCharAdvance(c));
    for (ImFontGlyph& glyph : font.Glyphs) {
        if (glyph.Codepoint < '0' || glyph.Codepoint > '9') continue;
        const float shift = std::floor((widest - glyph.AdvanceX) / 2);
        glyph.X0 += shift;
        glyph.X1 += shift;
        glyph.AdvanceX = widest;
        font.IndexAdvanceX[static_cast<int>(glyph.Codepoint)] = widest;
    }
}

// Rasterised at the size it is shown in: sharp at every scale.
void useFonts(float scale, const MoreGlyphs& more) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    // Latin, dashes and the ellipsis, arrows, minus, comparisons, the box for what is not there.
    static constexpr ImWchar kRanges[] = {0x20,   0x17f,  0x394,  0x3c9,  0x2010,
                                          0x2026, 0x2190, 0x2193, 0x2212, 0x2212,
                                          0x2264, 0x2265, 0xfffd, 0xfffd, 0};
    ImFontGlyphRangesBuilder wanted;
    for (const char32_t c : more.characters) wanted.AddChar(static_cast<ImWchar>(c));
    ImVector<ImWchar> further, all;
    wanted.BuildRanges(&further);
    wanted.AddRanges(kRanges);
    wanted.BuildRanges(&all);
    ImFontConfig config;
    config.OversampleH = 3;
    config.OversampleV = 1;
    config.PixelSnapH = true;
    config.FontDataOwnedByAtlas = false;
    const auto add = [&](std::span<const unsigned char> data, const ImVector<ImWchar>& ranges) {
        atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(data.data()),
                                   static_cast<int>(data.size()), std::round(kFontSize * scale),
                                   &config, ranges.Data);
    };
    for (const auto data : {interfaceFont(), interfaceFontMedium()}) {
        config.MergeMode = false;
        config.FontNo = 0;
        add(data, all);
        config.MergeMode = true;  // a glyph that is there already stays
        for (const FontFile& font : more.fonts) {
            config.FontNo = font.face;
            add(font.data, further);
        }
    }
    atlas.Build();
    for (ImFont* font : atlas.Fonts) alignDigits(*font);
    ImGui::GetIO().FontGlobalScale = 1;
}

ImVec4 vec(ImU32 colour) { return ImGui::ColorConvertU32ToFloat4(colour); }

}  // namespace

ImU32 toColour(const Float3& c) { return ImGui::ColorConvertFloat4ToU32({c[0], c[1], c[2], 1}); }

ImFont* titleFont() {
    const ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    return atlas.Fonts.Size > 1 ? atlas.Fonts[1] : nullptr;
}

ImU32 sideColour(std::size_t side) { return side == 0 ? palette::kLeft : palette::kRight; }

void applyStyle(float scale, const MoreGlyphs& more) {
    namespace p = palette;
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowPadding = {12, 10};
    style.FramePadding = {kFramePaddingX, kFramePaddingY};
    style.ItemSpacing = {8, 3};
    style.ItemInnerSpacing = {6, 4};
    style.CellPadding = {6, 2};
    style.ScrollbarSize = 10;
    style.GrabMinSize = 5;
    style.IndentSpacing = 14;
    style.WindowRounding = 6;
    style.PopupRounding = 5;
    style.FrameRounding = 4;
    style.GrabRounding = 2;
    style.ScrollbarRounding = 5;
    style.TabRounding = 4;
    style.WindowBorderSize = 1;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowTitleAlign = {0, 0.5f};
    const auto set = [&](ImGuiCol which, ImU32 colour) { style.Colors[which] = vec(colour); };
    set(ImGuiCol_Text, p::kText);
    set(ImGuiCol_TextDisabled, p::kDim);
    set(ImGuiCol_WindowBg, p::kPanel);
    set(ImGuiCol_ChildBg, 0);
    set(ImGuiCol_PopupBg, IM_COL32(34, 37, 43, 252));
    set(ImGuiCol_Border, p::kLine);
    set(ImGuiCol_FrameBg, p::kFrame);
    set(ImGuiCol_FrameBgHovered, p::kFrameHovered);
    set(ImGuiCol_FrameBgActive, IM_COL32(60, 66, 78, 255));
    set(ImGuiCol_TitleBg, p::kRaised);
    set(ImGuiCol_TitleBgActive, p::kRaised);
    set(ImGuiCol_MenuBarBg, IM_COL32(22, 24, 28, 255));
    set(ImGuiCol_ScrollbarBg, 0);
    set(ImGuiCol_ScrollbarGrab, IM_COL32(62, 68, 79, 255));
    set(ImGuiCol_ScrollbarGrabHovered, IM_COL32(80, 87, 100, 255));
    set(ImGuiCol_ScrollbarGrabActive, p::kAccent);
    set(ImGuiCol_CheckMark, p::kAccent);
    set(ImGuiCol_SliderGrab, p::kAccent);
    set(ImGuiCol_SliderGrabActive, IM_COL32(130, 186, 250, 255));
    set(ImGuiCol_Button, IM_COL32(50, 55, 64, 255));
    set(ImGuiCol_ButtonHovered, IM_COL32(64, 71, 83, 255));
    set(ImGuiCol_ButtonActive, p::kAccentDeep);
    set(ImGuiCol_Header, IM_COL32(46, 52, 62, 255));
    set(ImGuiCol_HeaderHovered, IM_COL32(56, 64, 77, 255));
    set(ImGuiCol_HeaderActive, p::kAccentDeep);
    set(ImGuiCol_Separator, p::kLine);
    set(ImGuiCol_Tab, 0);
    set(ImGuiCol_TabHovered, p::kFrameHovered);
    set(ImGuiCol_TabActive, p::kFrame);
    set(ImGuiCol_TabUnfocused, 0);
    set(ImGuiCol_TabUnfocusedActive, p::kFrame);
    set(ImGuiCol_PlotLines, p::kAccent);
    set(ImGuiCol_PlotHistogram, p::kAccent);
    set(ImGuiCol_TableHeaderBg, p::kRaised);
    set(ImGuiCol_TableBorderStrong, p::kLine);
    set(ImGuiCol_TableBorderLight, p::kLine);
    set(ImGuiCol_TableRowBgAlt, IM_COL32(255, 255, 255, 7));
    set(ImGuiCol_TextSelectedBg, p::kAccentDeep);
    set(ImGuiCol_NavHighlight, p::kAccent);
    set(ImGuiCol_ModalWindowDimBg, IM_COL32(8, 9, 11, 140));
    style.ScaleAllSizes(scale);
    style.WindowBorderSize = style.PopupBorderSize = 1;
    ImGui::GetStyle() = style;
    useFonts(scale, more);
}

}  // namespace mv::ui
