#pragma once
// What the instruments show, read back from the renderer and worked out on the CPU, but only while
// something shows it: overlays, legends, and the data of the panel that is open.

#include <cstdint>
#include <optional>
#include <vector>

#include "app/common/scene_assets.h"
#include "app/viewer/views_instrument.h"
#include "megaviews/inspect/overlay.h"
#include "renderer/frame_renderer.h"
#include "ui/model.h"

namespace mv {

class Instruments {
  public:
    void setScene(const SceneAssets& assets);  // outlives it or the next setScene

    // Reads the frame's views back where something open needs them.
    void readFrame(const FrameRenderer& renderer, const Settings& settings, ui::Model& model);
    // A sentence for each thing that settings ask to inspect and that scene or views do not have.
    std::vector<std::string> missing(const Settings& settings);
    // Draws what the settings ask for over the frame's picture.
    void drawOverlay(FrameRenderer& renderer, const Settings& settings,
                     FrameStatistics& statistics);
    // Fills what the panels show; settings are those the picture was made with, `picture` numbers
    // the pictures.
    void fill(const FrameRenderer& renderer, const Settings& settings,
              const FrameStatistics& statistics, std::uint64_t picture, ui::Model& model);

    // Picture pixels, counted from the top left.
    struct Pixel {
        int x = 0, y = 0;
        bool operator==(const Pixel&) const = default;
    };
    void setHover(std::optional<Pixel> pixel) { hover_ = pixel; }
    void pickPixel(Pixel pixel) { picked_ = pixel; }
    // The slot of the view that a pixel points at.
    std::optional<std::int64_t> viewAt(const FrameRenderer& renderer, const FrameCamera& camera,
                                       const Settings& settings, Pixel pixel);
    // The pair of the drawn step under the pixel; if that is the picked one, the next one there.
    std::optional<NodePair> pairAt(const FrameRenderer& renderer, const FrameCamera& camera,
                                   const Settings& settings, Pixel pixel);
    // The leaf of an octree, or its ancestor on the level that is drawn: in the scene octree, at
    // the surface under the pixel; in the view octree, of a view.
    std::optional<std::int64_t> sceneNodeAt(const FrameCamera& camera, const Settings& settings,
                                            Pixel pixel);
    std::optional<std::int64_t> viewNodeOf(const Settings& settings, std::int64_t slot);

  private:
    void readViews(const FrameRenderer& renderer);
    void fillLegends(const Settings& settings, const FrameStatistics& statistics, ui::Model& model);
    void fillSteps(const Settings& settings, ui::StepsData& data);
    void fillPixel(const FrameRenderer& renderer, const Settings& settings, std::uint64_t picture,
                   ui::PixelData& data);
    ui::PixelValues valuesOf(const FrameRenderer& renderer, const Settings& settings,
                             Pixel pixel) const;
    static int sideAt(const Settings& settings, Pixel pixel);

    const SceneAssets* assets_ = nullptr;
    Inspector inspector_;
    std::optional<std::uint64_t> viewsVersion_;  // of the views that the inspector has
    ViewsInstrument views_{inspector_};

    std::optional<Pixel> hover_, picked_;
    struct PixelKey {
        std::uint64_t picture = 0;
        std::optional<Pixel> hover, picked;
    };
    PixelKey filledPixel_;
    std::vector<Line> pixelLines_;
};

}  // namespace mv
