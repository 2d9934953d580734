#pragma once
// From a pressed key to an action, by the keys that the list of actions names.

#include <optional>

#include "megaviews/settings/actions.h"

namespace mv {

// key and modifiers as GLFW reports them.
std::optional<Action> actionOfKey(int key, int modifiers);

}  // namespace mv
