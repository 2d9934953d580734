// Brute force: every triangle of the scene rasterised into every view's own map.

#include "renderer/visibility.h"
#include "renderer/methods/raster/raster_maps_pass.h"

namespace mv {
namespace {

class RasterVisibility : public Visibility {
    void make(const VisibilityInput& input, const MethodSettings& settings, gl::Profiler& profiler,
              MethodStatistics& statistics) override {
        useHierarchy(input, kCorrectedRules, true, profiler);
        pass_.render(input.scene.triangles, hierarchy(), settings.maps.resolution,
                     bytesOf(settings.maps), profiler, maps_, statistics);
    }
    RasterMapsPass pass_;
};

}  // namespace

template <>
std::unique_ptr<Visibility> makeVisibility<Method::raster>(gl::Results) {
    return std::make_unique<RasterVisibility>();
}

}  // namespace mv
