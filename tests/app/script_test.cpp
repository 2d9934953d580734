// Scripts of user actions: what each command reads as, what is refused and where, and that no text
// whatever does anything else.

#include "app/common/script.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv::script {
namespace {

Script parsed(const std::string& text) { return parse(text, "--actions"); }

template <typename T>
T only(const std::string& text) {
    SCOPED_TRACE(text);
    const Script script = parsed(text);
    if (script.size() != 1 || !std::holds_alternative<T>(script[0].step)) {
        ADD_FAILURE() << text << " is something else";
        return T{};
    }
    EXPECT_EQ(script[0].number, 1);
    return std::get<T>(script[0].step);
}

TEST(Script, EveryActionIsACommand) {
    for (const ActionInfo& info : actionsTable()) {
        EXPECT_EQ(only<Perform>(idOf(info)).action, info.action) << info.name;
        // Some are named as a setting is: "views".
        if (!findSetting(idOf(info))) {
            EXPECT_THROW(parsed(idOf(info) + " = 3"), Error) << info.name;
        }
    }
}

TEST(Script, EverySettingIsACommand) {
    for (const SettingInfo& info : settingsTable()) {
        const std::string key(info.key), value = mv::toText(Settings{}, info);
        const auto set = only<SetValue>(key + "=" + value);
        EXPECT_EQ(set.key, key);
        EXPECT_EQ(set.value, value);
        EXPECT_EQ(only<SetValue>(key + " =  " + value).value, value);
        EXPECT_EQ(only<SetValue>(key + "=\"" + value + "\"").value, value);
        EXPECT_EQ(only<Expect>("expect " + key + "=" + value).value, value);
        EXPECT_TRUE(only<Expect>("expect " + key + "!=" + value).differs);
    }
}

TEST(Script, CommandsReadAsTheyAreWritten) {
    EXPECT_EQ(only<Wait>("wait 12").frames, 12);
    EXPECT_EQ(only<Wait>("wait").frames, 1);
    only<WaitLoading>("wait-loading");
    only<WaitStill>("wait-still");

    EXPECT_EQ(only<Move>("move 12,34.5").to, (Place{Place::Kind::pixels, 12, 34.5, ""}));
    EXPECT_EQ(only<Move>("hover @vpls").to, (Place{Place::Kind::widget, 0, 0, "vpls"}));
    EXPECT_EQ(only<Move>("hover @\"Open Recent\"").to.widget, "Open Recent");
    EXPECT_EQ(only<Move>("move 50%,25%").to, (Place{Place::Kind::share, 0.5, 0.25, ""}));

    EXPECT_EQ(only<Click>("click 1,2").button, Button::left);
    EXPECT_EQ(only<Click>("click 1,2 middle").button, Button::middle);
    EXPECT_EQ(only<Click>("right-click @vpls").button, Button::right);
    EXPECT_EQ(only<Click>("middle-click @vpls").button, Button::middle);
    EXPECT_EQ(only<Click>("double-click 1,2").count, 2);
    EXPECT_EQ(only<Click>("click 1,2").count, 1);

    const auto drag = only<Drag>("drag 1,2 30,40 right");
    EXPECT_EQ(drag.to, (Place{Place::Kind::pixels, 30, 40, ""}));
    EXPECT_EQ(drag.button, Button::right);
    EXPECT_FALSE(drag.by);
    const auto by = only<Drag>("drag @split by -50,0");
    EXPECT_EQ(by.from.widget, "split");
    EXPECT_EQ(by.to.x, -50);
    EXPECT_TRUE(by.by);

    EXPECT_EQ(only<Scroll>("scroll -2.5").steps, -2.5);
    EXPECT_EQ(only<Type>("type \"a; b # c\"").text, "a; b # c");
    EXPECT_EQ(only<Type>("type say \"it\" twice").text, "say it twice");
    EXPECT_EQ(only<Type>("type \"\\\"1\\\\2\\\"\"").text, "\"1\\2\"");
    EXPECT_EQ(only<Resize>("resize 640x480").height, 480);
    EXPECT_EQ(only<Open>("open my scene.glb").file, "my scene.glb");
    EXPECT_FALSE(only<Open>("open a.glb").dropped);
    EXPECT_TRUE(only<Open>("drop \"a;b.glb\"").dropped);
    EXPECT_EQ(only<Open>("drop \"a;b.glb\"").file, "a;b.glb");
    EXPECT_EQ(only<Open>("load-state s.json").file, "s.json");
    EXPECT_EQ(only<SetTime>("time -1.5").timeS, -1.5);
    EXPECT_EQ(only<Save>("save a.exr").what, Save::What::picture);
    EXPECT_EQ(only<Save>("save-window a.png").what, Save::What::window);
    EXPECT_EQ(only<Save>("save-state a.json").what, Save::What::state);
    EXPECT_EQ(only<Save>("save-scene a.GLB").what, Save::What::scene);
    EXPECT_EQ(outputFiles(parsed(
                  "save a.png; wait; save-window b.png; save-state c.json; save-scene d.glb")),
              (std::vector<std::string>{"a.png", "b.png", "c.json", "d.glb"}));
}

TEST(Script, ActionAndCommandOfOneNameAreToldApart) {
    EXPECT_EQ(only<Perform>("open").action, Action::open);
    EXPECT_EQ(only<Perform>("save-state").action, Action::saveState);
    EXPECT_EQ(only<Perform>("save-scene").action, Action::saveScene);
    EXPECT_EQ(only<SetValue>("time=3").value, "3");
    EXPECT_EQ(only<SetValue>("time = 3").value, "3");
    EXPECT_EQ(only<SetTime>("time 3").timeS, 3);
}

TEST(Script, ChordsAreNamedAsInTheTableOfActions) {
    const auto chord = only<Key>("key Ctrl+Shift+z").chord;
    EXPECT_EQ(chord, (Chord{true, true, false, "Z"}));
    EXPECT_EQ(toText(chord), "Ctrl+Shift+Z");
    EXPECT_EQ(only<Key>("hold Shift").chord, (Chord{false, true, false, ""}));
    EXPECT_EQ(toText(*parseChord("Shift")), "Shift");
    EXPECT_EQ(only<Key>("hold X").what, Key::What::hold);
    EXPECT_EQ(only<Key>("release X").what, Key::What::release);
    for (const ActionInfo& info : actionsTable()) {
        std::istringstream keys{std::string(info.key)};
        for (std::string key; keys >> key;) {
            const auto read = parseChord(key);
            ASSERT_TRUE(read) << info.name << ": " << key;
            EXPECT_EQ(toText(*read), key);
        }
    }
    for (const char* bad :
         {"", "+", "Ctrl+", "Ctrl+Ctrl+A", "F13", "F0", "enter", "AB", "Ctrl A"}) {
        EXPECT_FALSE(parseChord(bad)) << bad;
    }
}

TEST(Script, LinesSemicolonsAndCommentsSeparate) {
    const Script script = parsed(
        "# a script\n"
        "next-method; vpls = 4K;;\r\n"
        "  ; # nothing\n"
        "\twait 3 # then; not this\n"
        "open scene#2.glb; type \"# no comment\"; quit");
    ASSERT_EQ(script.size(), 6u);
    for (std::size_t i = 0; i < script.size(); ++i) {
        EXPECT_EQ(script[i].number, static_cast<int>(i) + 1);
    }
    EXPECT_EQ(script[1].text, "vpls = 4K");
    EXPECT_EQ(std::get<Open>(script[3].step).file, "scene#2.glb");
    EXPECT_EQ(std::get<Type>(script[4].step).text, "# no comment");
    EXPECT_TRUE(parsed("").empty());
    EXPECT_TRUE(parsed(" ;\n;# only this").empty());
    // What is quoted in messages is short and still UTF-8.
    const std::string word(100, '\xc3');
    std::string umlauts;
    for (int i = 0; i < 100; ++i) umlauts += "\xc3\xa4";
    const std::string quoted = parsed("type " + umlauts)[0].text;
    EXPECT_LT(quoted.size(), 70u);
    EXPECT_TRUE(quoted.ends_with("\xc3\xa4..."));
}

TEST(Script, ErrorsNameTheCommand) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"wait; wait 2; nxt-method",
         "--actions: command 3: unknown action 'nxt-method'; did you mean next-method?"},
        {"qwertyuiop", "unknown action 'qwertyuiop'; --list actions names all"},
        {"next-method now", "command 1: 'now' is more than this command takes"},
        {"vpl=3", "command 1: unknown setting 'vpl'; did you mean vpls?"},
        {"vpls=many", "command 1: vpls: 'many' is not a number"},
        {"vpls=0", "vpls: '0' is outside"},
        {"method=megaview", "did you mean megaviews?"},
        {"expect vpls", "'vpls' is not KEY=VALUE or KEY!=VALUE"},
        {"expect vpl=3", "unknown setting 'vpl'"},
        {"expect vpls=x", "'x' is not a number"},
        {"expect", "is not KEY=VALUE"},
        {"vpls!=3", "unknown action 'vpls!=3'"},
        {"wait -1", "'-1' is outside 0..1000000"},
        {"wait 1.5", "'1.5' is not a whole number"},
        {"wait 1 2", "'2' is more than this command takes"},
        {"wait-still 3", "'3' is more than this command takes"},
        {"move", "'move' lacks a place"},
        {"move 3", "'3' is no place"},
        {"move 3,x", "'x' is not a number"},
        {"move 10%,5", "mixes pixels and shares"},
        {"move 101%,5%", "outside"},
        {"move nan,1", "'nan' is not a number"},
        {"click @", "'@' names no widget"},
        {"click 1,2 up", "'up' is no mouse button"},
        {"click 1,2 left right", "'right' is more than"},
        {"right-click 1,2 left", "'left' is more than"},
        {"drag 1,2", "lacks where it ends"},
        {"drag 1,2 by", "lacks a distance"},
        {"drag 1,2 by @vpls", "'@vpls' is no distance"},
        {"scroll", "lacks steps"},
        {"scroll up", "'up' is not a number"},
        {"key", "lacks a key"},
        {"key Crtl+Z", "'Crtl+Z' is no key"},
        {"key Shift", "'Shift' holds modifiers but no key"},
        {"type", "lacks a text"},
        {"type \"abc", "command 1: a quotation mark is not closed"},
        {"wait; type \"a\nb\"", "command 2: a quotation mark is not closed"},
        {"resize 640", "'640' is not WxH"},
        {"resize 0x1", "'0' is outside"},
        {"drop", "lacks a file"},
        {"time", "lacks seconds"},
        {"save a.jpg", "'a.jpg' must end in .png or .exr"},
        {"save-scene a.gltf", "'a.gltf' must end in .glb"},
        {"save-window a.exr", "'a.exr' must end in .png"},
        {"= 3", "unknown action '='"},
    };
    for (const auto& [text, message] : cases) {
        try {
            parsed(text);
            ADD_FAILURE() << text << " is taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::usage);
            EXPECT_TRUE(std::string(error.what()).starts_with("--actions: command ")) << text;
            EXPECT_NE(std::string(error.what()).find(message), std::string::npos)
                << text << " gives: " << error.what();
        }
    }
}

