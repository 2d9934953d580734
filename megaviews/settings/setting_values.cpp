// Values of settings to and from text and JSON, and what makes them valid.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/overloaded.h"
#include "megaviews/core/strict_json.h"
#include "megaviews/core/text.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

template <typename Setting>
using ValueOf = typename std::decay_t<Setting>::Value;
template <typename T>
constexpr bool kIsOptional = false;
template <typename T>
constexpr bool kIsOptional<std::optional<T>> = true;

[[noreturn]] void refuse(std::string_view where, std::string_view value,
                         const std::string& reason) {
    throw Error(ExitCode::usage, std::string(where) + ": '" + std::string(value) + "' " + reason);
}

// The shortest text that reads back to the same double.
std::string numberText(double value) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return std::string(buffer, end);
}

std::string boundText(const SettingInfo& s, double value) {
    const bool counts = std::holds_alternative<Field<std::int64_t>>(s.field);
    if (counts && value == 1048576) return "1M";
    return numberText(value);
}

std::string rangeText(const SettingInfo& s) {
    return boundText(s, s.minimum) + ".." + boundText(s, s.maximum);
}

std::optional<double> parseNumber(std::string_view text, bool suffixes) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double scale = 1;
    if (suffixes && !text.empty()) {
        const char last = text.back();
        if (last == 'k' || last == 'K') scale = 1024;
        if (last == 'm' || last == 'M') scale = 1048576;
        if (scale != 1) text.remove_suffix(1);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
        return std::nullopt;
    }
    return value * scale;
}

bool isPowerOfTwo(double value) {
    const auto n = static_cast<std::int64_t>(value);
    return n > 0 && (n & (n - 1)) == 0;
}

// A number within the setting's range, or an error that says what would be.
template <typename T>
T checkedNumber(const SettingInfo& s, double value, std::string_view text, std::string_view where) {
    if constexpr (std::is_integral_v<T>) {
        if (value != std::floor(value)) refuse(where, text, "is not a whole number");
    }
    if (!(value >= s.minimum && value <= s.maximum)) {
        refuse(where, text, "is outside " + rangeText(s));
    }
    if (s.powerOfTwo && value != 0 && !isPowerOfTwo(value)) {  // 0 only where the range has it
        refuse(where, text, "is not a power of two in " + rangeText(s));
    }
    return static_cast<T>(value);
}

template <typename T>
T numberFromText(const SettingInfo& s, std::string_view text, std::string_view where) {
    const auto value = parseNumber(text, std::is_integral_v<T>);
    if (!value) refuse(where, text, "is not a number (" + valueRange(s) + ")");
    return checkedNumber<T>(s, *value, text, where);
}

Vector3 vectorFromText(const SettingInfo& s, std::string_view text, std::string_view where) {
    const auto parts = splitAt(text, ",");
    if (parts.size() != 3) refuse(where, text, "is not X,Y,Z");
    Vector3 v{};
    for (std::size_t i = 0; i < 3; ++i) v[i] = numberFromText<double>(s, parts[i], where);
    return v;
}

Size sizeFromText(const SettingInfo& s, std::string_view text, std::string_view where) {
    const auto parts = splitAt(text, "xX,");
    const auto isNumber = [](std::string_view part) { return parseNumber(part, true).has_value(); };
    if (parts.size() != 2 || !std::all_of(parts.begin(), parts.end(), isNumber)) {
        refuse(where, text, "is not WxH");
    }
    return {numberFromText<int>(s, parts[0], where), numberFromText<int>(s, parts[1], where)};
}

bool boolFromText(std::string_view text, std::string_view where) {
    for (const auto on : {"on", "true", "yes", "1"}) {
        if (text == on) return true;
    }
    for (const auto off : {"off", "false", "no", "0"}) {
        if (text == off) return false;
    }
    refuse(where, text, "is neither on nor off");
}

int indexOf(const std::vector<std::string_view>& names, std::string_view text,
            std::string_view where) {
    const auto it = std::find(names.begin(), names.end(), text);
    if (it != names.end()) return static_cast<int>(it - names.begin());
    const std::vector<std::string> known(names.begin(), names.end());
    throw Error(ExitCode::usage, std::string(where) + ": " + notOneOf(text, known));
}

int membersFromText(const SetField& of, std::string_view text, std::string_view where) {
    if (text.empty()) return 0;
    std::vector<std::string_view> known;
    for (const auto& [name, members] : of.sets) {
        if (text == name) return members;
        known.push_back(name);
    }
    known.insert(known.end(), of.names.begin(), of.names.end());
    int set = 0;
    for (const std::string_view name : splitAt(text, ",")) {
        const int member = indexOf(known, name, where) - static_cast<int>(of.sets.size());
        if (member < 0) refuse(where, text, "adds members to " + std::string(name));
        set |= 1 << member;
    }
    return set;
}

std::string textOf(const SetField& of, int set) {
    for (const auto& [name, members] : of.sets) {
        if (set == members) return std::string(name);
    }
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < of.names.size(); ++i) {
        if ((set >> i & 1) != 0) names.push_back(of.names[i]);
    }
    return joined(names, ",");
}

