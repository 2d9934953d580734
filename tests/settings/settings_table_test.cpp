#include "megaviews/settings/settings_table.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "megaviews/core/error.h"
#include "megaviews/settings/light_placement.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

const SettingInfo& setting(const std::string& key) {
    const SettingInfo* found = findSetting(key);
    if (!found) throw std::logic_error("no setting " + key);
    return *found;
}

Settings withText(const std::string& key, const std::string& text) {
    Settings s;
    setFromText(s, setting(key), text, "--" + key);
    return s;
}

// The message of the usage error that a value gives, or empty if it is taken.
std::string refusal(const std::string& key, const std::string& text) {
    try {
        withText(key, text);
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        return error.what();
    }
    return {};
}

// How many members an aggregate has: the most initialisers it takes.
struct Anything {
    template <typename T>
    operator T() const {
        std::abort();  // never run: only its type is asked for
    }
};
template <typename T, typename... Initialisers>
constexpr std::size_t memberCount() {
    if constexpr (requires { T{Initialisers{}..., Anything{}}; }) {
        return memberCount<T, Initialisers..., Anything>();
    } else {
        return sizeof...(Initialisers);
    }
}

TEST(SettingsTable, KeysAreUniqueFlagNamesWithHelp) {
    std::set<std::string_view> keys;
    for (const SettingInfo& s : settingsTable()) {
        EXPECT_TRUE(keys.insert(s.key).second) << s.key;
        EXPECT_EQ(s.key.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"), std::string_view::npos)
            << s.key;
        EXPECT_FALSE(s.label.empty()) << s.key;
        EXPECT_TRUE(s.help.ends_with(".")) << s.key;
        EXPECT_FALSE(valueRange(s).empty()) << s.key;
        EXPECT_EQ(findSetting(s.key), &s);
    }
    EXPECT_EQ(findSetting("no-such-setting"), nullptr);
}

TEST(SettingsTable, EveryMemberOfSettingsIsDeclaredOnce) {
    // Changing any one setting to another value of its kind changes Settings, and the number of
    // distinct changes is the number of rows: no two rows share a member.
    std::vector<Settings> changed;
    for (const SettingInfo& s : settingsTable()) {
        Settings other;
        for (const char* text :
             {"7",     "8",       "1,2,3",   "off",   "none",    "megaviews", "published",
              "queue", "64x32",   "0:1,2,3", "0.25",  "0.75",    "normals",   "absolute",
              "on",    "2",       "random",  "depth", "largest", "culled",    "name",
              "lazy",  "lambert", "binary",  "16"}) {
            try {
                setFromText(other, s, text, s.key);
            } catch (const Error&) {
            }
            if (other != Settings{}) break;
        }
        EXPECT_NE(other, Settings{}) << s.key;
        EXPECT_FALSE(hasDefault(other, s)) << s.key;
        for (const Settings& before : changed) EXPECT_NE(before, other) << s.key;
        changed.push_back(other);
        reset(other, s);
        EXPECT_EQ(other, Settings{}) << s.key;
    }
    // One row a member of the nested structs, one for the resolution, and three for what the right
    // side does otherwise.
    const std::size_t method = memberCount<MethodSettings>() - 3 + memberCount<MapSettings>() +
                               memberCount<PairSettings>() + memberCount<IsmSettings>();
    const std::size_t scene = memberCount<SceneSettings>() - 1 + memberCount<CameraSettings>() +
                              memberCount<EnvironmentSettings>();
    const std::size_t gather = memberCount<GatherSettings>() - 1 + memberCount<CullSettings>();
    const std::size_t nested = scene + memberCount<ViewSettings>() + method + gather +
                               memberCount<PictureSettings>() + memberCount<DisplaySettings>() +
                               memberCount<InspectSettings>();
    const std::size_t seedAndCompare = 2, resolution = 1;
    EXPECT_EQ(settingsTable().size(), nested + resolution + seedAndCompare + 3);
}

TEST(SettingsTable, TextAndJsonRoundTripForEveryDefault) {
    const Settings defaults;
    for (const SettingInfo& s : settingsTable()) {
        Settings fromText, fromJson;
        setFromText(fromText, s, toText(defaults, s), s.key);
        setFromJson(fromJson, s, nlohmann::json(toJson(defaults, s)), s.key);
        EXPECT_EQ(fromText, defaults) << s.key;
        EXPECT_EQ(fromJson, defaults) << s.key;
    }
}

TEST(SettingsTable, NumbersRoundTripExactly) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(-1, 1);
    std::uniform_int_distribution<int> exponent(-30, 8);
    for (int i = 0; i < 2000; ++i) {
        Settings s;
        s.scene.timeS = std::ldexp(mantissa(random), exponent(random));
        s.display.exposureEv = 60 * mantissa(random);
        s.camera.position = {mantissa(random), 1e9 * mantissa(random), 1e-9 * mantissa(random)};
        Settings back;
        for (const char* key : {"time", "exposure", "camera-position"}) {
            setFromText(back, setting(key), toText(s, setting(key)), key);
        }
        EXPECT_EQ(back, s) << toText(s, setting("time")) << " "
                           << toText(s, setting("camera-position"));
        Settings again;
        applyJson(again, nlohmann::json::parse(toJson(s).dump()), "test");
        EXPECT_EQ(again, s);
    }
}

