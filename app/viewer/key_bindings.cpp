#include "app/viewer/key_bindings.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mv {
namespace {

// By the names of script.h; letters, digits and F1 on follow each other in GLFW's codes.
constexpr std::pair<std::string_view, int> kKeys[] = {
    {"Space", GLFW_KEY_SPACE},
    {"Left", GLFW_KEY_LEFT},
    {"Right", GLFW_KEY_RIGHT},
    {"Up", GLFW_KEY_UP},
    {"Down", GLFW_KEY_DOWN},
    {"Enter", GLFW_KEY_ENTER},
    {"Tab", GLFW_KEY_TAB},
    {"Escape", GLFW_KEY_ESCAPE},
    {"Insert", GLFW_KEY_INSERT},
    {"Delete", GLFW_KEY_DELETE},
    {"Home", GLFW_KEY_HOME},
    {"End", GLFW_KEY_END},
    {"PageUp", GLFW_KEY_PAGE_UP},
    {"PageDown", GLFW_KEY_PAGE_DOWN},
    {"Backspace", GLFW_KEY_BACKSPACE},
    {"Menu", GLFW_KEY_MENU},
    {"Pause", GLFW_KEY_PAUSE},
    {";", GLFW_KEY_SEMICOLON},
    {"'", GLFW_KEY_APOSTROPHE},
    {"`", GLFW_KEY_GRAVE_ACCENT},
    {"\\", GLFW_KEY_BACKSLASH},
    {"-", GLFW_KEY_MINUS},
    {"=", GLFW_KEY_EQUAL},
    {"[", GLFW_KEY_LEFT_BRACKET},
    {"]", GLFW_KEY_RIGHT_BRACKET},
    {".", GLFW_KEY_PERIOD},
    {",", GLFW_KEY_COMMA},
    {"/", GLFW_KEY_SLASH},
    {"?", GLFW_KEY_SLASH},
};

int keyNamed(const std::string& name) {
    for (const auto& [known, key] : kKeys) {
        if (known == name) return key;
    }
    if (name.size() == 1)
        return name[0] >= 'A' ? GLFW_KEY_A + name[0] - 'A' : GLFW_KEY_0 + name[0] - '0';
    return name.empty() ? GLFW_KEY_UNKNOWN : GLFW_KEY_F1 + std::stoi(name.substr(1)) - 1;
}

struct Binding {
    KeyCode code;
    Action action;
};

std::vector<Binding> makeBindings() {
    std::vector<Binding> bindings;
    for (const ActionInfo& action : actionsTable()) {
        std::istringstream chords{std::string(action.key)};
        for (std::string name; chords >> name;) {
            if (const auto chord = script::parseChord(name)) {
                bindings.push_back({codeOf(*chord), action.action});
            } else {
                spdlog::warn("action '{}' names a key that does not exist: {}", action.name, name);
            }
        }
    }
    return bindings;
}

const std::vector<Binding>& bindings() {
    static const std::vector<Binding> kBindings = makeBindings();
    return kBindings;
}

}  // namespace

KeyCode codeOf(const script::Chord& chord) {
    const bool shift = chord.shift || chord.key == "?";  // a shifted key on most layouts
    return {keyNamed(chord.key), (chord.ctrl ? GLFW_MOD_CONTROL : 0) |
                                     (shift ? GLFW_MOD_SHIFT : 0) | (chord.alt ? GLFW_MOD_ALT : 0)};
}

std::optional<Action> actionOfKey(int key, int modifiers) {
    constexpr int kModifiers = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
    for (const Binding& binding : bindings()) {
        if (binding.code == KeyCode{key, modifiers & kModifiers}) return binding.action;
    }
    return std::nullopt;
}

int modifiersAfter(int key, int modifiers, bool pressed) {
    int own = 0;
    if (key == GLFW_KEY_LEFT_CONTROL || key == GLFW_KEY_RIGHT_CONTROL) own = GLFW_MOD_CONTROL;
    if (key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT) own = GLFW_MOD_SHIFT;
    if (key == GLFW_KEY_LEFT_ALT || key == GLFW_KEY_RIGHT_ALT) own = GLFW_MOD_ALT;
    if (key == GLFW_KEY_LEFT_SUPER || key == GLFW_KEY_RIGHT_SUPER) own = GLFW_MOD_SUPER;
    return pressed ? modifiers | own : modifiers & ~own;
}

int keyOf(Action action) {
    for (const Binding& binding : bindings()) {
        if (binding.action == action) return binding.code.key;
    }
    return GLFW_KEY_UNKNOWN;
}

}  // namespace mv
