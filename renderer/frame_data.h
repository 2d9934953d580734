#pragma once
// What FrameRenderer keeps from frame to frame, in groups: each is written by one stage, or is what
// one stage needs to know of the frames before. Used by the files frame_*.cpp only.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/frame_renderer.h"
#include "renderer/passes/difference_pass.h"
#include "renderer/passes/gather_pass.h"
#include "renderer/passes/overlay_pass.h"
#include "renderer/passes/reflection_pass.h"
#include "renderer/passes/sharing_pass.h"
#include "renderer/passes/temporal_pass.h"
#include "renderer/passes/thin_views_pass.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"
#include "renderer/stage_inputs.h"
#include "renderer/visibility.h"

namespace mv {

// Whom a stage works for.
constexpr int kShared = 0;
constexpr int ownerOf(std::size_t side) { return static_cast<int>(side) + 1; }

// A side's views as the gather reads them, of the versions of maps and views that they are of.
struct SideRecords {
    GatherRecords records;
    std::uint64_t maps = 0, views = 0;
};

// A side's maps of the views that a set of samples has of its own.
struct SetMaps {
    Method method{};  // of the visibility
    std::unique_ptr<Visibility> visibility;
    MethodStatistics statistics;
    SideRecords records;
};

// One half of a comparison: a method's visibility and the light gathered through it.
struct Side {
    explicit Side(gl::Results results)
        : asked("samples that asked", results), badCounts("bad pixels", results) {}

    MethodSettings settings;                 // of the visibility
    std::unique_ptr<Visibility> visibility;  // null: a reference, or nothing yet
    std::uint64_t mapsVersion = 0;
    bool unproved = false;  // whether the maps hold every pair is not known yet
    MethodStatistics statistics;

    std::optional<SampleInputs> sampleInputs;
    std::optional<SharingInputs> sharingInputs;  // while radiance holds a picture of sharing
    std::optional<HistoryInputs> historyInputs;
    LightHistory history;
    bool showsHistory = false;  // light of frames before is in the picture, beside the mean
    std::optional<ViewsInput> historyLight;  // of all its views, whichever were chosen
    SideRecords records;
    std::unique_ptr<SetMaps> setMaps;  // of ViewStage::ofSet
    GatherResult gathered;
    gl::ReadBack asked;                  // of GatherInputs, by whatever set was gathered
    double undecidedShare = 0;           // the last that has arrived
    int sets = 0;                        // of samples: in `gathered`, or averaged in the means
    gl::Texture irradiance, unfiltered;  // means; only where sets > 1
    gl::Texture reflected;               // radiance, mean of the sets; empty without gloss
    gl::Texture radiance, display;
    // Where the sets are of points of their own: `gathered` and `radiance` are those of the first,
    // the pixels' centres, and these the means over the points. Light that is remembered beside is
    // averaged apart, so that the last picture has none of it.
    TonemapPass::Means points, rememberedPoints;
    gl::ReadBack badCounts;
    std::uint64_t badPixels = 0;

    // Names a reference method's light, and says whether all of it is there.
    std::uint64_t reference = 0;
    bool referenceWhole = false;