std::string textOf(const std::string& value) { return value; }
std::string textOf(bool value) { return value ? "on" : "off"; }
std::string textOf(double value) { return numberText(value); }
std::string textOf(std::integral auto value) { return std::to_string(value); }
std::string textOf(const Vector3& v) {
    return numberText(v[0]) + "," + numberText(v[1]) + "," + numberText(v[2]);
}
std::string textOf(Size size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
}

// A value of type T, which is not optional.
template <typename T>
T valueFromText(const SettingInfo& s, std::string_view text, std::string_view where) {
    if constexpr (std::is_same_v<T, bool>) {
        return boolFromText(text, where);
    } else if constexpr (std::is_same_v<T, std::string>) {
        std::get<TextField>(s.field).check(text, where);
        return std::string(text);
    } else if constexpr (std::is_same_v<T, Vector3>) {
        return vectorFromText(s, text, where);
    } else if constexpr (std::is_same_v<T, Size>) {
        return sizeFromText(s, text, where);
    } else {
        return numberFromText<T>(s, text, where);
    }
}

// One JSON number or string, as text; anything else is refused.
std::string scalarText(const nlohmann::json& value, std::string_view where) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
    if (value.is_number_unsigned()) return std::to_string(value.get<std::uint64_t>());
    if (value.is_number_integer()) return std::to_string(value.get<std::int64_t>());
    if (value.is_number_float()) return numberText(value.get<double>());
    refuse(where, value.dump(), "is not a value of this setting");
}