TEST(LightPlacement, ReadsWhatItWritesAndRefusesTheRest) {
    for (const char* text :
         {"", "0:1,2,3", "3:-1,0.5,1e-07:0,-1,0", "1::0,0,2", "0:1,2,3 2::1,0,0 7:0,0,0:0,1,0",
          "2:::0,0,0", "0::::10,22.5", "1:1,2,3::4,5,6:0,90"}) {
        EXPECT_EQ(toText(parseLightPlacements(text, "test")), text);
    }
    EXPECT_EQ(parseLightPlacements("1::0,0,2", "test"),
              (std::vector<LightPlacement>{{1, {}, {{0, 0, 2}}, {}, {}}}));
    EXPECT_EQ(parseLightPlacements("1:::0,1,2:3,4", "test"),
              (std::vector<LightPlacement>{{1, {}, {}, {{0, 1, 2}}, {{3, 4}}}}));
    for (const char* text :
         {"x", "0", "0:", "0:1,2", "0:1,2,3,4", "0:1,2,nan", "-1:1,2,3", "0::0,0,0",
          "0:1,2,3 0:1,2,3", "0:1,2,3:1,2,3:4", "0::::", "0:::-1,0,0", "0:::1e13,0,0",
          "0:1e300,0,0", "0::1e-200,0,0", "0::::20,10", "0::::0,91", "0::::10", "0:1,2,3::::5"}) {
        EXPECT_NE(refusal("lights", text), "") << text;
    }
}

TEST(SettingsTable, HiddenOutcomesAreNames) {
    const Settings s = withText("step-hide", "split-view,culled");
    EXPECT_EQ(s.inspect.stepHidden, (std::array<bool, 6>{true, false, false, false, true, false}));
    EXPECT_EQ(toText(s, setting("step-hide")), "culled,split-view") << "in their order";
    EXPECT_EQ(withText("step-hide", ""), Settings());
    for (const char* text : {",", "split", "culled,", "culled;forced"}) {
        EXPECT_NE(refusal("step-hide", text), "") << text;
    }
    EXPECT_NE(refusal("step-hide", "cull").find("did you mean culled?"), std::string::npos);
}

TEST(SettingsTable, RulesAreASetOrItsMembers) {
    EXPECT_EQ(withText("rules", "published").side[0].rules, kPublishedRules);
    EXPECT_EQ(withText("rules", "corrected").side[0].rules, kCorrectedRules);
    const Settings s = withText("rules", "bound,boxes");
    EXPECT_EQ(s.side[0].rules, kRuleBoxes | kRuleBound);
    EXPECT_EQ(toText(s, setting("rules")), "boxes,bound");
    EXPECT_EQ(toJson(s, setting("rules")), "boxes,bound");
    EXPECT_EQ(
        withText("rules", "centroid,boxes,lone-views,bound,radius,two-texels,surfaces,footprint"),
        Settings());
    EXPECT_EQ(valueRange(setting("rules")), "published|corrected|NAME,NAME,..");
    EXPECT_NE(refusal("rules", "box").find("did you mean boxes?"), std::string::npos);
    EXPECT_NE(refusal("rules", "corrected,boxes").find("adds members to corrected"),
              std::string::npos);
    for (const char* text : {",", "boxes,", "Corrected"}) EXPECT_NE(refusal("rules", text), "");
    EXPECT_EQ(toText(s, setting("compare-rules")), "as left");
    EXPECT_EQ(withText("compare-rules", "surfaces").side[1].rules, kRuleSurfaces);
}

