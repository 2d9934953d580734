#include "app/viewer/key_bindings.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace mv {
namespace {

struct Binding {
    int key, modifiers;
    Action action;
};

int keyNamed(const std::string& name) {
    static const std::unordered_map<std::string, int> kNames = {
        {"Space", GLFW_KEY_SPACE},    {"Left", GLFW_KEY_LEFT},      {"Right", GLFW_KEY_RIGHT},
        {"Up", GLFW_KEY_UP},          {"Down", GLFW_KEY_DOWN},      {"Enter", GLFW_KEY_ENTER},
        {"Esc", GLFW_KEY_ESCAPE},     {"-", GLFW_KEY_MINUS},        {"=", GLFW_KEY_EQUAL},
        {"[", GLFW_KEY_LEFT_BRACKET}, {"]", GLFW_KEY_RIGHT_BRACKET}};
    if (const auto found = kNames.find(name); found != kNames.end()) return found->second;
    if (name.size() > 1 && name[0] == 'F') return GLFW_KEY_F1 + std::stoi(name.substr(1)) - 1;
    if (name.size() == 1 && name[0] >= 'A' && name[0] <= 'Z') return GLFW_KEY_A + name[0] - 'A';
    if (name.size() == 1 && name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + name[0] - '0';
    return GLFW_KEY_UNKNOWN;
}

std::vector<Binding> makeBindings() {
    std::vector<Binding> bindings;
    for (const ActionInfo& action : actionsTable()) {
        std::istringstream chords{std::string(action.key)};
        for (std::string chord; chords >> chord;) {
            Binding binding{GLFW_KEY_UNKNOWN, 0, action.action};
            for (std::size_t plus; (plus = chord.find('+')) != std::string::npos && plus > 0;) {
                const std::string modifier = chord.substr(0, plus);
                binding.modifiers |= modifier == "Shift"  ? GLFW_MOD_SHIFT
                                     : modifier == "Ctrl" ? GLFW_MOD_CONTROL
                                                          : GLFW_MOD_ALT;
                chord.erase(0, plus + 1);
            }
            if (chord == "?") {  // a shifted key on most layouts
                chord = "/";
                binding.modifiers |= GLFW_MOD_SHIFT;
                binding.key = GLFW_KEY_SLASH;
            } else {
                binding.key = keyNamed(chord);
            }
            if (binding.key == GLFW_KEY_UNKNOWN) {
                spdlog::warn("action '{}' names a key that does not exist: {}", action.name, chord);
                continue;
            }
            bindings.push_back(binding);
        }
    }
    return bindings;
}

}  // namespace

std::optional<Action> actionOfKey(int key, int modifiers) {
    static const std::vector<Binding> kBindings = makeBindings();
    constexpr int kModifiers = GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT;
    for (const Binding& binding : kBindings) {
        if (binding.key == key && binding.modifiers == (modifiers & kModifiers)) {
            return binding.action;
        }
    }
    return std::nullopt;
}

}  // namespace mv
