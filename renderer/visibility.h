#pragma once
// How a many-view method answers whether light passes between a surface and a view: the stage
// SceneHierarchy x ViewHierarchy -> Visibility of docs/architecture.md. A method may make depth
// maps, answer single samples in the gather's shaders, both, or neither. Each lies in a folder of
// its own, renderer/methods/NAME, and is known to the rest by its row in
// megaviews/settings/methods.inc.

#include <memory>
#include <optional>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/read_back.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gather_pass.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/view_hierarchy_pass.h"

namespace mv {

// What methods read of a scene. Its parts are uploaded when a method first asks for them.
class SceneOnGpu {
  public:
    SceneOnGpu(const TriangleBvh& sceneBvh, const SceneHierarchy& sceneHierarchy,
               const BvhTables& tables)
        : bvh(sceneBvh), hierarchy(sceneHierarchy), triangles(tables) {}
    const TriangleBvh& bvh;
    const SceneHierarchy& hierarchy;
    const BvhTables& triangles;
    const GpuSceneHierarchy& nodes(uint rules);
    // After SceneHierarchy::refit(); the triangles have been uploaded.
    void setPose(const Scene& scene);
    std::uint64_t poseNumber() const { return poseNumber_; }
    std::uint64_t nodeBytes() const;

  private:
    std::optional<GpuSceneHierarchy> nodes_[kNodeTables];  // by sceneTable()
    std::uint64_t poseNumber_ = 0;                         // Scene::poseNumber
};

struct VisibilityInput {
    SceneOnGpu& scene;
    const GpuViewHierarchy& views;       // the tree over the views with maps, corrected rules
    ViewHierarchyPass& viewHierarchies;  // the pass that made it, which still holds the views
    int viewDepth;                       // levels of view trees
    std::uint64_t version;               // of scene, views and their tree
    std::uint32_t seed;
    bool countLevels = false;  // count pairs by level too
    bool wait = false;         // with Results::late: wait for this build all the same
    // Make maps again where mapsLag(), though nothing has changed.
    bool refineLaggingMaps = false;
};

class Visibility {
  public:
    virtual ~Visibility() = default;
    Visibility(const Visibility&) = delete;
    Visibility& operator=(const Visibility&) = delete;

    // Makes what the settings ask for. Where neither they, as far as the method reads them, nor the
    // input have changed since the last call, nothing is done. Throws Error(ExitCode::impossible)
    // if maps do not fit the budget; then there are none.
    void build(const VisibilityInput& input, const MethodSettings& settings, gl::Profiler& profiler,
               MethodStatistics& statistics);
    // Whether the maps hold every pair, which is known late where results come late.
    virtual Proof proof(MethodStatistics&) { return Proof::good; }
    // Another build() of the same input would make better maps.
    virtual bool mapsLag() const { return false; }
    // Lets the next build() make everything anew.
    void forget() { key_.reset(); }
    // Rises whenever build() made other maps.
    std::uint64_t version() const { return version_; }

    // The hierarchy of views that build() was given last; null before.
    const GpuViewHierarchy* views() const { return views_; }
    // After build(): the view hierarchy that the maps are of; that of views() where there are none.
    const GpuViewHierarchy& hierarchy() const { return *hierarchy_; }
    // Maps; present is false where the method has none.
    const GpuViewMaps& maps() const { return maps_; }
    // How the gather's shaders ask for one sample; nullopt: by the maps, or everything is visible.
    virtual std::optional<SampleVisibility> sample() const { return std::nullopt; }
    // What the method keeps on the GPU, but for what MethodStatistics count.
    virtual std::vector<MemoryUse> memory() const { return {}; }

  protected:
    Visibility() = default;
    // The settings that the method reads, here those of maps; the others are at their defaults.
    virtual MethodSettings read(const MethodSettings& settings) const;
    virtual bool drawsAtRandom() const { return false; }
    // Makes maps_ and what else the samples need; hierarchy_ is input.views.
    virtual void make(const VisibilityInput& input, const MethodSettings& settings,
                      gl::Profiler& profiler, MethodStatistics& statistics) = 0;
    // Lets hierarchy_ be a hierarchy of the method's own.
    void useHierarchy(const VisibilityInput& input, uint rules, bool flat, gl::Profiler& profiler);

    GpuViewMaps maps_;

  private:
    struct Key {
        MethodSettings settings;
        std::uint64_t version = 0;
        std::uint32_t seed = 0;
        bool operator==(const Key&) const = default;
    };
    std::optional<Key> key_;
    bool countedLevels_ = false;
    std::uint64_t version_ = 0;
    const GpuViewHierarchy* views_ = nullptr;
    const GpuViewHierarchy* hierarchy_ = nullptr;
    GpuViewHierarchy own_;
};

// The budget for maps, in bytes.
inline std::uint64_t bytesOf(const MapSettings& maps) {
    return static_cast<std::uint64_t>(maps.memoryMiB) << 20;
}

// A sample answered by a ray against the scene's triangles.
SampleVisibility shadowRaySample(const BvhTables& triangles);

// Makes a method that is no reference. Each method's folder defines its specialisation.
template <Method method>
std::unique_ptr<Visibility> makeVisibility(gl::Results results);
std::unique_ptr<Visibility> makeVisibility(Method method, gl::Results results);

}  // namespace mv
