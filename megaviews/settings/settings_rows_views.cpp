#include "megaviews/settings/settings_rows.h"

namespace mv::rows {
namespace {

constexpr double kMaxViews = 1048576;

}  // namespace

std::vector<SettingInfo> ofViews() {
    using S = Settings;
    return {
        {.key = "vpls",
         .label = "Virtual point lights",
         .field = field(&S::views, &ViewSettings::vpls),
         .minimum = 1,
         .maximum = kMaxViews,
         .unit = "views",
         .help = "Virtual point lights chosen every frame; traced: slots for them, of which those "
                 "stay empty whose path has left the scene.",
         .paper = "Kol19 4.1"},
        {.key = "maps",
         .label = "Views with maps",
         .field = field(&S::views, &ViewSettings::maps),
         .minimum = 0,
         .maximum = kMaxViews,
         .unit = "views",
         .atLowest = "all",
         .help = "Views that have a depth map of their own at most, evenly chosen. Others are told "
                 "by the map of one nearby that faces as they do: rays correct what it says, as "
                 "they do what any map says, where undecided samples are rays."},
        {.key = "particles",
         .label = "Glowing particles",
         .field = field(&S::views, &ViewSettings::particles),
         .minimum = 0,
         .maximum = kMaxViews,
         .unit = "views",
         .atLowest = "none",
         .help = "Glowing particles that light the scene instead of its lights; 0 for none.",
         .paper = "Kol19 4.1"},
        {.key = "bounces",
         .label = "Bounces",
         .field = field(&S::views, &ViewSettings::bounces),
         .minimum = 1,
         .maximum = 16,
         .help = "Virtual point lights along each light path.",
         .paper = "Kol19 4.1"},
        {.key = "placement",
         .label = "Placement",
         .field =
             choice(field(&S::views, &ViewSettings::placement), {"importance", "traced", "random"}),
         .help =
             "Where virtual point lights lie: importance (on light paths, and of several "
             "candidates a view those that light what the camera sees), traced (every point "
             "of the light paths, as published, whether it lights anything in sight or not), or "
             "random (anywhere in the scene's box, looking anywhere: the least coherent views).",
         .paper = "Kol19 4.1"},
        {.key = "views",
         .label = "Views file",
         .field = TextField{field(&S::views, &ViewSettings::file), "FILE.ply"},
         .help = "PLY file of views (x y z nx ny nz red green blue) that replace traced ones."},
        {.key = "seed",
         .label = "Seed",
         .field = field(&S::seed),
         .minimum = 0,
         .maximum = 4294967295.0,
         .help = "Seed of every random number; the same seed gives the same picture."},
    };
}

}  // namespace mv::rows
