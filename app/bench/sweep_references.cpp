#include "app/bench/sweep_references.h"

#include <spdlog/spdlog.h>

#include "app/common/frame_images.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

// The reference asked for is not in the store, or there is none.
struct MissingReference : Error {
    using Error::Error;
};

Method methodOf(ErrorAgainst against) {
    return against == ErrorAgainst::exact ? Method::exact : Method::pathtraced;
}

// Paths follow the scene's own lights.
bool hasPathTraced(const Settings& settings) {
    return settings.particles == 0 && settings.viewsFile.empty() &&
           settings.placement == Placement::traced;
}

}  // namespace

std::string_view nameOf(ErrorAgainst against) { return nameOf(methodOf(against)); }

SweepReferences::SweepReferences(std::filesystem::path folder)
    : folder_(std::move(folder)), store_(folder_) {}

void SweepReferences::serve(FrameRenderer& renderer, const Scene& scene) {
    renderer.setReferences(
        [this, &scene](const ReferenceRequest& request) { return load(scene, request); });
}

std::vector<glm::vec3> SweepReferences::load(const Scene& scene, const ReferenceRequest& request) {
    const Settings& s = request.settings;
    const std::filesystem::path file = store_.fileFor(scene, request);
    lastName_ = file.filename().string();
    if (file.empty()) {
        throw MissingReference(ExitCode::usage,
                               "method " + std::string(nameOf(s.method)) + ": needs --references");
    }
    auto stored = store_.load(file, s.width, s.height);
    if (stored && stored->rowsDone == stored->height) return std::move(stored->mean);
    if (missed_.insert(lastName_).second) {
        spdlog::warn("{}.npy is {}: errors against it are n/a", file.string(),
                     stored ? "not complete" : "not there");
    }
    throw MissingReference(ExitCode::impossible, "no reference " + lastName_ + ".npy");
}

PictureErrors SweepReferences::measure(FrameRenderer& renderer, const Settings& settings,
                                       const FrameInput& input, const RgbImage& radiance,
                                       ErrorAgainst against) {
    PictureErrors errors;
    if (!any() || (against == ErrorAgainst::pathtraced && !hasPathTraced(settings))) return errors;
    Settings reference = settings;
    reference.method = methodOf(against);
    reference.exposureEv = settings.exposureEv.value_or(0);
    FrameInput again = input;
    again.reuse = true;  // the same views and surfaces
    FrameStatistics statistics;
    try {
        renderer.render(reference, again, statistics);
    } catch (const MissingReference&) {
        return errors;
    }
    errors.found = true;
    errors.reference = lastName_;
    errors.exposureEv = *reference.exposureEv;
    if (!settings.exposureEv) {
        if (!exposuresEv_.contains(lastName_)) {
            reference.exposureEv.reset();
            renderer.forgetExposure();
            renderer.render(reference, again, statistics);
            exposuresEv_[errors.reference] = renderer.exposureEv();
        }
        errors.exposureEv = exposuresEv_.at(errors.reference);
    }
    const RgbImage truth = radianceOf(renderer);
    Compared compared;
    compared.radiance.emplace(radiance, truth);
    compared.display = ImagePair(displayImage(radiance, errors.exposureEv, settings.toneMap),
                                 displayImage(truth, errors.exposureEv, settings.toneMap));
    errors.values = evaluate(compared, metricsOf(compared));
    return errors;
}

}  // namespace mv
