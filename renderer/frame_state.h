#pragma once
// The stages of a frame, over what FrameRenderer keeps. Used by the files frame_*.cpp only.

#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/frame_data.h"

namespace mv {

struct FrameRenderer::Impl {
    explicit Impl(gl::Results how) : results(how), profiler(how), views(how) {}

    const gl::Results results;
    gl::Profiler profiler;
    GBufferPass gbufferPass;
    DirectLightPass directPass;
    ComposePass composePass;
    AveragePixelsPass averagePixelsPass;
    BadPixelsPass badPixelsPass;
    TonemapPass tonemapPass;
    TemporalPass temporalPass;
    std::unique_ptr<DifferencePass> differencePass;  // made at first use
    SharingPass sharingPass;
    VplPass vplPass;
    ThinViewsPass thinViewsPass;
    GatherPass gatherPass;

    const Scene* scene = nullptr;
    const TriangleBvh* bvh = nullptr;
    std::shared_ptr<const EmissiveSurfaces> emissiveSurfaces;
    std::unique_ptr<SceneOnGpu> sceneOnGpu;  // for methods
    std::optional<ViewSet> loadedViews;
    std::uint64_t generation = 0;  // of scene and loaded views
    std::uint64_t poseNumber = 0;  // of the scene as it is on the GPU

    ViewStage views;
    LightState lights;
    SurfaceStage surfaces;
    CullStage culled;
    std::unique_ptr<PixelPoint> pixelPoint;  // null: pixels are sampled at their centres alone
    // The light view (final, direct, ...) for which points of pixels were last averaged.
    DebugView pointsView = DebugView::final;
    ReflectionStage reflections;
    SequenceState sequence;
    std::array<std::unique_ptr<Side>, 2> sides;
    int sideCount = 1;
    std::uint64_t references = 0;  // counts the references that were wanted
    ExposureState exposure;
    PictureState picture;
    LateState late;
    OverlayState overlay;

    // ---- the stages of a frame, each redone where its key changed (frame_stages.cpp, and
    // frame_gather.cpp from the culling on)

    // The lights that the settings ask for; particles replace the scene's own.
    Emitters emittersAsked(const Settings& settings, const FrameInput& input) const;
    // Makes views, surfaces, each side's maps, and the light gathered through them: all but the
    // picture. Returns how many sets of samples the light is the mean of; nullopt while results
    // that come late are under way.
    std::optional<int> makeLight(const Settings& settings, const FrameInput& input,
                                 const Emitters& asked);
    // Lets the next frame take nothing from earlier ones.
    void forget();
    // Brings moving geometry to the frame's time, here and on the GPU.
    void pose(const FrameInput& input);
    const GpuViewHierarchy& mapHierarchy(const Side& side) const {
        return side.visibility ? side.visibility->hierarchy() : views.frame.tree;
    }
    // What the frame's views are to be made from. While FrameInput::moving, views whose importance
    // hardly changes stay as they are.
    ViewsInput wantedViews(const Settings& settings, const FrameInput& input,
                           const Emitters& wanted);
    void makeViews(const Settings& settings, const FrameInput& input, const Emitters& wanted);
    // Traces views into `out` and begins with their trees.
    void traceViews(const Settings& settings, const ViewsInput& from, const FrameInput& input,
                    const Emitters& emitters, TracedViews& with, GpuViews& out);
    // The subset of the frame's views that a side made maps of; null: all, or none.
    const GpuMapViews* mapViewsOf(const Side& side) const {
        return views.frame.mapViews.subsetFor(side.visibility.get());
    }
    // Whether views without maps borrow those of others: only where rays correct what maps say.
    bool borrowsMaps(const Settings& settings, const MethodSettings& method) const;
    std::uint64_t requestedViews(const ViewSettings& settings) const;
    // Chooses those of the views just sorted that have maps, where a side borrows any, so that the
    // sizes of their hierarchy are there when treeOfMaps() builds it.
    void beginMapViews(const Settings& settings, const ViewsInput& from, TracedViews& with);
    void chooseMapViews(const ViewsInput& from, TracedViews& with);
    // A hierarchy, the pass that made it, and its version.
    struct MapTree {
        const GpuViewHierarchy& tree;
        ViewHierarchyPass& pass;
        std::uint64_t version;
    };
    // The hierarchy that a method makes maps of: over all views, or over the subset whose maps the
    // others borrow.
    MapTree treeOfMaps(const Settings& settings, const MethodSettings& method, TracedViews& of);
    void chooseViews(const ViewsInput& from, const Emitters& emitters, GpuViews& out);
    void makeGBuffer(const Settings& settings, const FrameCamera& camera, const Emitters& emitters);
    // Makes maps of the sky that lights the frame, while the settings ask for them.
    void makeSkyMaps(const Settings& settings);
    // Makes the side's visibility by its method in the settings.
    void makeVisibility(const Settings& settings, std::size_t index, const FrameInput& input);
    // Draws all surfaces, particles and the sky as a camera sees them.
    void drawGBuffer(const Settings& settings, const FrameCamera& camera, GBuffer& out);
    // Culls the frame's views for its receivers, for both sides.
    void cullGather(const Settings& settings);
    // Culls views for the G-buffer that is gathered next, unless these were culled last.
    void cullFor(const Settings& settings, const GBuffer& of, const GpuViewHierarchy& tree,
                 std::uint64_t version);
    // How many sets of samples this frame's picture averages: the same on both sides, which are
    // compared set by set, so that a change of either begins both anew.
    int nextSets(const Settings& settings, int count);
    // How the n-th set of samples uses the side's light history, which is emptied where its light
    // is not that of the settings.
    HistoryOptions historyOf(const Settings& settings, int n, const FrameCamera& camera,
                             Side& side) const;
    static GatherOptions gatherOptions(const Settings& settings);  // of both sides
    GatherOptions gatherOptionsOf(const Settings& settings, const Side& side,
                                  const Visibility* visibility, int set) const;
    // Takes the irradiance of a reference method, which has no samples to average.
    void setLight(std::span<const glm::vec3> irradiance, Side& side);
    bool awaitsReferences() const;
    // Gathers the n-th set of samples into the side's mean.
    void gather(const Settings& settings, int n, Side& side);
    // Reads what share of the samples asked GatherOptions::sample, once it is there.
    static void noteUndecided(const GatherInputs& in, Side& side);
    // What the n-th set of samples takes its light from, culled for the G-buffer `of`. For a
    // reference nothing is culled.
    SetLight lightOfSet(const Settings& settings, int n, const GBuffer& of, Side& side);

