#include "ui/setting_widget.h"

#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "megaviews/core/error.h"
#include "megaviews/core/overloaded.h"
#include "ui/format.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr float kLabelShare = 0.43f;

// "1 frame", "1 view a pixel": units are plurals.
std::string unitOf(const std::string& number, const SettingInfo& setting) {
    std::string unit(setting.unit);
    if (number != "1") return unit;
    const std::size_t first = std::min(unit.find(' '), unit.size());
    for (const std::size_t end : {first, unit.size()}) {
        if (end > 1 && unit[end - 1] == 's') return unit.erase(end - 1, 1);
    }
    return unit;
}

// The number with its unit, or without where both do not fit. What is counted stands in front:
// "level 5".
std::string withUnit(const std::string& number, const SettingInfo& setting, float width) {
    if (setting.unit.empty()) return number;
    const bool ordinal =
        setting.unit == "level" || setting.unit == "slot" || setting.unit == "node";
    const std::string unit = unitOf(number, setting);
    const std::string both = ordinal ? unit + " " + number : number + " " + unit;
    const float room = width - 2 * ImGui::GetStyle().FramePadding.x;
    return ImGui::CalcTextSize(both.c_str()).x <= room ? both : number;
}

// A slider that shows its value as the filled share of its frame, with a text of ours on it.
bool filledSlider(Context& c, const SettingInfo& setting, ImGuiDataType type, void* value,
                  const void* low, const void* high, double share, const std::string& shown,
                  ImGuiSliderFlags flags, float width) {
    const char* id = "##v";
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    const ImGuiStyle& style = ImGui::GetStyle();
    const ImGuiContext& g = *ImGui::GetCurrentContext();
    const ImGuiID itemId = ImGui::GetID(id);
    const bool hovered =
        ImGui::IsMouseHoveringRect(at, {at.x + width, at.y + height}) && ImGui::IsWindowHovered();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, {at.x + width, at.y + height},
                        hovered ? palette::kFrameHovered : palette::kFrame, style.FrameRounding);
    const float filled = width * static_cast<float>(std::clamp(share, 0.0, 1.0));
    if (filled >= 2) {
        draw->AddRectFilled(at, {at.x + filled, at.y + height}, palette::kAccentDeep,
                            style.FrameRounding,
                            filled > width - style.FrameRounding ? ImDrawFlags_RoundCornersAll
                                                                 : ImDrawFlags_RoundCornersLeft);
    }
    for (const ImGuiCol part : {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive,
                                ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive}) {
        ImGui::PushStyleColor(part, 0u);
    }
    ImGui::SetNextItemWidth(width);
    const std::string literal = escapedFormat(shown);
    // A press with Ctrl, and Enter, ask to type the value instead.
    const bool asks = (hovered && ImGui::GetIO().KeyCtrl && ImGui::IsMouseClicked(0)) ||
                      (g.NavActivateInputId == itemId);
    if (asks) {
        c.state.typing = setting.key;
        c.state.typingBegins = true;
    }
    const bool changed = ImGui::SliderScalar(id, type, value, low, high, literal.c_str(),
                                             flags | ImGuiSliderFlags_NoInput);
    ImGui::PopStyleColor(5);
    return changed && !asks;
}

