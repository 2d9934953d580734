#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "megaviews/views/view_guide.h"
#include "megaviews/views/view_set.h"

namespace mv {

std::uint64_t ViewSet::alive() const {
    return static_cast<std::uint64_t>(std::count_if(
        views.begin(), views.end(), [](const View& v) { return v.flags != kViewDead; }));
}

ViewSet traceVpls(const TriangleBvh& bvh, const Emitters& emitters, const VplOptions& options,
                  const ViewGuide* guide) {
    VplData vpl;
    vpl.setup = makeVplSetup(emitters, options, guide);
    if (guide) vpl.guide = guide->cells.data();
    vpl.lights = emitters.lights.data();
    vpl.sky = emitters.skyTexels();
    vpl.emissive = emitters.surfaces ? emitters.surfaces->triangles.data() : nullptr;
    const BvhData data = bvh.data(options.gloss);
    const VplSetup& setup = vpl.setup;

    ViewSet set;
    set.views.assign(setup.count, vplDead());
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, setup.surfaceSlots, 256),
                      [&](const auto& range) {
                          for (std::uint32_t slot = range.begin(); slot < range.end(); ++slot) {
                              set.views[slot] = vplOnEmitter(vpl, data, slot);
                          }
                      });
    tbb::parallel_for(
        tbb::blocked_range<std::uint32_t>(0, setup.paths, 16), [&](const auto& range) {
            for (std::uint32_t path = range.begin(); path < range.end(); ++path) {
                glm::vec3 origin, direction, flux;
                vplEmit(vpl, data, path, origin, direction, flux);
                bool alive = vplAnyFlux(flux);
                std::uint32_t slot = setup.surfaceSlots + path * setup.bounces;
                for (std::uint32_t bounce = 1; alive && bounce <= setup.bounces; ++bounce, ++slot) {
                    if (slot >= setup.count) break;
                    alive = vplBounce(vpl, data, path, bounce, slot, origin, direction, flux,
                                      set.views[slot]);
                }
            }
        });
    return set;
}

}  // namespace mv
