#pragma once
// Builds the view octree on the GPU, every frame, from nothing but the views: Morton keys, a
// stable radix sort by (key, slot), nodes level by level, attributes bottom-up [Kol19 §4].
// The CPU twin and definition is mv::ViewHierarchy::build.

#include <memory>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/read_back.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

class ViewHierarchyPass {
  public:
    explicit ViewHierarchyPass(gl::Results results = gl::Results::waited);
    ~ViewHierarchyPass();
    // Sorting is shared by every hierarchy of the same views in a frame: call sort once, then
    // build for each set of options (MegaViews' tree, ManyLoDs' flat forest). The views live until
    // then.
    void sort(const GpuViews& views, gl::Profiler& profiler);
    // Takes from the last sort the views that have maps, where at most so many do, for a sort of
    // their own (shaders/shared/map_borrowing.glsl).
    void chooseForMaps(std::uint32_t most, gl::Profiler& profiler, GpuViews& out);
    // What build() begins with: counts nodes and asks for the table of levels. To be called a frame
    // ahead of it, so that the table is there: placed() says whether those of this sort are.
    void place(const ViewHierarchyOptions& options, gl::Profiler& profiler);
    bool placed();
    // `out` keeps its buffers from frame to frame. Waits for the level table if it is not there.
    void build(const ViewHierarchyOptions& options, gl::Profiler& profiler, GpuViewHierarchy& out);
    // After build() of both hierarchies: writes whose map each view of the first takes. views: of
    // all, and those of chooseForMaps(), which made the hierarchy of the second.
    void borrowMaps(const GpuViewHierarchy& all, gl::Profiler& profiler, GpuMapViews& out);
    std::uint64_t bytes() const;  // of what it sorts and sums with

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
