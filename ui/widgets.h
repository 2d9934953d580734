#pragma once
// Small pieces that panels are made of: texts that say when they do not fit, aligned values, bars,
// legends, buttons with drawn icons.

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "ui/context.h"
#include "ui/style.h"

namespace mv::ui {

// ---------------------------------------------------------------- text
void text(Context& c, std::string_view text, ImU32 colour = palette::kText);
void rightText(Context& c, std::string_view text, ImU32 colour = palette::kText);
void wrappedText(std::string_view text, ImU32 colour = palette::kText);
// Shortened with an ellipsis to the width; hovering shows all of it.
void elidedText(std::string_view text, float width, ImU32 colour = palette::kText);
std::string elided(std::string_view text, float width);
std::string elidedFront(std::string_view text, float width);  // "...end of a path"
// A quiet heading with a line to the right edge.
void sectionTitle(Context& c, const char* title, bool line = true);
// A title that a click opens or closes; true while it is open.
bool groupHeader(Context& c, const std::string& title);
// Explains the last item: a title and sentences below it.
void tooltip(std::string_view title, std::string_view body = {});
// Says that of an entry of the menu that is being drawn, beside its other entries.
void tooltipBelowMenu(std::string_view title, std::string_view body = {});

// ---------------------------------------------------------------- values in columns
// A label and `columns` right-aligned values a row.
bool beginValues(const char* id, int columns, float labelShare = 0.46f);
void valueHeads(Context& c, std::string_view label, std::initializer_list<std::string> heads);
void valueRow(Context& c, std::string_view label, std::span<const std::string> values,
              ImU32 colour = palette::kText);
inline void valueRow(Context& c, std::string_view label, std::initializer_list<std::string> values,
                     ImU32 colour = palette::kText) {
    valueRow(c, label, std::span<const std::string>(values.begin(), values.size()), colour);
}
inline void endValues() { ImGui::EndTable(); }

// ---------------------------------------------------------------- drawing
// A filled share of a rectangle.
void bar(const Rect& rect, float share01, ImU32 colour, ImU32 ground = palette::kFrame);
struct Slice {
    double amount = 0;
    ImU32 colour = 0;
};
// Slices one after another, their sum against `whole`; gives the hovered slice or -1.
int stackedBar(const Rect& rect, std::span<const Slice> slices, double whole);
struct ColumnSeries {
    std::span<const double> values;
    ImU32 colour;
};
// Columns side by side, one group an index, against a common top; gives the hovered index or -1.
int columns(Context& c, const char* id, std::span<const ColumnSeries> series, float height);
// Square of a colour, then a text.
void swatch(Context& c, ImU32 colour, std::string_view label, ImU32 textColour = palette::kText);
// Scale with its numbers, entries with their counts, as wide as `width`.
void legend(Context& c, const Legend& legend, float width);
void picture(const Picture& picture, ImVec2 size, ImU32 ground = palette::kFrame);

// ---------------------------------------------------------------- buttons
enum class Icon { play, pause, backward, forward, toStart, slower, faster, close, lock, unlock };
bool iconButton(Context& c, std::string_view name, Icon icon, float width, std::string_view help,
                bool on = false);
// As ImGui::BeginCombo, with a quiet arrow; what does not fit is shortened, hovering shows it.
bool beginCombo(Context& c, const char* id, const std::string& shown, float width);
// A button that stays pressed.
bool toggleButton(Context& c, std::string_view name, const char* label, bool on, float width = 0);
// Asks for a click on the picture, or no longer; says `asked` while it does.
void pickButton(Context& c, Picking picking, std::string_view name, const char* label,
                const char* asked, float width);
bool button(Context& c, std::string_view name, const char* label, float width = 0);
// A button for an action: its help and key as the tooltip.
bool actionButton(Context& c, Action action, const char* label, float width = 0);
void actionTooltip(const ActionInfo& action);

}  // namespace mv::ui
