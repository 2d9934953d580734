#include "app/common/frame_images.h"

#include <cstdint>

namespace mv {

RgbImage radianceOf(const FrameRenderer& renderer) { return radianceOf(renderer.radiance()); }

RgbImage radianceOf(const gl::Texture& radiance) {
    const int w = radiance.width(), h = radiance.height();
    return {w, h, topDownColor(radiance.readFloats(4), w, h)};
}

RgbImage displayOf(const FrameRenderer& renderer) {
    const gl::Texture& display = renderer.display();
    const int w = display.width(), h = display.height();
    const std::vector<std::uint8_t> bytes = topDownColor(display.readBytes(4), w, h);
    RgbImage image{w, h, {}};
    image.rgb.resize(bytes.size());
    std::transform(bytes.begin(), bytes.end(), image.rgb.begin(),
                   [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; });
    return image;
}

std::optional<MapErrorReport> mapErrorsOf(const MapReferences& references,
                                          std::span<const View> views,
                                          const FrameRenderer& renderer, const Settings& settings,
                                          int side) {
    if (!makesMaps(settings.side[0].method)) return std::nullopt;
    const ReadMaps maps = renderer.readMapsOf(references.slots, side);
    if (maps.maps.mapRes != references.mapRes) return std::nullopt;
    return MapErrorReport{references.slots.size(), mapErrors(references, views, maps)};
}

std::optional<MapErrorReport> findMapErrors(const ReferenceStore& store,
                                            const FrameRenderer& renderer, const Scene& scene,
                                            const Settings& settings, const FrameMoment& moment,
                                            int side) {
    if (!makesMaps(settings.side[0].method)) return std::nullopt;
    const ReferenceRequest request{settings, moment, renderer.readMapViews(side).views, {}};
    const auto references = store.loadMaps(store.mapsFileFor(scene, request),
                                           settings.side[0].maps.resolution, request.views);
    if (!references) return std::nullopt;
    return mapErrorsOf(*references, request.views, renderer, settings, side);
}

}  // namespace mv
