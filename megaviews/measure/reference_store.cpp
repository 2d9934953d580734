#include "megaviews/measure/reference_store.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/io/npy.h"
#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/bvh.glsl"
#include "shaders/shared/paraboloid.glsl"
#include "shaders/shared/random.glsl"

namespace mv {
namespace {

namespace fs = std::filesystem;

// Each rises when the same description would give other values.
constexpr int kPathTracedVersion = 1, kExactVersion = 6, kMapReferenceVersion = 1;
// Views traced by another machine may differ in their last bits.
constexpr float kSamePlace = 1e-6f;

std::string exact(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value + 0.0);  // -0 is 0
    return text;
}
std::string exact(glm::vec3 v) {
    return exact(double{v.x}) + " " + exact(double{v.y}) + " " + exact(double{v.z});
}

std::string line(const char* name, const std::string& value) {
    return std::string(name) + " " + value + "\n";
}

fs::path withExtension(fs::path file, const char* extension) { return file += extension; }

// Damage that leaves an array's length alone would be taken for light: beside each array lies the
// hash of its elements.
template <typename T>
std::string checksumOf(std::span<const T> elements) {
    return Hash().add(std::as_bytes(elements)).hex() + "\n";
}

// An array and its hash. All files of a reference are closed before one takes its place, so that a
// full disk costs none of those that were there.
template <typename T>
class CheckedWriter {
  public:
    CheckedWriter(const fs::path& file, const std::vector<std::uint64_t>& shape,
                  std::span<const T> elements)
        : sum_(withExtension(file, ".xxh")), array_(file, shape) {
        sum_.write(checksumOf(elements));
        array_.write(elements);
        sum_.close();
        array_.close();
    }
    void commit() {
        sum_.commit();
        array_.commit();
    }

  private:
    OutputFile sum_;
    NpyWriter<T> array_;
};

template <typename T>
NpyArray<T> readChecked(const fs::path& file) {
    NpyArray<T> array = readNpy<T>(file);
    if (readTextFile(withExtension(file, ".xxh"), ExitCode::input) !=
        checksumOf(std::span<const T>(array.elements))) {
        throw Error(ExitCode::input, "'" + file.string() + "' is damaged");
    }
    return array;
}

template <typename T>
std::vector<T> readArray(const fs::path& file, const std::vector<std::uint64_t>& shape) {
    NpyArray<T> array = readChecked<T>(file);
    if (array.shape != shape) {
        throw Error(ExitCode::input, "'" + file.string() + "' has another shape");
    }
    return std::move(array.elements);
}

std::vector<glm::vec3> readPicture(const fs::path& file, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    const std::vector<float> values = readArray<float>(file, {h, w, 3});
    std::vector<glm::vec3> out(w * h);
    for (std::size_t i = 0; i < out.size(); ++i) {
        const float* v = &values[3 * ((h - 1 - i / w) * w + i % w)];
        out[i] = {v[0], v[1], v[2]};
    }
    return out;
}

// Mean and variance of the rows done, 6 values a pixel, or 3.
IrradianceImage readPartial(const fs::path& file, int width, int height) {
    const NpyArray<float> array = readChecked<float>(file);
    IrradianceImage out{width, height, 0, {}, {}};
    const auto w = static_cast<std::uint64_t>(width), h = static_cast<std::uint64_t>(height);
    if (array.shape.size() != 3 || array.shape[0] > h || array.shape[1] != w ||
        (array.shape[2] != 3 && array.shape[2] != 6)) {
        throw Error(ExitCode::input, "'" + file.string() + "' has another resolution");
    }
    out.rowsDone = static_cast<int>(array.shape[0]);
    const std::size_t values = static_cast<std::size_t>(array.shape[2]);
    out.mean.resize(static_cast<std::size_t>(w * h));
    if (values == 6) out.variance.resize(out.mean.size());
    for (std::size_t i = 0; i < static_cast<std::size_t>(array.shape[0] * w); ++i) {
        const float* v = &array.elements[values * i];
        out.mean[i] = {v[0], v[1], v[2]};
        if (values == 6) out.variance[i] = {v[3], v[4], v[5]};
    }
    return out;
}

std::string describeScene(const Scene& scene) {
    std::string text = line("scene", scene.contentHash.empty() ? scene.hash : scene.contentHash);
    if (scene.positionStep > 0) text += line("position-step", exact(double{scene.positionStep}));
    const float lift = rayLift(scene);
    if (lift < kVplOffset) text += line("ray-lift", exact(double{lift}));
    return text;
}

std::string describeMoment(const Settings& s, const FrameMoment& moment) {
    return line("time", exact(moment.timeS)) + line("animation", std::to_string(moment.animation)) +
           line("light-scale", exact(s.scene.lightScale)) + line("lights", s.scene.lights) +
           line("environment",
                moment.environment ? moment.environment->hash : s.scene.environment.source) +
           line("sky-rotation", exact(s.scene.environment.rotationDeg)) +
           line("sky-scale", exact(s.scene.environment.scale)) +
           line("seed", std::to_string(s.seed));
}

std::string namedByContent(std::span<const View> views) {
    Hash sum;
    sum.add(std::as_bytes(views));
    return line("views", sum.hex());
}

std::string describeViews(const Settings& s, std::span<const View> views) {
    const bool chosen = s.views.placement == Placement::importance && s.views.particles == 0;
    // A moving camera may have kept those of before.
    if (!s.views.file.empty() || chosen) return namedByContent(views);
    if (s.views.particles > 0) return line("particles", std::to_string(s.views.particles));
    if (s.views.placement == Placement::random)
        return line("random-views", std::to_string(s.views.vpls));
    return line("vpls", std::to_string(s.views.vpls)) +
           line("bounces", std::to_string(s.views.bounces));
}

void makeFolderOf(const fs::path& file) {
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) {
        throw Error(ExitCode::output,
                    "'" + file.parent_path().string() + "' cannot be made: " + error.message());
    }
}

