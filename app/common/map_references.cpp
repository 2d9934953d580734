#include "app/common/map_references.h"

#include <spdlog/spdlog.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/common/reference_store.h"
#include "megaviews/core/error.h"
#include "megaviews/io/npy.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/fuse.glsl"
#include "shaders/shared/random.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv {
namespace {

namespace fs = std::filesystem;

// Rises when the same description would give other values.
constexpr int kMapReferenceVersion = 1;
constexpr float kNoDepth = std::numeric_limits<float>::infinity();
constexpr float kOwnSurface = 10 * kVplOffset;
// Views traced by another machine may differ in their last bits.
constexpr float kSamePlace = 1e-6f;

glm::vec3 positionOf(const View& view) { return {view.positionX, view.positionY, view.positionZ}; }

// What the map holds: without fusion the first texel that is not empty from the leaf up,
// measured from the leaf's centre.
float depthIn(const ReadMaps& read, std::uint32_t map, uint texel) {
    const uint res = static_cast<uint>(read.maps.viewRes);
    const auto at = [&](std::uint32_t m) {
        return read.maps.texels[std::size_t{m} * mapTexels(res) + texel];
    };
    uint bits = at(map);
    if (!read.parents.empty()) {
        std::uint32_t above = map;
        while (bits == kNone && (above = read.parents[above]) != kNone) {
            bits = recenterDepth(at(above), texel, res,
                                 read.maps.centers[above] - read.maps.centers[map]);
        }
    }
    return bits == kNone ? kNoDepth : uintBitsToFloat(bits);
}

template <typename T>
std::vector<T> readArray(const fs::path& file, const std::vector<std::uint64_t>& shape) {
    NpyArray<T> array = readNpy<T>(file);
    if (array.shape != shape) {
        throw Error(ExitCode::input, "'" + file.string() + "' has another shape");
    }
    return std::move(array.elements);
}

}  // namespace

void MapReferences::keepFirst(std::size_t count) {
    if (count >= slots.size()) return;
    const std::size_t texels = count * mapTexels(static_cast<uint>(viewRes));
    slots.resize(count);
    positions.resize(count);
    for (std::vector<float>* values : {&depth, &nearest, &farthest}) values->resize(texels);
}

std::vector<std::uint32_t> chooseViews(std::span<const View> views, std::uint32_t seed,
                                       std::size_t count) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // hash, slot
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].flags == kViewDead) continue;
        const auto slot = static_cast<std::uint32_t>(i);
        order.emplace_back(pcg4d(uvec4(seed, slot, 0u, 0x6D617073u)).x, slot);
    }
    const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
    std::partial_sort(order.begin(), end, order.end());
    std::vector<std::uint32_t> slots;
    for (auto it = order.begin(); it != end; ++it) slots.push_back(it->second);
    return slots;
}

// ---------------------------------------------------------------- files

std::string MapReferenceStore::description(const Scene& scene, const Settings& settings,
                                           const FrameInput& input, std::span<const View> views) {
    return "version " + std::to_string(kMapReferenceVersion) + "\nmaps\n" + describeScene(scene) +
           describeMoment(settings, input) + describeViews(settings, views) + "view-res " +
           std::to_string(settings.viewRes) + "\n";
}

fs::path MapReferenceStore::fileFor(const Scene& scene, const Settings& settings,
                                    const FrameInput& input, std::span<const View> views) const {
    if (folder_.empty()) return {};
    return referenceFile(folder_, "maps", description(scene, settings, input, views));
}

