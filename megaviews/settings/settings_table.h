#pragma once
// The one place where a setting is described: its key (which is also its flag, its configuration
// key and its name in metadata), its kind, range, choices, unit, help and paper section. Command
// line, configuration files, panels, image metadata and statistics are all driven by this table;
// defaults are those of a default-constructed Settings.

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/settings/settings.h"

namespace mv {

enum class SettingGroup { scene, method, views, gather, picture, instruments };
std::string_view groupTitle(SettingGroup group);

// How a setting is read and written, wherever it lies in Settings. A setting that both sides of a
// comparison have is read from the left one; written, it takes the right one along while the two
// are equal.
template <typename T>
struct Field {
    using Value = T;
    std::function<T(const Settings&)> get;
    std::function<void(Settings&, T)> set;
};
// A setting of a few named choices; -1 stands for "unset" where the setting may be unset.
struct ChoiceField : Field<int> {
    std::vector<std::string_view> names;
};
// Any of a few named members, a bit each; some sets have names of their own. -1 stands for "unset"
// where the setting may be unset. Text: the set's name, or those of its members with commas.
struct SetField : Field<int> {
    std::vector<std::string_view> names;  // of the members
    std::vector<std::pair<std::string_view, int>> sets = {};
};
struct TextField : Field<std::string> {
    std::string_view form = "NAME|N";  // for help
    // Throws Error(ExitCode::usage), starting with `where`, for a text that it cannot be.
    void (*check)(std::string_view text, std::string_view where) = [](auto, auto) {};
};
using Vector3 = std::array<double, 3>;
using SettingField =
    std::variant<Field<bool>, Field<int>, Field<std::optional<int>>, Field<std::int64_t>,
                 Field<std::optional<std::int64_t>>, Field<std::uint32_t>, Field<double>,
                 Field<std::optional<double>>, Field<Vector3>, Field<std::optional<Vector3>>,
                 Field<Size>, ChoiceField, SetField, TextField>;

struct SettingInfo {
    std::string_view key;
    std::string_view label;  // for panels
    SettingField field;
    double minimum = 0, maximum = 0;  // inclusive; of each component; numbers only
    bool powerOfTwo = false;
    std::string_view unset = {};  // word for "no value", e.g. "auto"; empty: always has a value
    std::optional<int> oldUnset = {};  // number that stands for "no value" in files of before
    std::string_view unit = {};        // empty: a plain number
    std::string_view atLowest = {};    // word for a number at its minimum, e.g. "none"
    std::string_view help = {};        // one sentence
    std::string_view paper = {};       // section the setting comes from, or empty
    SettingGroup group = {};
};

std::span<const SettingInfo> settingsTable();
const SettingInfo* findSetting(std::string_view key);  // nullptr if there is none

// What a value may be, for help and messages: "1..1048576", "on|off", "X,Y,Z".
std::string valueRange(const SettingInfo& setting);
// The value as text that setFromText() reads back to the same value, and as JSON.
std::string toText(const Settings& settings, const SettingInfo& setting);
nlohmann::ordered_json toJson(const Settings& settings, const SettingInfo& setting);
// Defaults are the program's, or others that a window has.
bool hasDefault(const Settings& settings, const SettingInfo& setting,
                const Settings& defaults = {});
void reset(Settings& settings, const SettingInfo& setting, const Settings& defaults = {});

// Throw Error(ExitCode::usage), starting with `where` (the flag, or file and key), if the text or
// JSON is not a value of the setting; settings are then unchanged. Integers accept a suffix K or M
// (1024 and 1048576: the papers' 64K views are 65536).
void setFromText(Settings& settings, const SettingInfo& setting, std::string_view text,
                 std::string_view where);
void setFromJson(Settings& settings, const SettingInfo& setting, const nlohmann::json& value,
                 std::string_view where);

// A number in [minimum, maximum] from text, for options that are no settings; the same errors.
double numberFromText(std::string_view text, double minimum, double maximum, bool whole,
                      std::string_view where);

// What no single range can say: combinations that contradict each other. Throws
// Error(ExitCode::usage). Single values are in range once they went through the setters.
void validate(const Settings& settings);

// Every setting, in table order; what metadata and statistics store.
nlohmann::ordered_json toJson(const Settings& settings);
// Applies an object of keys and returns those it held. Unknown keys and bad values throw
// Error(ExitCode::usage) naming `where`; a member "schema" must be kSettingsSchema.
inline constexpr int kSettingsSchema = 1;
std::vector<std::string> applyJson(Settings& settings, const nlohmann::json& object,
                                   std::string_view where);
// A configuration file: one JSON object of keys, comments allowed. Throws Error(ExitCode::usage) if
// it cannot be read or is malformed.
std::vector<std::string> applyConfigFile(Settings& settings, const std::string& path);
// $XDG_CONFIG_HOME/megaviews/config.json or ~/.config/megaviews/config.json; empty without a home.
std::string defaultConfigFile();

std::string_view nameOf(Method method);
std::string_view nameOf(Traversal traversal);
std::string_view nameOf(ToneMap toneMap);
std::string_view nameOf(DebugView view);
std::string nameOfRules(uint rules);

// The candidate that `name` is probably a misspelling of, or empty.
std::string nearestName(std::string_view name, std::span<const std::string> candidates);
// Of a name that is none of these: "; did you mean vpls?", or `otherwise` where none is near.
std::string didYouMean(std::string_view name, std::span<const std::string> names,
                       std::string_view otherwise = "");
// "'vpl' is not one of vpls, maps; did you mean vpls?"
std::string notOneOf(std::string_view name, std::span<const std::string> names);

}  // namespace mv
