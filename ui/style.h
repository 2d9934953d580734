#pragma once
// The window's look, said once: a dark neutral palette with one accent, two colours for the sides
// of a comparison and one for each decision on a pair, all told apart in every form of colour
// vision (Okabe-Ito).

#include <imgui.h>

#include "ui/model.h"

namespace mv::ui {

namespace palette {
inline constexpr ImU32 kText = IM_COL32(214, 218, 225, 255);
inline constexpr ImU32 kDim = IM_COL32(142, 150, 163, 255);
inline constexpr ImU32 kFaint = IM_COL32(88, 95, 107, 255);
inline constexpr ImU32 kPanel = IM_COL32(28, 31, 36, 255);
inline constexpr ImU32 kRaised = IM_COL32(36, 40, 46, 255);
inline constexpr ImU32 kFrame = IM_COL32(43, 47, 55, 255);
inline constexpr ImU32 kFrameHovered = IM_COL32(53, 58, 68, 255);
inline constexpr ImU32 kLine = IM_COL32(52, 57, 66, 255);
inline constexpr ImU32 kOverlay = IM_COL32(18, 20, 24, 225);  // over the picture
inline constexpr ImU32 kAccent = IM_COL32(86, 156, 236, 255);
inline constexpr ImU32 kAccentDeep = IM_COL32(50, 86, 130, 255);  // fills below text
inline constexpr ImU32 kNotice = IM_COL32(255, 209, 102, 255);
inline constexpr ImU32 kTrouble = IM_COL32(255, 120, 108, 255);
inline constexpr ImU32 kLeft = IM_COL32(86, 180, 233, 255);
inline constexpr ImU32 kRight = IM_COL32(230, 159, 0, 255);
inline constexpr ImU32 kCulled = IM_COL32(150, 150, 150, 255);
inline constexpr ImU32 kRendered = IM_COL32(0, 158, 115, 255);
inline constexpr ImU32 kSubdivided = IM_COL32(221, 208, 92, 255);
inline constexpr ImU32 kForced = IM_COL32(213, 94, 0, 255);
inline constexpr ImU32 kSkipped = IM_COL32(204, 121, 167, 255);
inline constexpr ImU32 kViewA = IM_COL32(230, 159, 0, 255);  // as the picked views are drawn
inline constexpr ImU32 kViewB = IM_COL32(86, 180, 233, 255);
}  // namespace palette

ImU32 toColour(const Float3& displayValues);
ImU32 sideColour(std::size_t side);

// A little bolder, for titles; nullptr (ImGui's default) before applyStyle().
ImFont* titleFont();

// Sizes at scale 1, in window pixels.
inline constexpr float kFontSize = 15;
inline constexpr float kFramePaddingX = 7, kFramePaddingY = 3;

}  // namespace mv::ui
