#pragma once
// What FrameRenderer keeps from frame to frame, and the stages that make it. Used by the files
// frame_*.cpp only.

#include <array>
#include <chrono>
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
    std::unique_ptr<SetMaps> setMaps;  // of Impl::setViews
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

// Views that a set of samples of a still picture has of its own, instead of the frame's.
struct SetViews {
    explicit SetViews(gl::Results results) : hierarchyPass(results), mapViews(results) {}
    ViewHierarchyPass hierarchyPass;
    MapViews mapViews;
    std::optional<ViewsInput> input;  // of views, once they are traced
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

struct FrameRenderer::Impl {
    explicit Impl(gl::Results how)
        : results(how), profiler(how), viewHierarchyPass(how), mapViews(how) {}

    const gl::Results results;
    gl::Profiler profiler;
    GBufferPass gbufferPass;
    DirectLightPass directPass;
    TonemapPass tonemapPass;
    TemporalPass temporalPass;
    std::unique_ptr<DifferencePass> differencePass;  // made at first use
    SharingPass sharingPass;
    VplPass vplPass;
    ThinViewsPass thinViewsPass;
    ViewHierarchyPass viewHierarchyPass;

    const Scene* scene = nullptr;
    const TriangleBvh* bvh = nullptr;
    const SceneHierarchy* hierarchy = nullptr;
    std::shared_ptr<const EmissiveSurfaces> emissiveSurfaces;
    std::unique_ptr<SceneOnGpu> sceneOnGpu;  // for methods
    std::optional<ViewSet> loadedViews;
    std::uint64_t references = 0;  // how many were wanted
    std::uint64_t generation = 0;
    std::uint64_t poseNumber = 0;  // of the scene as it is on the GPU

    GpuViews views;
    GpuViewHierarchy cullTree;
    MapViews mapViews;
    std::optional<ViewsInput> viewsInput;  // of the views that are there
    Emitters litBy;                        // of the views
    GpuSky sky;                            // of litBy
    GpuLights lights;                      // of litBy
    std::unique_ptr<SkyMaps> skyMaps;      // where the sky's views are asked
    std::optional<SkyMapsInputs> skyMapsInputs;
    std::optional<NextViews> next;
    GpuViews spareViews;  // whose buffer `next` takes
    std::uint64_t viewsVersion = 0;
    std::uint64_t versions = 0;  // of views that were ever made, those of sets included
    std::unique_ptr<SetViews> setViews;
    // From where views were found to be about as important as they were chosen.
    std::optional<ImportanceCamera> steadyFrom;

    GBuffer gbuffer;
    std::optional<GBufferInputs> gbufferInputs;
    FrameCamera gbufferCamera;
    std::uint32_t movingFrames = 0;  // that were drawn off their pixels' centres, one after another
    std::uint64_t gbufferVersion = 0;
    gl::Texture direct;
    std::optional<DirectInputs> directInputs;

    GatherPass gatherPass;
    std::optional<CullInputs> cullInputs;
    std::uint64_t cullVersion = 0;
    std::optional<std::uint64_t> culledFor;  // GBuffer::drawing of gbuffer or pixelPoint->gbuffer
    std::uint64_t culledViews = 0;           // version

    std::unique_ptr<PixelPoint> pixelPoint;  // where pixels are averaged
    ReflectionPass reflectionPass;
    gl::Texture reflectedSet;
    std::unique_ptr<Reflections> reflections[2];  // by Follow, where there is anything to
    DebugView pointsView = DebugView::final;      // the last of light that was

    // Sets of samples before this frame's first, where frames have samples of their own.
    std::uint32_t setsBefore = 0;
    // A frame of a sequence, which moves or of whose sets there is but one, has samples of its own
    // and what those before remember.
    bool ownSamples = false;
    bool hurries = false;                   // the same of FrameInput
    std::optional<FrameMoment> sequenceAt;  // of the last that nothing moved in
    bool sameOfSequence = false;            // that once more: counted, or beside a reference
    bool keepsHistory = true;               // false: of pictures of several sets, made from nothing
    std::array<std::unique_ptr<Side>, 2> sides;
    int sideCount = 1;
    bool lightChanged = true;       // since the radiances were composed
    bool pointsChanged = false;     // since they were shown
    std::optional<Settings> shown;  // what the picture shows
    bool readable = false;          // what is kept is of it: no frame has failed since
    std::optional<double> shownEv;
    double differenceRange = 0;  // of the picture shown
    std::uint64_t flipVersion = 0;
    bool awaitsFlip = false;        // the picture should show it and does not
    gl::Texture display, radiance;  // composed of both sides
    // While the newest picture is unproved: the last good one, in its place.
    bool held = false, mapsFailed = false;
    double gpuMs = 0;  // of the last frame whose times have come
    gl::Texture front;
    std::optional<double> fittedEv;
    ToneMap fittedFor = {};    // what is white differs
    bool fittedEarly = false;  // to a picture whose references were not whole
    double usedEv = 0;

