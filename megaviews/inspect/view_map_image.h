#pragma once
// Pictures of one view's map: both faces side by side, coloured by depth, by the scene level at
// which a texel's occluder was rendered, or by how many views share the pair that won the texel.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/inspect/lines.h"
#include "megaviews/inspect/view_pairs.h"
#include "megaviews/settings/settings.h"

namespace mv {

struct ViewMapImage {
    int width = 0, height = 0;          // 2R x R: face +x left, face -x right
    std::vector<std::uint32_t> pixels;  // RGBA8 sRGB, top row first (v upwards); see emptyColour
    // What both ends of the colour scale mean; the scale of `views` is logarithmic.
    double low = 0, high = 0;
    std::uint64_t filled = 0, reachable = 0;  // texels
};

// Texels that no direction reaches (the corners outside the discs) are transparent, empty ones
// dark.
inline constexpr std::uint32_t kEmptyTexelColour = rgba(40, 40, 40);

// Ends of the colour scale; without one a picture takes those of its own texels.
struct MapScale {
    double low = 0, high = 1;
};
ViewMapImage viewMapImage(const InspectedMap& map, std::span<const NodePair> pairs,
                          std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                          int mapRes, MapQuantity quantity,
                          std::optional<MapScale> scale = std::nullopt);
// The value of a texel as the picture shows it; negative where it is empty. Depth in root-cube
// units, level from 0, number of views.
double mapValue(const InspectedMap& map, std::uint32_t texel, std::span<const NodePair> pairs,
                std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                MapQuantity quantity);
// The texel under a pixel of the picture, counted from its top left corner.
std::uint32_t texelOfPixel(int x, int y, int mapRes);

// What a map says in one texel.
struct MapTexel {
    bool back = false;             // of the face that looks along -x
    glm::vec3 direction{1, 0, 0};  // of its centre, unit
    std::optional<float> depth;    // root-cube units; nullopt: empty
    std::optional<NodePair> pair;  // that won it; not of maps without pairs
};
// nullopt where no direction falls into the texel. pairs: ViewPairs::pairs, or none.
std::optional<MapTexel> mapTexel(const InspectedMap& map, std::uint32_t texel,
                                 std::span<const NodePair> pairs, int mapRes);

}  // namespace mv
