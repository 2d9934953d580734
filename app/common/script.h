#pragma once
// What a user would do, written down: actions, settings, mouse and keyboard, one command after
// another, as `--actions` takes them. This file reads scripts and checks them; the viewer performs
// them, in a window or without one. The grammar stands in docs/command-line.md.

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "megaviews/settings/actions.h"
#include "megaviews/settings/settings.h"

namespace mv::script {

// A place in the window: the middle of a widget (`@vpls`), window pixels from the top left corner
// (`120,48`), or shares of the window's size (`50%,25%`).
struct Place {
    enum class Kind { pixels, share, widget };
    Kind kind = Kind::pixels;
    double x = 0, y = 0;  // pixels, or 0..1 of the window
    std::string widget;   // its key or label, without the @
    bool operator==(const Place&) const = default;
};

enum class Button { left, right, middle };

// "Ctrl+Shift+Z": modifiers, and a key by the name it has in actionsTable(), or none. Letters are
// upper case; "?" and the like stand for the key that types them.
struct Chord {
    bool ctrl = false, shift = false, alt = false;
    std::string key;  // empty: modifiers alone, for hold and release
    bool operator==(const Chord&) const = default;
};

struct Perform {
    Action action;
};
struct SetValue {  // the value reads as one of the setting's
    std::string key, value;
};
struct Expect {  // a failed run if the setting differs, or with `differs` if it does not
    std::string key, value;
    bool differs = false;
};
struct Wait {  // frames
    int frames = 1;
};
struct WaitLoading {};  // until no scene is being loaded
struct WaitStill {};    // until the picture has accumulated all it will
struct Move {
    Place to;
};
struct Click {
    Place at;
    Button button = Button::left;
    int count = 1;  // 2: double click
};
struct Drag {
    Place from, to;
    bool by = false;  // `to` is a distance from `from`
    Button button = Button::left;
};
struct Scroll {  // steps of the wheel, up is positive
    double steps = 0;
};
struct Key {
    enum class What { press, hold, release };
    Chord chord;
    What what = What::press;
};
struct Type {  // UTF-8
    std::string text;
};
struct Resize {
    int width = 0, height = 0;
};
struct Open {  // a scene, a state, or a picture that carries one
    std::string file;
    bool dropped = false;
};
struct SetTime {
    double timeS = 0;
};
struct Save {
    enum class What { picture, window, state, scene };
    std::string file;
    What what = What::picture;
};

using Step = std::variant<Perform, SetValue, Expect, Wait, WaitLoading, WaitStill, Move, Click,
                          Drag, Scroll, Key, Type, Resize, Open, SetTime, Save>;

struct Command {
    Step step;
    int number = 0;    // counted from 1
    std::string text;  // as written, for messages: "command 3, 'click @vpls'"
};
using Script = std::vector<Command>;

// Throws Error(ExitCode::usage) that starts with `where` and names the command. Nothing is opened.
Script parse(std::string_view text, std::string_view where);
// The value of --actions: commands, or @FILE that holds them.
Script parseOption(const std::string& value, std::string_view where);

// Why the expectation is not met, as one sentence, or nothing. Numbers match to six digits.
std::optional<std::string> unmet(const Expect& expect, const Settings& settings);

// Files that the script will write, each once, and those that it will open and has not written
// before, for the checks before anything takes long.
std::vector<std::string> outputFiles(const Script& script);
std::vector<std::string> inputFiles(const Script& script);

// "Ctrl+Shift+Z", or nothing if there is no such key.
std::optional<Chord> parseChord(std::string_view text);
std::string toText(const Chord& chord);

}  // namespace mv::script
