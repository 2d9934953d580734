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
    EXPECT_EQ(names, (std::set<std::string_view>{"fast", "balanced", "quality", "bench",
                                                 "paper-megaviews", "paper-manylods"}));
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
    // The rules of the papers do not outlive their presets; method and tone map stay chosen.
    applyPreset(settings, preset("paper-manylods"));
    applyPreset(settings, preset("balanced"));
    EXPECT_EQ(settings.side[0].method, Method::manylods);
    EXPECT_EQ(settings.display.toneMap, ToneMap::aces);
    setMethod(settings, Method::megaviews);
    settings.display.toneMap = ToneMap::agx;
    EXPECT_EQ(settings, Settings());
}

TEST(Presets, ThePapersAreAsPublished) {
    for (const char* name : {"paper-megaviews", "paper-manylods"}) {
        Settings settings;
        applyPreset(settings, preset(name));
        EXPECT_EQ(settings.side[0].rules, kPublishedRules);
        EXPECT_EQ(settings.side[0].pairs.traversal, Traversal::queue);
        EXPECT_EQ(settings.scene.octreeDepth, 11);
        EXPECT_EQ(settings.views.octreeDepth, 11);
        EXPECT_EQ(settings.side[0].maps.resolution, 16);
        EXPECT_EQ(settings.gather.samples, 64);
        EXPECT_EQ(settings.views.vpls, 65536);
        EXPECT_EQ(settings.views.bounces, 4);
        EXPECT_FALSE(settings.side[0].pairs.holeFill);
        EXPECT_EQ(settings.display.toneMap, ToneMap::aces);
        EXPECT_EQ(settings.side[0].method,
                  name == std::string("paper-manylods") ? Method::manylods : Method::megaviews);
    }
}

TEST(Presets, QualityAsksForMoreThanBalancedForMoreThanFast) {
    Settings fast, balanced, quality;
    applyPreset(fast, preset("fast"));
    applyPreset(balanced, preset("balanced"));
    applyPreset(quality, preset("quality"));
    EXPECT_LT(fast.views.vpls, balanced.views.vpls);
    EXPECT_LT(balanced.views.vpls, quality.views.vpls);
    EXPECT_LT(fast.scene.octreeDepth, balanced.scene.octreeDepth);
    EXPECT_LT(fast.side[0].maps.resolution, balanced.side[0].maps.resolution);
    EXPECT_LT(balanced.side[0].maps.resolution, quality.side[0].maps.resolution);
    EXPECT_LT(fast.gather.samples, balanced.gather.samples);
    EXPECT_LT(balanced.gather.samples, quality.gather.samples);
    EXPECT_GT(fast.gather.cull.scale, balanced.gather.cull.scale);
    EXPECT_GT(quality.picture.accumulate, balanced.picture.accumulate);
}

TEST(Presets, EqualSidesAreNotCompared) {
    Settings settings;
    compareWith(settings, Method::manylods);
    settings.display.difference = Difference::absolute;
    Settings same = settings;
    applyPreset(same, preset("paper-manylods"));
    EXPECT_FALSE(same.compare);
    EXPECT_EQ(same.display.difference, Difference::off);
    validate(same);
    // Sides that still differ stay.
    applyPreset(settings, preset("paper-megaviews"));
    EXPECT_TRUE(settings.compare);
    EXPECT_EQ(settings.side[1].method, Method::manylods);
    EXPECT_EQ(settings.display.difference, Difference::absolute);
}

}  // namespace
}  // namespace mv
