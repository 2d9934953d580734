#include "app/common/script.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "app/common/output_names.h"
#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/text.h"
#include "megaviews/settings/settings_table.h"

namespace mv::script {
namespace {

constexpr double kLongestScroll = 1000, kFarthestPixel = 32768;
constexpr int kLongestWait = 1000000, kLargestWindow = 16384;
constexpr std::size_t kLongestQuote = 60;  // of a command in a message

// ---------------------------------------------------------------- words

constexpr bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// One command's text with its place among the others; `fail` names both.
struct Source {
    std::string_view where;
    int number = 0;
    std::string text;

    std::string place() const { return std::string(where) + ": command " + std::to_string(number); }
    [[noreturn]] void fail(const std::string& reason) const {
        throw Error(ExitCode::usage, place() + ": " + reason);
    }
    [[noreturn]] void refuse(std::string_view word, const std::string& reason) const {
        fail("'" + std::string(word) + "' " + reason);
    }
};

// Cuts a script into commands: at ';' and line ends outside quotes, without comments. A '#' begins
// one where a word could begin; inside a word ('scene#2.glb') it is a character like any other.
std::vector<Source> cut(std::string_view text, std::string_view where) {
    std::vector<Source> sources;
    std::string current;
    bool quoted = false, comment = false;
    const auto finish = [&] {
        if (!trimmed(current).empty()) {
            const int number = static_cast<int>(sources.size()) + 1;
            sources.push_back({where, number, std::string(trimmed(current))});
        }
        current.clear();
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\n') {
            if (quoted) break;
            comment = false;
            finish();
        } else if (comment) {
            continue;
        } else if (quoted) {
            current += c;
            if (c == '\\' && i + 1 < text.size() && text[i + 1] != '\n') current += text[++i];
            if (c == '"') quoted = false;
        } else if (c == ';') {
            finish();
        } else if (c == '#' && (current.empty() || isSpace(current.back()))) {
            comment = true;
        } else {
            quoted = c == '"';
            current += c;
        }
    }
    if (quoted) {
        Source{where, static_cast<int>(sources.size()) + 1, {}}.fail(
            "a quotation mark is not closed in its line");
    }
    finish();
    return sources;
}

// The words of one command; what stands in quotes is one word, or a part of one.
class Words {
  public:
    explicit Words(const Source& source) : source_(source), rest_(source.text) {}

    bool empty() const { return rest_.empty(); }
    std::string_view rest() const { return rest_; }

    // The next word without its quotes; empty if there is none left.
    std::string next() {
        std::size_t length = 0;
        std::string word = read(rest_, length, true);
        rest_ = trimmed(rest_.substr(length));
        return word;
    }
    std::string need(const std::string& what) {
        if (rest_.empty()) source_.fail("'" + source_.text + "' lacks " + what);
        return next();
    }
    // All that is left as one: a file's name may have spaces, in quotes or not.
    std::string needAll(const std::string& what) {
        if (rest_.empty()) source_.fail("'" + source_.text + "' lacks " + what);
        std::size_t length = 0;
        std::string all = read(rest_, length, false);
        rest_ = {};
        return all;
    }
    void end() const {
        if (!rest_.empty()) source_.refuse(rest_, "is more than this command takes");
    }

  private:
    static std::string read(std::string_view text, std::size_t& length, bool oneWord) {
        std::string out;
        bool quoted = false;
        for (length = 0; length < text.size(); ++length) {
            const char c = text[length];
            if (c == '"') {
                quoted = !quoted;
            } else if (quoted && c == '\\' && length + 1 < text.size()) {
                const char escaped = text[++length];
                out += escaped == 'n' ? '\n' : escaped == 't' ? '\t' : escaped;
            } else if (!quoted && oneWord && isSpace(c)) {
                break;
            } else {
                out += c;
            }
        }
        return out;
    }

