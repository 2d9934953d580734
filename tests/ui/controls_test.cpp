// What the mouse and the keyboard do to the widgets of settings.

#include <gtest/gtest.h>

#include "megaviews/settings/settings_table.h"
#include "screen.h"

namespace mv::ui {
namespace {

// Everything of the controls in sight, both sides of a comparison too.
void openAll(Screen& s) {
    compareWith(s.settings, Method::manylods);
    s.settings.display.difference = Difference::absolute;
    s.statistics.methods.resize(2);
    s.frame(2);
    for (const char* group : {"Scene", "Method", "Views", "Gather", "Picture", "Instruments"}) {
        s.click(std::string("group:") + group);
    }
}

// Another value than the default, of any kind of setting.
std::string otherValue(const SettingInfo& setting) {
    if (setting.key == "compare") return "none";
    if (setting.key == "lights") return "0:1,2,3";
    if (std::holds_alternative<Field<bool>>(setting.field)) {
        return toText(Settings{}, setting) == "on" ? "off" : "on";
    }
    if (const auto* choice = std::get_if<ChoiceField>(&setting.field)) {
        const std::string first(choice->names[0]);
        return toText(Settings{}, setting) == first ? std::string(choice->names[1]) : first;
    }
    if (const auto* set = std::get_if<SetField>(&setting.field)) {
        return std::string(set->names[0]) + "," + std::string(set->names[4]);
    }
    if (std::holds_alternative<TextField>(setting.field)) return "x";
    if (std::holds_alternative<Field<Size>>(setting.field)) return "640x480";
    if (valueRange(setting) == "X,Y,Z" || setting.key == "camera-position" ||
        setting.key == "camera-target" || setting.key == "camera-up") {
        return setting.key == "camera-target" ? "4,5,7" : "1,2,3";
    }
    if (setting.key == "difference-range") return "0.5";
    if (setting.powerOfTwo) return setting.maximum == 32 ? "16" : "32";
    const std::string standard = toText(Settings{}, setting);
    return setting.maximum >= 100 ? "7" : standard == "1" ? "2" : "1";
}

// As on the command line, with its suffixes and its complaints.

TEST(Controls, ValuesAreTyped) {
    Screen s(1280, 4000, 1);
    openAll(s);
    const auto enter = [&](const char* key, const char* text) {
        ImGui::GetIO().KeyCtrl = true;
        s.click(key);
        ImGui::GetIO().KeyCtrl = false;
        s.frame(2);
        s.type(text);
        s.press(ImGuiKey_Enter);
        s.frame(2);
    };
    enter("vpls", "2K");
    EXPECT_EQ(s.settings.views.vpls, 2048);
    enter("vpls", "3000");
    EXPECT_EQ(s.settings.views.vpls, 3000);
    enter("view-res", "32");
    EXPECT_EQ(s.settings.side[0].maps.resolution, 32);
    enter("bias", "0.25");
    EXPECT_EQ(s.settings.gather.bias, 0.25);
    const Settings before = s.settings;
    enter("vpls", "many");
    EXPECT_EQ(s.settings, before);
    ASSERT_FALSE(s.model.toasts.empty());
    EXPECT_NE(s.model.toasts.back().text.find("many"), std::string::npos);
    s.drag("vpls", 30, 0);
    EXPECT_NE(s.settings, before) << "and dragged as before";
}

TEST(Controls, EverySettingHasATooltipAndIsResetByItsMenu) {
    Screen s(1280, 4000, 1);
    openAll(s);
    const Settings base = s.settings;
    for (const SettingInfo& setting : settingsTable()) {
        const std::string key(setting.key);
        s.settings = base;
        if (hasDefault(s.settings, setting)) {
            setFromText(s.settings, setting, otherValue(setting), key);
        }
        ASSERT_FALSE(hasDefault(s.settings, setting)) << key;
        s.frame(2);
        s.point(key);
        EXPECT_TRUE(s.tooltip()) << key;
        if (key == "camera") continue;  // chosen from the scene's; no menu
        s.click(key, 1);
        s.click("reset:" + key);
        EXPECT_TRUE(hasDefault(s.settings, setting)) << key << " " << toText(s.settings, setting);
        s.pointAt(400, 400);
        s.press(ImGuiKey_Escape);
    }
}

TEST(Controls, SlidersAreDraggedAndTyped) {
    Screen s(1280, 720, 1);
    s.frame(2);
    const std::int64_t before = s.settings.views.vpls = 4096;  // left of the slider's middle
    s.drag("vpls", 40, 0);
    EXPECT_GT(s.settings.views.vpls, before);
    s.drag("vpls", -4000, 0);
    EXPECT_EQ(s.settings.views.vpls, 1);
    ImGui::GetIO().KeyCtrl = true;
    s.click("vpls");
    ImGui::GetIO().KeyCtrl = false;
    s.type("12345");
    s.press(ImGuiKey_Enter);
    EXPECT_EQ(s.settings.views.vpls, 12345);
    s.drag("view-res", 4000, 0);
    EXPECT_EQ(s.settings.side[0].maps.resolution, 256);  // powers of two only
    s.drag("view-res", -50, 0);
    EXPECT_EQ(s.settings.side[0].maps.resolution, 16);
}

TEST(Controls, ChoicesAreMadeFromTheirLists) {
    Screen s(1280, 720, 1);
    s.frame(2);
    s.click("method");
    s.click("method=manylods");
    EXPECT_EQ(s.settings.side[0].method, Method::manylods);
    s.click("view");
    s.click("view=normals");
    EXPECT_EQ(s.settings.picture.view, DebugView::normals);
    s.click("camera");
    s.click("camera=Gallery");
    EXPECT_EQ(s.settings.camera.name, "Gallery");
    s.model.cameras = {"Nave", "Nave", ""};
    s.click("camera");
    s.click("camera=1");
    EXPECT_EQ(s.settings.camera.name, "1");
    s.click("camera");
    s.click("camera=Nave");
    EXPECT_EQ(s.settings.camera.name, "Nave");
}

TEST(Controls, ASideThatTakesTheOthersMethodGivesItsOwn) {
    Screen s(1280, 720, 1);
    compareWith(s.settings, Method::manylods);
    s.frame(2);
    s.click("method");
    s.click("method=manylods");
    EXPECT_EQ(s.settings.side[0].method, Method::manylods);
    EXPECT_TRUE(s.settings.compare);
    EXPECT_EQ(s.settings.side[1].method, Method::megaviews);
    // With rules of its own a side may run the same method.
    s.settings.side[1].rules = kPublishedRules;
    s.click("compare");
    s.click("compare=manylods");
    EXPECT_EQ(s.settings.side[0].method, Method::manylods);
    EXPECT_TRUE(s.settings.compare);
    EXPECT_EQ(s.settings.side[1].method, Method::manylods);
    s.settings.display.difference = Difference::absolute;
    s.click("compare");
    s.click("compare=off");
    EXPECT_FALSE(s.settings.compare);
    EXPECT_EQ(s.settings.display.difference, Difference::off);
}

TEST(Controls, RulesAreTakenTogetherOrOneByOne) {
    Screen s(1280, 720, 1);
    s.frame(2);
    s.click("rules");
    s.click("rules:boxes");
    EXPECT_EQ(s.settings.side[0].rules, kCorrectedRules & ~kRuleBoxes);
    s.click("rules:radius");  // the list is still open
    EXPECT_EQ(s.settings.side[0].rules, kCorrectedRules & ~(kRuleBoxes | kRuleRadius));
    s.click("rules:boxes");
    EXPECT_EQ(s.settings.side[0].rules, kCorrectedRules & ~kRuleRadius);
    s.click("rules=published");
    EXPECT_EQ(s.settings.side[0].rules, kPublishedRules);
}

TEST(Controls, AContradictionIsNotTakenOverAndSaysWhy) {
    Screen s(1280, 720, 1);
    compareWith(s.settings, Method::megaviews);
    s.settings.side[1].rules = kPublishedRules;
    s.frame(2);
    s.click("compare-rules");
    s.click("compare-rules=as left");
    EXPECT_EQ(s.settings.side[1].rules, kPublishedRules);
    ASSERT_FALSE(s.model.toasts.empty());
    EXPECT_NE(s.model.toasts.back().text.find("same"), std::string::npos);
}

TEST(Controls, TextsAreCheckedAsOnTheCommandLine) {
    Screen s(1280, 1400, 1);
    s.frame(2);
    s.click("group:Scene");
    s.click("lights");
    s.type("nonsense");
    s.press(ImGuiKey_Enter);
    EXPECT_EQ(s.settings.scene.lights, "");
    EXPECT_EQ(s.model.toasts.size(), 1u);
    std::string many;  // and are of any length
    for (int i = 0; i < 40; ++i) many += (i ? " " : "") + std::to_string(i) + ":1.5,2.5,3.5:0,-1,0";
    s.click("lights");
    s.type(many);
    s.press(ImGuiKey_Enter);
    EXPECT_EQ(s.settings.scene.lights, many);
    s.click("animation");
    s.type("Walk");
    s.press(ImGuiKey_Enter);
    EXPECT_EQ(s.settings.scene.animation, "Walk");
}

TEST(Controls, ExposureGoesBetweenFittedAndGiven) {
    Screen s(1280, 720, 1);
    s.frame(2);
    s.click("exposure:auto");
    EXPECT_EQ(s.settings.display.exposureEv, s.statistics.exposureEv);
    s.click("exposure:auto");
    EXPECT_FALSE(s.settings.display.exposureEv);
}

// What is automatic until then begins at a value that may be given.
TEST(Controls, WhatWasAutomaticBeginsWithinItsRange) {
    Screen s(1280, 1400, 1);
    s.frame(2);
    s.click("group:Gather");
    s.click("clamp-distance:auto");
    ASSERT_TRUE(s.settings.gather.clampDistance);
    EXPECT_LE(*s.settings.gather.clampDistance, findSetting("clamp-distance")->maximum);
}

}  // namespace
}  // namespace mv::ui