fs::path referenceFile(const fs::path& folder, std::string_view kind,
                       std::string_view description) {
    if (folder.empty()) return {};
    Hash sum;
    sum.add(description);
    return folder / (std::string(kind) + "-" + sum.hex().substr(0, 24));
}

}  // namespace

std::vector<float> topDown(const std::vector<glm::vec3>& rows, int width) {
    const auto w = static_cast<std::size_t>(width);
    std::vector<float> out;
    out.reserve(3 * rows.size());
    for (std::size_t end = rows.size(); end > 0; end -= w) {
        for (std::size_t i = end - w; i < end; ++i) {
            out.insert(out.end(), {rows[i].x, rows[i].y, rows[i].z});
        }
    }
    return out;
}

std::string ReferenceStore::description(const Scene& scene, const ReferenceRequest& request) {
    const Settings& s = request.settings;
    const FrameCamera& camera = request.moment.camera;
    const bool paths = s.side[0].method == Method::pathtraced;
    std::string text =
        line("version", std::to_string(paths ? kPathTracedVersion : kExactVersion)) +
        line("method", std::string(nameOf(s.side[0].method))) + describeScene(scene) +
        line("camera-position", exact(camera.position)) +
        line("camera-forward", exact(camera.forward)) + line("camera-up", exact(camera.up)) +
        line("camera-field",
             exact(double{camera.yfovRad}) + " " + exact(double{camera.orthoHalfHeight})) +
        line("resolution",
             std::to_string(s.resolution.width) + "x" + std::to_string(s.resolution.height)) +
        describeMoment(s, request.moment);
    // Of other scenes both are the same.
    const bool full = s.scene.materials == Materials::full &&
                      std::ranges::any_of(scene.materials, [](const Material& m) {
                          return m.isGlossy() || m.tints() || m.normalTexture >= 0;
                      });
    if (full) text += line("materials", "full, broad gloss by direction");
    if (paths) {
        return text + line("bounces", std::to_string(s.views.bounces)) +
               line("reference-samples", std::to_string(s.side[0].referenceSamples));
    }
    return text +
           line("clamp-distance",
                s.gather.clampDistance ? exact(*s.gather.clampDistance) : "spacing") +
           (s.gather.nearField
                ? line("near-field", "of " + std::to_string(s.views.bounces) + " bounces")
                : "") +
           describeViews(s, request.views);
}

fs::path ReferenceStore::fileFor(const Scene& scene, const ReferenceRequest& request) const {
    if (folder_.empty()) return {};
    return referenceFile(folder_, nameOf(request.settings.side[0].method),
                         description(scene, request));
}

std::optional<IrradianceImage> ReferenceStore::load(const fs::path& file, int width,
                                                    int height) const {
    if (file.empty()) return std::nullopt;
    try {
        std::error_code unreadable;
        const fs::path whole = withExtension(file, ".npy");
        if (fs::exists(whole, unreadable)) {
            IrradianceImage out{.width = width,
                                .height = height,
                                .rowsDone = height,
                                .mean = readPicture(whole, width, height),
                                .variance = {}};
            const fs::path variance = withExtension(file, ".variance.npy");
            if (fs::exists(variance, unreadable)) {
                out.variance = readPicture(variance, width, height);
            }
            return out;
        }
        const fs::path partial = withExtension(file, ".partial.npy");
        if (fs::exists(partial, unreadable)) return readPartial(partial, width, height);
    } catch (const Error& error) {
        spdlog::warn("{}; it is made again", error.what());
    }
    return std::nullopt;
}