    const Source& source_;
    std::string_view rest_;
};

// ---------------------------------------------------------------- values

double number(const Source& source, std::string_view text, double low, double high, bool whole) {
    return numberFromText(text, low, high, whole, source.place());
}

// "12,34" or "50%,25%".
Place place(const Source& source, const std::string& word, double lowest) {
    Place out;
    if (word.starts_with("@")) {
        out.kind = Place::Kind::widget;
        out.widget = word.substr(1);
        if (out.widget.empty()) source.refuse(word, "names no widget");
        return out;
    }
    const std::size_t comma = word.find(',');
    if (comma == std::string::npos) {
        source.refuse(word, "is no place: X,Y in pixels, X%,Y% of the window, or @widget");
    }
    std::string x = word.substr(0, comma), y = word.substr(comma + 1);
    if (x.ends_with("%") != y.ends_with("%")) {
        source.refuse(word, "mixes pixels and shares of the window");
    }
    double scale = 1, highest = kFarthestPixel;
    if (x.ends_with("%")) {
        out.kind = Place::Kind::share;
        x.pop_back();
        y.pop_back();
        scale = 0.01;
        highest = 100;
        lowest = std::max(lowest, -highest);
    }
    out.x = scale * number(source, x, lowest, highest, false);
    out.y = scale * number(source, y, lowest, highest, false);
    return out;
}

Place nextPlace(const Source& source, Words& words) {
    return place(source, words.need("a place: X,Y or @widget"), -kFarthestPixel);
}

Button nextButton(const Source& source, Words& words) {
    if (words.empty()) return Button::left;
    const std::string word = words.next();
    if (word == "left") return Button::left;
    if (word == "right") return Button::right;
    if (word == "middle") return Button::middle;
    source.refuse(word, "is no mouse button: left, right or middle");
}

Chord nextChord(const Source& source, Words& words, bool needsKey) {
    const std::string word = words.need("a key");
    const auto chord = parseChord(word);
    if (!chord) source.refuse(word, "is no key; keys are named as in Ctrl+Z, F1, Enter, Left");
    if (needsKey && chord->key.empty()) source.refuse(word, "holds modifiers but no key");
    return *chord;
}

std::string ending(const Source& source, const std::string& file,
                   const std::vector<std::string>& allowed) {
    const std::string extension = extensionOf(file);
    if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return file;
    source.refuse(file, "must end in " + joined(allowed, " or "));
}

const SettingInfo& settingOf(const Source& source, const std::string& key) {
    if (const SettingInfo* setting = findSetting(key)) return *setting;
    source.fail("unknown setting '" + key + "'" +
                didYouMean(key, namesIn(settingsTable(), &SettingInfo::key)));
}

// The value must read as one of the setting's, now rather than in the middle of a run.
void checkValue(const Source& source, const std::string& key, const std::string& value) {
    Settings scratch;
    setFromText(scratch, settingOf(source, key), value, source.place() + ": " + key);
}

// "key=value", "key = value", and for expectations "key!=value".
struct Assignment {
    std::string key, value;
    bool differs = false;
};
std::optional<Assignment> assignment(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    Assignment out;
    std::string_view key = text.substr(0, equals);
    if (key.ends_with('!')) {
        out.differs = true;
        key.remove_suffix(1);
    }
    key = trimmed(key);
    const bool name = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_';
    });
    if (!name) return std::nullopt;
    const Source value{{}, 0, std::string(trimmed(text.substr(equals + 1)))};
    Words words(value);
    out.key = std::string(key);
    out.value = words.empty() ? std::string() : words.needAll("");
    return out;
}

// ---------------------------------------------------------------- commands

using Read = Step (*)(const Source&, Words&);

Step readClick(const Source& source, Words& words, Button button, int count) {
    Click click{nextPlace(source, words), button, count};
    if (button == Button::left) click.button = nextButton(source, words);
    return click;
}

Step readDrag(const Source& source, Words& words) {
    Drag drag;
    drag.from = nextPlace(source, words);
    std::string to = words.need("where it ends: X,Y, @widget, or by X,Y");
    if (to == "by") {
        drag.by = true;
        to = words.need("a distance: X,Y");
        if (to.starts_with("@")) source.refuse(to, "is no distance: X,Y");
    }
    drag.to = place(source, to, -kFarthestPixel);
    drag.button = nextButton(source, words);
    return drag;
}

Step readResize(const Source& source, Words& words) {
    const std::string size = words.need("a size: WxH");
    const std::size_t cross = size.find_first_of("xX");
    if (cross == std::string::npos) source.refuse(size, "is not WxH");
    const double w = number(source, size.substr(0, cross), 1, kLargestWindow, true);
    const double h = number(source, size.substr(cross + 1), 1, kLargestWindow, true);
    return Resize{static_cast<int>(w), static_cast<int>(h)};
}

Step readExpect(const Source& source, Words& words) {
    const std::string_view rest = words.rest();
    const auto given = assignment(rest);
    if (!given) source.refuse(rest, "is not KEY=VALUE or KEY!=VALUE");
    checkValue(source, given->key, given->value);
    words.needAll("");
    return Expect{given->key, given->value, given->differs};
}