// The value as text, in place of the slider: as the command line takes it, so 64K is a number too.
bool typedField(Context& c, const SettingInfo& setting, float width) {
    PanelState& s = c.state;
    if (s.typingBegins) {
        std::snprintf(s.typed, sizeof s.typed, "%s", toText(c.settings, setting).c_str());
        ImGui::SetKeyboardFocusHere();
    }
    ImGui::SetNextItemWidth(width);
    const bool entered =
        ImGui::InputText("##typed", s.typed, sizeof s.typed,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool left = !std::exchange(s.typingBegins, false) && ImGui::IsItemDeactivated();
    if (!entered && !left) return false;
    s.typing.clear();
    if (!entered) return false;  // Escape, or a click elsewhere
    try {
        setFromText(c.settings, setting, s.typed, setting.key);
        return true;
    } catch (const Error& error) {
        c.model.toasts.push_back({error.what()});
        return false;
    }
}

bool powerOfTwoSlider(Context& c, std::int64_t& value, const SettingInfo& setting, float width) {
    const bool zero = setting.minimum < 1;  // it stands left of the powers
    int lowest = 0, highest = 0, exponent = 0;
    while (!zero && (std::int64_t{1} << lowest) < static_cast<std::int64_t>(setting.minimum)) {
        ++lowest;
    }
    while ((std::int64_t{1} << (highest + 1)) <= static_cast<std::int64_t>(setting.maximum)) {
        ++highest;
    }
    while ((std::int64_t{1} << (exponent + 1)) <= value) ++exponent;
    const int first = zero ? lowest - 1 : lowest;
    int place = value == 0 ? first : std::clamp(exponent, lowest, highest);
    const std::string shown =
        value == 0 ? std::string(setting.atLowest) : withUnit(withThousands(value), setting, width);
    c.checkFits(shown, width);
    const double share = static_cast<double>(place - first) / std::max(highest - first, 1);
    if (!filledSlider(c, setting, ImGuiDataType_S32, &place, &first, &highest, share, shown,
                      ImGuiSliderFlags_AlwaysClamp, width)) {
        return false;
    }
    value = zero && place == first ? 0 : std::int64_t{1} << place;
    return true;
}

bool integer(Context& c, std::int64_t& value, const SettingInfo& setting, float width) {
    if (setting.powerOfTwo) return powerOfTwoSlider(c, value, setting, width);
    const auto lo = static_cast<std::int64_t>(setting.minimum);
    const auto hi = static_cast<std::int64_t>(setting.maximum);
    // A range over three decades is explored on a logarithmic slider.
    const bool wide = hi > 1000 * std::max<std::int64_t>(lo, 1);
    const double from = static_cast<double>(lo), to = static_cast<double>(hi);
    const double v = static_cast<double>(value), floor = std::max(from, 0.1);
    const double share = wide ? std::log(std::max(v, floor) / floor) / std::log(to / floor)
                              : (v - from) / std::max(to - from, 1.0);
    const std::string shown = !setting.atLowest.empty() && v <= setting.minimum
                                  ? std::string(setting.atLowest)
                                  : withUnit(withThousands(value), setting, width);
    c.checkFits(shown, width);
    return filledSlider(c, setting, ImGuiDataType_S64, &value, &lo, &hi, share, shown,
                        ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : 0),
                        width);
}

