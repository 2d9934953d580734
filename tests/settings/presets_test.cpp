// Presets set what they say, leave the rest alone, and nothing of one stays behind in the next.

#include "megaviews/settings/presets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

const PresetInfo& preset(std::string_view name) {
    const PresetInfo* found = findPreset(name);
    if (!found) throw std::runtime_error("no preset " + std::string(name));
    return *found;
}

TEST(Presets, AreNamedOnceAndDescribed) {
    std::set<std::string_view> names;
    for (const PresetInfo& p : presetsTable()) {
        EXPECT_TRUE(names.insert(p.name).second) << p.name;
        EXPECT_TRUE(p.help.ends_with(".")) << p.name;
        EXPECT_EQ(findPreset(p.name), &p);
    }
    EXPECT_EQ(names, (std::set<std::string_view>{"fast", "balanced", "quality", "paper-megaviews",
                                                 "paper-manylods"}));
    EXPECT_EQ(findPreset("Fast"), nullptr);
}

TEST(Presets, SetTheirValuesAndNothingElse) {
    for (const PresetInfo& p : presetsTable()) {
        // From settings that differ from every preset wherever they can.
        Settings before;
        for (const auto& [key, value] :
             std::vector<std::pair<const char*, const char*>>{{"vpls", "77"},
                                                              {"scene-depth", "5"},
                                                              {"view-depth", "4"},
                                                              {"view-res", "128"},
                                                              {"gather-samples", "3"},
                                                              {"accumulate", "7"},
                                                              {"fusion", "off"},
                                                              {"filter", "off"},
                                                              {"cull-level", "2"},
                                                              {"cutoff", "0.5"},
                                                              {"bounces", "9"},
                                                              {"method", "none"},
                                                              {"seed", "12"},
                                                              {"exposure", "2"},
                                                              {"camera-position", "1,2,3"}}) {
            setFromText(before, *findSetting(key), value, key);
        }
        Settings after = before;
        const std::vector<std::string> keys = applyPreset(after, p);
        EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), p.values.size());
        validate(after);
        for (const SettingInfo& s : settingsTable()) {
            const auto given = std::find_if(p.values.begin(), p.values.end(),
                                            [&](const auto& v) { return v.first == s.key; });
            if (given == p.values.end()) {
                EXPECT_EQ(toText(after, s), toText(before, s)) << p.name << ": " << s.key;
                continue;
            }
            Settings one;
            setFromText(one, s, given->second, "");
            EXPECT_EQ(toText(after, s), toText(one, s)) << p.name << ": " << s.key;
        }
    }
}

TEST(Presets, BalancedIsTheDefault) {
    Settings settings;
    applyPreset(settings, preset("quality"));
    EXPECT_NE(settings, Settings());
    applyPreset(settings, preset("balanced"));
    EXPECT_EQ(settings, Settings());
    // The rules of the papers do not outlive their presets; the method stays chosen.
    applyPreset(settings, preset("paper-manylods"));
    applyPreset(settings, preset("balanced"));
    EXPECT_EQ(settings.method, Method::manylods);
    settings.method = Method::megaviews;
    EXPECT_EQ(settings, Settings());
}

TEST(Presets, ThePapersAreAsPublished) {
    for (const char* name : {"paper-megaviews", "paper-manylods"}) {
        Settings settings;
        applyPreset(settings, preset(name));
        EXPECT_EQ(settings.rules, Rules::published);
        EXPECT_EQ(settings.traversal, Traversal::queue);
        EXPECT_EQ(settings.sceneDepth, 11);
        EXPECT_EQ(settings.viewDepth, 11);
        EXPECT_EQ(settings.viewRes, 16);
        EXPECT_EQ(settings.gatherSamples, 64);
        EXPECT_EQ(settings.vpls, 65536);
        EXPECT_EQ(settings.bounces, 4);
        EXPECT_FALSE(settings.holeFill);
        EXPECT_EQ(settings.method,
                  name == std::string("paper-manylods") ? Method::manylods : Method::megaviews);
    }
}

TEST(Presets, QualityAsksForMoreThanBalancedForMoreThanFast) {
    Settings fast, balanced, quality;
    applyPreset(fast, preset("fast"));
    applyPreset(balanced, preset("balanced"));
    applyPreset(quality, preset("quality"));
    EXPECT_LT(fast.vpls, balanced.vpls);
    EXPECT_LT(balanced.vpls, quality.vpls);
    EXPECT_LT(fast.sceneDepth, balanced.sceneDepth);
    EXPECT_LT(fast.viewRes, balanced.viewRes);
    EXPECT_LT(balanced.viewRes, quality.viewRes);
    EXPECT_LT(fast.gatherSamples, balanced.gatherSamples);
    EXPECT_LT(balanced.gatherSamples, quality.gatherSamples);
    EXPECT_GT(fast.gatherScale, balanced.gatherScale);
    EXPECT_GT(quality.accumulate, balanced.accumulate);
}

TEST(Presets, EqualSidesAreNotCompared) {
    Settings settings;
    settings.compare = Method::manylods;
    settings.difference = Difference::absolute;
    Settings same = settings;
    applyPreset(same, preset("paper-manylods"));
    EXPECT_FALSE(same.compare);
    EXPECT_EQ(same.difference, Difference::off);
    validate(same);
    // Sides that still differ stay.
    applyPreset(settings, preset("paper-megaviews"));
    EXPECT_EQ(settings.compare, Method::manylods);
    EXPECT_EQ(settings.difference, Difference::absolute);
}

}  // namespace
}  // namespace mv