TEST(SettingsTable, SuffixesAreBinary) {
    EXPECT_EQ(withText("vpls", "64K").views.vpls, 65536);
    EXPECT_EQ(withText("vpls", "64k").views.vpls, 65536);
    EXPECT_EQ(withText("vpls", "1M").views.vpls, 1048576);
    EXPECT_EQ(withText("vpls", "1.5K").views.vpls, 1536);
    EXPECT_EQ(withText("vpls", "+17").views.vpls, 17);
    EXPECT_EQ(withText("seed", "4294967295").seed, 4294967295u);
    EXPECT_EQ(withText("gpu-memory", "2K").side[0].maps.memoryMiB, 2048);
    // Distances and times take none.
    EXPECT_NE(refusal("time", "1K"), "");
}

TEST(SettingsTable, RefusesWhatIsNoValue) {
    for (const char* text : {"", " ", "-", "+", "1x", "K", "1KK", "0x10", "1e3x", "nan", "inf",
                             "-inf", "1,2", "١", "1.5"}) {
        EXPECT_NE(refusal("vpls", text), "") << text;
    }
    for (const char* text : {"nan", "inf", "", "1.0.0", "e3", "--1", "++1"}) {
        EXPECT_NE(refusal("time", text), "") << text;
    }
    EXPECT_EQ(refusal("vpls", "0"), "--vpls: '0' is outside 1..1M");
    EXPECT_EQ(refusal("vpls", "1048577"), "--vpls: '1048577' is outside 1..1M");
    EXPECT_EQ(refusal("vpls", "1e300"), "--vpls: '1e300' is outside 1..1M");
    EXPECT_NE(refusal("seed", "-1"), "");
    EXPECT_NE(refusal("seed", "4294967296"), "");
    EXPECT_NE(refusal("filter", "maybe"), "");
    EXPECT_NE(refusal("filter", ""), "");
}

TEST(SettingsTable, RangesAreInclusive) {
    int checked = 0;
    for (const SettingInfo& s : settingsTable()) {
        const bool number = !(s.minimum == 0 && s.maximum == 0) &&
                            !std::holds_alternative<Field<Size>>(s.field) &&
                            valueRange(s).find("X,Y,Z") == std::string::npos;
        if (!number) continue;
        ++checked;
        const auto text = [](double value) { return Json(value).dump(); };
        EXPECT_EQ(refusal(std::string(s.key), text(s.minimum)), "") << s.key;
        EXPECT_EQ(refusal(std::string(s.key), text(s.maximum)), "") << s.key;
        const double step = std::max(1e-3, std::abs(s.maximum) * 1e-3);
        EXPECT_NE(refusal(std::string(s.key), text(s.minimum - step)), "") << s.key;
        EXPECT_NE(refusal(std::string(s.key), text(s.maximum + step)), "") << s.key;
    }
    EXPECT_GE(checked, 50);  // of about as many settings that are numbers
}

TEST(SettingsTable, ViewResolutionIsAPowerOfTwo) {
    for (int r = 0; r <= 300; ++r) {
        const bool valid = r == 8 || r == 16 || r == 32 || r == 64 || r == 128 || r == 256;
        EXPECT_EQ(refusal("view-res", std::to_string(r)).empty(), valid) << r;
    }
}

TEST(SettingsTable, ResolutionTakesBothForms) {
    EXPECT_EQ(withText("resolution", "1920x1080").resolution.width, 1920);
    EXPECT_EQ(withText("resolution", "1920,1080").resolution.height, 1080);
    for (const char* text :
         {"0x0", "0,0", "100", "100x", "x100", "1x2x3", "-1x10", "10x16385", "1.5x2", "axb"}) {
        EXPECT_NE(refusal("resolution", text), "") << text;
    }
    // A value refused halfway changes nothing.
    Settings s;
    EXPECT_THROW(setFromText(s, setting("resolution"), "64x0", "x"), Error);
    EXPECT_EQ(s, Settings{});
}

