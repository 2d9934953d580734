#include "app/viewer/references.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <functional>
#include <optional>

#include "app/viewer/image_io.h"
#include "megaviews/core/error.h"
#include "megaviews/references/exact_gather.h"
#include "megaviews/references/exact_maps.h"
#include "megaviews/references/path_tracer.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

// A receiver: their noise is far below that of the views.
constexpr int kExactNearFieldRays = 128;

void checkRequest(const Settings& settings) {
    if (settings.side[0].method != Method::pathtraced) return;
    if (settings.views.particles > 0 || settings.views.placement == Placement::random ||
        !settings.views.file.empty()) {
        throw Error(ExitCode::usage,
                    "method pathtraced: follows light from the scene's own lights, not from "
                    "particles, random places or a file of views; take method exact");
    }
}

void saveExr(const std::filesystem::path& file, const IrradianceImage& image,
             const std::string& description) {
    std::filesystem::path exr = file;
    exr += ".exr";
    writeExr(exr.string(), image.width, image.height, 3, topDown(image.mean, image.width),
             {{"Description", description}});
}

// Minutes of work are used even if they cannot be kept.
void keepOrSay(const std::function<void()>& keep) {
    try {
        keep();
    } catch (const Error& error) {
        spdlog::warn("{}; the reference is used, but not kept", error.what());
    }
}

}  // namespace

struct References::Impl {
    const SceneAssets& assets;
    ReferenceStore store;
    Progress progress;
    Watch watch = {};
    std::optional<EmbreeScene> embree;  // made when the first ray is traced

    void needRays() {
        if (embree) return;
        report(progress, "ray hierarchy", 0);
        embree.emplace(assets.bvh);
    }

    void make(const ReferenceRequest& request, IrradianceImage& image) {
        const Settings& s = request.settings;
        needRays();
        const Progress atRow = [&](std::string_view stage, float fraction) {
            if (watch) watch(image.mean);
            report(progress, stage, fraction);
        };
        Emitters emitters;  // beside particles nothing else shines
        if (s.views.particles == 0) {
            emitters =
                makeEmitters(assets.scene, assets.bvh,
                             {.timeS = request.moment.timeS,
                              .animation = request.moment.animation,
                              .scale = s.scene.lightScale,
                              .placements = parseLightPlacements(s.scene.lights, "lights"),
                              .environment = {s.scene.environment, request.moment.environment}});
        }
        if (s.side[0].method == Method::exact) {
            ExactGatherOptions options;
            options.clampDistance.reset();
            if (s.gather.clampDistance) {
                options.clampDistance = static_cast<float>(*s.gather.clampDistance);
            }
            if (s.gather.nearField && s.views.particles == 0)
                options.nearFieldRays = kExactNearFieldRays;
            options.lights = emitters.lights;
            if (s.views.areOfLamps()) options.emissionScale = emitters.lightScale;
            options.bounces = s.views.bounces;
            options.gloss = s.scene.materials == Materials::full;
            options.seed = s.seed;
            options.sky = emitters.sky;
            exactGather(*embree, request.views, request.receivers, s.resolution.width,
                        s.resolution.height, options, image, atRow);
        } else {
            pathTrace(*embree, emitters, request.receivers, s.resolution.width, s.resolution.height,
                      {s.views.bounces, static_cast<std::uint32_t>(s.side[0].referenceSamples),
                       s.seed, s.scene.materials == Materials::full},
                      image, atRow);
        }
    }
};

References::References(const SceneAssets& assets, std::filesystem::path folder, Progress progress)
    : impl_(new Impl{assets, ReferenceStore(folder), std::move(progress), {}, {}}) {}
References::~References() = default;

void References::setWatch(Watch watch) { impl_->watch = std::move(watch); }

std::filesystem::path referenceFolder(const RunOptions& options) {
    if (!options.referencesFolder.empty()) return options.referencesFolder;
    const std::filesystem::path cache = defaultCacheDirectory();
    return options.useCache && !cache.empty() ? cache / "references" : std::filesystem::path();
}

std::vector<glm::vec3> References::irradiance(const ReferenceRequest& request) {
    Impl& m = *impl_;
    const Settings& s = request.settings;
    checkRequest(s);
    const std::string name(nameOf(s.side[0].method));
    const std::filesystem::path file = m.store.fileFor(m.assets.scene, request);
    const std::string description = ReferenceStore::description(m.assets.scene, request);
    IrradianceImage image;
    if (auto stored = m.store.load(file, s.resolution.width, s.resolution.height)) {
        image = std::move(*stored);
        if (image.done()) {
            spdlog::info("{}: read from {}.npy", name, file.string());
            return std::move(image.mean);
        }
        spdlog::info("{}: goes on after {} of {} rows", name, image.rowsDone, image.height);
    }
    const auto start = std::chrono::steady_clock::now();
    try {
        m.make(request, image);
    } catch (const Cancelled&) {
        if (image.rowsDone > 0) keepOrSay([&] { m.store.save(file, image, description); });
        throw;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    spdlog::info("{}: made in {:.1f} s", name, took.count());
    keepOrSay([&] {
        m.store.save(file, image, description);
        if (!file.empty()) saveExr(file, image, description);
    });
    return std::move(image.mean);
}

MapReferences References::maps(const ReferenceRequest& request, std::size_t count) {
    Impl& m = *impl_;
    const Settings& settings = request.settings;
    const std::vector<View>& views = request.views;
    MapReferences out;
    out.mapRes = settings.side[0].maps.resolution;
    out.slots = chooseViews(views, settings.seed, count);
    const std::filesystem::path file = m.store.mapsFileFor(m.assets.scene, request);
    auto stored = m.store.loadMaps(file, settings.side[0].maps.resolution, views);
    if (stored && stored->slots.size() >= out.slots.size()) {
        spdlog::info("exact maps: read from {}.npy", file.string());
        stored->keepFirst(out.slots.size());
        return std::move(*stored);
    }
    const auto start = std::chrono::steady_clock::now();
    m.needRays();
    for (const std::uint32_t slot : out.slots) out.positions.push_back(viewPosition(views[slot]));
    ExactMaps maps =
        exactMaps(*m.embree, out.positions, settings.side[0].maps.resolution, true, m.progress);
    out.depth = std::move(maps.depth);
    out.nearest = std::move(maps.nearest);
    out.farthest = std::move(maps.farthest);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    spdlog::info("exact maps: {} views made in {:.1f} s", out.slots.size(), took.count());
    keepOrSay([&] {
        m.store.saveMaps(file, out, ReferenceStore::mapsDescription(m.assets.scene, request));
    });
    return out;
}

}  // namespace mv
