#include "app/viewer/system_fonts.h"

#include <fontconfig/fontconfig.h>
#include <imgui.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <string_view>
#include <utility>

namespace mv {
namespace {

template <auto release>
struct Release {
    template <typename T>
    void operator()(T* held) const {
        release(held);
    }
};
using Configuration = std::unique_ptr<FcConfig, Release<FcConfigDestroy>>;
using Pattern = std::unique_ptr<FcPattern, Release<FcPatternDestroy>>;
using Characters = std::unique_ptr<FcCharSet, Release<FcCharSetDestroy>>;
using FontSet = std::unique_ptr<FcFontSet, Release<FcFontSetDestroy>>;

// All fonts, those that have most of the characters first.
FontSet fontsFor(const std::set<char32_t>& characters, FcConfig* configuration) {
    const Characters wanted(FcCharSetCreate());
    for (const char32_t c : characters) FcCharSetAddChar(wanted.get(), c);
    const Pattern pattern(FcPatternCreate());
    FcPatternAddCharSet(pattern.get(), FC_CHARSET, wanted.get());
    FcPatternAddString(pattern.get(), FC_FAMILY, reinterpret_cast<const FcChar8*>("sans-serif"));
    FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
    FcConfigSubstitute(configuration, pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    FcResult result = FcResultMatch;
    return FontSet(FcFontSort(configuration, pattern.get(), FcTrue, nullptr, &result));
}

bool hasAny(FcPattern* font, const std::set<char32_t>& characters) {
    FcCharSet* has = nullptr;
    if (FcPatternGetCharSet(font, FC_CHARSET, 0, &has) != FcResultMatch) return false;
    for (const char32_t c : characters) {
        if (FcCharSetHasChar(has, c)) return true;
    }
    return false;
}

// Empty if it is of another kind than Dear ImGui reads.
ui::FontFile read(FcPattern* font) {
    FcChar8* path = nullptr;
    ui::FontFile file;
    if (FcPatternGetString(font, FC_FILE, 0, &path) != FcResultMatch ||
        FcPatternGetInteger(font, FC_INDEX, 0, &file.face) != FcResultMatch) {
        return {};
    }
    file.face &= 0xffff;  // above it a variable font's named instance
    std::ifstream in(reinterpret_cast<const char*>(path), std::ios::binary);
    file.data.assign(std::istreambuf_iterator<char>(in), {});
    using namespace std::string_view_literals;
    for (const std::string_view kind : {"\0\1\0\0"sv, "true"sv, "OTTO"sv, "ttcf"sv}) {
        if (file.data.size() > kind.size() &&
            std::equal(kind.begin(), kind.end(), file.data.begin())) {
            return file;
        }
    }
    return {};
}

// Takes from `characters` what Dear ImGui draws with this font: nothing if it cannot read it.
bool draws(const ui::FontFile& font, std::set<char32_t>& characters) {
    if (font.data.empty()) return false;
    ImFontGlyphRangesBuilder builder;
    for (const char32_t c : characters) builder.AddChar(static_cast<ImWchar>(c));
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.FontNo = font.face;
    ImFontAtlas trial;
    const ImFont* drawn =
        trial.AddFontFromMemoryTTF(const_cast<unsigned char*>(font.data.data()),
                                   static_cast<int>(font.data.size()), 16, &config, ranges.Data);
    return trial.Build() && std::erase_if(characters, [&](char32_t c) {
                                return drawn->FindGlyphNoFallback(static_cast<ImWchar>(c));
                            }) > 0;
}

}  // namespace

std::vector<ui::FontFile> systemFonts(std::set<char32_t> characters) {
    std::vector<ui::FontFile> found;
    const Configuration configuration(FcInitLoadConfigAndFonts());
    if (!configuration) return found;
    const FontSet fonts = fontsFor(characters, configuration.get());
    for (int i = 0; fonts && i < fonts->nfont && !characters.empty(); ++i) {
        if (!hasAny(fonts->fonts[i], characters)) continue;
        ui::FontFile font = read(fonts->fonts[i]);
        if (draws(font, characters)) found.push_back(std::move(font));
    }
    if (!characters.empty()) {
        spdlog::debug("no font of the system has {} of the characters", characters.size());
    }
    return found;
}

}  // namespace mv
