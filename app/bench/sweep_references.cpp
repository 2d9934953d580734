#include "app/bench/sweep_references.h"

#include <spdlog/spdlog.h>

#include "app/common/frame_images.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

Method methodOf(ErrorAgainst against) {
    return against == ErrorAgainst::exact ? Method::exact : Method::pathtraced;
}

// Paths follow the scene's own lights.
bool hasPathTraced(const Settings& settings) {
    return settings.views.particles == 0 && settings.views.file.empty() &&
           settings.views.placement != Placement::random;
}

}  // namespace

std::string_view nameOf(ErrorAgainst against) { return nameOf(methodOf(against)); }

SweepReferences::SweepReferences(std::filesystem::path folder)
    : folder_(std::move(folder)), store_(folder_) {}

std::optional<std::string> SweepReferences::render(FrameRenderer& renderer, const Scene& scene,
                                                   const Settings& settings,
                                                   const FrameInput& input,
                                                   FrameStatistics& statistics) {
    renderer.render(settings, input, statistics);
    const std::uint64_t wanted = renderer.wantedReference(0);
    if (wanted == 0) return std::nullopt;
    const std::filesystem::path file =
        store_.fileFor(scene, {settings, input, renderer.readViews().views, {}});
    lastName_ = file.filename().string();
    const auto stored = store_.load(file, settings.resolution.width, settings.resolution.height);
    if (stored && stored->done()) {
        renderer.setReference(0, wanted, stored->mean, true);
        FrameInput again = input;
        again.reuse = true;
        FrameStatistics whole;
        renderer.render(settings, again, whole);
        statistics.badPixels = whole.badPixels;
        return std::nullopt;
    }
    if (missed_.insert(lastName_).second) {
        spdlog::warn("{}.npy is {}: errors against it are n/a", file.string(),
                     stored ? "not complete" : "not there");
    }
    return "no reference " + lastName_ + ".npy";
}

std::optional<Measurement> SweepReferences::measure(FrameRenderer& renderer, const Scene& scene,
                                                    const Settings& settings,
                                                    const FrameInput& input,
                                                    const RgbImage& radiance, ErrorAgainst against,
                                                    std::vector<std::string>& missing) {
    if (!any() || (against == ErrorAgainst::pathtraced && !hasPathTraced(settings))) {
        return std::nullopt;
    }
    Settings reference = settings;
    reference.side[0].method = methodOf(against);
    reference.display.exposureEv = settings.display.exposureEv.value_or(0);
    FrameInput again = input;
    again.reuse = true;  // the same views and surfaces
    FrameStatistics statistics;
    if (render(renderer, scene, reference, again, statistics)) {
        missing.push_back(lastName_ + ".npy");
        return std::nullopt;
    }
    double exposureEv = *reference.display.exposureEv;
    if (!settings.display.exposureEv) {
        const std::pair fitted{lastName_, settings.display.toneMap};
        if (!exposuresEv_.contains(fitted)) {
            reference.display.exposureEv.reset();
            renderer.forgetExposure();
            renderer.render(reference, again, statistics);
            exposuresEv_[fitted] = renderer.exposureEv();
        }
        exposureEv = exposuresEv_.at(fitted);
    }
    const Compared both = compared({.test = radiance,
                                    .reference = radianceOf(renderer),
                                    .linear = true,
                                    .exposureEv = exposureEv,
                                    .toneMap = settings.display.toneMap});
    Measurement out = mv::measure(both, metricsOf(both));
    out.reference = lastName_;
    return out;
}

}  // namespace mv
