#pragma once
// GBuffer x SceneHierarchy x ViewHierarchy -> for every coarse scene node that a pixel shows, the
// views that can light it [Kol19 §5.1], as runs of sorted views in bounded memory.

#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/read_back.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/prefix_sum.h"

namespace mv {

struct GatherCullOptions {
    int scale = 1;      // G-buffer pixels a gather pixel, each way
    int cullLevel = 6;  // of both hierarchies at most; 0 = no culling
    float cutoff = 0;   // root-cube units; 0 = none
    // Of one receiver at most. Where a list needs more, its view tree is walked less deeply.
    std::uint32_t maxRuns = 512;
};

struct GatherLists {
    gl::Texture surfaces;   // RGBA32UI: position, packed normal (kNoSurface: none), gather size
    gl::Texture planes;     // R32UI: packed normal of the triangle
    gl::Texture receivers;  // R32UI: node * kReceiverCones + cone, kNone: everything
    gl::TexelBuffer<glm::uvec2> used;              // of a node: cones in use, a bit each
    gl::TexelBuffer<std::uint32_t> firstReceiver;  // of a node: its first receiver's number
    gl::TexelBuffer<GatherList> lists;             // of a receiver; number 0 keeps everything
    gl::TexelBuffer<GatherRun> runs;               // receivers * capacity
    gl::TextureBuffer runWords;                    // the same, word by word
    gl::TexelBuffer<std::uint32_t> guide;          // receivers * kGuideSlots, see gather_guide.comp
    std::uint32_t receiverCount =
        0;                       // that there is room for; in use, where results are waited for
    std::uint32_t capacity = 0;  // runs of each
    std::uint64_t bytes() const;
};

class GatherCullPass {
  public:
    explicit GatherCullPass(gl::Results results = gl::Results::waited);
    // cullTree: a tree with at least one view. Reads back how many receivers are in use.
    void render(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                const GpuViewHierarchy& cullTree, const GatherViews& views,
                const GatherCullOptions& options, GatherLists& out);

    // Whether there was room for every receiver, as far as is known; makes more where not. A count
    // that is still underWay() may say otherwise later.
    bool fits(GatherLists& lists);
    bool underWay() const { return total_.requested(); }

  private:
    void findReceivers(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                       const GatherCullOptions& options, int level, GatherLists& out);
    std::uint32_t roomFor(std::uint32_t count) const;
    void numberReceivers(std::uint32_t nodes, GatherLists& out);
    gl::Results results_;
    gl::ReadBack total_;
    gl::Program findReceivers_, countReceivers_, placeReceivers_, cull_, guide_;
    PrefixSum prefixSum_;
    gl::TexelBuffer<std::uint32_t> counts_, begins_, keys_;
};

}  // namespace mv
