#include "app/common/reference_store.h"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/io/npy.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

namespace fs = std::filesystem;

// Rises when the same description would give other values.
constexpr int kReferenceVersion = 1;

std::string exact(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}
std::string exact(glm::vec3 v) {
    return exact(double{v.x}) + " " + exact(double{v.y}) + " " + exact(double{v.z});
}

std::string line(const char* name, const std::string& value) {
    return std::string(name) + " " + value + "\n";
}

// Rows change their order: of a picture in a file the top one is first.
std::vector<float> flipped(const std::vector<glm::vec3>& rows, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<float> out;
    out.reserve(3 * rows.size());
    for (std::size_t y = h; y-- > 0;) {
        for (std::size_t x = 0; x < w; ++x) {
            for (int c = 0; c < 3; ++c) out.push_back(rows[y * w + x][c]);
        }
    }
    return out;
}
std::vector<glm::vec3> unflipped(const std::vector<float>& values, int width, int height) {
    const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
    std::vector<glm::vec3> out(w * h);
    for (std::size_t y = 0; y < h; ++y) {
        for (std::size_t x = 0; x < w; ++x) {
            const float* v = &values[3 * ((h - 1 - y) * w + x)];
            out[y * w + x] = {v[0], v[1], v[2]};
        }
    }
    return out;
}

std::vector<glm::vec3> readPicture(const fs::path& file, int width, int height) {
    const NpyArray<float> array = readNpy<float>(file);
    const std::vector<std::uint64_t> shape = {static_cast<std::uint64_t>(height),
                                              static_cast<std::uint64_t>(width), 3};
    if (array.shape != shape) {
        throw Error(ExitCode::input, "'" + file.string() + "' has another resolution");
    }
    return unflipped(array.elements, width, height);
}

// Mean and variance of the rows done, 6 values a pixel, or 3.
StoredReference readPartial(const fs::path& file, int width, int height) {
    const NpyArray<float> array = readNpy<float>(file);
    StoredReference out{width, height, 0, {}, {}};
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

}  // namespace

std::string describeScene(const Scene& scene) {
    return line("scene", scene.contentHash.empty() ? scene.hash : scene.contentHash);
}

std::string describeMoment(const Settings& s, const FrameInput& input) {
    return line("time", exact(input.timeS)) + line("animation", std::to_string(input.animation)) +
           line("light-scale", exact(s.lightScale)) + line("lights", s.lights) +
           line("seed", std::to_string(s.seed));
}

std::string describeViews(const Settings& s, std::span<const View> views) {
    if (!s.viewsFile.empty()) {
        Hash sum;
        sum.add(std::as_bytes(views));
        return line("views", sum.hex());
    }
    if (s.particles > 0) return line("particles", std::to_string(s.particles));
    if (s.placement == Placement::random) return line("random-views", std::to_string(s.vpls));
    return line("vpls", std::to_string(s.vpls)) + line("bounces", std::to_string(s.bounces));
}

fs::path withExtension(fs::path file, const char* extension) { return file += extension; }

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

std::string ReferenceStore::description(const Scene& scene, const ReferenceRequest& request) {
    const Settings& s = request.settings;
    const FrameCamera& camera = request.input.camera;
    std::string text =
        line("version", std::to_string(kReferenceVersion)) +
        line("method", std::string(nameOf(s.method))) + describeScene(scene) +
        line("camera-position", exact(camera.position)) +
        line("camera-forward", exact(camera.forward)) + line("camera-up", exact(camera.up)) +
        line("camera-field",
             exact(double{camera.yfovRad}) + " " + exact(double{camera.orthoHalfHeight})) +
        line("resolution", std::to_string(s.width) + "x" + std::to_string(s.height)) +
        describeMoment(s, request.input);
    if (s.method == Method::pathtraced) {
        return text + line("bounces", std::to_string(s.bounces)) +
               line("reference-samples", std::to_string(s.referenceSamples));
    }
    return text + line("clamp-distance", exact(s.clampDistance)) + describeViews(s, request.views);
}

fs::path ReferenceStore::fileFor(const Scene& scene, const ReferenceRequest& request) const {
    if (folder_.empty()) return {};
    return referenceFile(folder_, nameOf(request.settings.method), description(scene, request));
}

std::optional<StoredReference> ReferenceStore::load(const fs::path& file, int width,
                                                    int height) const {
    if (file.empty()) return std::nullopt;
    try {
        std::error_code unreadable;
        const fs::path whole = withExtension(file, ".npy");
        if (fs::exists(whole, unreadable)) {
            StoredReference out{width, height, height, readPicture(whole, width, height), {}};
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

void ReferenceStore::save(const fs::path& file, const StoredReference& r,
                          const std::string& description) const {
    if (file.empty()) return;
    makeFolderOf(file);
    const auto w = static_cast<std::uint64_t>(r.width), h = static_cast<std::uint64_t>(r.height);
    const fs::path partial = withExtension(file, ".partial.npy");
    if (r.rowsDone < r.height) {
        const bool both = !r.variance.empty();
        std::vector<float> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(r.rowsDone) * w; ++i) {
            for (int c = 0; c < 3; ++c) values.push_back(r.mean[i][c]);
            for (int c = 0; both && c < 3; ++c) values.push_back(r.variance[i][c]);
        }
        writeNpy<float>(partial, {static_cast<std::uint64_t>(r.rowsDone), w, both ? 6ull : 3ull},
                        values);
        return;
    }
    OutputFile text(withExtension(file, ".txt"));
    text.write(description);
    text.commit();
    // The mean last: whoever finds it finds the rest.
    if (!r.variance.empty()) {
        writeNpy<float>(withExtension(file, ".variance.npy"), {h, w, 3},
                        flipped(r.variance, r.width, r.height));
    }
    writeNpy<float>(withExtension(file, ".npy"), {h, w, 3}, flipped(r.mean, r.width, r.height));
    std::error_code unremoved;  // a partial one left behind does no harm
    fs::remove(partial, unremoved);
}

}  // namespace mv