std::optional<MapReferences> MapReferenceStore::load(const fs::path& file, int viewRes,
                                                     std::span<const View> views) const {
    if (file.empty()) return std::nullopt;
    try {
        std::error_code unreadable;
        const fs::path depths = withExtension(file, ".npy");
        if (!fs::exists(depths, unreadable)) return std::nullopt;
        MapReferences out;
        out.viewRes = viewRes;
        NpyArray<std::uint32_t> slots = readNpy<std::uint32_t>(withExtension(file, ".slots.npy"));
        const std::uint64_t count = slots.elements.size();
        const std::uint64_t texels = mapTexels(static_cast<uint>(viewRes));
        out.slots = std::move(slots.elements);
        const auto places = readArray<float>(withExtension(file, ".positions.npy"), {count, 3});
        const auto values = readArray<float>(depths, {count, 3, texels});
        for (std::size_t i = 0; i < count; ++i) {
            out.positions.emplace_back(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
            const std::uint32_t slot = out.slots[i];
            if (slot >= views.size() || views[slot].flags == kViewDead ||
                !(glm::distance(positionOf(views[slot]), out.positions[i]) <= kSamePlace)) {
                throw Error(ExitCode::input,
                            "'" + depths.string() + "' holds maps of views that stand elsewhere");
            }
            const float* map = values.data() + 3 * i * texels;
            out.depth.insert(out.depth.end(), map, map + texels);
            out.nearest.insert(out.nearest.end(), map + texels, map + 2 * texels);
            out.farthest.insert(out.farthest.end(), map + 2 * texels, map + 3 * texels);
        }
        return out;
    } catch (const Error& error) {
        spdlog::warn("{}; it is not used", error.what());
    }
    return std::nullopt;
}

void MapReferenceStore::save(const fs::path& file, const MapReferences& maps,
                             const std::string& description) const {
    if (file.empty()) return;
    makeFolderOf(file);
    const std::uint64_t count = maps.slots.size();
    const std::size_t texels = mapTexels(static_cast<uint>(maps.viewRes));
    OutputFile text(withExtension(file, ".txt"));
    text.write(description);
    NpyWriter<std::uint32_t> slots(withExtension(file, ".slots.npy"), {count});
    slots.write(maps.slots);
    NpyWriter<float> positions(withExtension(file, ".positions.npy"), {count, 3});
    NpyWriter<float> depths(withExtension(file, ".npy"), {count, 3, texels});
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3& p = maps.positions[i];
        positions.write(std::vector<float>{p.x, p.y, p.z});
        for (const std::vector<float>* values : {&maps.depth, &maps.nearest, &maps.farthest}) {
            depths.write(std::span(*values).subspan(i * texels, texels));
        }
    }
    // All are whole before the first takes its place; the depths last: whoever finds them finds
    // the rest.
    text.commit();
    slots.commit();
    positions.commit();
    depths.commit();
}

// ---------------------------------------------------------------- errors

MapErrors mapErrors(const MapReferences& references, std::span<const View> views,
                    const ReadMaps& read) {
    const uint res = static_cast<uint>(references.viewRes);
    const std::size_t size = mapTexels(res);
    if (read.maps.viewRes != references.viewRes) return {};
    // Where both are infinite, nothing is compared.
    std::vector<float> exact(references.depth.size(), kNoDepth), found = exact;
    tbb::parallel_for(std::size_t{0}, references.slots.size(), [&](std::size_t k) {
        const std::uint32_t slot = references.slots[k];
        const std::uint32_t map = read.mapOfSlot.at(slot);
        if (map == kNone) return;
        const View& view = views[slot];
        const glm::vec3 normal(view.normalX, view.normalY, view.normalZ);
        for (uint texel = 0; texel < size; ++texel) {
            const glm::vec3 direction = texelDirection(texel, res);
            const float depth = references.depth[k * size + texel];
            const bool behind =
                view.flags != kViewOmnidirectional && glm::dot(direction, normal) <= 0;
            if (behind || depth <= kOwnSurface || !texelReachable(texel, res)) continue;
            exact[k * size + texel] = depth;
            found[k * size + texel] = depthIn(read, map, texel);
        }
    });
    return compareMaps(found, exact, references.nearest, references.farthest);
}

std::optional<MapErrorReport> mapErrorsOf(const MapReferences& references,
                                          std::span<const View> views,
                                          const FrameRenderer& renderer, const Settings& settings,
                                          int side) {
    if (!makesMaps(settings.method)) return std::nullopt;
    const ReadMaps maps = renderer.readMapsOf(references.slots, side);
    if (maps.maps.viewRes != references.viewRes) return std::nullopt;
    return MapErrorReport{references.slots.size(), mapErrors(references, views, maps)};
}

std::optional<MapErrorReport> findMapErrors(const MapReferenceStore& store,
                                            const FrameRenderer& renderer, const Scene& scene,
                                            const Settings& settings, const FrameInput& input,
                                            int side) {
    if (!makesMaps(settings.method)) return std::nullopt;
    const ViewSet views = renderer.readViews();
    const auto references = store.load(store.fileFor(scene, settings, input, views.views),
                                       settings.viewRes, views.views);
    if (!references) return std::nullopt;
    return mapErrorsOf(*references, views.views, renderer, settings, side);
}

std::string toText(const MapErrorReport& report, Method method) {
    std::string text = fmt::format("maps of {}, {} views", nameOf(method), report.views);
    for (const MapMetricInfo& info : mapMetricsTable()) {
        text += fmt::format(", {} {:.3g} %", info.name, info.percent(report.errors));
    }
    return text;
}

nlohmann::ordered_json toJson(const MapErrorReport& report) {
    nlohmann::ordered_json out = {{"views", report.views},
                                  {"texels", report.errors.texels},
                                  {"badTexels", report.errors.bad}};
    for (const MapMetricInfo& info : mapMetricsTable()) {
        out[std::string(info.name)] = report.errors.texels
                                          ? nlohmann::ordered_json(info.percent(report.errors))
                                          : nlohmann::ordered_json(nullptr);
    }
    return out;
}

}  // namespace mv
