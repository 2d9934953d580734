#include "app/viewer/script_runner.h"

#include <GLFW/glfw3.h>
#include <spdlog/spdlog.h>

#include "app/viewer/key_bindings.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

constexpr int kLongestWait = 20000;  // frames; loading sleeps in between

MouseButton buttonOf(script::Button button) {
    switch (button) {
        case script::Button::right:
            return MouseButton::right;
        case script::Button::middle:
            return MouseButton::middle;
        default:
            return MouseButton::left;
    }
}

// Code points of valid UTF-8; anything else is left out.
std::vector<unsigned> codepoints(const std::string& text) {
    std::vector<unsigned> out;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        const int more = lead < 0x80 ? 0 : lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : 1;
        unsigned code = more == 0 ? lead : lead & (0x3Fu >> more);
        for (int k = 0; k < more && i < text.size(); ++k) {
            code = code << 6 | (static_cast<unsigned char>(text[i++]) & 0x3Fu);
        }
        out.push_back(code);
    }
    return out;
}

}  // namespace

ScriptRunner::ScriptRunner(script::Script script, Session& session, Host& host)
    : script_(std::move(script)), session_(session), host_(host) {}

void ScriptRunner::step(int width, int height) {
    if (wait_ > 0) {
        --wait_;
        return;
    }
    if (next_ == script_.size() || !session_.input().empty()) return;
    width_ = width;
    height_ = height;
    const script::Command& command = script_[next_];
    if (std::visit([this](const auto& todo) { return run(todo); }, command.step)) {
        ++next_;
        waited_ = 0;
        wait_ = std::max(wait_, 1);
    } else if (++waited_ > kLongestWait) {
        throw Error(ExitCode::checkFailed,
                    where() + ", '" + command.text + "': has waited too long");
    }
}

std::string ScriptRunner::where() const {
    return "--actions: command " + std::to_string(script_[next_].number);
}

ScriptRunner::Position ScriptRunner::find(const script::Place& place) const {
    switch (place.kind) {
        case script::Place::Kind::pixels:
            return {place.x, place.y};
        case script::Place::Kind::share:
            return {place.x * width_, place.y * height_};
        case script::Place::Kind::widget:
            break;
    }
    const auto& interface = session_.interface();
    auto item = interface.findItem(place.widget);
    for (const auto& other : interface.itemRects()) {
        if (!item && other.name.ends_with(":" + place.widget)) item = other;
    }
    if (!item) {
        throw Error(ExitCode::usage, where() + ", '" + script_[next_].text + "': there is no '" +
                                         place.widget + "' in sight");
    }
    return {static_cast<double>(item->centerX()), static_cast<double>(item->centerY())};
}

void ScriptRunner::moveTo(Position position) {
    session_.input().push(MouseMoved{position.x, position.y});
}

void ScriptRunner::press(const script::Chord& chord, bool down) {
    InputQueue& input = session_.input();
    const auto modifier = [&](bool used, int key, int bit) {
        if (used) input.push(KeyChanged{key, down ? bit : 0, down});
    };
    const KeyCode code = codeOf(chord);
    const bool named = code.key != GLFW_KEY_UNKNOWN;
    if (!down && named) input.push(KeyChanged{code.key, code.modifiers, false});
    modifier(chord.ctrl, GLFW_KEY_LEFT_CONTROL, GLFW_MOD_CONTROL);
    modifier(chord.shift, GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT);
    modifier(chord.alt, GLFW_KEY_LEFT_ALT, GLFW_MOD_ALT);
    if (down && named) input.push(KeyChanged{code.key, code.modifiers, true});
}

bool ScriptRunner::run(const script::Perform& step) {
    session_.perform(step.action);
    return true;
}

bool ScriptRunner::run(const script::SetValue& step) {
    Settings changed = session_.settings();
    setFromText(changed, *findSetting(step.key), step.value, where());
    try {
        validate(changed);
    } catch (const Error& error) {
        throw Error(error.code, where() + ": " + error.what());
    }
    session_.editSettings() = changed;
    session_.fitWindow();
    return true;
}

bool ScriptRunner::run(const script::Expect& step) {
    if (const auto reason = script::unmet(step, session_.settings())) {
        throw Error(ExitCode::checkFailed, where() + ": " + *reason);
    }
    return true;
}

bool ScriptRunner::run(const script::Wait& step) {
    wait_ = step.frames;
    return true;
}

bool ScriptRunner::run(const script::WaitLoading&) { return !session_.loading(); }

bool ScriptRunner::run(const script::WaitStill&) {
    const ui::Model& m = session_.model();
    if (m.playing && m.animationS > 0 && !m.renderingPaused) {
        throw Error(ExitCode::usage, where() + ": the animation runs: nothing will stand still");
    }
    return !session_.loading() && session_.still();
}

bool ScriptRunner::run(const script::Move& step) {
    moveTo(find(step.to));
    return true;
}

bool ScriptRunner::run(const script::Click& step) {
    moveTo(find(step.at));
    for (int i = 0; i < step.count; ++i) {
        session_.input().push(MouseButtonChanged{buttonOf(step.button), true});
        session_.input().push(MouseButtonChanged{buttonOf(step.button), false});
    }
    return true;
}

bool ScriptRunner::run(const script::Drag& step) {
    const Position from = find(step.from);
    Position to = find(step.to);
    if (step.by) to = {from.x + to.x, from.y + to.y};
    moveTo(from);
    session_.input().push(MouseButtonChanged{buttonOf(step.button), true});
    moveTo({(from.x + to.x) / 2, (from.y + to.y) / 2});
    moveTo(to);
    session_.input().push(MouseButtonChanged{buttonOf(step.button), false});
    return true;
}

bool ScriptRunner::run(const script::Scroll& step) {
    session_.input().push(Scrolled{0, step.steps});
    return true;
}

bool ScriptRunner::run(const script::Key& step) {
    if (step.what != script::Key::What::release) press(step.chord, true);
    if (step.what != script::Key::What::hold) press(step.chord, false);
    return true;
}

bool ScriptRunner::run(const script::Type& step) {
    for (const unsigned code : codepoints(step.text)) session_.input().push(TextTyped{code});
    return true;
}

bool ScriptRunner::run(const script::Resize& step) {
    host_.resize(step.width, step.height);
    return true;
}

bool ScriptRunner::run(const script::Open& step) {
    if (step.dropped) {
        session_.input().push(FilesDropped{{step.file}});
    } else {
        session_.openFile(step.file);
    }
    return true;
}

bool ScriptRunner::run(const script::SetTime& step) {
    session_.setTime(step.timeS);
    return true;
}

bool ScriptRunner::run(const script::Save& step) {
    switch (step.what) {
        case script::Save::What::picture:
            session_.savePicture(step.file);
            spdlog::info("picture written: {}", step.file);
            break;
        case script::Save::What::window:
            session_.saveWindowAfterFrame(step.file);
            break;
        case script::Save::What::state:
            session_.saveState(step.file);
            break;
        case script::Save::What::scene:
            session_.saveScene(step.file);
            spdlog::info("scene written: {}", step.file);
            break;
    }
    return true;
}

}  // namespace mv
