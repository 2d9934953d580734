#pragma once
// The one named scope every dispatch and draw goes through: debug group, timer and row of the
// profiler. On a GPU a pair of timestamps, read when ready; on a software renderer, whose GPU
// timers are wrong by orders of magnitude, glFinish and a steady clock.

#include <epoxy/gl.h>

#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "megaviews/settings/statistics.h"
#include "renderer/gl/read_back.h"

namespace mv::gl {

class Profiler {
  public:
    // Results::late reads timestamps when they are there, whatever the renderer.
    explicit Profiler(Results results = Results::waited);
    ~Profiler();
    Profiler(const Profiler&) = delete;
    Profiler& operator=(const Profiler&) = delete;

    // Whom the scopes from here on work for: what stages() is asked for.
    int owner = 0;
    // Ends a frame. Times are those of this frame, or, if they come late, of the last frame whose
    // timestamps have arrived; false where none has since the call before.
    bool endFrame();
    // An owner's stages of the frame that endFrame() found, in order of their first scope, times of
    // equal stages added.
    std::vector<StageTime> stages(int ofOwner) const;
    // Of all scopes since the last call, as a frame of its own. Nothing where times come late: then
    // they are the next frame's.
    std::vector<StageTime> take();

    const char* clock() const;  // "gpu timer" or "wall clock, synchronised"
    bool enabled = true;        // off: scopes keep only their debug group

  private:
    friend class PassScope;
    struct Scope {
        Stage stage{};
        int owner = 0;
        GLuint begin = 0, end = 0;  // timestamp queries, or 0
        double ms = 0;              // by the wall clock; of queries, once they are read
    };
    using Frame = std::vector<Scope>;
    GLuint takeQuery();
    static bool arrived(const Frame& frame);
    void read(Frame& frame);
    static void add(const Scope& scope, std::vector<StageTime>& stages);
    Frame open_, read_;
    std::deque<Frame> underWay_;  // ended, oldest first
    std::vector<GLuint> freeQueries_;
    Results results_;
    bool wallClock_ = true;
};

class PassScope {
  public:
    PassScope(Profiler& profiler, Stage stage);
    ~PassScope();
    PassScope(const PassScope&) = delete;
    PassScope& operator=(const PassScope&) = delete;

  private:
    void finish() const;  // and counts that wait
    Profiler& profiler_;
    Stage stage_;
    std::string outerPass_;
    bool timed_;
    GLuint begin_ = 0;
    std::chrono::steady_clock::time_point start_;
};

}  // namespace mv::gl