Step readType(const Source&, Words& words) { return Type{words.needAll("a text")}; }

struct Form {
    std::string_view name;
    Read read;
};
constexpr Form kForms[] = {
    {"wait",
     [](const Source& s, Words& w) -> Step {
         const std::string n = w.empty() ? "1" : w.next();
         return Wait{static_cast<int>(number(s, n, 0, kLongestWait, true))};
     }},
    {"wait-loading", [](const Source&, Words&) -> Step { return WaitLoading{}; }},
    {"wait-still", [](const Source&, Words&) -> Step { return WaitStill{}; }},
    {"move", [](const Source& s, Words& w) -> Step { return Move{nextPlace(s, w)}; }},
    {"hover", [](const Source& s, Words& w) -> Step { return Move{nextPlace(s, w)}; }},
    {"click", [](const Source& s, Words& w) { return readClick(s, w, Button::left, 1); }},
    {"right-click", [](const Source& s, Words& w) { return readClick(s, w, Button::right, 1); }},
    {"middle-click", [](const Source& s, Words& w) { return readClick(s, w, Button::middle, 1); }},
    {"double-click", [](const Source& s, Words& w) { return readClick(s, w, Button::left, 2); }},
    {"drag", readDrag},
    {"scroll",
     [](const Source& s, Words& w) -> Step {
         return Scroll{number(s, w.need("steps"), -kLongestScroll, kLongestScroll, false)};
     }},
    {"key",
     [](const Source& s, Words& w) -> Step {
         return Key{nextChord(s, w, true), Key::What::press};
     }},
    {"hold",
     [](const Source& s, Words& w) -> Step {
         return Key{nextChord(s, w, false), Key::What::hold};
     }},
    {"release",
     [](const Source& s, Words& w) -> Step {
         return Key{nextChord(s, w, false), Key::What::release};
     }},
    {"type", readType},
    {"resize", readResize},
    {"open",
     [](const Source&, Words& w) -> Step {
         return Open{w.needAll("a file"), false};
     }},
    {"drop",
     [](const Source&, Words& w) -> Step {
         return Open{w.needAll("a file"), true};
     }},
    {"time",
     [](const Source& s, Words& w) -> Step {
         return SetTime{number(s, w.need("seconds"), -1e9, 1e9, false)};
     }},
    {"save",
     [](const Source& s, Words& w) -> Step {
         return Save{ending(s, w.needAll("a file"), {".png", ".exr"}), Save::What::picture};
     }},
    {"save-window",
     [](const Source& s, Words& w) -> Step {
         return Save{ending(s, w.needAll("a file"), {".png"}), Save::What::window};
     }},
    {"save-state",
     [](const Source&, Words& w) -> Step {
         return Save{w.needAll("a file"), Save::What::state};
     }},
    {"save-scene",
     [](const Source& s, Words& w) -> Step {
         return Save{ending(s, w.needAll("a file"), {".glb"}), Save::What::scene};
     }},
    {"load-state", [](const Source&, Words& w) -> Step { return Open{w.needAll("a file")}; }},
    {"expect", readExpect},
};

[[noreturn]] void refuseUnknown(const Source& source, const std::string& word) {
    std::vector<std::string> names = namesIn(actionsTable(), idOf);
    for (const Form& form : kForms) names.emplace_back(form.name);
    source.fail("unknown action '" + word + "'" +
                didYouMean(word, names, "; --list actions names all"));
}

Step readStep(const Source& source) {
    Words words(source);
    const std::string word = words.next();
    // Some actions share their name with a command that takes a file; alone they are the action.
    const ActionInfo* action = findAction(word);
    if (action && words.empty()) return Perform{action->action};
    const auto form = std::find_if(std::begin(kForms), std::end(kForms),
                                   [&](const Form& f) { return f.name == word; });
    const bool assigns = words.rest().starts_with("=");
    if (form != std::end(kForms) && !assigns) {
        Step step = form->read(source, words);
        words.end();
        return step;
    }
    if (const auto given = assignment(source.text); given && !given->differs) {
        checkValue(source, given->key, given->value);
        return SetValue{given->key, given->value};
    }
    if (action) words.end();
    refuseUnknown(source, word);
}

// ---------------------------------------------------------------- keys

constexpr std::array<std::string_view, 29> kNamedKeys = {
    "Enter", "Space",  "Tab",      "Escape", "Backspace", "Delete", "Insert", "Home",
    "End",   "PageUp", "PageDown", "Left",   "Right",     "Up",     "Down",   "-",
    "=",     "[",      "]",        ".",      ",",         "/",      "?",      ";",
    "'",     "`",      "\\",       "Menu",   "Pause"};

