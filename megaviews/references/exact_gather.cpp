#include "megaviews/references/exact_gather.h"

#include <cassert>
#include <vector>

#include "megaviews/views/view_spacing.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv {

void exactGather(const EmbreeScene& embree, std::span<const View> views,
                 std::span<const Receiver> receivers, int width, int height,
                 const ExactGatherOptions& options, IrradianceImage& image,
                 const Progress& progress) {
    assert(receivers.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    if (image.width != width || image.height != height || image.mean.size() != receivers.size()) {
        image = {width, height, 0, {}, {}};
        image.mean.assign(receivers.size(), glm::vec3(0));
    }
    const std::vector<float> distances = options.clampDistance
                                             ? std::vector<float>(views.size(),
                                                                  *options.clampDistance)
                                             : clampDistances(views);
    const double edge = embree.bvh().scene->root.edge;
    const double perArea = 1 / (edge * edge);
    forEachPixel(image, "exact gather", progress, [&](std::size_t pixel) {
        const Receiver& r = receivers[pixel];
        if (r.normal == glm::vec3(0)) return;
        const vec3 lifted = r.position + r.normal * kVplOffset;
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < views.size(); ++i) {
            const View& v = views[i];
            if (v.flags == kViewDead) continue;
            const vec3 position(v.positionX, v.positionY, v.positionZ);
            const float term =
                gatherTerm(position - r.position, r.normal, vec3(v.normalX, v.normalY, v.normalZ),
                           v.flags == kViewOmnidirectional, distances[i], 0);
            if (!(term > 0)) continue;
            if (options.visibility && embree.occluded(lifted, position - lifted, 0, 1)) continue;
            sum += double{term} * glm::dvec3(v.fluxR, v.fluxG, v.fluxB);
        }
        image.mean[pixel] = glm::vec3(sum * perArea);
    });
}

}  // namespace mv
