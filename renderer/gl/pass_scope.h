#pragma once
// The one named scope every dispatch and draw goes through: debug group, timer and row of the
// profiler. On a GPU a pair of timestamps, read when ready; on a software renderer, whose GPU
// timers are wrong by orders of magnitude, glFinish and a steady clock.

#include <epoxy/gl.h>

#include <chrono>
#include <string>
#include <vector>

#include "megaviews/settings/statistics.h"

namespace mv::gl {

class Profiler {
  public:
    Profiler();
    ~Profiler();
    Profiler(const Profiler&) = delete;
    Profiler& operator=(const Profiler&) = delete;
    // Stages since the last take(), in order of their first scope, times of equal names added.
    // Waits for timestamps that are still under way.
    std::vector<StageTime> take();
    const char* clock() const;  // "gpu timer" or "wall clock, synchronised"
    bool enabled = true;        // off: scopes keep only their debug group

  private:
    friend class PassScope;
    struct Pending {
        std::string name;
        GLuint begin = 0, end = 0;  // timestamp queries, or 0
        double ms = 0;              // wall clock
    };
    GLuint takeQuery();
    std::vector<Pending> pending_;
    std::vector<GLuint> freeQueries_;
    bool wallClock_ = true;
};

class PassScope {
  public:
    PassScope(Profiler& profiler, std::string name);
    ~PassScope();
    PassScope(const PassScope&) = delete;
    PassScope& operator=(const PassScope&) = delete;

  private:
    Profiler& profiler_;
    std::string name_;
    bool timed_;
    GLuint begin_ = 0;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace mv::gl
