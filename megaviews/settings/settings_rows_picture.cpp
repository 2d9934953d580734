#include "megaviews/settings/settings_rows.h"

#include <array>

namespace mv::rows {
namespace {

constexpr std::array<std::string_view, 4> kToneMapNames = {"none", "aces", "neutral", "agx"};
constexpr std::array<std::string_view, 12> kDebugViewNames = {
    "final", "direct",     "indirect", "unfiltered", "normals", "albedo",
    "depth", "candidates", "nan",      "sharing",    "shared",  "undecided"};

}  // namespace

std::vector<SettingInfo> ofPicture() {
    using S = Settings;
    return {
        {.key = "resolution",
         .label = "Resolution",
         .field = field(&S::resolution),
         .minimum = 1,
         .maximum = 16384,
         .unit = "pixels",
         .help = "Size of the picture."},
        {.key = "pixel-samples",
         .label = "Samples a pixel",
         .field = field(&S::picture, &PictureSettings::pixelSamples),
         .minimum = 1,
         .maximum = 4096,
         .help = "Points within a pixel whose light is averaged while nothing moves, which makes "
                 "edges soft; each has gather samples of its own, and where more sets of those "
                 "accumulate, each set has a point of its own. 1: the pixel's centre alone. Data, "
                 "differences, references and what the window measures are of centres."},
        {.key = "fresh-views",
         .label = "Fresh views",
         .field = field(&S::picture, &PictureSettings::freshViews),
         .help = "Each further set of samples that a still picture averages is lit by views of its "
                 "own, and maps of them, so that the mean has not the blotches of one set of "
                 "views. Views from a file, particles and what stands beside a reference stay."},
        {.key = "temporal",
         .label = "Smooth motion",
         .field = field(&S::picture, &PictureSettings::temporal),
         .help = "While something moves and frames are remembered: each frame is drawn at another "
                 "point of its pixels and averaged with what those before showed of the same "
                 "surfaces, which makes edges soft and calm. Data, differences and references "
                 "have none of it."},
        {.key = "exposure",
         .label = "Exposure",
         .field = field(&S::display, &DisplaySettings::exposureEv),
         .minimum = -64,
         .maximum = 64,
         .unset = "auto",
         .unit = "EV",
         .help = "Power of two on the radiance; auto fits it to the first frame, in "
                 "a window also to where the camera comes to rest if it is more than 2 EV off."},
        {.key = "tonemap",
         .label = "Tone map",
         .field = choice(field(&S::display, &DisplaySettings::toneMap), kToneMapNames),
         .help = "Curve from radiance to the display: none, ACES-like, Khronos neutral, or "
                 "AgX."},
        {.key = "view",
         .label = "Debug view",
         .field = choice(field(&S::picture, &PictureSettings::view), kDebugViewNames),
         .help = "What the picture shows: the final light, parts of it, or what it is made from."},
    };
}

}  // namespace mv::rows

namespace mv {

std::string_view nameOf(ToneMap toneMap) {
    return rows::kToneMapNames.at(static_cast<std::size_t>(toneMap));
}
std::string_view nameOf(DebugView view) {
    return rows::kDebugViewNames.at(static_cast<std::size_t>(view));
}

}  // namespace mv
