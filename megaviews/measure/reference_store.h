#pragma once
// References as files, named by a hash of everything they depend on, so that one program makes them
// and others read them without tracing a ray: the irradiance that a reference method gave a
// picture, and exact depth maps of views.
//
// <method>-<hash>.npy           float32, height x width x 3, top row first: irradiance, W/m^2
// <method>-<hash>.variance.npy  the same of its variance (pathtraced)
// <method>-<hash>.partial.npy   rows done so far, bottom first, while it is not complete
// maps-<hash>.npy               float32, N x 3 x 2R^2: depth through each texel's centre, nearest
//                               and farthest of the rays through the texel, root-cube units
// maps-<hash>.slots.npy         uint32, N: the slots of their views
// maps-<hash>.positions.npy     float32, N x 3: where those views are, root-cube units
// *.npy.xxh                     hash of an array's elements; without the right one it is made again
// *.txt                         what was hashed

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/gather/receiver.h"
#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"
#include "megaviews/views/view_set.h"

namespace mv {

// What a reference is made from.
struct ReferenceRequest {
    Settings settings;  // of the side: its method, or the resolution of its maps
    FrameMoment moment;
    std::vector<View> views;          // by slot
    std::vector<Receiver> receivers;  // of a picture: width * height, bottom row first
};

// Exact depth maps of some views.
struct MapReferences {
    int mapRes = 0;
    std::vector<std::uint32_t> slots;
    std::vector<glm::vec3> positions;
    // Root-cube units, infinity where a ray leaves the scene; maps in the order of slots, texels as
    // in ViewMaps.
    std::vector<float> depth, nearest, farthest;
    // The first `count` maps, or all if there are not more.
    void keepFirst(std::size_t count);
};

// Up to `count` views that live, by slot: the first of an order that depends on seed and slots
// alone, so that fewer views are a part of more.
std::vector<std::uint32_t> chooseViews(std::span<const View> views, std::uint32_t seed,
                                       std::size_t count);

// Three values a pixel as files hold them, top row first, of rows that begin with the bottom one.
std::vector<float> topDown(const std::vector<glm::vec3>& rows, int width);

class ReferenceStore {
  public:
    // An empty folder keeps nothing.
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Everything that a reference depends on, one setting a line. Of a picture: scene, camera,
    // resolution, time, lights, and for the method exact also the views and the clamp. Of maps,
    // beside their number: scene, time, lights, views, seed, the resolution.
    static std::string description(const Scene& scene, const ReferenceRequest& request);
    static std::string mapsDescription(const Scene& scene, const ReferenceRequest& request);

    // Files without extension; empty if nothing is kept.
    std::filesystem::path fileFor(const Scene& scene, const ReferenceRequest& request) const;
    std::filesystem::path mapsFileFor(const Scene& scene, const ReferenceRequest& request) const;

    // Complete or partial, of this size; nothing if there is none or it cannot be read.
    std::optional<IrradianceImage> load(const std::filesystem::path& file, int width,
                                        int height) const;
    // Nothing if there are none, or they cannot be read, or are of views that stand elsewhere.
    std::optional<MapReferences> loadMaps(const std::filesystem::path& file, int mapRes,
                                          std::span<const View> views) const;
    // Nothing happens without a file. Throw Error(ExitCode::output).
    void save(const std::filesystem::path& file, const IrradianceImage& image,
              const std::string& description) const;
    void saveMaps(const std::filesystem::path& file, const MapReferences& maps,
                  const std::string& description) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace mv
