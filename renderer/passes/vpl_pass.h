#pragma once
// Shoots VPLs on the GPU every frame: one invocation a path, rays against the triangle BVH walked
// in GLSL, a VPL at each bounce [Kol19 §4.1]. The CPU twin is mv::traceVpls, by the same lines
// (shaders/shared/vpl.glsl).

#include <memory>

#include "megaviews/views/view_guide.h"
#include "megaviews/views/view_set.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

class VplPass {
  public:
    VplPass();
    ~VplPass();
    void setScene(const Scene& scene, const TriangleBvh& bvh);  // uploads; both outlive the pass
    void setPose(const Scene& scene, const TriangleBvh& bvh);   // what moves, after refit()
    // guide: where paths begin; null: wherever light does.
    void trace(const Emitters& emitters, const VplOptions& options, const ViewGuide* guide,
               gl::Profiler& profiler, GpuViews& out);
    const BvhTables& tables() const;  // of the scene, for other passes
    std::uint64_t bytes() const;      // BVH, triangles, attributes, trace textures

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Any view set made on the CPU: particles, views from a file.
void upload(const ViewSet& views, GpuViews& out);

}  // namespace mv
