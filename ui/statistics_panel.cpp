#include "ui/statistics_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "megaviews/settings/statistics_table.h"

namespace mv::ui {
namespace {

void rightAligned(const std::string& text) {
    const float x = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                    ImGui::CalcTextSize(text.c_str()).x;
    ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(), x));
    ImGui::TextUnformatted(text.c_str());
}

std::string fixed(double value, const char* format) {
    char text[32];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

double totalMs(const std::vector<StageTime>& stages) {
    double sum = 0;
    for (const StageTime& stage : stages) sum += stage.ms;
    return sum;
}

bool beginTable(const char* id, std::size_t columns) {
    if (!ImGui::BeginTable(id, static_cast<int>(columns) + 1,
                           ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
        return false;
    }
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.5f);
    for (std::size_t i = 0; i < columns; ++i) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch, 1.0f);
    }
    return true;
}

void row(const char* name, const std::vector<std::string>& values, bool dim = false) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (dim) ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::TextUnformatted(name);
    for (const std::string& value : values) {
        ImGui::TableNextColumn();
        rightAligned(value);
    }
    if (dim) ImGui::PopStyleColor();
}

template <typename Info>
std::string valueText(const Info& info, double value) {
    if (info.unit == "bytes") return bytesText(static_cast<std::uint64_t>(value));
    return info.whole ? withThousands(static_cast<std::uint64_t>(value)) : fixed(value, "%.2f");
}

void tooltip(std::string_view description) {
    if (ImGui::IsItemHovered()) {
        ImGui::SetTooltip("%.*s", static_cast<int>(description.size()), description.data());
    }
}

}  // namespace

std::string withThousands(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (int i = static_cast<int>(digits.size()) - 3; i > 0; i -= 3) {
        digits.insert(static_cast<std::size_t>(i), 1, ',');
    }
    return digits;
}

std::string bytesText(std::uint64_t bytes) {
    const double b = static_cast<double>(bytes);
    if (bytes >= 1ull << 30) return fixed(b / (1ull << 30), "%.2f GiB");
    if (bytes >= 1ull << 20) return fixed(b / (1ull << 20), "%.1f MiB");
    return fixed(b / (1ull << 10), "%.1f KiB");
}

const char* methodTitle(Method method) {
    switch (method) {
        case Method::megaviews:
            return "MegaViews";
        case Method::manylods:
            return "ManyLoDs";
        case Method::none:
            return "no visibility";
    }
    return "";
}

void statisticsPanel(const Settings& settings, const FrameStatistics& statistics) {
    const auto& methods = statistics.methods;
    std::vector<std::string> titles;
    if (!methods.empty()) titles.emplace_back(methodTitle(settings.method));
    if (methods.size() > 1)
        titles.emplace_back(methodTitle(settings.compare.value_or(Method::none)));
    const auto each = [&](auto&& text) {
        std::vector<std::string> values;
        for (const MethodStatistics& m : methods) values.push_back(text(m));
        return values;
    };

    if (ImGui::CollapsingHeader("Time", ImGuiTreeNodeFlags_DefaultOpen)) {
        ImGui::TextDisabled("ms, %s", statistics.clock.c_str());
        if (beginTable("shared", 1)) {
            for (const StageTime& stage : statistics.sharedStages) {
                row(stage.name.c_str(), {fixed(stage.ms, "%.2f")});
            }
            row("shared by both", {fixed(totalMs(statistics.sharedStages), "%.2f")}, true);
            ImGui::EndTable();
        }
        if (!methods.empty() && beginTable("methods", methods.size())) {
            row("", titles, true);
            // Stages may differ between methods: one row a name, in order of first appearance.
            std::vector<std::string> names;
            for (const MethodStatistics& m : methods) {
                for (const StageTime& stage : m.stages) {
                    if (std::find(names.begin(), names.end(), stage.name) == names.end()) {
                        names.push_back(stage.name);
                    }
                }
            }
            for (const std::string& name : names) {
                row(name.c_str(), each([&](const MethodStatistics& m) {
                        for (const StageTime& stage : m.stages) {
                            if (stage.name == name) return fixed(stage.ms, "%.2f");
                        }
                        return std::string("-");
                    }));
            }
            row("method", each([](const auto& m) { return fixed(totalMs(m.stages), "%.2f"); }),
                true);
            ImGui::EndTable();
        }
    }
    const auto table = [&](const char* title, auto&& selects, ImGuiTreeNodeFlags flags) {
        if (!ImGui::CollapsingHeader(title, flags) || methods.empty() ||
            !beginTable(title, methods.size())) {
            return;
        }
        row("", titles, true);
        for (const auto& info : methodStatistics()) {
            if (!selects(info)) continue;
            row(std::string(info.label).c_str(),
                each([&](const MethodStatistics& m) { return valueText(info, info.value(m)); }));
            tooltip(info.description);
        }
        ImGui::EndTable();
    };
    const auto isMemory = [](const auto& info) { return info.unit == "bytes"; };
    table(
        "Sharing", [&](const auto& info) { return !isMemory(info); },
        ImGuiTreeNodeFlags_DefaultOpen);
    table("Memory", isMemory, ImGuiTreeNodeFlags_DefaultOpen);
    if (ImGui::CollapsingHeader("Views and frame") && beginTable("frame", 1)) {
        for (const auto& info : frameStatistics()) {
            row(std::string(info.label).c_str(), {valueText(info, info.value(statistics))});
            tooltip(info.description);
        }
        ImGui::EndTable();
    }
}

}  // namespace mv::ui
