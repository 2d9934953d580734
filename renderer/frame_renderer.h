#pragma once
// One frame, from views to picture: runs the passes in the order of docs/architecture.md and keeps
// what a frame may reuse from the one before. Two methods side by side share views, camera, seed,
// culling and gather samples and differ in nothing but their maps (Settings::side).

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/gather/receiver.h"
#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/inspect/lines.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/settings/settings.h"
#include "megaviews/settings/statistics.h"
#include "megaviews/views/frame_camera.h"
#include "megaviews/views/view_set.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/read_back.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/gather_answers.h"

namespace mv {

struct FrameInput : FrameMoment {
    // false: take nothing from earlier frames but the light history (GatherSettings::history), so
    // that times are a whole frame's and samples accumulate from the first set on.
    bool reuse = true;
    // Something moves, and the next frame will be another. Views stay, and with them their maps,
    // while the camera's motion has changed what is important by less than a tenth; with
    // GatherSettings::history each frame has samples of its own. Pictures then depend on the
    // motion. false: the picture converges to this frame's own samples, and the light history is
    // dropped once as many sets have accumulated as it remembers.
    bool moving = false;
    // false: GatherSettings::history counts as 0.
    bool usesHistory = true;
    // For drafts: pixels that remember enough of light that stays gather in turns instead of in
    // every frame.
    bool gathersInTurns = false;
    bool refineLaggingMaps = false;  // where FrameRenderer::mapsLag(), though nothing has changed
    bool countLevels = false;        // fill MethodStatistics::pairsPerLevel and occupancy
    // Fit the automatic exposure anew if it is more than 2 EV off. Waits for the GPU.
    bool adaptExposure = false;
    // Brings a scene that moves to timeS (poseScene and both refits); empty: it stands. Called as
    // the stage "pose", whenever the frame begins.
    std::function<void()> pose;
    // Follows the frame on a renderer that waits for it. Where it throws the picture stays as it
    // was, and the next frame makes what this one had not finished.
    gl::Watch watch;
};

// What a pixel shows, whatever debug view is on. Colours are linear, radiance in W/(m^2 sr).
struct PixelSide {
    glm::vec3 radiance{0};    // direct + indirect: of the final picture, before exposure
    glm::vec3 direct{0};      // emission included
    glm::vec3 indirect{0};    // albedo / pi * irradiance, filtered and accumulated as shown
    glm::vec3 unfiltered{0};  // irradiance before the filter, W/m^2
};
struct PixelValues {
    bool surface = false;   // false: background, and nothing below but radiance and display
    glm::vec3 position{0};  // root-cube units
    glm::vec3 normal{0}, albedo{0};
    float depth = 0;                   // distance along the camera's forward, root-cube units
    std::array<PixelSide, 2> sides{};  // [1]: the compared method, if there is one
    int sideCount = 1;
    std::array<std::uint8_t, 3> display{};  // as the picture shows it, without overlay
};

class FrameRenderer {
  public:
    // Results::late is for a window: no frame but the first of a scene waits for the GPU. Counts,
    // times and the room of lists are then those of the frame before, views follow their lights a
    // frame later, and a picture is shown once it is proved that it holds every pair.
    explicit FrameRenderer(gl::Results results = gl::Results::waited);
    ~FrameRenderer();
    FrameRenderer(const FrameRenderer&) = delete;
    FrameRenderer& operator=(const FrameRenderer&) = delete;

    // Uploads the scene. All three must outlive the renderer or the next setScene().
    void setScene(const Scene& scene, const TriangleBvh& bvh, const SceneHierarchy& hierarchy);
    // Views from a file instead of traced or animated ones; nullopt: as the settings say.
    void setViews(std::optional<ViewSet> views);
    // Takes them back, so that none are set; for a setScene() that may fail.
    std::optional<ViewSet> takeViews();

    // The light of a reference method (isReference) is made elsewhere, from what readViews() and
    // readReceivers() give. A number that names the light which the last frame should show on that
    // side and does not show whole; 0 where nothing is missing.
    std::uint64_t wantedReference(int side) const;
    // That light for the next frame: irradiance in W/m^2 at each receiver, 0 where it is not done.
    // Nothing happens where `wanted` is no longer what is wanted.
    void setReference(int side, std::uint64_t wanted, std::span<const glm::vec3> irradiance,
                      bool complete);
    // Whether a side wants one.
    bool awaitsReferences() const;