    // Lines over the picture; empty while there are none.
    std::unique_ptr<OverlayPass> overlayPass;
    gl::Texture overlaid;
    std::uint64_t overlayVersion = 0;
    bool overlayCurrent = false;  // overlaid shows this picture

    // ---- the stages of a frame, each redone where its key changed (frame_stages.cpp, and
    // frame_gather.cpp from the culling on)

    // What the settings ask to be lit by; particles replace the scene's own lights.
    Emitters emittersAsked(const Settings& settings, const FrameInput& input) const;
    // Views, what is seen, each side's maps, and the light gathered through them: all but the
    // picture. How many sets of samples it is the mean of; none while results that come late are
    // under way.
    std::optional<int> makeLight(const Settings& settings, const FrameInput& input,
                                 const Emitters& asked);
    // The next frame takes nothing from those before.
    void forget();
    // Moving geometry at the frame's time, and on the GPU.
    void pose(const FrameInput& input);
    const GpuViewHierarchy& mapHierarchy(const Side& side) const {
        return side.visibility ? side.visibility->hierarchy() : cullTree;
    }
    // What the frame's views are to be made from. Views that hardly change in importance while a
    // camera moves stay as they are if the input says so.
    ViewsInput wantedViews(const Settings& settings, const FrameInput& input,
                           const Emitters& wanted);
    void makeViews(const Settings& settings, const FrameInput& input, const Emitters& wanted);
    void traceViews(const ViewsInput& from, const FrameInput& input, const Emitters& emitters,
                    ViewHierarchyPass& pass, GpuViews& out);
    // Those of the frame's views that a side made maps of; null: all, or none.
    const GpuMapViews* shared(const Side& side) const {
        return mapViews.sharedBy(side.visibility.get());
    }
    // Whether some of the views have maps for all: only where rays correct what maps say.
    bool sharesMaps(const Settings& settings, const MethodSettings& method) const;
    std::uint64_t requestedViews(const ViewSettings& settings) const;
    // Of the views that a pass has just sorted those that have maps, where a side makes any, so
    // that the sizes of their hierarchy are there when treeOfMaps() builds it.
    void beginMapViews(const Settings& settings, const ViewsInput& from, ViewHierarchyPass& pass,
                       MapViews& out);
    void chooseMapViews(const ViewsInput& from, ViewHierarchyPass& pass, MapViews& out);
    // A hierarchy, the pass that made it, and its version.
    struct MapTree {
        const GpuViewHierarchy& tree;
        ViewHierarchyPass& pass;
        std::uint64_t version;
    };
    // That of the views which a method makes maps of: of all, or of some that share theirs.
    MapTree treeOfMaps(const Settings& settings, const MethodSettings& method,
                       const ViewsInput& from, MapTree all, MapViews& out);
    void chooseViews(const ViewsInput& from, const Emitters& emitters, GpuViews& out);
    void makeGBuffer(const Settings& settings, const FrameCamera& camera, const Emitters& emitters);
    // Whether the frame is one of a sequence: ownSamples, and what belongs to it.
    void noteSequence(const Settings& settings, const FrameInput& input);
    // The camera of a frame that moves sees another point of each pixel than that before.
    FrameCamera movingCamera(const Settings& settings, const FrameInput& input);
    // Of the sky that lights the frame, while the settings ask for them.
    void makeSkyMaps(const Settings& settings);
    // Shows that side's method of the settings.
    void makeVisibility(const Settings& settings, std::size_t index, const FrameInput& input);
    // Everything that is drawn from a camera, and the direct light on it.
    void drawGBuffer(const Settings& settings, const FrameCamera& camera, GBuffer& out);
    // What each receiver keeps of the views, for both sides.
    void cullGather(const Settings& settings);
    // The same for the G-buffer and the views that are gathered next, where it was done for others.
    void cullFor(const Settings& settings, const GBuffer& of, const GpuViewHierarchy& tree,
                 std::uint64_t version);
    // How many sets of samples this frame's picture averages: the same on both sides, which are
    // compared set by set, so that a change of either begins both anew.
    int nextSets(const Settings& settings, int count);
    // The n-th set of samples takes these; what the side keeps is emptied where its light is no
    // longer that of the settings.
    HistoryOptions historyOf(const Settings& settings, int n, const FrameCamera& camera,
                             Side& side) const;
    static GatherOptions gatherOptions(const Settings& settings);  // of both sides
    GatherOptions gatherOptionsOf(const Settings& settings, const Side& side,
                                  const Visibility* visibility, int set) const;
    // The irradiance of a reference method, which has no samples to average.
    void setLight(std::span<const glm::vec3> irradiance, Side& side);
    bool awaitsReferences() const;
    // Gathers the n-th set of samples into the side's mean.
    void gather(const Settings& settings, int n, Side& side);
    // The share of the samples that asked, once it is there.
    static void noteUndecided(const GatherInputs& in, Side& side);
    // What the n-th set of samples takes its light from, culled for that G-buffer; a reference's
    // side alone has nothing that was culled.
    SetLight lightOfSet(const Settings& settings, int n, const GBuffer& of, Side& side);

