#pragma once
// Exact maps as files, made by one program from rays (megaviews/reference/exact_maps.h) and read by
// others, and the errors of a method's maps against them (docs/metrics.md, "Depth maps").
//
// maps-<hash>.npy            float32, N x 3 x 2R^2: depth through each texel's centre, nearest and
//                            farthest of the rays through the texel, root-cube units
// maps-<hash>.slots.npy      uint32, N: the slots of their views
// maps-<hash>.positions.npy  float32, N x 3: where those views are, root-cube units
// maps-<hash>.txt            what was hashed

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/metrics/map_errors.h"
#include "renderer/frame_renderer.h"

namespace mv {

struct MapReferences {
    int viewRes = 0;
    std::vector<std::uint32_t> slots;
    std::vector<glm::vec3> positions;
    std::vector<float> depth, nearest, farthest;  // as ExactMaps, maps in the order of slots
    // The first `count` maps, or all if there are not more.
    void keepFirst(std::size_t count);
};

// Up to `count` views that live, by slot: the first of an order that depends on seed and slots
// alone, so that fewer views are a part of more.
std::vector<std::uint32_t> chooseViews(std::span<const View> views, std::uint32_t seed,
                                       std::size_t count);

class MapReferenceStore {
  public:
    // An empty folder keeps nothing.
    explicit MapReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // What exact maps depend on beside their number: scene, time, lights, views, seed, viewRes.
    static std::string description(const Scene& scene, const Settings& settings,
                                   const FrameInput& input, std::span<const View> views);
    // Without extension; empty if nothing is kept.
    std::filesystem::path fileFor(const Scene& scene, const Settings& settings,
                                  const FrameInput& input, std::span<const View> views) const;
    // Nothing if there are none, or they cannot be read, or are of views that stand elsewhere.
    std::optional<MapReferences> load(const std::filesystem::path& file, int viewRes,
                                      std::span<const View> views) const;
    // Throws Error(ExitCode::output).
    void save(const std::filesystem::path& file, const MapReferences& maps,
              const std::string& description) const;

  private:
    std::filesystem::path folder_;
};

// Errors of the maps that a method gave these views, texel against texel: the depth in a direction
// from the map's centre, which is that of the view's leaf, against the depth in the same direction
// from the view. So views that share a map err by sharing it. Texels that nothing asks for are left
// out: those whose centre lies behind a view that lights one hemisphere (views without a normal
// light all), and those that show the view's own surface, within ten times the distance that views
// are lifted off it.
MapErrors mapErrors(const MapReferences& references, std::span<const View> views,
                    const ReadMaps& maps);

struct MapErrorReport {
    std::uint64_t views = 0;
    MapErrors errors;
};

// Errors of one side's maps in the renderer's last frame; settings: of that side. Nothing where it
// has no maps. Reads back maps: not for each frame.
std::optional<MapErrorReport> mapErrorsOf(const MapReferences& references,
                                          std::span<const View> views,
                                          const FrameRenderer& renderer, const Settings& settings,
                                          int side);
// The same against all the maps that the store has for these views; nothing if it has none.
std::optional<MapErrorReport> findMapErrors(const MapReferenceStore& store,
                                            const FrameRenderer& renderer, const Scene& scene,
                                            const Settings& settings, const FrameInput& input,
                                            int side);

// "maps of manylods, 9 views, off2 12.3 %, ..."
std::string toText(const MapErrorReport& report, Method method);
// {"views", "texels", "badTexels", and mapMetricsTable()'s names in %}; null without texels.
nlohmann::ordered_json toJson(const MapErrorReport& report);

}  // namespace mv
