#include "renderer/visibility.h"

#include <stdexcept>

#include "renderer/passes/scene_hierarchy_upload.h"

namespace mv {

const GpuSceneHierarchy& SceneOnGpu::nodes(uint rules) {
    auto& nodes = nodes_[sceneTable(rules)];
    if (!nodes) nodes = uploadSceneHierarchy(hierarchy, rules);
    return *nodes;
}

void SceneOnGpu::setPose(const Scene& scene) {
    poseNumber_ = scene.poseNumber;
    if (!hierarchy.moving) return;
    for (uint rules = 0; rules < kNodeTables; ++rules) {
        auto& nodes = nodes_[sceneTable(rules)];
        if (nodes) uploadPose(hierarchy, rules, *nodes);
    }
}

std::uint64_t SceneOnGpu::nodeBytes() const {
    std::uint64_t sum = 0;
    for (const auto& nodes : nodes_) {
        if (nodes) {
            sum += nodes->nodes.bytes();
        }
    }
    return sum;
}

MethodSettings Visibility::read(const MethodSettings& settings) const {
    MethodSettings out;
    out.method = settings.method;
    if (makesMaps(settings.method)) out.maps = settings.maps;
    out.maps.depthBits = MapSettings{}.depthBits;
    return out;
}

void Visibility::build(const VisibilityInput& input, const MethodSettings& settings,
                       gl::Profiler& profiler, MethodStatistics& statistics) {
    const Key key{read(settings), input.version, drawsAtRandom() ? input.seed : 0};
    const bool same = key_ == key;
    const bool better = input.refineLaggingMaps && mapsLag();
    if (same && !better && countedLevels_ >= input.countLevels) return;

    key_.reset();
    maps_.present = false;
    views_ = hierarchy_ = &input.views;
    statistics = {};
    if (!same || better) ++version_;  // counting by level changes no map
    try {
        make(input, key.settings, profiler, statistics);
    } catch (...) {
        maps_.present = false;
        throw;
    }
    statistics.viewHierarchyBytes = hierarchy_->bytes();
    key_ = key;
    // Kept cuts are not built again for their counts: a frame without motion tests but few pairs.
    const bool once = !testsPairs(key.settings.method) || key.settings.pairs.cut != Cut::basic;
    countedLevels_ = input.countLevels || once;
}

void Visibility::useHierarchy(const VisibilityInput& input, uint rules, bool flat,
                              gl::Profiler& profiler) {
    if (viewTable(rules) == viewTable(kCorrectedRules) && !flat) return;
    input.viewHierarchies.build({input.viewDepth, rules, flat}, profiler, own_);
    hierarchy_ = &own_;
}

#define MV_METHOD(id, name, title, traits, summary) \
    template <>                                     \
    std::unique_ptr<Visibility> makeVisibility<Method::id>(gl::Results);
#include "megaviews/settings/methods.inc"
#undef MV_METHOD

std::unique_ptr<Visibility> makeVisibility(Method method, gl::Results results) {
    switch (method) {
#define MV_METHOD(id, name, title, traits, summary)                                         \
    case Method::id:                                                                        \
        if constexpr (!isReference(Method::id)) return makeVisibility<Method::id>(results); \
        break;
#include "megaviews/settings/methods.inc"
#undef MV_METHOD
    }
    throw std::logic_error("makeVisibility: a reference is made on the CPU");
}

}  // namespace mv