    // A number that names the pictures of both sides, radianceOf() at exposureEv(), where
    // settings.display.difference = flip waits for the error between them, which is measured
    // elsewhere once both have all their samples. Until it is there the split is shown. 0: no error
    // is wanted.
    std::uint64_t wantedFlip() const;
    // An error in [0,1] for each pixel, bottom row first, NaN for one that was not measured.
    void setFlip(std::uint64_t wanted, std::span<const float> errors);

    // Renders at settings.resolution. While nothing that the gathered light depends on changes,
    // each call adds one set of samples to the picture's mean until Settings::setsWanted() are in
    // it (statistics.accumulatedFrames), then does nothing. Exposure, tone map, split, difference
    // and view change the picture without gathering again. Throws Error(ExitCode::impossible) if
    // maps do not fit the budget; the previous picture stays readable. Where results come late:
    // false, and nothing is done, while those of the frame before are under way.
    bool render(const Settings& settings, const FrameInput& input, FrameStatistics& statistics);

    // Another frame of the same settings would show more: results are still to come.
    bool underWay() const;
    // Another frame of the same settings, with FrameInput::refineLaggingMaps, would have better
    // maps.
    bool mapsLag() const;

    const gl::Texture& picture() const;  // display() without what drawOverlay() drew
    const gl::Texture& display() const;  // RGBA8, sRGB encoded, alpha 1, bottom row first
    // RGBA32F, linear, not exposed; with display.difference right minus left.
    const gl::Texture& radiance() const;
    const gl::Texture& radianceOf(int side) const;  // of the side's whole picture
    double exposureEv() const;                      // in use: given or fitted
    void forgetExposure();                          // the next frame fits it again

    // Draws lines over the last frame as its camera saw it: display() is then the picture with
    // them, until render makes another or this is called again; no lines take them away. `version`
    // names the lines: where neither it nor the picture changed since the last call, nothing is
    // done; 0 = always draw. The time goes to the shared stage "overlay".
    void drawOverlay(std::span<const Line> lines, std::uint64_t version,
                     FrameStatistics& statistics);

    // Rises whenever the views of a frame are others than those of the frame before.
    std::uint64_t viewsVersion() const;
    // Rises whenever readMapViews(side) would give other views.
    std::uint64_t mapViewsVersion(int side = 0) const;
    // Rises whenever a side's maps are others; 0 where there is no such side.
    std::uint64_t mapsVersion(int side) const;
    // Compiles changed shaders again (gl::reloadPrograms) and forgets what the old ones made.
    // Returns what went wrong; programs that fail go on as they were.
    std::vector<std::string> reloadShaders();

    // What the last frame had; these synchronise.
    ViewSet readViews() const;
    // The views that a side makes maps of; the others, which share these maps, are dead.
    ViewSet readMapViews(int side = 0) const;
    // The surfaces in sight, bottom row first; a zero normal where there is none.
    std::vector<Receiver> readReceivers() const;
    // Side 1: the compared method; nothing without maps.
    ReadMaps readMaps(int side = 0) const;
    // The maps of some slots of readMapViews() only, numbered anew.
    ReadMaps readMapsOf(std::span<const std::uint32_t> slots, int side = 0) const;

    // One pixel of the last frame, (0, 0) the lower left; synchronise. A pixel outside the picture
    // has no surface and no samples. readSamples: the views it gathered in the last set of samples,
    // see GatherPass::readSamples; without accumulation their irradiance sums up to
    // PixelSide::unfiltered.
    PixelValues readPixel(int x, int y) const;
    std::vector<GatheredSample> readSamples(int x, int y, int side = 0) const;

    // What culling keeps of a side's views and the clamp of its light, see GatherPass::readShares;
    // nothing of a reference.
    std::optional<GatherShares> readGatherShares(int side = 0) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// A posed camera of the scene in root-cube units.
FrameCamera frameCamera(const PosedCamera& camera, const RootCube& root);

}  // namespace mv
