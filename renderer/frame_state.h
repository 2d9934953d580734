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
    std::unique_ptr<PixelPoint> pixelPoint;   // where pixels are averaged
    DebugView pointsView = DebugView::final;  // the last that points of pixels were averaged for
    ReflectionStage reflections;
    SequenceState sequence;
    std::array<std::unique_ptr<Side>, 2> sides;
    int sideCount = 1;
    std::uint64_t references = 0;  // how many were wanted
    ExposureState exposure;
    PictureState picture;
    LateState late;
    OverlayState overlay;

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
        return side.visibility ? side.visibility->hierarchy() : views.frame.tree;
    }
    // What the frame's views are to be made from. Views that hardly change in importance while a
    // camera moves stay as they are if the input says so.
    ViewsInput wantedViews(const Settings& settings, const FrameInput& input,
                           const Emitters& wanted);
    void makeViews(const Settings& settings, const FrameInput& input, const Emitters& wanted);
    // Traces views into `out` and begins with their trees.
    void traceViews(const Settings& settings, const ViewsInput& from, const FrameInput& input,
                    const Emitters& emitters, TracedViews& with, GpuViews& out);
    // Those of the frame's views that a side made maps of; null: all, or none.
    const GpuMapViews* shared(const Side& side) const {
        return views.frame.mapViews.sharedBy(side.visibility.get());
    }
    // Whether some of the views have maps for all: only where rays correct what maps say.
    bool sharesMaps(const Settings& settings, const MethodSettings& method) const;
    std::uint64_t requestedViews(const ViewSettings& settings) const;
    // Chooses those of the views just sorted that have maps, where a side shares any, so that the
    // sizes of their hierarchy are there when treeOfMaps() builds it.
    void beginMapViews(const Settings& settings, const ViewsInput& from, TracedViews& with);
    void chooseMapViews(const ViewsInput& from, TracedViews& with);
    // A hierarchy, the pass that made it, and its version.
    struct MapTree {
        const GpuViewHierarchy& tree;
        ViewHierarchyPass& pass;
        std::uint64_t version;
    };
    // That of the views which a method makes maps of: of all, or of some that share theirs.
    MapTree treeOfMaps(const Settings& settings, const MethodSettings& method, TracedViews& of);
    void chooseViews(const ViewsInput& from, const Emitters& emitters, GpuViews& out);
    void makeGBuffer(const Settings& settings, const FrameCamera& camera, const Emitters& emitters);
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
    const gl::Texture& newestPicture() const {
        return sideCount == 2 ? picture.display : sides[0]->display;
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
    bool mapsLag() const;
    // Keeps the picture that is shown while this frame's is unproved.
    void holdPicture();
    // Begins with the trees over views just traced that the sides' methods make for themselves.
    void placeOwnTrees(TracedViews& with, int depth);
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
