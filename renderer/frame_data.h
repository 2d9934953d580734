#pragma once
// What FrameRenderer keeps from frame to frame, in groups: each is written by one stage, or is what
// one stage needs to know of the frames before. Used by the files frame_*.cpp only.

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/frame_renderer.h"
#include "renderer/passes/average_pixels_pass.h"
#include "renderer/passes/bad_pixels_pass.h"
#include "renderer/passes/compose_pass.h"
#include "renderer/passes/difference_pass.h"
#include "renderer/passes/direct_light_pass.h"
#include "renderer/passes/gather_pass.h"
#include "renderer/passes/overlay_pass.h"
#include "renderer/passes/reflection_pass.h"
#include "renderer/passes/sharing_pass.h"
#include "renderer/passes/temporal_pass.h"
#include "renderer/passes/thin_views_pass.h"
#include "renderer/passes/tonemap_pass.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"
#include "renderer/stage_inputs.h"
#include "renderer/visibility.h"

namespace mv {

// Profiler owners: kBothSides for work that both sides use, ownerOf(side) for one side's.
constexpr int kBothSides = 0;
constexpr int ownerOf(std::size_t side) { return static_cast<int>(side) + 1; }

// A side's views as the gather reads them, and the versions of the maps and views that they were
// made from.
struct SideRecords {
    GatherRecords records;
    std::uint64_t maps = 0, views = 0;
    std::optional<double> clampDistance;
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

    // ---- whether light passes between views and surfaces
    MethodSettings settings;                 // that the visibility was asked for with
    std::unique_ptr<Visibility> visibility;  // null: a reference, or nothing yet
    std::uint64_t mapsVersion = 0;
    bool unproved = false;  // it is not known yet whether the maps hold every pair
    MethodStatistics statistics;
    SideRecords records;
    std::unique_ptr<SetMaps> setMaps;  // for the views of ViewStage::ofSet

    // ---- the light gathered through it
    std::optional<SampleInputs> sampleInputs;
    int sets = 0;  // sets of samples in `gathered` or in the means
    GatherResult gathered;
    gl::ReadBack asked;                  // GatherInputs::asked, of the sets gathered so far
    double undecidedShare = 0;           // the last that has arrived
    gl::Texture irradiance, unfiltered;  // means of the sets; only where sets > 1
    gl::Texture reflected;               // mean radiance of the sets; empty without gloss

    // ---- light of the frames before
    std::optional<HistoryInputs> historyInputs;
    std::optional<ViewsInput> historyLight;  // what the last views came from, but camera and counts
    LightHistory history;
    bool showsHistory = false;  // it is in the picture, beside the mean

    // ---- a reference's light
    std::uint64_t reference = 0;  // its name
    bool referenceWhole = false;  // all of it is there

    // ---- the picture
    std::optional<SharingInputs> sharingInputs;  // while radiance holds a picture of sharing
    gl::Texture radiance, display;
    // Where each set samples a point of its own in every pixel, these are the means over the
    // points; `gathered` and `radiance` then belong to the first point, the pixel's centre. Light
    // that is remembered from other frames is averaged apart, so that the final picture has none of
    // it.
    PixelMeans points, rememberedPoints;
    TemporalMeans temporal;    // of frames that move; empty while none does
    bool showsPoints = false;  // the picture is of shownPoints(), which no view of data is
    gl::ReadBack badCounts;
    std::uint64_t badPixels = 0;

