#include "megaviews/settings/presets.h"

#include <algorithm>

#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using Values = std::vector<std::pair<std::string_view, std::string_view>>;

// Every preset gives the same keys, so that nothing of these is left behind in the next. What
// paper() and bench() give on top stays, for a preset of quality takes nobody's light away.
Values with(std::string_view views, std::string_view maps, std::string_view levels,
            std::string_view mapRes, std::string_view samples, std::string_view scale,
            std::string_view accumulate, std::string_view pixelSamples, std::string_view history,
            std::string_view skySamples, bool published) {
    return {{"vpls", views},
            {"maps", maps},
            {"scene-depth", levels},
            {"view-depth", levels},
            {"view-res", mapRes},
            {"gather-samples", samples},
            {"gather-candidates", published ? "1" : "32"},
            {"gather-scale", scale},
            {"accumulate", accumulate},
            {"pixel-samples", pixelSamples},
            {"fresh-views", published ? "off" : "on"},
            {"temporal", history == "0" ? "off" : "on"},
            {"traversal", published ? "queue" : "lists"},
            {"rules", published ? "published" : "corrected"},
            {"fusion", "on"},
            {"hole-fill", published ? "off" : "on"},  // the papers fill above 16 texels only
            {"cull-level", published ? "6" : "7"},
            {"cutoff", "0"},
            {"placement", published ? "traced" : "importance"},
            {"clamp-distance", published ? "0.01" : "auto"},
            {"near-field", published ? "off" : "on"},
            {"map-check", published ? "0" : "0.6"},
            {"undecided", published ? "off" : "rays"},
            {"history", history},
            {"sky-samples", skySamples},
            {"filter", "on"},
            {"limit-fireflies", published ? "off" : "on"},
            {"second-look", published ? "off" : "on"},
            {"materials", published ? "lambert" : "full"}};
}

Values paper(std::string_view method) {
    Values values = with("64K", "0", "11", "16", "64", "1", "1", "1", "0", "4", true);
    values.emplace_back("method", method);
    values.emplace_back("bounces", "4");
    values.emplace_back("tonemap", "aces");  // errors of display values stay comparable
    return values;
}

// What comparisons of light and speed are made with, whatever the defaults become: the scene's own
// lights, four bounces, one frame by itself.
Values bench() {
    Values values = with("4K", "0", "11", "16", "8", "1", "1", "1", "0", "4", false);
    for (const auto& [key, value] : Values{{"materials", "lambert"},
                                           {"fresh-views", "off"},
                                           {"bounces", "4"},
                                           {"bias", "1"},
                                           {"light-scale", "1"},
                                           {"lights", ""},
                                           {"environment", "none"},
                                           {"particles", "0"},
                                           {"tonemap", "aces"}}) {
        const auto same =
            std::find_if(values.begin(), values.end(),
                         [name = key](const auto& given) { return given.first == name; });
        if (same != values.end()) {
            same->second = value;
        } else {
            values.emplace_back(key, value);
        }
    }
    return values;
}

}  // namespace

std::span<const PresetInfo> presetsTable() {
    static const std::vector<PresetInfo> table = {
        {"fast", "Few views and samples on coarse octrees, for moving about.",
         with("1K", "0", "8", "8", "4", "2", "1", "1", "16", "1", false)},
        {"balanced", "The defaults of the method.",
         with("64K", "4K", "11", "16", "8", "1", "1", "1", "0", "4", false)},
        {"quality", "Many views and samples, larger maps, and frames averaged at rest.",
         with("256K", "16K", "11", "32", "64", "1", "16", "16", "0", "8", false)},
        {"bench", "What measurements are made with: frozen, whatever the defaults become.",
         bench()},
        {"paper-megaviews",
         "MegaViews as published: pair queue, printed rules, 11 levels, maps of 16 x 16, 64 "
         "samples.",
         paper("megaviews")},
        {"paper-manylods",
         "ManyLoDs under the same conditions as paper-megaviews: a cut for each view.",
         paper("manylods")},
    };
    return table;
}

const PresetInfo* findPreset(std::string_view name) {
    const auto table = presetsTable();
    const auto it = std::find_if(table.begin(), table.end(),
                                 [&](const PresetInfo& p) { return p.name == name; });
    return it == table.end() ? nullptr : &*it;
}

std::vector<std::string> applyPreset(Settings& settings, const PresetInfo& preset) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : preset.values) {
        setFromText(settings, *findSetting(key), value, "preset " + std::string(preset.name));
        keys.emplace_back(key);
    }
    if (settings.compare && settings.side[0] == settings.side[1]) {
        settings.compare = false;
        settings.display.difference = Difference::off;
    }
    return keys;
}

}  // namespace mv
