#include "app/bench/sweep.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "app/bench/sweep_search.h"
#include "app/common/frame_images.h"
#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/io/ply.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMethodKey = "method";

// One point while it is measured.
struct Measured {
    Settings settings;
    FrameRenderer* renderer = nullptr;
    std::string refusal;
    FrameStatistics statistics;  // of the last frame
    StageSamples bothSides, stages;
    std::vector<double> mapsMs, gatherMs, indirectMs, frameMs;
    std::vector<std::optional<Measurement>> errors;  // by ErrorAgainst; nothing: no reference
    std::optional<MapErrorReport> mapErrors;
    std::vector<std::string> missing;  // arrays of references that were not there
    Summary speedup;                   // ManyLoDs' time of the maps over this method's
};

std::optional<double> errorOf(const Measured& m, const SweepSearch& search) {
    const auto& errors = m.errors[static_cast<std::size_t>(search.against)];
    if (!errors) return std::nullopt;
    const double value = valueOf(*errors, search.metric);
    return std::isnan(value) ? std::nullopt : std::optional(value);
}

Json toJson(const Measured& m) {
    Json out = Json::object();
    out["refusal"] = m.refusal.empty() ? Json(nullptr) : Json(m.refusal);
    if (m.refusal.empty()) {
        const FrameStatistics& frame = m.statistics;
        const bool timed = !isReference(m.settings.side[0].method);  // else it was read from a file
        const auto time = [&](const std::vector<double>& ms) {
            return timed ? toJson(summarize(ms)) : Json(nullptr);
        };
        out["clock"] = frame.clock;
        out["views"] = {{"requested", frame.viewsRequested},
                        {"alive", frame.viewsAlive},
                        {"nodes", frame.viewNodes},
                        {"leaves", frame.viewLeaves}};
        out["ms"] = {{"maps", time(m.mapsMs)},
                     {"gather", time(m.gatherMs)},
                     {"indirect", time(m.indirectMs)},
                     {"frame", time(m.frameMs)}};
        out["speedup"] = m.speedup.count ? toJson(m.speedup) : Json(nullptr);
        const Json numbers = toJson(frame.methods.front());
        for (const auto& [key, value] : numbers.items()) out[key] = value;
        out["stages"] = m.bothSides.toJson();
        const Json own = m.stages.toJson();
        for (const auto& [name, ms] : own.items()) out["stages"][name] = ms;
        out["memory"] = Json::object();
        for (const MemoryUse& use : frame.memory) out["memory"][use.name] = use.usedBytes;
        out["badPixels"] = frame.badPixels;
        out["errors"] = Json::object();
        out["references"] = Json::object();
        for (std::size_t i = 0; i < m.errors.size(); ++i) {
            const std::string name(nameOf(static_cast<ErrorAgainst>(i)));
            const auto& errors = m.errors[i];
            out["errors"][name] = errors ? toJson(*errors)["values"] : Json(nullptr);
            out["references"][name] =
                errors ? Json{{"name", errors->reference}, {"exposureEv", errors->exposureEv}}
                       : Json(nullptr);
        }
        out["errors"]["maps"] = m.mapErrors ? toJson(*m.mapErrors) : Json(nullptr);
        out["missingReferences"] = m.missing;
    }
    out["settings"] = toJson(m.settings);
    return out;
}

void fillSpeedups(std::vector<Measured>& group) {
    const auto lods = std::find_if(group.begin(), group.end(), [](const Measured& m) {
        return m.settings.side[0].method == Method::manylods && m.refusal.empty();
    });
    if (lods == group.end()) return;
    for (Measured& m : group) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < m.mapsMs.size(); ++i) {
            if (m.mapsMs[i] > 0) ratios.push_back(lods->mapsMs[i] / m.mapsMs[i]);
        }
        m.speedup = summarize(std::move(ratios));
    }
}

}  // namespace

void SweepRequest::check() const {
    std::vector<SweepAxis> all = axes;
    if (search) all.push_back(search->vary);
    for (const SweepPoint& point : sweepPoints(base, all)) {
        const std::string file = environmentFile(point.settings.scene.environment);
        if (file.empty()) continue;
        throw Error(ExitCode::usage, "--environment: a sweep reads no images, so not '" + file +
                                         "'; it takes auto, none, sky or white");
    }
}

