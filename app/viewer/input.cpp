#include "app/viewer/input.h"

#include <algorithm>

namespace mv {

std::vector<InputEvent> InputQueue::takeFrame() {
    std::vector<InputEvent> frame;
    std::vector<MouseButton> buttons;
    std::vector<int> keys;
    bool typed = false, moved = false;
    const auto fits = [&](const InputEvent& event) {
        if (const auto* button = std::get_if<MouseButtonChanged>(&event)) {
            if (std::find(buttons.begin(), buttons.end(), button->button) != buttons.end()) {
                return false;
            }
            if (moved) return false;
            buttons.push_back(button->button);
        } else if (const auto* key = std::get_if<KeyChanged>(&event)) {
            if (typed || std::find(keys.begin(), keys.end(), key->key) != keys.end()) return false;
            keys.push_back(key->key);
        } else if (std::holds_alternative<TextTyped>(event)) {
            typed = true;
        } else if (std::holds_alternative<MouseMoved>(event)) {
            if (!buttons.empty()) return false;
            moved = true;
        }
        return true;
    };
    while (!events_.empty() && fits(events_.front())) {
        frame.push_back(std::move(events_.front()));
        events_.pop_front();
    }
    return frame;
}

bool InputQueue::holdsOnlyMoves() const {
    return std::all_of(events_.begin(), events_.end(), [](const InputEvent& event) {
        return std::holds_alternative<MouseMoved>(event);
    });
}

bool InputQueue::holdsPress(int key) const {
    return std::any_of(events_.begin(), events_.end(), [&](const InputEvent& event) {
        const auto* change = std::get_if<KeyChanged>(&event);
        return change && change->pressed && change->key == key;
    });
}

}  // namespace mv