std::string keyName(std::string_view text) {
    if (text.size() == 1) {
        const char c = text[0];
        if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z')) return std::string(text);
        if (c >= 'a' && c <= 'z') return std::string(1, static_cast<char>(c - 'a' + 'A'));
    }
    for (const std::string_view name : kNamedKeys) {
        if (text == name) return std::string(name);
    }
    for (int i = 1; i <= 12; ++i) {
        std::string name = "F" + std::to_string(i);
        if (text == name) return name;
    }
    return {};
}

std::string shortened(const std::string& text) {
    if (text.size() <= kLongestQuote) return text;
    std::size_t end = kLongestQuote;  // never within a character of several bytes
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return text.substr(0, end) + "...";
}

}  // namespace

std::optional<Chord> parseChord(std::string_view text) {
    Chord chord;
    while (true) {
        const std::size_t plus = text.find('+');
        const std::string_view part = text.substr(0, plus);
        bool* modifier = nullptr;
        if (part == "Ctrl") modifier = &chord.ctrl;
        if (part == "Shift") modifier = &chord.shift;
        if (part == "Alt") modifier = &chord.alt;
        if (modifier) {
            if (*modifier) return std::nullopt;  // twice
            *modifier = true;
            if (plus == std::string_view::npos) return chord;
            text.remove_prefix(plus + 1);
            continue;
        }
        chord.key = keyName(text);
        if (chord.key.empty()) return std::nullopt;
        return chord;
    }
}

std::string toText(const Chord& chord) {
    std::string text;
    if (chord.ctrl) text += "Ctrl+";
    if (chord.shift) text += "Shift+";
    if (chord.alt) text += "Alt+";
    if (chord.key.empty() && !text.empty()) text.pop_back();
    return text + chord.key;
}

Script parse(std::string_view text, std::string_view where) {
    Script script;
    for (const Source& source : cut(text, where)) {
        script.push_back({readStep(source), source.number, shortened(source.text)});
    }
    return script;
}

Script parseOption(const std::string& value, std::string_view where) {
    if (!value.starts_with("@")) return parse(value, where);
    const std::string path = value.substr(1);
    std::string text;
    try {
        text = readTextFile(path, ExitCode::usage);
    } catch (const Error& error) {
        throw Error(error.code, std::string(where) + ": " + error.what());
    }
    return parse(text, std::string(where) + " " + path);
}

std::optional<std::string> unmet(const Expect& expect, const Settings& settings) {
    const SettingInfo& setting = *findSetting(expect.key);
    Settings wanted;
    setFromText(wanted, setting, expect.value, expect.key);
    const std::string is = mv::toText(settings, setting), should = mv::toText(wanted, setting);
    bool equal = is == should;
    // Numbers that were added up in steps need not be the same in their last digits.
    const auto close = [](double a, double b) {
        return std::abs(a - b) <= 1e-6 * std::max({std::abs(a), std::abs(b), 1e-6});
    };
    if (const auto* field = std::get_if<Field<double>>(&setting.field)) {
        equal = close(field->get(settings), field->get(wanted));
    } else if (const auto* optional = std::get_if<Field<std::optional<double>>>(&setting.field)) {
        const auto a = optional->get(settings), b = optional->get(wanted);
        equal = a && b ? close(*a, *b) : a.has_value() == b.has_value();
    }
    if (equal != expect.differs) return std::nullopt;
    if (expect.differs) return expect.key + " is " + is + " and should not be";
    return expect.key + " is " + is + " and should be " + should;
}

std::vector<std::string> outputFiles(const Script& script) {
    std::vector<std::string> files;
    for (const Command& command : script) {
        const auto* save = std::get_if<Save>(&command.step);
        if (save && std::find(files.begin(), files.end(), save->file) == files.end()) {
            files.push_back(save->file);
        }
    }
    return files;
}

std::vector<std::string> inputFiles(const Script& script) {
    std::vector<std::string> files, saved;
    for (const Command& command : script) {
        if (const auto* save = std::get_if<Save>(&command.step)) saved.push_back(save->file);
        const auto* open = std::get_if<Open>(&command.step);
        if (open && std::find(saved.begin(), saved.end(), open->file) == saved.end() &&
            !open->file.starts_with("builtin:")) {
            files.push_back(open->file);
        }
    }
    return files;
}

}  // namespace mv::script
