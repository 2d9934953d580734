#include "app/viewer/key_bindings.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <charconv>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace mv {
namespace {

struct Binding {
    Chord chord;
    Action action;
};

int keyNamed(const std::string& name) {
    static const std::unordered_map<std::string, int> kNames = {{"Space", GLFW_KEY_SPACE},
                                                                {"Left", GLFW_KEY_LEFT},
                                                                {"Right", GLFW_KEY_RIGHT},
                                                                {"Up", GLFW_KEY_UP},
                                                                {"Down", GLFW_KEY_DOWN},
                                                                {"Enter", GLFW_KEY_ENTER},
                                                                {"Esc", GLFW_KEY_ESCAPE},
                                                                {";", GLFW_KEY_SEMICOLON},
                                                                {"'", GLFW_KEY_APOSTROPHE},
                                                                {"`", GLFW_KEY_GRAVE_ACCENT},
                                                                {"\\", GLFW_KEY_BACKSLASH},
                                                                {"Menu", GLFW_KEY_MENU},
                                                                {"Pause", GLFW_KEY_PAUSE},
                                                                {"Escape", GLFW_KEY_ESCAPE},
                                                                {"Insert", GLFW_KEY_INSERT},
                                                                {"-", GLFW_KEY_MINUS},
                                                                {"=", GLFW_KEY_EQUAL},
                                                                {"[", GLFW_KEY_LEFT_BRACKET},
                                                                {"]", GLFW_KEY_RIGHT_BRACKET},
                                                                {".", GLFW_KEY_PERIOD},
                                                                {",", GLFW_KEY_COMMA},
                                                                {"/", GLFW_KEY_SLASH},
                                                                {"Tab", GLFW_KEY_TAB},
                                                                {"Delete", GLFW_KEY_DELETE},
                                                                {"Home", GLFW_KEY_HOME},
                                                                {"End", GLFW_KEY_END},
                                                                {"Backspace", GLFW_KEY_BACKSPACE},
                                                                {"PageUp", GLFW_KEY_PAGE_UP},
                                                                {"PageDown", GLFW_KEY_PAGE_DOWN},
                                                                {"Shift", GLFW_KEY_LEFT_SHIFT},
                                                                {"Ctrl", GLFW_KEY_LEFT_CONTROL}};
    if (const auto found = kNames.find(name); found != kNames.end()) return found->second;
    if (name.size() > 1 && name[0] == 'F') {
        int number = 0;
        const auto end = name.data() + name.size();
        const auto read = std::from_chars(name.data() + 1, end, number);
        const bool exists = read.ptr == end && number >= 1 && number <= 25;
        return exists ? GLFW_KEY_F1 + number - 1 : GLFW_KEY_UNKNOWN;
    }
    if (name.size() == 1 && name[0] >= 'A' && name[0] <= 'Z') return GLFW_KEY_A + name[0] - 'A';
    if (name.size() == 1 && name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + name[0] - '0';
    return GLFW_KEY_UNKNOWN;
}

std::vector<Binding> makeBindings() {
    std::vector<Binding> bindings;
    for (const ActionInfo& action : actionsTable()) {
        std::istringstream chords{std::string(action.key)};
        for (std::string chord; chords >> chord;) {
            const auto named = chordNamed(chord);
            if (!named) {
                spdlog::warn("action '{}' names a key that does not exist: {}", action.name, chord);
                continue;
            }
            bindings.push_back({*named, action.action});
        }
    }
    return bindings;
}

const std::vector<Binding>& bindings() {
    static const std::vector<Binding> kBindings = makeBindings();
    return kBindings;
}

}  // namespace

std::optional<Chord> chordNamed(std::string_view name) {
    std::string rest(name);
    Chord chord;
    for (std::size_t plus; (plus = rest.find('+')) != std::string::npos && plus > 0;) {
        const std::string modifier = rest.substr(0, plus);
        if (modifier == "Shift") {
            chord.modifiers |= GLFW_MOD_SHIFT;
        } else if (modifier == "Ctrl") {
            chord.modifiers |= GLFW_MOD_CONTROL;
        } else if (modifier == "Alt") {
            chord.modifiers |= GLFW_MOD_ALT;
        } else {
            return std::nullopt;
        }
        rest.erase(0, plus + 1);
    }
    if (rest == "?") {  // a shifted key on most layouts
        rest = "/";
        chord.modifiers |= GLFW_MOD_SHIFT;
    }
    chord.key = keyNamed(rest);
    if (chord.key == GLFW_KEY_UNKNOWN) return std::nullopt;
    return chord;
}

std::optional<Action> actionOfKey(int key, int modifiers) {
    constexpr int kModifiers = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
    for (const Binding& binding : bindings()) {
        if (binding.chord.key == key && binding.chord.modifiers == (modifiers & kModifiers)) {
            return binding.action;
        }
    }
    return std::nullopt;
}

int keyOf(Action action) {
    for (const Binding& binding : bindings()) {
        if (binding.action == action) return binding.chord.key;
    }
    return GLFW_KEY_UNKNOWN;
}

}  // namespace mv
