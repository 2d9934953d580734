#pragma once
// How the rows of the table of settings are written, a file a stage: members of Settings by the
// pointers that lead to them, choices and sets by their names.

#include <initializer_list>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "megaviews/settings/settings_table.h"

namespace mv::rows {

auto& at(auto& object, auto member) { return object.*member; }
auto& at(auto& object, auto member, auto... rest) { return at(object.*member, rest...); }

// A member of Settings, by the pointers to members that lead to it.
auto field(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<Settings&>(), path...))>;
    return Field<T>{[=](const Settings& s) { return at(s, path...); },
                    [=](Settings& s, T v) { at(s, path...) = std::move(v); }};
}
// A member of MethodSettings, which both sides have.
auto methodField(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<MethodSettings&>(), path...))>;
    return Field<T>{[=](const Settings& s) { return at(s.side[0], path...); },
                    [=](Settings& s, T v) {
                        T &left = at(s.side[0], path...), &right = at(s.side[1], path...);
                        if (right == left) right = v;
                        left = v;
                    }};
}
// The same of the right side, where it differs from the left one; else unset.
auto rightField(auto... path) {
    using T = std::decay_t<decltype(at(std::declval<MethodSettings&>(), path...))>;
    return Field<std::optional<T>>{
        [=](const Settings& s) {
            const T &left = at(s.side[0], path...), &right = at(s.side[1], path...);
            return left == right ? std::nullopt : std::optional<T>(right);
        },
        [=](Settings& s, std::optional<T> v) {
            at(s.side[1], path...) = v.value_or(at(s.side[0], path...));
        }};
}
// Choices and sets all go through an int, so that panels need to know only one kind.
template <typename T>
Field<int> asInt(Field<T> of) {
    return {[of](const Settings& s) { return static_cast<int>(of.get(s)); },
            [of](Settings& s, int v) { of.set(s, static_cast<T>(v)); }};
}
template <typename T>
Field<int> asInt(Field<std::optional<T>> of) {
    return {[of](const Settings& s) {
                const std::optional<T> value = of.get(s);
                return value ? static_cast<int>(*value) : -1;
            },
            [of](Settings& s, int v) {
                of.set(s, v < 0 ? std::nullopt : std::optional(static_cast<T>(v)));
            }};
}
// names: in the order of the enum in settings.h.
ChoiceField choice(auto of, const auto& names) {
    return {asInt(of), {std::begin(names), std::end(names)}};
}
ChoiceField choice(auto of, std::initializer_list<std::string_view> names) {
    return {asInt(of), names};
}

std::vector<SettingInfo> ofScene();
std::vector<SettingInfo> ofMethod();
std::vector<SettingInfo> ofViews();
std::vector<SettingInfo> ofGather();
std::vector<SettingInfo> ofPicture();
std::vector<SettingInfo> ofInstruments();

}  // namespace mv::rows