    bool isReference() const { return mv::isReference(settings.method); }
    bool hasMaps() const { return visibility && visibility->maps().present; }
    bool hasMean() const { return sets > 1 && irradiance && !isReference(); }
    TemporalMeans temporal;  // of frames that move; empty while none does
    const TonemapPass::Means& shownPoints() const {
        if (temporal.means.points > 0) return temporal.means;
        return rememberedPoints.points > 0 ? rememberedPoints : points;
    }
    bool averagesPixels() const { return points.points > 1; }
    bool showsPoints = false;  // not a view of data
    // Of the whole picture, before exposure.
    const gl::Texture& shownRadiance() const {
        return showsPoints ? shownPoints().radiance : radiance;
    }
    const gl::Texture& shownIrradiance() const {
        return showsHistory ? gathered.remembered : hasMean() ? irradiance : gathered.irradiance;
    }
    const gl::Texture& shownUnfiltered() const {
        return hasMean() ? unfiltered : gathered.unfiltered;
    }
};

// Those of the frame's or a set's views that have maps, where not all do.
struct MapViews {
    explicit MapViews(gl::Results results) : pass(results) {}
    ViewHierarchyPass pass;
    GpuMapViews of;
    bool chosen = false;        // of the views sorted last, whose hierarchy is not built yet
    std::uint64_t ofViews = 0;  // version of those that the hierarchy is of
    std::uint64_t version = 0;  // of the hierarchy
    bool placed() { return !chosen || pass.placed(); }
    // What a method's maps are of; null where it makes maps of all views, or none.
    const GpuMapViews* sharedBy(const Visibility* visibility) const {
        return visibility && visibility->views() == &of.tree ? &of : nullptr;
    }
};

// Views with their trees: the frame's, or those that one set of samples of a still picture has of
// its own. The passes already work on the next views where those are traced a frame ahead.
struct TracedViews {
    explicit TracedViews(gl::Results results) : hierarchyPass(results), mapViews(results) {}
    ViewHierarchyPass hierarchyPass;
    MapViews mapViews;
    std::optional<ViewsInput> input;  // what the views were made from; nullopt: they are not there
    GpuViews views;
    GpuViewHierarchy tree;
    std::uint64_t version = 0;  // of the tree; 0: not built
};

// What a set of samples is gathered from.
struct SetLight {
    const GpuViewHierarchy& cullTree;
    const Visibility* visibility;  // null: a reference
    const GpuMapViews* shared;     // the views that have maps; null: all, or none
    const GatherRecords& records;
    std::uint64_t viewsVersion, mapsVersion;
    const GpuViewHierarchy& mapHierarchy() const {
        return visibility ? visibility->hierarchy() : cullTree;
    }
    // As GatherPass::gather() takes it.
    const GpuViewHierarchy& gatherHierarchy() const { return shared ? cullTree : mapHierarchy(); }
    const GpuViewMaps& maps() const {
        static const GpuViewMaps kNoMaps;
        return visibility ? visibility->maps() : kNoMaps;
    }
    GatherInputs inputs(const GBuffer& of, const RootCube& root, const GatherOptions& options,
                        gl::ReadBack* asked = nullptr) const {
        return {.gbuffer = of,
                .root = root,
                .mapHierarchy = gatherHierarchy(),
                .maps = maps(),
                .records = records,
                .options = options,
                .asked = asked};
    }
};

// A point of every pixel off its centre: what is drawn and gathered there.
struct PixelPoint {
    FrameCamera camera;
    GBuffer gbuffer;
    gl::Texture direct, radiance;
    GatherResult gathered;  // of one side at a time
    gl::Texture reflected;
    int set = 0;  // that gbuffer and direct are of; 0: none
    std::uint64_t bytes() const;
};

// What glossy surfaces reflect, or what is seen through clear ones: the surfaces that a ray a pixel
// meets, and their light, of one set of samples and one side at a time.
struct Reflections {
    GatherPass gatherPass;
    std::optional<ReflectionInputs> inputs;
    GBuffer met;
    gl::Texture direct, radiance;
    GatherRecords records;  // of sides that keep none
    GatherResult gathered;
    std::uint64_t bytes() const;
};

// Views that were traced in the frame before: their tree is built once its sizes are there.
struct NextViews {
    ViewsInput input;
    Emitters emitters;
    GpuViews views;
};

// The views of the frame, of its sets of samples and of the next frame.
struct ViewStage {
    explicit ViewStage(gl::Results results) : frame(results) {}
    TracedViews frame;
    std::unique_ptr<TracedViews> ofSet;
    std::optional<NextViews> next;
    GpuViews spare;              // whose buffer `next` takes
    std::uint64_t versions = 0;  // counts the trees of views that were ever built
    // From here the frame's views were found to be about as important as where they were chosen.
    std::optional<ImportanceCamera> steadyFrom;
    // All views are made anew, and with them their maps.
    void forget() {
        frame.input.reset();
        next.reset();
        if (ofSet) ofSet->input.reset();
    }
};

// The lights that the frame's views were traced from, as the passes read them.
struct LightState {
    Emitters emitters;
    GpuSky sky;
    GpuLights punctual;
    std::unique_ptr<SkyMaps> skyMaps;  // where the sky's views are asked
    std::optional<SkyMapsInputs> skyMapsInputs;
};

// The surfaces that the camera sees through the pixels' centres, and the direct light on them.
struct SurfaceStage {
    GBuffer gbuffer;
    std::optional<GBufferInputs> inputs;
    FrameCamera camera;
    std::uint64_t version = 0;
    gl::Texture direct;
    std::optional<DirectInputs> directInputs;
};

// What GatherPass has culled last, which a set of samples may replace by its own.
struct CullStage {
    std::optional<CullInputs> inputs;      // of the frame's own surfaces and views
    std::uint64_t version = 0;             // rises with `inputs`
    std::optional<std::uint64_t> drawing;  // GBuffer::drawing of the frame's or PixelPoint's
    std::uint64_t views = 0;               // TracedViews::version
};

// What glossy surfaces reflect and what is seen through clear ones, made set by set.
struct ReflectionStage {
    ReflectionPass pass;
    std::unique_ptr<Reflections> met[2];  // by Follow, where there is anything to
    gl::Texture ofSet;                    // radiance of one set, before it is averaged
    void forget() {
        for (const auto& r : met) {
            if (r) r->inputs.reset();
        }
    }
    std::uint64_t bytes() const;
};

// Where the frame stands in a sequence: of frames that move, or of whose sets there is but one.
// Such a frame has samples of its own and what those before remember.
struct SequenceState {
    bool ownSamples = false;         // the frame is one of a sequence
    bool gathersInTurns = false;     // as FrameInput asks
    std::uint32_t setsBefore = 0;    // sets of samples before this frame's first
    std::optional<FrameMoment> at;   // of the last frame that nothing moved in
    bool repeats = false;            // that frame once more: counted, or beside a reference
    bool keepsHistory = true;        // false: of pictures of several sets, made from nothing
    std::uint32_t movingFrames = 0;  // drawn off their pixels' centres, one after another

