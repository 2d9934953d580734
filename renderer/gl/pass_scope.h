#pragma once
// The one named scope every dispatch and draw goes through: debug group, timer and row of the
// profiler. On a GPU a pair of timestamps, read when ready; on a software renderer, whose GPU
// timers are wrong by orders of magnitude, glFinish and a steady clock.

#include <epoxy/gl.h>

#include <chrono>
#include <deque>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "megaviews/settings/statistics.h"
#include "renderer/gl/read_back.h"

namespace mv::gl {

// Told, once the GPU has come so far, which stage begins and, between its slices, what share of it
// is done. May throw, which gives the frame up.
using Watch = std::function<void(Stage stage, double done)>;

class Profiler {
  public:
    // Results::late reads timestamps when they are there, whatever the renderer.
    explicit Profiler(Results results = Results::waited);
    ~Profiler();
    Profiler(const Profiler&) = delete;
    Profiler& operator=(const Profiler&) = delete;

    // Ends a frame. Times are those of this frame, or, if they come late, of the last frame whose
    // timestamps have arrived; false where none has since the call before.
    bool endFrame();
    // An owner's stages of the frame that endFrame() found, in order of their first scope, times of
    // equal stages added.
    std::vector<StageTime> stages(int ofOwner) const;
    // Times of all scopes since the last call, as a frame of its own. Nothing where they come late:
    // then they are the next frame's.
    std::vector<StageTime> take();
    // Discards the open scopes of a frame that was abandoned by an exception.
    void discardOpen();

    // Where somebody watches, long stages run in slices, each followed by this.
    bool watched() const { return static_cast<bool>(watch_); }
    void report(Stage stage, double done);
    // What the watch took since the frame began, which is no stage's time.
    double watchMs() const { return watchMs_; }

    const char* clock() const;  // "gpu timer" or "wall clock, synchronised"
    bool enabled = true;        // off: scopes keep only their debug group

  private:
    friend class OwnerScope;
    friend class PassScope;
    friend class WatchScope;
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
    void discard(const Frame& frame);
    static void add(const Scope& scope, std::vector<StageTime>& stages);
    Frame open_, read_;
    std::deque<Frame> underWay_;  // ended, oldest first
    std::vector<GLuint> freeQueries_;
    Results results_;
    bool wallClock_ = true;
    int owner_ = 0;
    Watch watch_;
    double watchMs_ = 0;
};

// Whom the pass scopes within work for: what Profiler::stages() is asked for. Outside of any: 0.
class OwnerScope {
  public:
    OwnerScope(Profiler& profiler, int owner)
        : profiler_(profiler), outer_(std::exchange(profiler.owner_, owner)) {}
    ~OwnerScope() { profiler_.owner_ = outer_; }
    OwnerScope(const OwnerScope&) = delete;
    OwnerScope& operator=(const OwnerScope&) = delete;

  private:
    Profiler& profiler_;
    int outer_;
};

// A frame that is watched, if `watch` is not empty. Times of one that is given up are forgotten.
class WatchScope {
  public:
    WatchScope(Profiler& profiler, const Watch& watch);
    ~WatchScope();
    WatchScope(const WatchScope&) = delete;
    WatchScope& operator=(const WatchScope&) = delete;

  private:
    Profiler& profiler_;
    int exceptions_;
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
    double watchMs_ = 0;  // until it began
};

}  // namespace mv::gl