int editDistance(std::string_view a, std::string_view b) {
    // Optimal string alignment: insert, delete, replace, swap neighbours.
    const std::size_t n = a.size(), m = b.size();
    std::vector<std::vector<int>> d(n + 1, std::vector<int>(m + 1));
    for (std::size_t i = 0; i <= n; ++i) d[i][0] = static_cast<int>(i);
    for (std::size_t j = 0; j <= m; ++j) d[0][j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= n; ++i) {
        for (std::size_t j = 1; j <= m; ++j) {
            const int replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[n][m];
}

}  // namespace

std::string valueRange(const SettingInfo& s) {
    std::string unset;
    if (!s.unset.empty()) unset.append("|").append(s.unset);
    return std::visit(
        Overloaded{[&](const ChoiceField& choice) { return joined(choice.names, "|") + unset; },
                   [&](const SetField& of) {
                       std::string sets;
                       for (const auto& [name, members] : of.sets) sets.append(name).append("|");
                       return sets + "NAME,NAME,.." + unset;
                   },
                   [](const TextField& text) { return std::string(text.form); },
                   [&](const auto& field) -> std::string {
                       using T = ValueOf<decltype(field)>;
                       if constexpr (std::is_same_v<T, bool>) {
                           return "on|off";
                       } else if constexpr (std::is_same_v<T, Size>) {
                           return "WxH";
                       } else if constexpr (std::is_same_v<T, Vector3> ||
                                            std::is_same_v<T, std::optional<Vector3>>) {
                           return "X,Y,Z" + unset;
                       } else {
                           return rangeText(s) + unset;
                       }
                   }},
        s.field);
}

std::string toText(const Settings& settings, const SettingInfo& s) {
    return std::visit(
        Overloaded{[&](const ChoiceField& choice) {
                       const int value = choice.get(settings);
                       return std::string(
                           value < 0 ? s.unset : choice.names.at(static_cast<std::size_t>(value)));
                   },
                   [&](const SetField& of) {
                       const int value = of.get(settings);
                       return value < 0 ? std::string(s.unset) : textOf(of, value);
                   },
                   [&](const auto& field) -> std::string {
                       const auto value = field.get(settings);
                       if constexpr (kIsOptional<ValueOf<decltype(field)>>) {
                           return value ? textOf(*value) : std::string(s.unset);
                       } else {
                           return textOf(value);
                       }
                   }},
        s.field);
}

Json toJson(const Settings& settings, const SettingInfo& s) {
    return std::visit(
        Overloaded{[&](const ChoiceField& choice) -> Json {
                       const int value = choice.get(settings);
                       if (value < 0) return nullptr;
                       return std::string(choice.names.at(static_cast<std::size_t>(value)));
                   },
                   [&](const SetField& of) -> Json {
                       const int value = of.get(settings);
                       if (value < 0) return nullptr;
                       return textOf(of, value);
                   },
                   [&](const Field<Size>& size) -> Json {
                       return Json::array({size.get(settings).width, size.get(settings).height});
                   },
                   [&](const auto& field) -> Json {
                       const auto value = field.get(settings);
                       if constexpr (kIsOptional<ValueOf<decltype(field)>>) {
                           if (!value) return nullptr;
                           return *value;
                       } else {
                           return value;
                       }
                   }},
        s.field);
}

bool hasDefault(const Settings& settings, const SettingInfo& s, const Settings& defaults) {
    return toJson(settings, s) == toJson(defaults, s);
}

void reset(Settings& settings, const SettingInfo& s, const Settings& defaults) {
    std::visit([&](const auto& field) { field.set(settings, field.get(defaults)); }, s.field);
}

void setFromText(Settings& settings, const SettingInfo& s, std::string_view text,
                 std::string_view where) {
    const bool unset = (!s.unset.empty() && text == s.unset) ||
                       (s.oldUnset && text == std::to_string(*s.oldUnset));
    std::visit(Overloaded{[&](const ChoiceField& choice) {
                              choice.set(settings, unset ? -1 : indexOf(choice.names, text, where));
                          },
                          [&](const SetField& of) {
                              of.set(settings, unset ? -1 : membersFromText(of, text, where));
                          },
                          [&](const auto& field) {
                              using T = ValueOf<decltype(field)>;
                              if constexpr (kIsOptional<T>) {
                                  using Given = typename T::value_type;
                                  field.set(settings,
                                            unset ? T() : T(valueFromText<Given>(s, text, where)));
                              } else {
                                  field.set(settings, valueFromText<T>(s, text, where));
                              }
                          }},
               s.field);
}

void setFromJson(Settings& settings, const SettingInfo& s, const nlohmann::json& value,
                 std::string_view where) {
    if (value.is_null() && !s.unset.empty()) {
        setFromText(settings, s, s.unset, where);
        return;
    }
    if (value.is_array() && value.size() >= 2) {
        std::string text;
        for (const auto& element : value) {
            if (!element.is_number()) refuse(where, value.dump(), "is not an array of numbers");
            text.append(text.empty() ? "" : ",").append(scalarText(element, where));
        }
        setFromText(settings, s, text, where);
        return;
    }
    setFromText(settings, s, scalarText(value, where), where);
}

double numberFromText(std::string_view text, double minimum, double maximum, bool whole,
                      std::string_view where) {
    const auto bound = [&](double b) {
        return whole ? std::to_string(static_cast<std::int64_t>(b)) : numberText(b);
    };
    const std::string range = bound(minimum) + ".." + bound(maximum);
    const auto value = parseNumber(text, whole);
    if (!value) refuse(where, text, "is not a number (" + range + ")");
    if (whole && *value != std::floor(*value)) refuse(where, text, "is not a whole number");
    if (!(*value >= minimum && *value <= maximum)) refuse(where, text, "is outside " + range);
    return *value;
}

Json toJson(const Settings& settings) {
    Json out = Json::object();
    for (const SettingInfo& s : settingsTable()) out[std::string(s.key)] = toJson(settings, s);
    return out;
}

std::vector<std::string> applyJson(Settings& settings, const nlohmann::json& object,
                                   std::string_view where) {
    const std::string place(where);
    if (!object.is_object()) {
        throw Error(ExitCode::usage, place + ": not an object of settings");
    }
    for (const auto& [key, value] : object.items()) {
        if (key == "schema") {
            if (value != kSettingsSchema) {
                throw Error(ExitCode::usage, place + ": schema " + value.dump() +
                                                 " is not known; this program reads " +
                                                 std::to_string(kSettingsSchema));
            }
            continue;
        }
        if (findSetting(key)) continue;
        throw Error(ExitCode::usage,
                    place + ": unknown setting '" + key + "'" +
                        didYouMean(key, namesIn(settingsTable(), &SettingInfo::key)));
    }
    std::vector<std::string> keys;
    Settings result = settings;                     // all or nothing
    for (const SettingInfo& s : settingsTable()) {  // whose order says what the right side follows
        const std::string key(s.key);
        if (!object.contains(key)) continue;
        setFromJson(result, s, object[key], place + ": " + key);
        keys.push_back(key);
    }
    settings = std::move(result);
    return keys;
}

std::vector<std::string> applyConfigFile(Settings& settings, const std::string& path) {
    const std::string text = readTextFile(path, ExitCode::usage);
    return applyJson(settings, parseStrictJson(text, path, ExitCode::usage), path);
}

std::string defaultConfigFile() {
    const char* config = std::getenv("XDG_CONFIG_HOME");
    if (config && *config) return std::string(config) + "/megaviews/config.json";
    const char* home = std::getenv("HOME");
    if (home && *home) return std::string(home) + "/.config/megaviews/config.json";
    return {};
}

std::string nearestName(std::string_view name, std::span<const std::string> candidates) {
    const int tolerance = std::max(1, static_cast<int>(name.size()) / 3);
    int best = tolerance + 1;
    std::string nearest;
    for (const std::string& candidate : candidates) {
        const int distance = editDistance(name, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    if (!nearest.empty()) return nearest;
    // Nothing close: the one candidate that starts as the name does, if there is just one.
    for (const std::string& candidate : candidates) {
        if (name.size() >= 3 && candidate.starts_with(name)) {
            if (!nearest.empty()) return {};
            nearest = candidate;
        }
    }
    return nearest;
}

std::string didYouMean(std::string_view name, std::span<const std::string> names,
                       std::string_view otherwise) {
    const std::string nearest = nearestName(name, names);
    return nearest.empty() ? std::string(otherwise) : "; did you mean " + nearest + "?";
}

std::string notOneOf(std::string_view name, std::span<const std::string> names) {
    return "'" + std::string(name) + "' is not one of " + joined(names, ", ") +
           didYouMean(name, names);
}

}  // namespace mv