struct Sweep::Impl {
    SweepRequest request;
    std::unique_ptr<SceneAssets> assets;
    Settings loaded;  // that the assets were made with
    // One for each method, so that none measures the memory of another; buffers grow and never
    // shrink, so that one is used again only where nothing changes what it needs.
    struct Slot {
        std::unique_ptr<FrameRenderer> renderer;
        Settings settings;
    };
    std::map<Method, Slot> slots;
    SweepReferences references{""};
    ReferenceStore maps{""};

    void load(const Settings& settings) {
        TerminalProgress progress(request.quiet);
        assets = loadAssets(request.scene, settings, request.cacheFolder, progress.callback());
        loaded = settings;
    }

    // Scene and octree of a point, where they are others than those of the last.
    void use(const Settings& settings) {
        if (settings.scene.timeS != loaded.scene.timeS ||
            settings.scene.fileScene != loaded.scene.fileScene ||
            settings.scene.variant != loaded.scene.variant ||
            settings.scene.animation != loaded.scene.animation) {
            slots.clear();
            load(settings);
        } else if (settings.scene.octreeDepth != loaded.scene.octreeDepth ||
                   settings.scene.tree != loaded.scene.tree) {
            slots.clear();
            TerminalProgress progress(request.quiet);
            buildHierarchy(*assets, settings, request.cacheFolder, progress.callback());
            loaded = settings;
        }
    }

    FrameRenderer& rendererFor(const Settings& settings) {
        Slot& slot = slots[settings.side[0].method];
        if (slot.renderer && slot.settings == settings) return *slot.renderer;
        slot.renderer.reset();  // before the next one takes memory
        slot.renderer = std::make_unique<FrameRenderer>();
        slot.settings = settings;
        FrameRenderer& renderer = *slot.renderer;
        renderer.setScene(assets->scene, assets->bvh, assets->hierarchy);
        renderer.forgetExposure();
        if (!settings.views.file.empty()) {
            std::vector<std::string> warnings;
            renderer.setViews(loadViews(settings.views.file, assets->scene.root, &warnings));
            for (const std::string& warning : warnings) spdlog::warn("{}", warning);
        }
        return renderer;
    }

    FrameInput inputOf(const Settings& settings) const {
        FrameInput input;
        input.camera = chosenCamera(settings, *assets, settings.scene.timeS);
        input.timeS = settings.scene.timeS;
        input.animation = assets->animation;
        input.reuse = false;
        return input;
    }

    // One frame of a point. What cannot fit is noted and not tried again.
    void renderFrame(Measured& m, bool measured, bool last) {
        if (!m.refusal.empty()) return;
        if (interrupted()) throw Cancelled();
        const FrameInput input = inputOf(m.settings);
        try {
            Settings settings = m.settings;
            settings.display.exposureEv =
                m.settings.display.exposureEv.value_or(0);  // nobody looks
            const auto missing =
                references.render(*m.renderer, assets->scene, settings, input, m.statistics);
            if (missing) m.refusal = *missing;
        } catch (const Error& error) {
            if (error.code != ExitCode::impossible) throw;
            m.refusal = error.what();
        }
        if (!measured || !m.refusal.empty()) return;
        const FrameStatistics& frame = m.statistics;
        const MethodStatistics& method = frame.methods.front();
        m.bothSides.add(frame.stagesOfBothSides);
        m.stages.add(method.stages);
        m.mapsMs.push_back(groupMs(method.stages, StageGroup::maps));
        m.gatherMs.push_back(groupMs(frame.stagesOfBothSides, StageGroup::gather) +
                             method.gatherMs);
        m.indirectMs.push_back(m.mapsMs.back() + m.gatherMs.back());
        m.frameMs.push_back(frame.frameMs);
        if (!last) return;
        m.errors.resize(2);
        if (!references.any()) return;
        // The maps first: the references' pictures have none.
        m.mapErrors = findMapErrors(maps, *m.renderer, assets->scene, m.settings, input, 0);
        if (!m.mapErrors && makesMaps(m.settings.side[0].method)) {
            const std::filesystem::path file = maps.mapsFileFor(
                assets->scene, {m.settings, input, m.renderer->readMapViews().views, {}});
            m.missing.push_back(file.filename().string() + ".npy");
        }
        const RgbImage radiance = radianceOf(*m.renderer);
        for (std::size_t i = 0; i < m.errors.size(); ++i) {
            m.errors[i] = references.measure(*m.renderer, assets->scene, m.settings, input,
                                             radiance, static_cast<ErrorAgainst>(i), m.missing);
        }
    }

