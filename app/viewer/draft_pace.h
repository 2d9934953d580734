#pragma once
// How many pixels a draft has, so that motion stays motion on any machine: fewer where drafts have
// taken long, more where there was time to spare.

namespace mv {

class DraftPace {
  public:
    static constexpr double kWantedS = 0.18;
    static constexpr double kFirstPixels = 560 * 360, kLeastPixels = 320 * 200;

    // adapts: else every draft has kFirstPixels, so that the same hand gets the same pictures.
    explicit DraftPace(bool adapts) : adapts_(adapts) {}

    double pixels() const { return pixels_; }
    // A draft of `pixels` took so long. mostPixels: of the picture that it stands for.
    void note(double seconds, double pixels, double mostPixels);

  private:
    static constexpr int kDrafts = 3;  // of one size that agree before it changes

    bool adapts_;
    double pixels_ = kFirstPixels;
    double noted_ = 0;  // pixels of the last draft
    int drafts_ = -1;   // of them that count; the first of a size also pays for its textures
    double shortest_ = 0, longest_ = 0;
};

}  // namespace mv