bool real(Context& c, double& value, const SettingInfo& setting, float width) {
    const double lo = setting.minimum, hi = setting.maximum;
    char number[64];
    std::snprintf(number, sizeof number, "%.3g", value);
    const std::string shown = !setting.atLowest.empty() && value <= setting.minimum
                                  ? std::string(setting.atLowest)
                                  : withUnit(number, setting, width);
    c.checkFits(shown, width);
    if (hi - lo > 1e5) {  // no range that a slider could explore
        ImGui::SetNextItemWidth(width);
        const double step = std::max(std::abs(value) * 0.01, 0.01);
        return ImGui::DragScalar(
            "##v", ImGuiDataType_Double, &value, static_cast<float>(step), &lo, &hi,
            (setting.unit.empty() || shown == number ? std::string("%.3g")
                                                     : "%.3g " + escapedFormat(setting.unit))
                .c_str(),
            ImGuiSliderFlags_AlwaysClamp);
    }
    const bool wide = lo > 0 && hi / lo > 1000;
    const double share =
        wide ? std::log(std::max(value, lo) / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
    return filledSlider(c, setting, ImGuiDataType_Double, &value, &lo, &hi, share, shown,
                        ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat |
                            (wide ? ImGuiSliderFlags_Logarithmic : 0),
                        width);
}

bool vector(std::array<double, 3>& value, float width) {
    ImGui::SetNextItemWidth(width);
    return ImGui::InputScalarN("##v", ImGuiDataType_Double, value.data(), 3, nullptr, nullptr,
                               "%.3g", ImGuiInputTextFlags_EnterReturnsTrue);
}

// A toggle for "no value" at the right of a field; gives the width that is left for the field.
struct Automatic {
    Context& c;
    const SettingInfo& setting;
    std::string word;
    float width;
    Automatic(Context& context, const SettingInfo& info, float whole)
        : c(context), setting(info), word(info.unset.empty() ? "unset" : info.unset) {
        const float toggle = ImGui::CalcTextSize(word.c_str()).x + c.px(12);
        width = std::max(whole - toggle - c.px(4), c.px(30));
    }
    bool toggled(bool on) {
        ImGui::SameLine(0, c.px(4));
        const bool pressed = toggleButton(c, std::string(setting.key) + ":" + word, word.c_str(),
                                          on, ImGui::CalcTextSize(word.c_str()).x + c.px(12));
        tooltip(on ? "Sets a value" : "Takes the value back to " + word);
        return pressed;
    }
};

// A text is checked as one from the command line; what is wrong with it is said in passing.
bool textField(Context& c, std::string& value, const SettingInfo& setting, float width) {
    std::string typed = value;
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##v", "not set", &typed);
    if (!ImGui::IsItemDeactivatedAfterEdit()) return false;
    try {
        Settings scratch;  // what the command line refuses is refused
        setFromText(scratch, setting, typed, setting.key);
    } catch (const Error& error) {
        c.model.toasts.push_back({error.what()});
        return false;
    }
    value = typed;
    return true;
}

bool choiceField(Context& c, const ChoiceField& choice, const SettingInfo& setting, float width) {
    const int current = choice.get(c.settings);
    const auto title = [&](int i) {
        return i < 0 ? std::string(setting.unset)
                     : choiceTitle(setting.key, choice.names[static_cast<std::size_t>(i)]);
    };
    bool edited = false;
    if (beginCombo(c, "##v", title(current), width)) {
        const bool hasUnset = !setting.unset.empty();
        for (int i = hasUnset ? -1 : 0; i < static_cast<int>(choice.names.size()); ++i) {
            if (ImGui::Selectable(title(i).c_str(), i == current) && i != current) {
                choice.set(c.settings, i);
                edited = true;
            }
            c.named(std::string(setting.key) + "=" +
                    std::string(i < 0 ? setting.unset : choice.names[static_cast<std::size_t>(i)]));
            if (i == current) ImGui::SetItemDefaultFocus();
        }
        ImGui::EndCombo();
    }
    return edited;
}

// Sets with names first, then the members, each to be taken or left; the list stays open for those.
bool setField(Context& c, const SetField& of, const SettingInfo& setting, float width) {
    const int before = of.get(c.settings);
    const std::string title = toText(c.settings, setting);
    if (!beginCombo(c, "##v", title.empty() ? "none" : title, width)) return false;
    int set = before;
    const auto whole = [&](std::string_view name, int members) {
        if (ImGui::Selectable(std::string(name).c_str(), members == before)) set = members;
        c.named(std::string(setting.key) + "=" + std::string(name));
    };
    if (!setting.unset.empty()) whole(setting.unset, -1);
    for (const auto& [name, members] : of.sets) whole(name, members);
    if (!of.sets.empty()) ImGui::Separator();
    int members = std::max(before, 0);
    for (std::size_t i = 0; i < of.names.size(); ++i) {
        if (ImGui::CheckboxFlags(std::string(of.names[i]).c_str(), &members, 1 << i)) set = members;
        c.named(std::string(setting.key) + ":" + std::string(of.names[i]));
    }
    ImGui::EndCombo();
    if (set != before) of.set(c.settings, set);
    return set != before;
}

// Edits `value` in place and says whether it did.
bool edit(Context&, bool& value, const SettingInfo&, float) {
    return ImGui::Checkbox("##v", &value);
}
bool edit(Context& c, std::int64_t& value, const SettingInfo& setting, float width) {
    return integer(c, value, setting, width);
}
bool edit(Context& c, int& value, const SettingInfo& setting, float width) {
    std::int64_t wide = value;
    const bool edited = integer(c, wide, setting, width);
    value = static_cast<int>(wide);
    return edited;
}
bool edit(Context&, std::uint32_t& value, const SettingInfo&, float width) {
    ImGui::SetNextItemWidth(width);
    const std::uint32_t step = 1;
    return ImGui::InputScalar("##v", ImGuiDataType_U32, &value, &step);
}
bool edit(Context& c, double& value, const SettingInfo& setting, float width) {
    return real(c, value, setting, width);
}
bool edit(Context& c, std::string& value, const SettingInfo& setting, float width) {
    return textField(c, value, setting, width);
}
bool edit(Context&, Vector3& value, const SettingInfo&, float width) {
    return vector(value, width);
}
bool edit(Context&, Size& value, const SettingInfo& setting, float width) {
    int values[2] = {value.width, value.height};
    ImGui::SetNextItemWidth(width);
    if (!ImGui::InputInt2("##v", values, ImGuiInputTextFlags_EnterReturnsTrue)) return false;
    const auto clamp = [&](int v) {
        return std::clamp(v, static_cast<int>(setting.minimum), static_cast<int>(setting.maximum));
    };
    value = {clamp(values[0]), clamp(values[1])};
    return true;
}

// What an unset value stands at until it is given.
template <typename T>
T standIn(const Context& c, const SettingInfo& setting) {
    if constexpr (std::is_same_v<T, double>) {
        if (setting.key == "exposure") return c.statistics.exposureEv;
        if (setting.key == "difference-range") return c.statistics.differenceRange;
        if (setting.key == "fov") return c.model.camera.fovDeg.value_or(60);
        assert(setting.key == "clamp-distance");
        return 0.01;  // about what is found where views stand as usual
    } else if constexpr (std::is_same_v<T, int>) {
        return setting.key == "compare-view-res" ? c.settings.side[0].maps.resolution : 0;
    } else if constexpr (std::is_same_v<T, Vector3>) {
        const CameraSettings& camera = c.model.camera;
        const auto& known = setting.key == "camera-position" ? camera.position : camera.target;
        return known.value_or(T{});
    } else {
        return T{};
    }
}
template <typename T>
bool edit(Context& c, std::optional<T>& value, const SettingInfo& setting, float width) {
    Automatic automatic(c, setting, width);
    T shown = value.value_or(standIn<T>(c, setting));
    if constexpr (std::is_same_v<T, double>) {
        shown = std::clamp(shown, setting.minimum, setting.maximum);
    }
    const T before = shown;
    // Where unset means none, what it stands at is no value.
    const bool none = !value && setting.unset == "none";
    if (none) ImGui::PushStyleColor(ImGuiCol_Text, palette::kFaint);
    bool edited = edit(c, shown, setting, automatic.width);
    if (none) ImGui::PopStyleColor();
    if (edited && shown != before) value = shown;
    if (automatic.toggled(!value)) {
        value = value ? std::nullopt : std::optional<T>(shown);
        edited = true;
    }
    return edited;
}

bool field(Context& c, const SettingInfo& setting, float width) {
    if (c.state.typing == setting.key) return typedField(c, setting, width);
    return std::visit(
        Overloaded{
            [&](const ChoiceField& choice) { return choiceField(c, choice, setting, width); },
            [&](const SetField& of) { return setField(c, of, setting, width); },
            [&](const auto& of) {
                auto value = of.get(c.settings);
                const bool edited = edit(c, value, setting, width);
                if (edited) of.set(c.settings, value);
                return edited;
            }},
        setting.field);
}

}  // namespace

