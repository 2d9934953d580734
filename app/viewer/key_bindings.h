#pragma once
// From a pressed key to an action, by the keys that the list of actions names.

#include <optional>

#include "app/common/script.h"
#include "megaviews/settings/actions.h"

namespace mv {

// As GLFW reports them; without a key, GLFW_KEY_UNKNOWN.
struct KeyCode {
    int key = 0, modifiers = 0;
    bool operator==(const KeyCode&) const = default;
};
KeyCode codeOf(const script::Chord& chord);

std::optional<Action> actionOfKey(int key, int modifiers);
// What is held after a key: X11 reports what was held before it (glfw/glfw#1630).
int modifiersAfter(int key, int modifiers, bool pressed);
// The key of an action's first chord, without its modifiers.
int keyOf(Action action);

}  // namespace mv