    bool isReference() const { return mv::isReference(settings.method); }
    bool hasMaps() const { return visibility && visibility->maps().present; }
    bool hasMean() const { return sets > 1 && irradiance && !isReference(); }
    bool averagesPixels() const { return points.points > 1; }
    const PixelMeans& shownPoints() const {
        if (temporal.means.points > 0) return temporal.means;
        return rememberedPoints.points > 0 ? rememberedPoints : points;
    }
    // The radiance of the whole picture, not exposed.
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

// The subset of views that have maps of their own when --maps limits them; the others borrow these.
// One for the frame's views, one for each fresh set.
struct MapViews {
    explicit MapViews(gl::Results results) : pass(results) {}
    ViewHierarchyPass pass;
    GpuMapViews subset;
    bool chosen = false;        // they are chosen, but their hierarchy is not built yet
    std::uint64_t ofViews = 0;  // TracedViews::version that the hierarchy was chosen from
    std::uint64_t version = 0;  // of the hierarchy
    bool placed() { return !chosen || pass.placed(); }
    // The views that this method makes maps of; null where it makes maps of all views, or none.
    const GpuMapViews* subsetFor(const Visibility* visibility) const {
        return visibility && visibility->views() == &subset.tree ? &subset : nullptr;
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
    // Of its trees and of what makes them.
    std::uint64_t treeBytes() const {
        return hierarchyPass.bytes() + tree.bytes() + mapViews.pass.bytes() +
               mapViews.subset.bytes();
    }
};

// What a set of samples is gathered from.
struct SetLight {
    const GpuViewHierarchy& cullTree;
    const Visibility* visibility;  // null: a reference
    const GpuMapViews* mapViews;   // the views that have maps; null: all, or none
    const GatherRecords& records;
    std::uint64_t viewsVersion, mapsVersion;
    const GpuViewHierarchy& mapHierarchy() const {
        return visibility ? visibility->hierarchy() : cullTree;
    }
    // The hierarchy that GatherPass::gather() is given.
    const GpuViewHierarchy& gatherHierarchy() const { return mapViews ? cullTree : mapHierarchy(); }
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

// A point of every pixel off its centre, and what is drawn and gathered there.
struct PixelPoint {
    FrameCamera camera;
    GBuffer gbuffer;
    gl::Texture direct, radiance;
    GatherResult gathered;  // of one side at a time
    gl::Texture reflected;
    int set = 0;  // the set that gbuffer and direct were drawn for; 0: none
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
    GpuViews spare;              // its buffer is used for `next`
    std::uint64_t versions = 0;  // counts the trees of views that were ever built
    // A camera from which the frame's views were found to matter about as much as from the camera
    // that they were chosen for.
    std::optional<ImportanceCamera> steadyFrom;
    // Lets the next frame make all views anew, and with them their maps.
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
    std::unique_ptr<SkyMaps> skyMaps;  // null: --sky-views is 0, or there is no sky
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

// What GatherPass was prepared for last: culled lists, which sets of samples with points or views
// of their own replace.
struct CullStage {
    std::optional<CullInputs> inputs;      // of the frame's own surfaces and views
    std::uint64_t version = 0;             // rises with `inputs`
    std::optional<std::uint64_t> drawing;  // GBuffer::drawing of the frame's or PixelPoint's
    std::uint64_t views = 0;               // TracedViews::version of the views that were culled
};

// What glossy surfaces reflect and what is seen through clear ones, made set by set.
struct ReflectionStage {
    ReflectionPass pass;
    std::unique_ptr<Reflections> met[2];  // by Follow; null where nothing is glossy or clear
    gl::Texture ofSet;                    // radiance of one set, not yet averaged
    std::uint64_t bytes() const;
};

// Whether the frame is one of a sequence: something moves, or each frame is made from nothing with
// a single set of samples. Such a frame has samples of its own and uses the light history.
struct SequenceState {
    bool ownSamples = false;        // this frame is one of a sequence
    bool gathersInTurns = false;    // FrameInput::gathersInTurns, in a sequence
    std::uint32_t setsBefore = 0;   // sets of samples that earlier frames took
    std::optional<FrameMoment> at;  // moment of the last frame in which nothing moved
    // This call renders the same sequence frame again, to count its pairs or show its reference:
    // nothing advances.
    bool repeats = false;
    bool keepsHistory = true;        // false: the picture is made from nothing, of several sets
    std::uint32_t movingFrames = 0;  // consecutive frames drawn off their pixels' centres

    // Decides all of this for a frame. `shown`: what the picture shows.
    void begin(const Settings& settings, const FrameInput& input,
               const std::optional<Settings>& shown, gl::Results results);
    // The frame's camera. While something moves each frame sees another point of every pixel.
    FrameCamera movingCamera(const Settings& settings, const FrameInput& input);
};

// The exposure in use, and the one that was fitted.
struct ExposureState {
    double usedEv = 0;
    std::optional<double> fittedEv;
    ToneMap fittedFor = {};    // tone maps differ in what is white
    bool fittedEarly = false;  // to a picture whose references were incomplete
    // Points of pixels are averaged as a display shows them at this exposure, near the one in use.
    int pointsEv(const Settings& settings) const;
};

// The picture of both sides, what it shows, and what has changed since.
struct PictureState {
    std::optional<Settings> shown;
    std::optional<double> shownEv;
    bool readable = false;          // everything kept belongs to it: no frame has failed since
    bool lightChanged = true;       // since the sides' radiances were composed
    bool pointsChanged = false;     // since the means over points were shown
    gl::Texture display, radiance;  // of a comparison, joined from both sides
    double differenceRange = 0;     // end of the difference's colour scale; 0: none is shown
    std::uint64_t flipVersion = 0;  // names the pair of pictures for wantedFlip()
    bool awaitsFlip = false;        // the picture should show FLIP's error, which is not there yet
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
    double gpuMs = 0;  // GPU time of the last frame whose timestamps have arrived
};

// Lines over the picture; empty while there are none.
struct OverlayState {
    std::unique_ptr<OverlayPass> pass;
    gl::Texture picture;
    std::uint64_t version = 0;
    bool current = false;  // `picture` is the newest picture with its lines
};

}  // namespace mv