    std::vector<Measured> measure(const std::vector<Settings>& group) {
        std::vector<Measured> out(group.size());
        for (std::size_t i = 0; i < group.size(); ++i) out[i].settings = group[i];
        try {
            use(group.front());
            for (Measured& m : out) m.renderer = &rendererFor(m.settings);
        } catch (const Error& error) {
            if (error.code != ExitCode::impossible) throw;
            for (Measured& m : out) m.refusal = error.what();
        }
        for (int i = -request.warmup; i < request.frames; ++i) {
            for (Measured& m : out) renderFrame(m, i >= 0, i + 1 == request.frames);
        }
        fillSpeedups(out);
        return out;
    }

    // The point with the value of the varied setting that meets the limit.
    Json search(const SweepPoint& point) {
        const SweepSearch& s = *request.search;
        std::vector<SweepAxis> axes = request.axes;
        axes.push_back(s.vary);
        std::vector<Measured> measured(s.vary.values.size());
        const bool byTime = s.goal == SweepSearch::Goal::time;
        const SearchFunction ask = [&](std::size_t i) -> std::optional<double> {
            std::vector<std::string> values = point.values;
            values.push_back(s.vary.values[i]);
            measured[i] = std::move(measure({sweepSettings(request.base, axes, values)}).front());
            if (!measured[i].refusal.empty()) return std::nullopt;
            return byTime ? summarize(measured[i].indirectMs).median : errorOf(measured[i], s);
        };
        const std::size_t count = s.vary.values.size();
        const SearchResult result =
            byTime ? searchEqualTime(count, ask, s.limit)
                   : searchEqualError(count, ask, s.limit, infoOf(s.metric).higherIsBetter);
        const Measured& best = measured[result.index];
        Json out = toJson(best);
        Json found = {
            {"met", result.met},
            {"value", sweepValue(s.vary.key, s.vary.values[result.index], best.settings)}};
        found["tried"] = Json::array();
        for (const SearchStep& step : result.steps) {
            const Measured& m = measured[step.index];
            const double error = byTime ? std::nan("") : step.value.value_or(std::nan(""));
            found["tried"].push_back(
                {{"value", sweepValue(s.vary.key, s.vary.values[step.index], m.settings)},
                 {"ms", m.refusal.empty() ? Json(summarize(m.indirectMs).median) : Json(nullptr)},
                 {"error", std::isfinite(error) ? Json(error) : Json(nullptr)},
                 {"refusal", m.refusal.empty() ? Json(nullptr) : Json(m.refusal)}});
        }
        out["search"] = std::move(found);
        return out;
    }
};

Sweep::Sweep(const SweepRequest& request) : impl_(new Impl) {
    impl_->request = request;
    impl_->references = SweepReferences(request.referencesFolder);
    impl_->maps = ReferenceStore(request.referencesFolder);
    const std::vector<SweepPoint> points = request.points();
    impl_->load(points.front().settings);
    for (const SweepPoint& point : points) {
        posedCamera(*impl_->assets, point.settings, point.settings.scene.timeS);
    }
}
Sweep::~Sweep() = default;

const SceneAssets& Sweep::assets() const { return *impl_->assets; }

void Sweep::run(const std::vector<SweepPoint>& points, const std::vector<bool>& skip,
                const Finished& finished) {
    Impl& impl = *impl_;
    struct Release {  // renderers must not outlive the context
        Impl& impl;
        ~Release() { impl.slots.clear(); }
    } release{impl};
    const std::vector<SweepAxis>& axes = impl.request.axes;
    std::vector<bool> done = skip;
    const auto finish = [&](std::size_t index, Json measured) {
        Json entry = {{"values", sweepValues(axes, points[index])}};
        entry.update(measured);
        finished(index, std::move(entry));
    };
    for (std::size_t first = 0; first < points.size(); ++first) {
        if (done[first]) continue;
        if (impl.request.search) {
            finish(first, impl.search(points[first]));
            continue;
        }
        // This point and those that differ from it in nothing but the method.
        std::vector<std::size_t> group;
        std::vector<Settings> settings;
        for (std::size_t i = first; i < points.size(); ++i) {
            bool same = !done[i];
            for (std::size_t a = 0; a < axes.size() && same; ++a) {
                same = axes[a].key == kMethodKey || points[i].values[a] == points[first].values[a];
            }
            if (!same) continue;
            done[i] = true;
            group.push_back(i);
            settings.push_back(points[i].settings);
        }
        const std::vector<Measured> measured = impl.measure(settings);
        for (std::size_t k = 0; k < group.size(); ++k) finish(group[k], toJson(measured[k]));
    }
}

}  // namespace mv