void ReferenceStore::save(const fs::path& file, const IrradianceImage& r,
                          const std::string& description) const {
    if (file.empty()) return;
    makeFolderOf(file);
    const auto w = static_cast<std::uint64_t>(r.width), h = static_cast<std::uint64_t>(r.height);
    const fs::path partial = withExtension(file, ".partial.npy");
    if (!r.done()) {
        const bool both = !r.variance.empty();
        std::vector<float> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(r.rowsDone) * w; ++i) {
            for (int c = 0; c < 3; ++c) values.push_back(r.mean[i][c]);
            for (int c = 0; both && c < 3; ++c) values.push_back(r.variance[i][c]);
        }
        CheckedWriter<float>(
            partial, {static_cast<std::uint64_t>(r.rowsDone), w, both ? 6ull : 3ull}, values)
            .commit();
        return;
    }
    OutputFile text(withExtension(file, ".txt"));
    text.write(description);
    text.close();
    const std::vector<std::uint64_t> shape = {h, w, 3};
    std::optional<CheckedWriter<float>> variance;
    if (!r.variance.empty()) {
        variance.emplace(withExtension(file, ".variance.npy"), shape, topDown(r.variance, r.width));
    }
    CheckedWriter<float> mean(withExtension(file, ".npy"), shape, topDown(r.mean, r.width));
    // The mean last: whoever finds it finds the rest.
    text.commit();
    if (variance) variance->commit();
    mean.commit();
    std::error_code unremoved;  // a partial one left behind does no harm
    fs::remove(partial, unremoved);
    fs::remove(withExtension(partial, ".xxh"), unremoved);
}

// ---------------------------------------------------------------- maps

void MapReferences::keepFirst(std::size_t count) {
    if (count >= slots.size()) return;
    const std::size_t texels = count * mapTexels(static_cast<uint>(mapRes));
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

std::string ReferenceStore::mapsDescription(const Scene& scene, const ReferenceRequest& request) {
    const Settings& s = request.settings;
    // Which of the views have maps is in their content alone.
    return line("version", std::to_string(kMapReferenceVersion)) + "maps\n" + describeScene(scene) +
           describeMoment(s, request.moment) + describeViews(s, request.views) +
           namedByContent(request.views) +
           line("view-res", std::to_string(s.side[0].maps.resolution));
}

fs::path ReferenceStore::mapsFileFor(const Scene& scene, const ReferenceRequest& request) const {
    if (folder_.empty()) return {};
    return referenceFile(folder_, "maps", mapsDescription(scene, request));
}

std::optional<MapReferences> ReferenceStore::loadMaps(const fs::path& file, int mapRes,
                                                      std::span<const View> views) const {
    if (file.empty()) return std::nullopt;
    try {
        std::error_code unreadable;
        const fs::path depths = withExtension(file, ".npy");
        if (!fs::exists(depths, unreadable)) return std::nullopt;
        MapReferences out;
        out.mapRes = mapRes;
        NpyArray<std::uint32_t> slots =
            readChecked<std::uint32_t>(withExtension(file, ".slots.npy"));
        const std::uint64_t count = slots.elements.size();
        const std::uint64_t texels = mapTexels(static_cast<uint>(mapRes));
        out.slots = std::move(slots.elements);
        const auto places = readArray<float>(withExtension(file, ".positions.npy"), {count, 3});
        const auto values = readArray<float>(depths, {count, 3, texels});
        for (std::size_t i = 0; i < count; ++i) {
            out.positions.emplace_back(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
            const std::uint32_t slot = out.slots[i];
            if (slot >= views.size() || views[slot].flags == kViewDead ||
                !(glm::distance(viewPosition(views[slot]), out.positions[i]) <= kSamePlace)) {
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

void ReferenceStore::saveMaps(const fs::path& file, const MapReferences& maps,
                              const std::string& description) const {
    if (file.empty()) return;
    makeFolderOf(file);
    const std::uint64_t count = maps.slots.size();
    const std::size_t texels = mapTexels(static_cast<uint>(maps.mapRes));
    OutputFile text(withExtension(file, ".txt"));
    text.write(description);
    text.close();
    std::vector<float> places, values;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec3& p = maps.positions[i];
        places.insert(places.end(), {p.x, p.y, p.z});
        for (const std::vector<float>* of : {&maps.depth, &maps.nearest, &maps.farthest}) {
            const auto map = std::span(*of).subspan(i * texels, texels);
            values.insert(values.end(), map.begin(), map.end());
        }
    }
    CheckedWriter<std::uint32_t> slots(withExtension(file, ".slots.npy"), {count}, maps.slots);
    CheckedWriter<float> positions(withExtension(file, ".positions.npy"), {count, 3}, places);
    CheckedWriter<float> depths(withExtension(file, ".npy"), {count, 3, texels}, values);
    // The depths last: whoever finds them finds the rest.
    text.commit();
    slots.commit();
    positions.commit();
    depths.commit();
}

}  // namespace mv