void resetGroup(Context& c, SettingGroup group) {
    for (const SettingInfo& setting : settingsTable()) {
        if (setting.group == group) reset(c.settings, setting, c.model.defaults);
    }
}

bool settingMenu(Context& c, const SettingInfo& setting) {
    bool changed = false;
    if (!ImGui::BeginPopupContextItem("##menu")) return false;
    const std::string key(setting.key);
    std::string standard = toText(c.model.defaults, setting);
    if (standard.empty()) standard = setting.unset.empty() ? "none" : setting.unset;
    if (ImGui::MenuItem(("Reset to " + standard).c_str(), nullptr, false,
                        !hasDefault(c.settings, setting, c.model.defaults))) {
        reset(c.settings, setting, c.model.defaults);
        changed = true;
    }
    c.named("reset:" + key);
    if (ImGui::MenuItem(("Reset all of " + std::string(groupTitle(setting.group))).c_str())) {
        resetGroup(c, setting.group);
        changed = true;
    }
    ImGui::Separator();
    const std::string option = "--" + key + "=" + toText(c.settings, setting);
    if (ImGui::MenuItem("Copy as option", nullptr)) ImGui::SetClipboardText(option.c_str());
    ImGui::EndPopup();
    return changed;
}

std::string settingTooltip(const Context& c, const SettingInfo& setting) {
    std::string text(setting.help);
    text += "\n\nRange: " + valueRange(setting);
    if (!setting.unit.empty()) text += " " + std::string(setting.unit);
    std::string standard = toText(c.model.defaults, setting);
    if (standard.empty()) standard = setting.unset.empty() ? "empty" : setting.unset;
    text += "\nDefault: " + standard;
    if (!setting.paper.empty()) text += "\nPaper: " + std::string(setting.paper);
    text += "\nOption: --" + std::string(setting.key) +
            "\n\nRight click: a menu with reset. Ctrl+click on a slider types a number.";
    return text;
}

