#pragma once
// Performs a script on a Session, in a window or without one: mouse and keyboard commands become
// the InputEvents that a hand would make, everything else is done at once. After each command at
// least one frame is drawn, so that the next one finds what the last one made.

#include "app/common/script.h"
#include "app/viewer/session.h"

namespace mv {

class ScriptRunner {
  public:
    ScriptRunner(script::Script script, Session& session, Host& host);

    // Before each frame. Throws Error(ExitCode::usage) if a command cannot be done (no such widget
    // in sight), Error(ExitCode::checkFailed) if an expectation is not met.
    void step(int width, int height);
    bool started() const { return next_ > 0; }
    bool done() const { return next_ == script_.size() && wait_ == 0 && session_.input().empty(); }

  private:
    struct Position {
        double x = 0, y = 0;
    };
    // True once the command is finished; otherwise it is asked again in the next frame.
    bool perform(const script::Command& command, int width, int height);
    Position find(const script::Place& place, int width, int height) const;
    void press(const script::Chord& chord, bool down);
    void moveTo(Position position);

    script::Script script_;
    Session& session_;
    Host& host_;
    std::size_t next_ = 0;
    int wait_ = 0;    // frames before the next command
    int waited_ = 0;  // frames that the present command has waited
};

}  // namespace mv
