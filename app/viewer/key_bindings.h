#pragma once
// From a pressed key to an action, by the keys that the list of actions names.

#include <optional>
#include <string_view>

#include "megaviews/settings/actions.h"

namespace mv {

// key and modifiers as GLFW reports them.
std::optional<Action> actionOfKey(int key, int modifiers);
// The key of an action's first chord, without its modifiers.
int keyOf(Action action);
// A chord such as "Ctrl+Shift+Z" or "F12"; nothing if there is no such key.
struct Chord {
    int key = 0, modifiers = 0;
};
std::optional<Chord> chordNamed(std::string_view name);

}  // namespace mv