TEST(SettingsTable, ChoicesAreNamedAndSuggested) {
    EXPECT_EQ(withText("method", "manylods").side[0].method, Method::manylods);
    EXPECT_TRUE(withText("compare", "manylods").compare);
    EXPECT_EQ(withText("compare", "manylods").side[1].method, Method::manylods);
    EXPECT_FALSE(withText("compare", "off").compare);
    EXPECT_EQ(withText("view", "nan").picture.view, DebugView::nan);
    EXPECT_NE(refusal("method", "megaview").find("did you mean megaviews?"), std::string::npos);
    EXPECT_NE(refusal("method", "off"), "");
    EXPECT_NE(refusal("method", "MegaViews"), "");
    for (const auto* key : {"method", "scene-tree", "traversal", "tonemap", "view"}) {
        const auto& member = std::get<ChoiceField>(setting(key).field);
        for (std::size_t i = 0; i < member.names.size(); ++i) {
            const Settings s = withText(key, std::string(member.names[i]));
            EXPECT_EQ(member.get(s), static_cast<int>(i)) << key;
            EXPECT_EQ(toText(s, setting(key)), member.names[i]);
        }
    }
    EXPECT_EQ(nameOf(Method::none), "none");
    EXPECT_EQ(nameOf(Traversal::lists), "lists");
    EXPECT_EQ(nameOfRules(kCorrectedRules), "corrected");
    EXPECT_EQ(nameOf(ToneMap::neutral), "neutral");
    EXPECT_EQ(nameOf(ToneMap::agx), "agx");
    EXPECT_EQ(nameOf(DebugView::nan), "nan");
}

TEST(SettingsTable, UnsetValuesHaveAWord) {
    EXPECT_EQ(withText("exposure", "auto").display.exposureEv, std::nullopt);
    EXPECT_EQ(withText("exposure", "-1.5").display.exposureEv, -1.5);
    EXPECT_EQ(withText("fov", "auto").camera.fovDeg, std::nullopt);
    EXPECT_NE(refusal("vpls", "auto"), "");
    EXPECT_EQ(toText(Settings{}, setting("exposure")), "auto");
    EXPECT_TRUE(toJson(Settings{}, setting("exposure")).is_null());
}

TEST(SettingsTable, JsonTakesTheKindsAConfigurationHolds) {
    Settings s;
    const auto apply = [&](const char* text) { applyJson(s, nlohmann::json::parse(text), "c"); };
    apply(R"({"vpls": "64K", "filter": false, "resolution": [64, 32], "exposure": null})");
    EXPECT_EQ(s.views.vpls, 65536);
    EXPECT_FALSE(s.gather.filter);
    EXPECT_EQ(s.resolution.width, 64);
    EXPECT_EQ(s.resolution.height, 32);
    apply(R"({"vpls": 100, "filter": "on", "resolution": "8x4", "exposure": 2, "schema": 1})");
    EXPECT_EQ(s.views.vpls, 100);
    EXPECT_TRUE(s.gather.filter);
    EXPECT_EQ(s.display.exposureEv, 2);

    const Settings before = s;
    for (const char* bad :
         {R"([])", R"(3)", R"({"vpl": 3})", R"({"vpls": [1]})", R"({"vpls": null})",
          R"({"vpls": {}})", R"({"vpls": true})", R"({"filter": 2})", R"({"camera-up": [0, 1]})",
          R"({"camera-up": ["a", 1, 2]})", R"({"bounces": 2, "seed": -1})", R"({"schema": 2})"}) {
        EXPECT_THROW(apply(bad), Error) << bad;
        EXPECT_EQ(s, before) << bad;  // all or nothing
    }
}

TEST(SettingsTable, TheRightSideFollowsTheLeftWhileTheyAreEqual) {
    Settings s;
    const auto set = [&](const char* key, const char* value) {
        setFromText(s, setting(key), value, key);
    };
    set("compare", "manylods");
    set("rules", "published");
    EXPECT_EQ(s.side[1].rules, kPublishedRules);
    EXPECT_EQ(toText(s, setting("compare-rules")), "as left");
    set("compare-rules", "corrected");
    set("view-res", "32");
    EXPECT_EQ(s.side[0].rules, kPublishedRules);
    EXPECT_EQ(s.side[1].rules, kCorrectedRules);
    EXPECT_EQ(s.side[1].maps.resolution, 32);
    // A side is set after the settings that it follows, in whatever order a file has them.
    Settings read;
    applyJson(read, nlohmann::json::parse(R"({"compare-rules": "corrected", "rules": "published",
        "compare": "none", "compare-view-res": 0, "pick-a": -1})"),
              "c");
    EXPECT_EQ(read.side[0].rules, kPublishedRules);
    EXPECT_EQ(read.side[1].rules, kCorrectedRules);
    EXPECT_EQ(read.side[1].maps, read.side[0].maps);
    EXPECT_EQ(read.inspect.pickA, std::nullopt);
    Settings again;
    applyJson(again, toJson(read), "c");
    EXPECT_EQ(again, read);
}

