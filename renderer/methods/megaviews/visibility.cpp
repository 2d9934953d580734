// MegaViews [Kol19 §3] and ManyLoDs [HREB11 §3.1]: pairs of scene and view nodes are tested, and a
// pair that is small enough is drawn once for all the views of its view node. The two differ in
// their view hierarchy alone: a tree, or a leaf for each view.

#include "renderer/methods/megaviews/visibility.h"

namespace mv {

MethodSettings ManyViewVisibility::read(const MethodSettings& settings) const {
    MethodSettings out = Visibility::read(settings);
    out.rules = settings.rules;
    out.maps.depthBits = settings.maps.depthBits;
    out.pairs = settings.pairs;
    if (!hasFlatViews(settings.method)) out.pairs.cut = Cut::basic;
    if (out.pairs.cut != Cut::lazy) out.pairs.lazyIterations = PairSettings{}.lazyIterations;
    return out;
}

void ManyViewVisibility::make(const VisibilityInput& input, const MethodSettings& settings,
                              gl::Profiler& profiler, MethodStatistics& statistics) {
    useHierarchy(input, settings.rules, hasFlatViews(settings.method), profiler);
    ManyViewOptions options{settings};
    options.countLevels = input.countLevels;
    options.gpuMemoryBytes = bytesOf(settings.maps);
    options.queueMemoryBytes = static_cast<std::uint64_t>(settings.pairs.queueMemoryMiB) << 20;
    const GpuSceneHierarchy& nodes = input.scene.nodes(settings.rules);
    do {
        pass_.render(nodes, hierarchy(), options, profiler, maps_, statistics);
    } while (pass_.proof(statistics, input.wait) == Proof::overflowed);
    statistics.sceneHierarchyBytes = nodes.nodes.bytes();
}

Proof ManyViewVisibility::proof(MethodStatistics& statistics) { return pass_.proof(statistics); }

template <>
std::unique_ptr<Visibility> makeVisibility<Method::megaviews>(gl::Results results) {
    return std::make_unique<ManyViewVisibility>(results);
}

}  // namespace mv
