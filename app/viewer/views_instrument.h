#pragma once
// What the views panel shows, read back and worked out on the CPU: how many views live, and of the
// picked ones their maps, what they share, and the texel under the pointer.

#include <cstdint>
#include <optional>
#include <vector>

#include "app/common/scene_assets.h"
#include "megaviews/inspect/overlay.h"
#include "renderer/frame_renderer.h"
#include "ui/model.h"

namespace mv {

class ViewsInstrument {
  public:
    // The inspector, which must outlive it, has the scene and the views.
    explicit ViewsInstrument(Inspector& inspector) : inspector_(inspector) {}

    void setScene(const SceneAssets& assets);  // outlives it or the next setScene
    // Fills what the open panel shows. settings: the picture's; viewsVersion: of the views.
    void fill(const FrameRenderer& renderer, const Settings& settings, std::uint64_t viewsVersion,
              ui::ViewsData& data);
    // The next fill() makes everything anew.
    void forget() { filled_.reset(); }
    void clear();  // and frees the maps

  private:
    // Maps of a picked view, as ui::PickedView lists them.
    struct ShownMaps {
        int mapRes = 0;
        std::vector<InspectedMap> maps;
        std::vector<gl::Texture> textures;
    };
    // What ViewsData was made from.
    struct Key {
        std::uint64_t viewsVersion = 0;
        Settings settings;
        bool operator==(const Key&) const = default;
    };

    std::optional<ui::PickedView> pickedView(const FrameRenderer& renderer,
                                             const Settings& settings,
                                             std::optional<std::int64_t> slot, ShownMaps& shown);
    // Colours the shown maps by the legend that it returns.
    ui::Legend colourMaps(const Settings& settings, ui::ViewsData& data);
    std::vector<ui::SharedLevel> sharedLevels(const Settings& settings);
    std::optional<ui::MapTexel> texelAt(const Settings& settings, const ui::ViewsData& data,
                                        const ui::MapPlace& place);

    Inspector& inspector_;
    const SceneAssets* assets_ = nullptr;
    std::optional<Key> filled_;
    ShownMaps mapsA_, mapsB_;
};

}  // namespace mv