TEST(SettingsTable, CombinationsAreChecked) {
    EXPECT_NO_THROW(validate(Settings{}));
    const auto invalid = [](auto change) {
        Settings s;
        change(s);
        EXPECT_THROW(validate(s), Error);
    };
    invalid([](Settings& s) {
        s.views.file = "views.ply";
        s.views.particles = 5;
    });
    invalid([](Settings& s) { s.camera.up = {0, 0, 0}; });
    invalid([](Settings& s) {
        s.camera.position = {1, 2, 3};
        s.camera.target = {1, 2, 3};
    });
    invalid([](Settings& s) {
        s.camera.position = {1, 2, 3};
        s.camera.target = {1, 5, 3};
        s.camera.up = {0, 2, 0};
    });
    Settings plan;  // along the default up, which gives way
    plan.camera.position = {1, 5, 3};
    plan.camera.target = {1, 2, 3};
    EXPECT_NO_THROW(validate(plan));
    invalid([](Settings& s) { compareWith(s, Method::megaviews); });
}

TEST(NearestName, FindsSlipsAndOnlyThose) {
    const std::vector<std::string> names = {"--vpls", "--views", "--view", "--time", "--method"};
    EXPECT_EQ(nearestName("--vpl", names), "--vpls");
    EXPECT_EQ(nearestName("--vlps", names), "--vpls");
    EXPECT_EQ(nearestName("--tmie", names), "--time");
    EXPECT_EQ(nearestName("--view", names), "--view");
    EXPECT_EQ(nearestName("--completely-different", names), "");
    EXPECT_EQ(nearestName("", names), "");
}

TEST(PixelSamples, AreOfPicturesOfLightAndOfMethods) {
    Settings s;
    s.picture.freshViews = false;  // which are noise, too
    s.picture.accumulate = 6;
    EXPECT_FALSE(s.averagesPixels());
    EXPECT_EQ(s.setsWanted(), 6);
    s.picture.pixelSamples = 4;
    EXPECT_TRUE(s.averagesPixels());
    EXPECT_EQ(s.setsWanted(), 6) << "each set has a point of its own";
    s.picture.pixelSamples = 9;
    EXPECT_EQ(s.setsWanted(), 9);
    s.gather.samples = 0;
    s.picture.pixelSamples = 4;
    EXPECT_EQ(s.setsWanted(), 6) << "the near field is of rays";
    s.gather.nearField = false;
    EXPECT_EQ(s.setsWanted(), 4) << "full sums have no noise to average";
    s.gather.nearField = true;
    s.gather.samples = 8;
    for (const DebugView view :
         {DebugView::final, DebugView::direct, DebugView::indirect, DebugView::unfiltered}) {
        s.picture.view = view;
        EXPECT_TRUE(s.averagesPixels());
    }
    for (const DebugView view :
         {DebugView::normals, DebugView::albedo, DebugView::depth, DebugView::candidates,
          DebugView::nan, DebugView::sharing, DebugView::shared, DebugView::undecided}) {
        s.picture.view = view;
        EXPECT_FALSE(s.averagesPixels());
        EXPECT_TRUE(s.mayAveragePixels());
        EXPECT_EQ(s.setsWanted(), 1) << "data has nothing to average";
    }
    s.picture.view = DebugView::final;
    compareWith(s, Method::manylods);
    EXPECT_TRUE(s.averagesPixels());
    s.display.difference = Difference::relative;
    EXPECT_FALSE(s.mayAveragePixels());
    EXPECT_EQ(s.setsWanted(), 6);
    s.display.difference = Difference::off;
    s.side[1].method = Method::pathtraced;
    EXPECT_FALSE(s.mayAveragePixels());
    s.compare = false;
    EXPECT_TRUE(s.mayAveragePixels());
    s.side[0].method = Method::exact;
    EXPECT_FALSE(s.mayAveragePixels());
}

}  // namespace
}  // namespace mv
