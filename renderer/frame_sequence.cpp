// Whether a frame belongs to a sequence, and where in its pixels its camera looks.

#include "renderer/frame_data.h"

namespace mv {
namespace {

// Sub-pixel positions that --temporal cycles through, one per moving frame.
constexpr std::uint32_t kTemporalPoints = 16;

}  // namespace

void SequenceState::begin(const Settings& settings, const FrameInput& input,
                          const std::optional<Settings>& shown, gl::Results results) {
    const bool atRest = input.reuse && !input.moving;
    const bool asShown = shown && shown->light() == settings.light();
    const bool whole = results == gl::Results::waited;  // else another call may refine the frame
    repeats = atRest && whole && asShown && at == FrameMoment(input);
    const bool anew = input.moving || (!input.reuse && settings.setsWanted() == 1);
    const bool mayRemember = settings.gather.history > 0 && input.usesHistory;
    ownSamples = mayRemember && (anew || repeats);
    at.reset();
    if (ownSamples && !input.moving) at = input;
    if (!atRest) keepsHistory = ownSamples;
    gathersInTurns = ownSamples && input.gathersInTurns;
}

FrameCamera SequenceState::movingCamera(const Settings& settings, const FrameInput& input) {
    FrameCamera camera = input.camera;
    const bool moves = ownSamples && settings.smoothsMotion();
    // A repeated frame stays where it was drawn.
    if (!moves || !repeats) movingFrames = moves ? movingFrames + 1 : 0;
    if (movingFrames == 0) return camera;
    const std::uint32_t point = (movingFrames - 1) % kTemporalPoints;
    camera.offset += 2.0f * pixelOffset(point) /
                     glm::vec2(settings.resolution.width, settings.resolution.height);
    return camera;
}

}  // namespace mv
