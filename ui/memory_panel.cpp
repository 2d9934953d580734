// What lies in the GPU's memory, by buffer, and what was predicted before it was allocated.

#include <algorithm>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/setting_widget.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

constexpr std::uint64_t kMiB = 1ull << 20;

void table(Context& c) {
    const auto& memory = c.statistics.memory;
    std::uint64_t used = 0, predicted = 0, most = 1;
    for (const MemoryUse& use : memory) {
        used += use.usedBytes;
        predicted += use.predictedBytes;
        most = std::max({most, use.usedBytes, use.predictedBytes});
    }
    if (!beginValues("memory", 2, 0.44f)) return;
    valueHeads(c, "buffer", {"used", "predicted"});
    for (const MemoryUse& use : memory) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x, line = ImGui::GetTextLineHeight();
        elidedText(use.name, width);
        const auto share = [&](std::uint64_t bytes) {
            return static_cast<float>(static_cast<double>(bytes) / static_cast<double>(most));
        };
        // Used as a bar, predicted as a mark on it.
        bar({at.x, at.y + line, width, c.px(3)}, share(use.usedBytes), palette::kAccent);
        if (use.predictedBytes > 0) {
            const float x = at.x + width * share(use.predictedBytes);
            ImGui::GetWindowDrawList()->AddLine(
                {x, at.y + line - c.px(1)}, {x, at.y + line + c.px(4)}, palette::kText, c.px(1.5f));
        }
        ImGui::Dummy({0, c.px(2)});
        const auto column = [&](const char* which, const std::string& shown, ImU32 colour) {
            ImGui::TableNextColumn();
            rightText(c, shown, colour);
            c.figure(shown, {"/memory/" + std::to_string(&use - memory.data()) + "/" + which});
        };
        column("usedBytes", bytesText(use.usedBytes), palette::kText);
        column("predictedBytes", use.predictedBytes ? bytesText(use.predictedBytes) : "-",
               palette::kDim);
    }
    valueRow(c, "together", {bytesText(used), predicted ? bytesText(predicted) : "-"},
             palette::kText);
    endValues();
}

void budget(Context& c, const char* label, std::string_view key, std::uint64_t used,
            std::uint64_t allowed) {
    settingRow(c, key);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const double share = static_cast<double>(used) / static_cast<double>(std::max(allowed, kMiB));
    bar({at.x, at.y + c.px(2), width, c.px(6)}, static_cast<float>(share),
        share > 0.9 ? palette::kNotice : palette::kAccent);
    ImGui::Dummy({width, c.px(10)});
    text(c, label, palette::kDim);
    ImGui::SameLine();
    rightText(c, bytesText(used) + " of " + bytesText(allowed) + ", " + percentText(share),
              palette::kDim);
    ImGui::Dummy({0, c.px(4)});
}

}  // namespace

void memoryPanel(Context& c) {
    if (c.statistics.memory.empty()) {
        wrappedText("Nothing has been rendered yet.", palette::kDim);
    } else {
        table(c);
    }
    std::uint64_t maps = 0, queues = 0;
    for (const MethodStatistics& m : c.statistics.methods) {
        const bool keepsCuts = m.cuts.nodes > 0;
        maps = std::max(maps, m.mapBytes + (keepsCuts ? m.queueBytes : 0));
        queues = std::max(queues, keepsCuts ? 0 : m.queueBytes);
    }
    sectionTitle(c, "Budgets");
    budget(c, "maps of a side", "gpu-memory", maps,
           static_cast<std::uint64_t>(c.settings.side[0].maps.memoryMiB) * kMiB);
    budget(c, "queue or lists", "queue-memory", queues,
           static_cast<std::uint64_t>(c.settings.side[0].pairs.queueMemoryMiB) * kMiB);
    sectionTitle(c, "Graphics card");
    text(c, "free");
    ImGui::SameLine();
    rightText(c, c.model.freeGpuBytes ? bytesText(*c.model.freeGpuBytes) : "not available",
              c.model.freeGpuBytes ? palette::kText : palette::kDim);
    if (!c.model.freeGpuBytes) tooltip("The driver does not tell how much memory is free.");
    wrappedText(c.model.renderer, palette::kDim);
}

}  // namespace mv::ui
