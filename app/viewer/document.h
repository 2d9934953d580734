#pragma once
// What a user edits: the settings, what they were before, and what of them the program may choose
// in the user's place.

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/settings/settings.h"

namespace mv {

class Document {
  public:
    // given: keys of the settings that the user asked for, which the program leaves alone.
    Document(const Settings& settings, std::vector<std::string> given);

    // Changes come into effect with the next frame and can be undone.
    Settings& edit() { return settings_; }
    const Settings& settings() const { return settings_; }

    // Lets a window average sets of samples while nothing moves.
    void averageFrames();
    // Lowers still pictures to what a software renderer can show; notice() says so. Both change the
    // defaults that reset() goes back to, and those settings that the user did not ask for.
    void lowerQuality();
    std::string notice() const;
    // The settings of a draft while something moves, of at most `pixels` pixels.
    Settings draftOf(Settings settings, double pixels) const;

    // Changes that cannot be undone: a state of another scene, the size of the window.
    void replace(const Settings& settings) { settings_ = noted_ = settings; }
    void setPictureSize(int width, int height);

    // After each frame, unless a widget is held: what has changed since is one change. True if
    // there is one.
    bool noteChange();
    // The last change, which could not come into effect, has been edited away: no step leads to it.
    void takeBack();
    void undo() { step(undo_, redo_); }
    void redo() { step(redo_, undo_); }
    void forgetChanges();
    bool canUndo() const { return !undo_.empty(); }
    bool canRedo() const { return !redo_.empty(); }

    const Settings& defaults() const { return defaults_; }
    void reset();  // everything but camera and scene to its default
    // The preset whose values the settings have, or "defaults"; empty if there is none.
    const std::string& preset();

    // Remembers what each side shows while it is no reference, and goes back to it.
    void noteMethods();
    void leaveReferences();  // takes them back

  private:
    bool isGiven(const char* key) const;
    Settings afterReset() const;
    void step(std::deque<Settings>& from, std::deque<Settings>& to);

    Settings settings_, defaults_;
    std::vector<std::string> given_;
    std::deque<Settings> undo_, redo_;
    Settings noted_;                    // what undo goes back to from here
    std::optional<Settings> presetOf_;  // whose preset preset_ is
    std::string preset_;
    struct Methods {
        Method left = Method::megaviews, right = Method::megaviews;
        bool compare = false;
    };
    Methods methods_;
};

}  // namespace mv
