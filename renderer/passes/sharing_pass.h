#pragma once
// GBuffer x SceneHierarchy x ViewHierarchy -> pictures of what views share [Kol19 fig. 1]: how many
// of them use the pair that renders a pixel's surface, and what two picked views have in common.
// Pairs are found again by shaders/shared/pair_path.glsl; maps are not needed.

#include <cstdint>
#include <optional>

#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

struct SharingInput {
    const GBuffer& gbuffer;
    const GpuSceneHierarchy& scene;  // nodes of the rules
    const GpuViewHierarchy& views;   // that the maps are rendered for: a tree, or flat
    uint rules = kCorrectedRules;
    int mapRes = 16;
    bool present = true;  // false for methods without pairs
    float pairSize = 1;   // times the rules' threshold
};

class SharingPass {
  public:
    // DebugView::sharing, RGBA32F: x = mean number of views that share the pair, over up to 16
    // views drawn at random by (seed, pixel); y = share of those for which the surface is rendered
    // at all. 0 where there is no surface, no view, or it is rendered for none of them. grid: so
    // many pixels each way show what the lower left of them sees, where paths take long to follow.
    void sharing(const SharingInput& input, std::uint32_t seed, int grid, gl::Profiler& profiler,
                 gl::Texture& out);
    // Mean of what sharing() wrote, every pair of a pixel and a view counting once; 0 if there is
    // none. Synchronises.
    static double meanSharing(const gl::Texture& sharing);
    // DebugView::shared, RGBA32F: linear colour. Slots that are not alive are as if not picked.
    void shared(const SharingInput& input, const FrameCamera& camera, std::int64_t slotA,
                std::int64_t slotB, gl::Profiler& profiler, gl::Texture& out);

  private:
    void bind(gl::Program& program, const SharingInput& input);
    gl::Program sharing_, shared_;  // made when first used
    gl::Texture coarse_;            // where grid > 1
};

// The place of a slot's view in the sorted views; nullopt if it is not alive. Synchronises.
std::optional<std::uint32_t> sortedViewOf(const GpuViewHierarchy& views, std::int64_t slot);

}  // namespace mv
