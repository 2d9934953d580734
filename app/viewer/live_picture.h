#pragma once
// The picture of a session: rendered frame by frame towards what is asked for, as a draft while
// something moves and the renderer is software, or whole, from nothing, as results without a window
// are. What cannot be rendered leaves the last picture as it is.

#include <cstdint>
#include <functional>

#include "app/viewer/measuring.h"
#include "renderer/frame_renderer.h"

namespace mv {

class LivePicture {
  public:
    // complete() needs Results::waited.
    explicit LivePicture(gl::Results results) : renderer_(results) {}

    FrameRenderer& renderer() { return renderer_; }
    const FrameRenderer& renderer() const { return renderer_; }

    // One frame towards `wanted`; true if it made another picture. `draft` is what is rendered in
    // its place while something moves. Throws the renderer's errors, and what input.watch throws,
    // which follows it on a software renderer: then the last picture stays, and the next frame goes
    // on.
    bool advance(const Settings& wanted, const Settings& draft, FrameInput input);
    // After an error of advance(): these settings are what the picture shows, unless it is a draft.
    // It is drawn anew, since the renderer holds what failed.
    void keep(const Settings& wanted);
    // Hands the picture what measuring has made of its references and of FLIP.
    void supply(Measuring& measuring);
    void rest() { still_ = shown_, moving_ = false; }  // instead of advance()
    void forget() { shown_ = false; }                  // the next frame draws anew
    // The next frame draws anew, on a software renderer a draft first; also after forget().
    void outdate() { outdated_ = true; }
    // The draft is enough, until something moves or the whole is asked for after all.
    void settleForDraft() { settled_ = true; }
    void askForWhole() { settled_ = false; }
    bool settledForDraft() const { return settled_; }
    bool makesDraft() const { return makesDraft_; }  // of the frame under way, or the last
    // A frame was given up: what the renderer holds does not belong to the picture shown.
    bool interrupted() const { return interrupted_; }

    // A whole frame, taking nothing from the one before: its times are those of the first set of
    // samples. False where results come late and those of the frame before are under way. Throws as
    // advance().
    bool renderWhole(const Settings& settings, FrameInput input);
    // Gives the whole frame just rendered what it still lacks of references, sets of samples
    // and FLIP. countLevels: pairs by level too, which slows a traversal, so apart from the times.
    // wait: returns once nothing is being made on another thread; false leaves the picture as far
    // as it is.
    void complete(Measuring& measuring, bool countLevels, const std::function<bool()>& wait);

    bool shown() const { return shown_; }
    // It shows what was asked for, with all the samples that were.
    bool still() const { return still_; }
    // It will show more with the next frame.
    bool isSupplied() const { return supplied_; }
    bool isDraft() const { return draft_; }
    // Something moves, as of this frame: references wait.
    bool moving() const { return moving_; }
    const Settings& wanted() const { return wanted_; }
    const Settings& effective() const { return effective_; }  // the same, or its draft
    const FrameInput& input() const { return input_; }
    FrameStatistics& statistics() { return statistics_; }
    const FrameStatistics& statistics() const { return statistics_; }
    std::uint64_t number() const { return number_; }  // counts the pictures

  private:
    bool renderAs(const Settings& settings, FrameInput& input);
    void show(const Settings& wanted, const Settings& effective, const FrameInput& input);

    FrameRenderer renderer_;
    FrameStatistics statistics_;
    // Of the picture: there is one; nothing more is to come; a draft, or made while things moved.
    bool shown_ = false, still_ = false, draft_ = false;
    // Of the frame under way, or the last: something moves in it; it is a draft; it was given up.
    bool moving_ = false, makesDraft_ = false, interrupted_ = false;
    // Of the next: it draws anew; a draft is enough; there is light or FLIP that it shows.
    bool outdated_ = false, settled_ = false, supplied_ = false;
    bool fitted_ = true;       // the exposure was fitted to a whole picture, not to a draft
    FrameCamera exposedFrom_;  // whose picture the exposure was last compared with
    Settings wanted_, effective_;
    FrameInput input_;
    std::uint64_t number_ = 0;
};

}  // namespace mv