TEST(Script, ComesFromAFileToo) {
    const auto file =
        std::filesystem::temp_directory_path() /
        ("megaviews-script-" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
         std::to_string(reinterpret_cast<std::uintptr_t>(&parsed)) + ".txt");
    std::ofstream(file) << "wait 2\nnxt-method\n";
    try {
        parseOption("@" + file.string(), "--actions");
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(file.string() + ": command 2: unknown action"),
                  std::string::npos)
            << error.what();
    }
    std::ofstream(file) << "wait 2\n";
    EXPECT_EQ(parseOption("@" + file.string(), "--actions").size(), 1u);
    std::filesystem::remove(file);
    EXPECT_THROW(parseOption("@" + file.string(), "--actions"), Error);
    EXPECT_EQ(parseOption("wait", "--actions").size(), 1u);
}

TEST(Script, ExpectationsHoldOrSayWhatIs) {
    Settings settings;
    settings.views.vpls = 4096;
    const auto says = [&](const std::string& text) {
        return unmet(std::get<Expect>(parsed("expect " + text)[0].step), settings).value_or("");
    };
    EXPECT_EQ(says("vpls=4096"), "");
    EXPECT_EQ(says("vpls=4K"), "");
    EXPECT_EQ(says("vpls=5K"), "vpls is 4096 and should be 5120");
    EXPECT_EQ(says("vpls!=5K"), "");
    EXPECT_EQ(says("vpls!=4K"), "vpls is 4096 and should not be");
    EXPECT_EQ(says("compare=off"), "");
    EXPECT_EQ(says("exposure=auto"), "");
    EXPECT_NE(says("exposure=0"), "");
    settings.display.exposureEv = 0.1 + 0.2;
    EXPECT_EQ(says("exposure=0.3"), "");
    EXPECT_NE(says("exposure=0.30001"), "");
    EXPECT_NE(says("exposure=auto"), "");
    settings.display.split = 0.5;
    for (int i = 0; i < 10; ++i) settings.display.split += 0.02;
    EXPECT_EQ(says("split=0.7"), "");
    EXPECT_EQ(says("split!=0.7"),
              "split is " + mv::toText(settings, *findSetting("split")) + " and should not be");
}

