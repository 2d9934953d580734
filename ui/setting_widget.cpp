#include "ui/setting_widget.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "megaviews/settings/error.h"

namespace mv::ui {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
    using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

std::string tooltip(const SettingInfo& setting) {
    std::string text(setting.help);
    text += "\n\nrange: " + valueRange(setting);
    if (!setting.unit.empty()) text += "   unit: " + std::string(setting.unit);
    text += "\ndefault: " + toText(Settings{}, setting);
    if (!setting.paper.empty()) text += "\npaper: " + std::string(setting.paper);
    text += "\nflag: --" + std::string(setting.key) + "   (right click: reset)";
    return text;
}

std::string unitFormat(const char* number, const SettingInfo& setting) {
    std::string format = number;
    if (!setting.unit.empty()) format += ' ';
    for (const char c : setting.unit) format += c == '%' ? "%%" : std::string(1, c);
    return format;
}

bool powerOfTwoSlider(const char* label, std::int64_t& value, const SettingInfo& setting) {
    int exponent = 0;
    while ((std::int64_t{1} << (exponent + 1)) <= value) ++exponent;
    int lowest = 0, highest = 0;
    while ((std::int64_t{1} << lowest) < static_cast<std::int64_t>(setting.minimum)) ++lowest;
    while ((std::int64_t{1} << (highest + 1)) <= static_cast<std::int64_t>(setting.maximum)) {
        ++highest;
    }
    const std::string shown = std::to_string(value);
    if (!ImGui::SliderInt(label, &exponent, lowest, highest, shown.c_str(),
                          ImGuiSliderFlags_NoInput)) {
        return false;
    }
    value = std::int64_t{1} << exponent;
    return true;
}

bool integer(const char* label, std::int64_t& value, const SettingInfo& setting) {
    if (setting.powerOfTwo) return powerOfTwoSlider(label, value, setting);
    const auto lo = static_cast<std::int64_t>(setting.minimum);
    const auto hi = static_cast<std::int64_t>(setting.maximum);
    // A range over three decades is explored on a logarithmic slider.
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp |
        (hi > 1000 * std::max<std::int64_t>(lo, 1) ? ImGuiSliderFlags_Logarithmic : 0);
    return ImGui::SliderScalar(label, ImGuiDataType_S64, &value, &lo, &hi,
                               unitFormat("%lld", setting).c_str(), flags);
}

bool real(const char* label, double& value, const SettingInfo& setting) {
    const double lo = setting.minimum, hi = setting.maximum;
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (hi > 100 && lo > 0 ? ImGuiSliderFlags_Logarithmic : 0);
    return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &lo, &hi,
                               unitFormat("%.3g", setting).c_str(), flags);
}

bool vector(const char* label, std::array<double, 3>& value) {
    return ImGui::InputScalarN(label, ImGuiDataType_Double, value.data(), 3, nullptr, nullptr,
                               "%.3f");
}

}  // namespace

bool settingWidget(Settings& settings, const SettingInfo& setting) {
    const std::string label(setting.label);
    const char* l = label.c_str();
    ImGui::PushID(setting.key.data(), setting.key.data() + setting.key.size());
    bool changed = std::visit(
        Overloaded{
            [&](bool Settings::*member) { return ImGui::Checkbox(l, &(settings.*member)); },
            [&](int Settings::*member) {
                std::int64_t value = settings.*member;
                const bool edited = integer(l, value, setting);
                settings.*member = static_cast<int>(value);
                return edited;
            },
            [&](std::int64_t Settings::*member) { return integer(l, settings.*member, setting); },
            [&](std::uint32_t Settings::*member) {
                return ImGui::InputScalar(l, ImGuiDataType_U32, &(settings.*member));
            },
            [&](double Settings::*member) { return real(l, settings.*member, setting); },
            [&](std::optional<double> Settings::*member) {
                std::optional<double>& value = settings.*member;
                double shown = value.value_or(std::clamp(0.0, setting.minimum, setting.maximum));
                if (!value) {
                    const std::string word =
                        setting.unset.empty() ? "unset" : std::string(setting.unset);
                    if (ImGui::Button((word + "##set").c_str(), {ImGui::CalcItemWidth(), 0})) {
                        value = shown;
                        return true;
                    }
                    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
                    ImGui::TextUnformatted(l);
                    return false;
                }
                if (!real(l, shown, setting)) return false;
                value = shown;
                return true;
            },
            [&](std::string Settings::*member) {
                char text[256];
                std::snprintf(text, sizeof text, "%s", (settings.*member).c_str());
                if (!ImGui::InputText(l, text, sizeof text, ImGuiInputTextFlags_EnterReturnsTrue)) {
                    return false;
                }
                settings.*member = text;
                return true;
            },
            [&](std::array<double, 3> Settings::*member) { return vector(l, settings.*member); },
            [&](std::optional<std::array<double, 3>> Settings::*member) {
                auto& value = settings.*member;
                std::array<double, 3> shown = value.value_or(std::array<double, 3>{});
                if (!vector(l, shown)) return false;
                value = shown;
                return true;
            },
            [&](const ChoiceMember& choice) {
                const int current = choice.get(settings);
                const bool hasUnset = !setting.unset.empty();
                const std::string shown =
                    current < 0 ? std::string(setting.unset)
                                : std::string(choice.names[static_cast<std::size_t>(current)]);
                bool edited = false;
                if (ImGui::BeginCombo(l, shown.c_str())) {
                    for (int i = hasUnset ? -1 : 0; i < static_cast<int>(choice.names.size());
                         ++i) {
                        const std::string name =
                            i < 0 ? std::string(setting.unset)
                                  : std::string(choice.names[static_cast<std::size_t>(i)]);
                        if (ImGui::Selectable(name.c_str(), i == current) && i != current) {
                            choice.set(settings, i);
                            edited = true;
                        }
                    }
                    ImGui::EndCombo();
                }
                return edited;
            },
            [&](const SizeMember& size) {
                int values[2] = {settings.*size.width, settings.*size.height};
                if (!ImGui::InputInt2(l, values, ImGuiInputTextFlags_EnterReturnsTrue))
                    return false;
                const auto clamp = [&](int v) {
                    return std::clamp(v, static_cast<int>(setting.minimum),
                                      static_cast<int>(setting.maximum));
                };
                settings.*size.width = clamp(values[0]);
                settings.*size.height = clamp(values[1]);
                return true;
            }},
        setting.member);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
        ImGui::TextUnformatted(tooltip(setting).c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        reset(settings, setting);
        changed = true;
    }
    ImGui::PopID();
    return changed;
}

bool settingWidget(Settings& settings, const char* key) {
    const SettingInfo* setting = findSetting(key);
    IM_ASSERT(setting && "no such setting");
    return setting && settingWidget(settings, *setting);
}

}  // namespace mv::ui
