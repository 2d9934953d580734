// The characters that the font lacks, looked for where text comes in that is not the program's own:
// names and paths of files, messages about them, what is typed.

#include <imgui.h>
#include <imgui_internal.h>

#include "ui/panels.h"

namespace mv::ui {
namespace {

class Missing {
  public:
    explicit Missing(Context& c)
        : font_(*ImGui::GetIO().Fonts->Fonts[0]), into_(c.state.drawn.missing) {}

    void note(ImWchar c) {
        if (c > ' ' && !font_.FindGlyphNoFallback(c)) into_.insert(c);
    }
    void note(std::string_view text) {
        const char *at = text.data(), *end = at + text.size();
        while (at < end) {
            unsigned c = static_cast<unsigned char>(*at);
            at += c < 0x80 ? 1 : ImTextCharFromUtf8(&c, at, end);
            if (c <= IM_UNICODE_CODEPOINT_MAX) note(static_cast<ImWchar>(c));
        }
    }
    void note(const std::vector<std::string>& texts) {
        for (const std::string& text : texts) note(text);
    }
    template <class... Texts>
    void operator()(const Texts&... texts) {
        (note(texts), ...);
    }

  private:
    const ImFont& font_;
    std::set<char32_t>& into_;
};

}  // namespace

// Before a field takes them.
void noteTyped(Context& c) {
    Missing missing(c);
    for (const ImWchar typed : ImGui::GetIO().InputQueueCharacters) missing.note(typed);
}

void noteMissing(Context& c) {
    const Model& m = c.model;
    Missing missing(c);
    missing(m.sceneName, m.cameras, m.animations, m.variants, m.warnings, m.notes, m.extensions,
            m.ignored, m.loadingStage, m.error, m.errorHint, m.referenceStage);
    for (const LightRow& light : m.lights) missing(light.name);
    for (const RecentFile& file : m.recent) missing(file.path);
    for (const Toast& toast : m.toasts) missing(toast.text);
    for (const std::string& error : m.shaderErrors) missing(error);
    for (const auto* tables : {&m.errors.tables, &m.errors.maps}) {
        for (const ErrorTable& table : *tables) missing(table.of, table.against, table.reason);
    }
    if (m.browse == Browse::none) return;
    const FileBrowser& browser = c.state.browser;
    missing(browser.folder(), browser.problem(), std::string_view(browser.typed));
    for (const FileBrowser::Entry& entry : browser.entries()) missing(entry.name);
}

}  // namespace mv::ui
