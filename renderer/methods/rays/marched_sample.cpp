#include "renderer/methods/rays/visibility.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

// What a march is left at first. Few need more: measured up to 1700 at 11 levels.
constexpr std::uint32_t kMarchSteps = 3300;

SampleVisibility marchedSample(const GpuMarchTree& tree) {
    return {"methods/rays/visible.glsl",
            {},
            [&tree](gl::Program& program) {
                tree.nodes.bindTexels(kUnitMarchNodes);
                program.set("marchCount", tree.nodeCount);
                program.set("marchLeafEdge", tree.leafEdge);
            },
            kMarchSteps,
            "a ray looks at too many nodes of the scene octree: take a smaller --scene-depth"};
}

}  // namespace mv
