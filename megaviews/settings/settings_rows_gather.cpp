#include "megaviews/settings/settings_rows.h"

namespace mv::rows {

std::vector<SettingInfo> ofGather() {
    using S = Settings;
    return {
        {.key = "gather-samples",
         .label = "Samples",
         .field = field(&S::gather, &GatherSettings::samples),
         .minimum = 0,
         .maximum = 65535,
         .unit = "views a pixel",
         .atLowest = "all",
         .help = "Views gathered by each pixel; 0 gathers every view that culling keeps.",
         .paper = "Kol19 5.1"},
        {.key = "gather-candidates",
         .label = "Candidates",
         .field = field(&S::gather, &GatherSettings::candidates),
         .minimum = 1,
         .maximum = 64,
         .unit = "views a sample",
         .help =
             "Views weighed for each sample by what they would give if nothing stood between "
             "(resampled importance sampling); about one of them is asked for its visibility. 1 "
             "takes each view as it is drawn."},
        {.key = "gather-scale",
         .label = "Gather scale",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::scale),
         .minimum = 1,
         .maximum = 4,
         .unit = "pixels",
         .help = "1 gathers at every pixel, 2 at half resolution, where pixels that no neighbour "
                 "serves are gathered all the same; 3 and 4 at a third and a quarter, for drafts."},
        {.key = "cull-level",
         .label = "Cull level",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::level),
         .minimum = 0,
         .maximum = 10,
         .unit = "level",
         .atLowest = "none",
         .help = "Deepest level of the view hierarchy at which views that cannot light a tile of "
                 "the picture are culled: the one in use follows distance. 0 for none.",
         .paper = "Kol19 5.1"},
        {.key = "cutoff",
         .label = "Cutoff distance",
         .field = field(&S::gather, &GatherSettings::cull, &CullSettings::cutoff),
         .minimum = 0,
         .maximum = 2,
         .unit = "root edges",
         .atLowest = "none",
         .help = "Distance beyond which views are ignored (biased); 0 for none.",
         .paper = "Kol19 5.1"},
        {.key = "clamp-distance",
         .label = "Clamp distance",
         .field = field(&S::gather, &GatherSettings::clampDistance),
         .minimum = 1e-6,
         .maximum = 1,
         .unset = "auto",
         .unit = "root edges",
         .help =
             "Distance below which a view lights no brighter; loses energy in corners. auto: of "
             "each view by how far its neighbours are."},
        {.key = "near-field",
         .label = "Near field",
         .field = field(&S::gather, &GatherSettings::nearField),
         .help = "Give back the light that the clamp takes away in corners: two short rays a "
                 "pixel, and another from each surface that they meet to what lights that."},
        {.key = "sky-samples",
         .label = "Sky samples",
         .field = field(&S::gather, &GatherSettings::skySamples),
         .minimum = 1,
         .maximum = 1024,
         .help = "Directions a pixel that are asked which light of the environment reaches it."},
        {.key = "sky-views",
         .label = "Sky views",
         .field = field(&S::gather, &GatherSettings::skyViews),
         .minimum = 0,
         .maximum = 4096,
         .powerOfTwo = true,
         .atLowest = "rays",
         .help = "Parallel views of the environment whose depth maps answer instead of rays, kept "
                 "while neither geometry nor environment changes; where a map cannot tell, a ray "
                 "does. With as many sky samples as views shadows have no noise. 0 for rays alone.",
         .paper = "Marrs17"},
        {.key = "sky-view-res",
         .label = "Sky view resolution",
         .field = field(&S::gather, &GatherSettings::skyMapRes),
         .minimum = 8,
         .maximum = 2048,
         .powerOfTwo = true,
         .unit = "texels",
         .help = "Width and height of the depth map of a sky view; it covers the whole scene."},
        {.key = "map-check",
         .label = "Doubt in maps",
         .field = field(&S::gather, &GatherSettings::mapCheck),
         .minimum = 0,
         .maximum = 1,
         .unit = "share",
         .help =
             "How far a view's map is doubted where it is sure, beside 1 where it knows nothing. "
             "A pixel's light is what maps believe of many views, and its samples are rays "
             "that correct it, taken in proportion to doubt; so the mean is that of rays "
             "alone, and light that maps let through walls goes. 0 trusts maps that are sure. "
             "Where undecided samples are rays."},
        {.key = "undecided",
         .label = "Undecided samples",
         .field = choice(field(&S::gather, &GatherSettings::undecided), {"rays", "off"}),
         .help =
             "What answers where maps are not sure: rays (samples are rays against the triangles, "
             "which correct what maps believe), or off (the nearest texel of a map alone, with a "
             "bias as wide as it is). Of corrected rules with fused maps."},
        {.key = "bias",
         .label = "Bias",
         .field = field(&S::gather, &GatherSettings::bias),
         .minimum = 0,
         .maximum = 16,
         .help =
             "How much nearer than a receiver an occluder must be to hide it, times the rules' "
             "own: "
             "corrected, the footprint of a texel; published, 1 % of the root edge. Less darkens "
             "surfaces that hide themselves, more leaks light."},
        {.key = "history",
         .label = "History",
         .field = field(&S::gather, &GatherSettings::history),
         .minimum = 0,
         .maximum = 1024,
         .unit = "frames",
         .atLowest = "none",
         .help = "Frames before whose samples a pixel remembers while camera or light move: less "
                 "noise, but light that changes by less than the noise lags behind (biased). A "
                 "picture then depends on the frames before it."},
        {.key = "filter",
         .label = "Filter",
         .field = field(&S::gather, &GatherSettings::filter),
         .help = "Cross-bilateral filter of the gathered irradiance.",
         .paper = "Kol19 5.1"},
        {.key = "limit-fireflies",
         .label = "Limit fireflies",
         .field = field(&S::gather, &GatherSettings::limitFireflies),
         .help =
             "A pixel that the filter left far brighter than what lies around it is shown as "
             "bright as that, and under a sky one that it left far darker as dark. Dims a picture "
             "by a few thousandths, and less the more sets of samples are averaged."},
        {.key = "second-look",
         .label = "Second look",
         .field = field(&S::gather, &GatherSettings::secondLook),
         .help = "A pixel none of whose samples is lit may be dark or had bad luck. Where the "
                 "filter shows four times more than its samples let one expect, it is gathered "
                 "again, up to eight times as many samples against the scene itself; what they "
                 "do not bear out is taken away."},
        {.key = "accumulate",
         .label = "Accumulate",
         .field = field(&S::picture, &PictureSettings::accumulate),
         .minimum = 1,
         .maximum = 65536,
         .unit = "frames",
         .help = "Frames whose samples are averaged in one picture while nothing moves."},
        {.key = "reference-samples",
         .label = "Reference paths",
         .field = methodField(&MethodSettings::referenceSamples),
         .minimum = 1,
         .maximum = 1e6,
         .unit = "a pixel",
         .help = "Paths a pixel of the method pathtraced."},
    };
}

}  // namespace mv::rows
