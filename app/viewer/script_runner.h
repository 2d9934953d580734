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
    // Each true once its command is finished; otherwise it is asked again in the next frame.
    bool run(const script::Perform& step);
    bool run(const script::SetValue& step);
    bool run(const script::Expect& step);
    bool run(const script::Wait& step);
    bool run(const script::WaitLoading& step);
    bool run(const script::WaitStill& step);
    bool run(const script::Move& step);
    bool run(const script::Click& step);
    bool run(const script::Drag& step);
    bool run(const script::Scroll& step);
    bool run(const script::Key& step);
    bool run(const script::Type& step);
    bool run(const script::Resize& step);
    bool run(const script::Open& step);
    bool run(const script::SetTime& step);
    bool run(const script::Save& step);
    std::string where() const;  // the present command, for errors
    Position find(const script::Place& place) const;
    void press(const script::Chord& chord, bool down);
    void moveTo(Position position);

    script::Script script_;
    Session& session_;
    Host& host_;
    int width_ = 0, height_ = 0;  // of the window, in the present frame
    std::size_t next_ = 0;
    int wait_ = 0;    // frames before the next command
    int waited_ = 0;  // frames that the present command has waited
};

}  // namespace mv