void rowLabel(Context& c, std::string_view label, bool changed) {
    const float width = ImGui::GetContentRegionAvail().x * kLabelShare - c.px(6);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::AlignTextToFramePadding();
    const float start = ImGui::GetCursorPosX();
    elidedText(label, width, changed ? palette::kText : IM_COL32(184, 190, 200, 255));
    if (changed) {  // a value other than the default is marked
        const float y = at.y + ImGui::GetFrameHeight() / 2;
        ImGui::GetWindowDrawList()->AddRectFilled({at.x - c.px(6), y - c.px(6)},
                                                  {at.x - c.px(4), y + c.px(6)}, palette::kAccent,
                                                  c.px(1));
    }
    ImGui::SameLine(start + width + c.px(6), 0);
}

float rowFieldWidth() { return ImGui::GetContentRegionAvail().x; }

bool settingField(Context& c, const SettingInfo& setting, float width) {
    ImGui::PushID(setting.key.data(), setting.key.data() + setting.key.size());
    ImGui::BeginGroup();
    bool changed = field(c, setting, width);
    ImGui::EndGroup();
    c.named(setting.key);
    if (!ImGui::IsAnyItemActive()) tooltip(setting.label, settingTooltip(c, setting));
    changed |= settingMenu(c, setting);
    ImGui::PopID();
    return changed;
}

bool settingField(Context& c, std::string_view key, float width) {
    const SettingInfo* setting = findSetting(key);
    IM_ASSERT(setting && "no such setting");
    return setting && settingField(c, *setting, width);
}

bool settingRow(Context& c, const SettingInfo& setting) {
    rowLabel(c, setting.label, !hasDefault(c.settings, setting, c.model.defaults));
    return settingField(c, setting, rowFieldWidth());
}

bool settingRow(Context& c, std::string_view key, std::string_view shortLabel) {
    const SettingInfo* setting = findSetting(key);
    IM_ASSERT(setting && "no such setting");
    if (!setting) return false;
    const std::string_view label = setting->label;
    const float room = ImGui::GetContentRegionAvail().x * kLabelShare - c.px(6);
    const bool narrow = ImGui::CalcTextSize(label.data(), label.data() + label.size()).x > room;
    rowLabel(c, narrow && !shortLabel.empty() ? shortLabel : label,
             !hasDefault(c.settings, *setting, c.model.defaults));
    return settingField(c, *setting, rowFieldWidth());
}

}  // namespace mv::ui
