#pragma once
// The tour: five steps that drive the real window by scripts, each with a few sentences, from what
// a view is to what the error is. What stood before comes back when it is left.

#include <memory>

#include "app/common/state.h"
#include "app/viewer/script_runner.h"

namespace mv {

class Tour {
  public:
    // Begins with the first step, on a scene that ships with the program.
    Tour(Session& session, Host& host);

    // Before each frame: goes on with the step's script. Throws what a script throws.
    void advance(int width, int height);
    // Forward or backward, as far as there are steps.
    void move(int steps);
    void restart();
    // Puts back what stood before.
    void leave();
    ui::TourStep shown() const;

  private:
    void begin();
    void run(const std::string& commands);
    void pickView();

    Session& session_;
    Host& host_;
    const State before_;
    const std::optional<ui::Instrument> instrumentBefore_;
    std::size_t step_ = 0;
    bool viewPicked_ = true;
    std::unique_ptr<ScriptRunner> script_;
};

}  // namespace mv