    // Begins a frame. shown: what the picture shows; results: of the renderer.
    void begin(const Settings& settings, const FrameInput& input,
               const std::optional<Settings>& shown, gl::Results results);
    // The camera of a frame that moves sees another point of each pixel than that before.
    FrameCamera movingCamera(const Settings& settings, const FrameInput& input);
};

// The exposure in use, and the one that was fitted.
struct ExposureState {
    double usedEv = 0;
    std::optional<double> fittedEv;
    ToneMap fittedFor = {};    // what is white differs
    bool fittedEarly = false;  // to a picture whose references were not whole
    // The exposure that points of pixels are averaged for on a display: near the one in use.
    int pointsEv(const Settings& settings) const;
};

// The picture of both sides, what it shows, and what has changed since.
struct PictureState {
    std::optional<Settings> shown;
    std::optional<double> shownEv;
    bool readable = false;          // what is kept is of it: no frame has failed since
    bool lightChanged = true;       // since the sides' radiances were composed
    bool pointsChanged = false;     // since they were shown
    gl::Texture display, radiance;  // composed of both sides
    double differenceRange = 0;
    std::uint64_t flipVersion = 0;
    bool awaitsFlip = false;  // the picture should show it and does not
    bool mustCompose(const Settings& settings) const {
        return lightChanged || !shown || shown->light() != settings.light() ||
               shown->picture != settings.picture || shown->inspect != settings.inspect;
    }
};

// Where results come late: the last good picture while the newest is unproved.
struct LateState {
    bool held = false;        // `front` is shown
    bool mapsFailed = false;  // the newest picture's maps lack pairs
    gl::Texture front;
    double gpuMs = 0;  // of the last frame whose times have come
};

// Lines over the picture; empty while there are none.
struct OverlayState {
    std::unique_ptr<OverlayPass> pass;
    gl::Texture picture;
    std::uint64_t version = 0;
    bool current = false;  // the picture with lines is of the newest picture
};

}  // namespace mv
