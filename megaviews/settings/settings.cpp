#include "megaviews/settings/settings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <string_view>

#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {

bool showsLight(DebugView view) {
    return view == DebugView::final || view == DebugView::direct || view == DebugView::indirect ||
           view == DebugView::unfiltered;
}

namespace {

bool hasReference(const Settings& s) {
    return isReference(s.side[0].method) || (s.compare && isReference(s.side[1].method));
}
bool showsDifference(const Settings& s) {
    return s.compare && s.display.difference != Difference::off;
}

}  // namespace

bool Settings::mayAveragePixels() const {
    return picture.pixelSamples > 1 && !hasReference(*this) && !showsDifference(*this);
}

bool Settings::smoothsMotion() const {
    return picture.temporal && gather.history > 0 && showsLight(picture.view) &&
           !hasReference(*this) && !showsDifference(*this);
}

bool Settings::averagesViews() const {
    if (!picture.freshViews || views.particles > 0 || !views.file.empty()) return false;
    if (views.placement == Placement::random) return false;  // these are lights, not samples
    return !hasReference(*this);
}

int Settings::setsWanted() const {
    // A full sum has the noise of its views and of the near field. Approximate: that of sky and
    // gloss is not averaged, either.
    const bool same = gather.samples == 0 && !gather.nearField && !averagesViews();
    const int sets = same ? 1 : picture.accumulate;
    if (!mayAveragePixels()) return sets;
    return showsLight(picture.view) ? std::max(sets, picture.pixelSamples) : 1;
}

void compareWith(Settings& settings, Method method) {
    settings.compare = true;
    settings.side[1] = settings.side[0];
    settings.side[1].method = method;
}

void setMethod(Settings& settings, Method method) {
    settings.side[0].method = method;
    if (!settings.compare) settings.side[1].method = method;
}

Settings sideAlone(const Settings& settings, std::size_t side) {
    Settings alone = settings;
    alone.side[0] = settings.side.at(side);
    alone.compare = false;
    return alone;
}

std::string environmentFile(const EnvironmentSettings& settings) {
    for (const std::string_view word : {"auto", "none", "sky", "white"}) {
        if (settings.source == word) return {};
    }
    return settings.source;
}

void copySceneChoices(Settings& settings, const Settings& from) {
    settings.camera = from.camera;
    settings.scene.fileScene = from.scene.fileScene;
    settings.scene.variant = from.scene.variant;
    settings.scene.animation = from.scene.animation;
    settings.scene.timeS = from.scene.timeS;
    settings.views.file = from.views.file;
}

Settings forAnotherScene(Settings settings) {
    copySceneChoices(settings, {});
    settings.scene.lights.clear();
    settings.scene.environment = {};
    settings.display.exposureEv.reset();
    InspectSettings& inspect = settings.inspect;
    for (auto picked : {&InspectSettings::pickA, &InspectSettings::pickB,
                        &InspectSettings::pairScene, &InspectSettings::pairView}) {
        (inspect.*picked).reset();
    }
    inspect.stepScene = inspect.stepView = 0;
    return settings;
}

void validate(const Settings& s) {
    const auto fail = [](const std::string& message) { throw Error(ExitCode::usage, message); };
    if (!s.views.file.empty() && s.views.particles > 0) {
        fail("views and particles exclude each other: views come from a file or from particles");
    }
    if (s.views.placement == Placement::random &&
        (s.views.particles > 0 || !s.views.file.empty())) {
        fail("placement: random places virtual point lights, not particles or views from a file");
    }
    if (s.camera.up == Vector3{0, 0, 0}) fail("camera-up: 0,0,0 is no direction");
    if (s.camera.position && s.camera.target) {
        Vector3 d{}, c{};
        for (std::size_t i = 0; i < 3; ++i) d[i] = (*s.camera.target)[i] - (*s.camera.position)[i];
        const auto length = [](const Vector3& v) {
            return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0));
        };
        if (!(length(d) > 0)) fail("camera-target: is the same point as camera-position");
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
            c[i] = d[j] * s.camera.up[k] - d[k] * s.camera.up[j];
        }
        const bool given = s.camera.up != CameraSettings{}.up;  // else another is chosen
        if (given && !(length(c) > 1e-9 * length(d) * length(s.camera.up))) {
            fail("camera-up: points along the view; give another direction");
        }
    }
    if (s.compare) {
        if (s.side[0] == s.side[1]) {
            fail("compare: both sides would be the same '" + std::string(nameOf(s.side[0].method)) +
                 "'");
        }
    } else if (s.display.difference != Difference::off) {
        fail("difference: needs a second method, compare");
    }
}

}  // namespace mv
