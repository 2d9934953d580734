#pragma once
// Which run of the sorted views each pass of a traversal takes, so that its queue or lists fill up
// and seldom overflow. The prediction of [TSK13 §4.3], for runs of views on the Morton curve where
// the paper has tiles of a picture, and for entries where it has fragments: a run may be as long as
// fills a share α of the room [eq. 2], by the largest of several estimates of what a view takes,
// narrow ones and wide ones [eq. 3]. Known are, instead of a map of counts rendered beforehand, the
// passes of the frame before, and those of this frame up to here.

#include <cstdint>
#include <vector>

#include "megaviews/settings/statistics.h"

namespace mv {

class PassPlan {
  public:
    // A frame of `views` sorted views, > 0. usual: entries that a view takes, > 0, as long as
    // nothing is known. fillShare: α, in (0, 1].
    void begin(std::uint32_t views, double usual, double fillShare);
    // Where the run from `first` < views on should end, > first, in room for `capacity` entries.
    std::uint32_t endFrom(std::uint32_t first, std::uint64_t capacity) const;
    // Entries expected of views [first, end).
    double expected(std::uint32_t first, std::uint32_t end) const;

    // How the pass over [first, end) ended; `entries` of its fullest step. Passes come in order. An
    // overflow may become known after its frame only.
    void passed(std::uint32_t first, std::uint32_t end, std::uint64_t entries,
                std::uint64_t capacity);
    void overflowed(std::uint32_t first, std::uint32_t end, std::uint64_t capacity);

    PassCounts counts() const;  // of the frame up to here

  private:
    // A pass: its views up to `end`, a share of all. expected = 0: nothing was known. room = 0: its
    // maps ended it, not its entries.
    struct Part {
        double end, perView, expected, entries, room;
    };
    double perView() const;  // of the views that come next, by the passes up to here

    std::uint32_t views_ = 1;
    double usual_ = 1, fillShare_ = 1;
    double atLeast_ = 0;                // a view, since a first pass overflowed
    std::uint32_t limit_ = 0;           // a pass overflowed: the next ends here at most; else 0
    std::vector<Part> before_, parts_;  // of the last frame, if it came to its end; of this one
    std::uint64_t overflows_ = 0;
};

}  // namespace mv