    // ---- still pictures of more than one set of views (frame_views.cpp)

    // The n-th set of samples has views of its own.
    bool hasOwnViews(const Settings& settings, int n) const;
    // Makes them, and each side's maps of them. False, where results come late, while some are
    // under way.
    bool makeSetViews(const Settings& settings, const FrameInput& input, int n);
    bool makeSetMaps(const Settings& settings, Side& side);
    void dropSetViews();

    // ---- pictures of more than pixels' centres (frame_pixels.cpp)

    // The n-th set of samples, n > 1, at a point of every pixel of its own, into the side's means.
    void gatherPoint(const Settings& settings, int n, Side& side);
    void drawPoint(const Settings& settings, int n);
    // The exposure that points are averaged for on a display: near the one in use.
    int pointsEv(const Settings& settings) const;

    // ---- what glossy and clear surfaces show (frame_reflections.cpp)

    // The surfaces that the rays of the n-th set meet, with their direct light.
    Reflections& traceReflections(Follow what, const Settings& settings, int n, const GBuffer& of,
                                  const SetLight& light);
    void reflect(Follow what, const Settings& settings, int n, const GBuffer& of, const Side& side,
                 const SetLight& light, gl::Texture& out);
    // Their light by that side's method, and what of it comes back: radiance.
    void reflect(const Settings& settings, int n, const GBuffer& of, const Side& side,
                 const SetLight& light, gl::Texture& out);
    // The n-th set of pixels' centres into the side's mean.
    void reflectCentres(const Settings& settings, int n, const SetLight& light, Side& side);

    // ---- the picture (frame_picture.cpp)

    // Whatever of it changed.
    void makePicture(const Settings& settings, const FrameInput& input);
    // A side's radiance, and of it what moves; composed: it changed. changed: it or its points did.
    void composeSide(const Settings& settings, std::size_t index, bool composed, bool changed);
    // What the traversal's pairs mean for the surfaces in sight, instead of light.
    void composeSharing(const Settings& settings, Side& side);
    void compose(const Settings& settings, DebugView view, Side& side);
    void composeLight(DebugView view, const Side& side, gl::Texture& out);
    TonemapPass::Input lightOf(const Side& side) const;  // of pixels' centres
    // Exposure is fitted to the whole picture, whatever view of it is asked for, and shared by both
    // sides: on the first frame, once more when a reference that it lacked is there, where the
    // input asks for it (adaptExposure) and for another tone map. One that is off by no more than
    // toleranceEv stays.
    void fitExposure(const Settings& settings, double toleranceEv);
    const gl::Texture& picture() const { return sideCount == 2 ? display : sides[0]->display; }
    bool mustCompose(const Settings& settings) const {
        return lightChanged || !shown || shown->light() != settings.light() ||
               shown->picture != settings.picture || shown->inspect != settings.inspect;
    }
    // The sides' radiance as the picture.
    void show(const Settings& settings);
    void showFlip(std::span<const float> errors);
    // Left part from side 0, right part from side 1.
    void joinSides(const Settings& settings);

    // ---- results that come late (frame_late.cpp): a frame takes what the one before asked for.
    // Views lag behind their lights by a frame, and a picture is shown once it is known that no
    // list or queue of its maps has overflowed.

    // Takes what has come back. False while something is under way that the next frame needs.
    bool settle();
    bool underWay() const;
    bool lags() const;
    // Keeps the picture that is shown while this frame's is unproved.
    void holdPicture();
    // Begins with the trees over views just traced that the sides' methods make for themselves.
    void placeOwnTrees(ViewHierarchyPass& pass, MapViews& chosen, int depth);
    // Begins with the views that the next frame takes, where it needs others.
    void traceNext(const Settings& settings, const FrameInput& input, const Emitters& wanted);

    // ---- what a frame says of itself (frame_statistics.cpp)

    // All but the sets of samples. start: of the frame, on the CPU.
    void tell(const Settings& settings, std::chrono::steady_clock::time_point start,
              FrameStatistics& statistics);

    // ---- what is where on the GPU (frame_memory.cpp)

    // Everything on the GPU.
    std::vector<MemoryUse> memory() const;
};

}  // namespace mv