    // ---- still pictures of more than one set of views (frame_views.cpp)

    // Whether the n-th set of samples has views of its own.
    bool hasOwnViews(const Settings& settings, int n) const;
    // Makes the set's views and each side's maps of them. False, where results come late, while
    // some are under way.
    bool makeSetViews(const Settings& settings, const FrameInput& input, int n);
    bool makeSetMaps(const Settings& settings, Side& side);
    void dropSetViews();

    // ---- pictures of more than pixels' centres (frame_pixels.cpp)

    // Gathers the n-th set of samples, n > 1, at a point of its own in every pixel, into the side's
    // means.
    void gatherPoint(const Settings& settings, int n, Side& side);
    void drawPoint(const Settings& settings, int n);

    // ---- what glossy and clear surfaces show (frame_reflections.cpp)

    // Traces the rays of the n-th set; the surfaces that they meet, with their direct light.
    Reflections& traceReflections(Follow what, const Settings& settings, int n, const GBuffer& of,
                                  const SetLight& light);
    void reflect(Follow what, const Settings& settings, int n, const GBuffer& of, const Side& side,
                 const SetLight& light, gl::Texture& out);
    // Lights what both kinds of rays meet by the side's method; out: the radiance that comes back.
    void reflect(const Settings& settings, int n, const GBuffer& of, const Side& side,
                 const SetLight& light, gl::Texture& out);
    // Averages what the n-th set reflects at the pixels' centres into the side's mean.
    void reflectCentres(const Settings& settings, int n, const SetLight& light, Side& side);

    // ---- the picture (frame_picture.cpp)

    // Makes whatever of the picture has changed.
    void makePicture(const Settings& settings, const FrameInput& input);
    // Composes a side's radiance if `composed`, and smooths it while something moves. changed: the
    // radiance or the means over points are others than those shown.
    void composeSide(const Settings& settings, std::size_t index, bool composed, bool changed);
    // Shows what the traversal's pairs mean for the surfaces in sight, instead of light.
    void composeSharing(const Settings& settings, Side& side);
    void compose(const Settings& settings, DebugView view, Side& side);
    void composeLight(DebugView view, const Side& side, gl::Texture& out);
    ComposePass::Input lightOf(const Side& side) const;  // at the pixels' centres
    // Exposure is fitted to the whole picture, whatever view of it is asked for, and shared by both
    // sides: on the first frame, once more when a reference that it lacked is there, where the
    // input asks for it (adaptExposure) and for another tone map. One that is off by no more than
    // toleranceEv stays.
    void fitExposure(const Settings& settings, double toleranceEv);
    const gl::Texture& newestPicture() const {
        return sideCount == 2 ? picture.display : sides[0]->display;
    }
    // Tone maps the sides' radiance, or their difference, as the picture.
    void show(const Settings& settings);
    void showFlip(std::span<const float> errors);
    // Joins the left part of side 0 and the right part of side 1.
    void joinSides(const Settings& settings);

    // ---- results that come late (frame_late.cpp): a frame takes what the one before asked for.
    // Views lag behind their lights by a frame, and a picture is shown once it is known that no
    // list or queue of its maps has overflowed.

    // Takes what has come back. False while something is under way that the next frame needs.
    bool settle();
    bool underWay() const;
    bool mapsLag() const;
    // Keeps the last picture in view while this frame's is unproved.
    void holdPicture();
    // Begins with those trees over the views just traced that methods make for themselves.
    void placeOwnTrees(TracedViews& with, int depth);
    // Traces the views of the next frame, where it needs others.
    void traceNext(const Settings& settings, const FrameInput& input, const Emitters& wanted);

    // ---- what is read back (frame_readback.cpp)

    // The side whose gathered light the picture shows; null: it shows none of this side.
    Side* gatheredSide(int index);

    // ---- what a frame says of itself (frame_statistics.cpp)

    // Fills all but the sets of samples. start: when the frame began on the CPU.
    void tell(const Settings& settings, std::chrono::steady_clock::time_point start,
              FrameStatistics& statistics);

    // ---- what is where on the GPU (frame_memory.cpp)

    std::vector<MemoryUse> memory() const;
};

}  // namespace mv