TEST(Script, AnyTextIsReadOrRefused) {
    // Pieces of the grammar in any order, and bytes of any value.
    std::vector<std::string> pieces = {
        "wait", "click", "drag",        "by",  "move",       "@",    "@vpls", "1,2",
        "%",    "50%,",  "\"",          "\\",  ";",          "\n",   "#",     " ",
        "=",    "!=",    "expect",      "key", "Ctrl+",      "Ctrl", "F1",    "type",
        "save", ".png",  "resize",      "x",   "9999999999", "-1",   "1e400", "nan",
        "vpls", "4K",    "next-method", ",",   "\xff"};
    for (const SettingInfo& info : settingsTable()) pieces.emplace_back(info.key);
    std::mt19937 random(7);
    int taken = 0, refused = 0;
    for (int i = 0; i < 5000; ++i) {
        std::string text;
        const std::size_t count = random() % 12;
        for (std::size_t k = 0; k < count; ++k) {
            if (random() % 8 == 0) {
                text += static_cast<char>(random());
            } else {
                text += pieces[random() % pieces.size()];
            }
            if (random() % 2 == 0) text += ' ';
        }
        try {
            for (const Command& command : parsed(text)) {
                ASSERT_FALSE(command.text.empty());
                if (const auto* expect = std::get_if<Expect>(&command.step)) {
                    unmet(*expect, Settings{});
                }
                if (const auto* click = std::get_if<Click>(&command.step)) {
                    ASSERT_TRUE(std::isfinite(click->at.x) && std::isfinite(click->at.y));
                }
            }
            ++taken;
        } catch (const Error& error) {
            ASSERT_EQ(error.code, ExitCode::usage) << text;
            ASSERT_TRUE(std::string(error.what()).starts_with("--actions: command ")) << text;
            ++refused;
        }
    }
    EXPECT_GT(taken, 100);
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace mv::script
