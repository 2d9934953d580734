// The file browser's window.

#include <imgui_internal.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "ui/format.h"
#include "ui/panels.h"
#include "ui/style.h"
#include "ui/widgets.h"

namespace mv::ui {
namespace {

struct Words {
    const char *title, *accept, *what;
};
Words wordsOf(Browse purpose) {
    switch (purpose) {
        case Browse::loadState:
            return {"Load a state", "Load", "States, and pictures that carry one"};
        case Browse::loadReference:
            return {"Load a reference", "Load", "Pictures"};
        case Browse::saveState:
            return {"Save the state", "Save", "States"};
        case Browse::saveScene:
            return {"Save the scene as glTF", "Save", "Scenes"};
        default:
            return {"Open a scene, a state or a picture", "Open", "Scenes, states and pictures"};
    }
}

void hand(Context& c, const std::string& file) {
    if (file.empty()) return;
    switch (c.model.browse) {
        case Browse::open:
            c.requests.openFile = file;
            break;
        case Browse::loadState:
            c.requests.loadState = file;
            break;
        case Browse::saveState:
            c.requests.saveState = file;
            break;
        case Browse::saveScene:
            c.requests.saveScene = file;
            break;
        case Browse::loadReference:
            c.requests.loadReference = file;
            break;
        case Browse::none:
            break;
    }
    c.model.browseFolder = c.state.browser.folder();
    c.model.browse = Browse::none;
}

void list(Context& c, float height) {
    FileBrowser& b = c.state.browser;
    if (!ImGui::BeginTable(
            "files", 2,
            ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersOuter,
            {0, height})) {
        return;
    }
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, c.px(90));
    std::string opened;
    const auto& entries = b.entries();
    // Arrows move through the list while the name is typed, else from button to button.
    const int last = static_cast<int>(entries.size()) - 1;
    const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    const int step = (pressed(ImGuiKey_DownArrow) ? 1 : 0) - (pressed(ImGuiKey_UpArrow) ? 1 : 0);
    const bool moved = step != 0 && last >= 0 && ImGui::IsAnyItemActive();
    if (moved) {
        b.selected = std::clamp(b.selected + step, 0, last);
        b.take(static_cast<std::size_t>(b.selected));
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const FileBrowser::Entry& entry = entries[i];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::PushID(static_cast<int>(i));
        ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? palette::kAccent : palette::kText);
        const std::string shown =
            elided(entry.name + (entry.folder ? "/" : ""), ImGui::GetContentRegionAvail().x);
        if (ImGui::Selectable(
                (shown + "##entry").c_str(), b.selected == static_cast<int>(i),
                ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick)) {
            b.selected = static_cast<int>(i);
            b.take(i);
            // A double click and Enter take what a single click only selects.
            const bool keyboard =
                !ImGui::IsMouseReleased(0) && !ImGui::IsMouseClicked(0) && !ImGui::IsMouseDown(0);
            if (ImGui::IsMouseDoubleClicked(0) || keyboard) opened = entry.name;
        }
        c.named("file:" + entry.name);
        if (moved && b.selected == static_cast<int>(i)) ImGui::SetScrollHereY();
        ImGui::PopStyleColor();
        ImGui::PopID();
        ImGui::TableNextColumn();
        if (!entry.folder) rightText(c, bytesText(entry.bytes), palette::kDim);
    }
    ImGui::EndTable();
    if (!opened.empty()) hand(c, b.choose(opened));
}

}  // namespace

void browserDialog(Context& c) {
    Model& m = c.model;
    FileBrowser& b = c.state.browser;
    constexpr const char* kId = "###browser";
    if (!m.error.empty()) return;  // an error comes first; the browser is back after it
    if (m.browse != Browse::none && !ImGui::IsPopupOpen(kId)) {
        b.open(m.browse, m.browseFolder);
        ImGui::OpenPopup(kId);
    }
    const Words words = wordsOf(m.browse);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const ImVec2 size(std::min(c.px(660), display.x - c.px(24)),
                      std::min(c.px(480), display.y - c.px(24)));
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(size);
    bool open = true;
    if (!ImGui::BeginPopupModal((std::string(words.title) + kId).c_str(), &open,
                                ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings)) {
        if (m.browse != Browse::none && !open) m.browse = Browse::none;
        return;
    }
    const ImVec2 at = ImGui::GetWindowPos();
    c.named("panel:browser", {at.x, at.y, size.x, size.y});
    if (button(c, "browser.parent", "Up")) b.enterParent();
    tooltip("The folder above");
    ImGui::SameLine();
    if (button(c, "browser.home", "Home")) b.enterHome();
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, palette::kDim);
    ImGui::TextUnformatted(elidedFront(b.folder(), ImGui::GetContentRegionAvail().x).c_str());
    ImGui::PopStyleColor();

    const float line = ImGui::GetFrameHeightWithSpacing();
    list(c, ImGui::GetContentRegionAvail().y - 3 * line - c.px(2));

    ImGui::SetNextItemWidth(-1);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    // Tab completes, or leaves the field where it cannot; what arrows have chosen since is put into
    // the text being edited. With history arrows do not leave it.
    const auto complete = [](ImGuiInputTextCallbackData* data) {
        auto& browser = *static_cast<FileBrowser*>(data->UserData);
        const std::string typed(data->Buf, static_cast<std::size_t>(data->BufTextLen));
        const bool completes = data->EventFlag == ImGuiInputTextFlags_CallbackCompletion;
        const std::string text = completes ? browser.completed(typed) : browser.takeChosen();
        if (completes && (text.empty() || text == typed)) ImGui::ClearActiveID();
        if (!text.empty()) {
            data->DeleteChars(0, data->BufTextLen);
            data->InsertChars(0, text.c_str());
        }
        return 0;
    };
    if (ImGui::InputTextWithHint(
            "##path", "name, or a path", b.typed, sizeof b.typed,
            ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
                ImGuiInputTextFlags_CallbackHistory | ImGuiInputTextFlags_CallbackAlways,
            complete, &b)) {
        hand(c, b.choose(b.typed));
        if (m.browse != Browse::none) ImGui::SetKeyboardFocusHere(-1);  // a folder was entered
    }
    c.named("browser.path");
    tooltip("Name or path",
            "Up and Down move through the list, Tab completes and then leaves to the buttons, "
            "Enter takes it.");
    std::string note = b.problem();
    if (note.empty() && b.replaces(b.typed)) {
        note = "This file exists and will be replaced.";
    }
    elidedText(note.empty() ? std::string(" ") : note, ImGui::GetContentRegionAvail().x,
               b.problem().empty() ? palette::kNotice : palette::kTrouble);
    bool all = b.allFiles();
    if (ImGui::Checkbox("all files", &all)) b.setAllFiles(all);
    c.named("browser.all");
    tooltip(words.what, "Shown by default; all files shows the others and hidden ones too.");
    const float wide = c.px(90), gap = ImGui::GetStyle().ItemSpacing.x;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 2 * wide - gap);
    if (button(c, "browser.accept", words.accept, wide)) hand(c, b.choose(b.typed));
    ImGui::SameLine();
    const bool escape =
        !ImGui::IsAnyItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
    if (button(c, "browser.cancel", "Cancel", wide) || escape) m.browse = Browse::none;
    if (!open) m.browse = Browse::none;
    m.browseFolder = b.folder();
    if (m.browse == Browse::none) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace mv::ui
