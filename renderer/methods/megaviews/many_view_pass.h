#pragma once
// SceneHierarchy x ViewHierarchy -> ViewMaps on the GPU, by each traversal [Kol19 §3.2]:
// breadth-first pair queue as published, view-major lists, and cuts that are kept. MegaViews when
// the view hierarchy is a tree, ManyLoDs [HREB11 §3.1] when it is flat. Gives the maps of
// mv::traverse, bit for bit, where IEEE arithmetic allows.
// A queue or list that proves too small is detected, and the frame redone in more passes over
// subsets of the views before anything is shown.

#include <memory>

#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/read_back.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// Rules, maps and pairs are read of the settings, but for their budgets: tests need bytes.
struct ManyViewOptions : MethodSettings {
    std::uint64_t gpuMemoryBytes = 2048ull << 20;   // for maps, working and final, and kept cuts
    std::uint64_t queueMemoryBytes = 256ull << 20;  // for queues or lists
    bool countPairs = true;                         // counters cost a little
    bool countLevels = false;                       // and by level of the scene node: somewhat more
    // Shared-memory words of a list work group's stack and survivors; tests make it small.
    std::uint32_t sharedEntries = 1280;
    // Final maps that one pass may write, at least 2; tests make it small. 0: as many as a storage
    // block holds.
    std::uint32_t mapsAtOnce = 0;
    // Loop iterations after which a list work group is suspended; 0: as the renderer needs.
    std::uint32_t loopBudget = 0;
};

class ManyViewPass {
  public:
    explicit ManyViewPass(gl::Results results = gl::Results::waited);
    ~ManyViewPass();
    // scene must hold the nodes of the rules. `out` keeps its buffer from frame to frame; it holds
    // one fused map a leaf, or one map a node without fusion. Where results are waited for, nothing
    // has overflowed when it returns; where they come late, proof() says whether it did. Throws
    // Error(ExitCode::impossible), before allocating and saying what would fit, if the final maps
    // exceed the budget or the largest storage block and cannot be made in slices (no fusion,
    // filling by coarser levels, kept cuts), or if not even a single view fits the working
    // memory. What makeSlice() needs, `scene` and `views` among it, has to stay as it is.
    void render(const GpuSceneHierarchy& scene, const GpuViewHierarchy& views,
                const ManyViewOptions& options, gl::Profiler& profiler, GpuViewMaps& out,
                MethodStatistics& statistics);
    // Says how the last render() ended. After an overflow the next takes more room or more passes.
    Proof proof(MethodStatistics& statistics, bool wait = false);
    // Cuts are too coarse, as far as is known: another render() would refine them.
    bool mapsLag() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
