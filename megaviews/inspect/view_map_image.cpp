#include "megaviews/inspect/view_map_image.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

std::uint32_t pixelOf(vec3 colour) {
    const auto byte = [](float x) { return static_cast<std::uint32_t>(std::lround(255 * x)); };
    return rgba(byte(colour.x), byte(colour.y), byte(colour.z));
}

}  // namespace

double mapValue(const InspectedMap& map, std::uint32_t texel, std::span<const NodePair> pairs,
                std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                MapQuantity quantity) {
    if (map.depth[texel] == kNone) return -1;
    if (quantity == MapQuantity::depth) {
        return static_cast<double>(uintBitsToFloat(map.depth[texel]));
    }
    const NodePair& pair = pairs[map.pair[texel]];
    if (quantity == MapQuantity::level) return sceneNodes[pair.scene].level;
    return views.nodes[pair.view].viewCount;
}

std::uint32_t texelOfPixel(int x, int y, int mapRes) {
    const int face = x >= mapRes ? 1 : 0;
    const int row = mapRes - 1 - y;
    return texelAt(static_cast<uint>(face), static_cast<uint>(x - face * mapRes),
                   static_cast<uint>(row), static_cast<uint>(mapRes));
}

std::optional<MapTexel> mapTexel(const InspectedMap& map, std::uint32_t texel,
                                 std::span<const NodePair> pairs, int mapRes) {
    const uint res = static_cast<uint>(mapRes);
    if (!texelReachable(texel, res)) return std::nullopt;
    MapTexel out;
    out.back = faceOfTexel(texel, res) != 0;
    out.direction = texelDirection(texel, res);
    if (map.depth[texel] == kNone) return out;
    out.depth = uintBitsToFloat(map.depth[texel]);
    if (!pairs.empty()) out.pair = pairs[map.pair[texel]];
    return out;
}

ViewMapImage viewMapImage(const InspectedMap& map, std::span<const NodePair> pairs,
                          std::span<const SceneNode> sceneNodes, const ViewHierarchy& views,
                          int mapRes, MapQuantity quantity, std::optional<MapScale> scale) {
    const uint res = static_cast<uint>(mapRes);
    ViewMapImage out;
    out.width = 2 * mapRes;
    out.height = mapRes;
    out.pixels.assign(map.depth.size(), 0);

    std::vector<double> values(map.depth.size(), -1);
    for (uint texel = 0; texel < map.depth.size(); ++texel) {
        if (!texelReachable(texel, res)) continue;
        ++out.reachable;
        values[texel] = mapValue(map, texel, pairs, sceneNodes, views, quantity);
        if (values[texel] < 0) continue;
        out.low = out.filled ? std::min(out.low, values[texel]) : values[texel];
        out.high = out.filled ? std::max(out.high, values[texel]) : values[texel];
        ++out.filled;
    }

    if (scale) {
        out.low = scale->low;
        out.high = scale->high;
    }
    const bool logarithmic = quantity == MapQuantity::views;  // at least one
    const auto scaled = [&](double value) { return logarithmic ? std::log2(value) : value; };
    const double span = scaled(out.high) - scaled(out.low);
    for (int y = 0; y < out.height; ++y) {
        for (int x = 0; x < out.width; ++x) {
            const std::uint32_t texel = texelOfPixel(x, y, mapRes);
            if (!texelReachable(texel, res)) continue;
            std::uint32_t pixel = kEmptyTexelColour;
            if (values[texel] >= 0) {
                const double t = span > 0 ? (scaled(values[texel]) - scaled(out.low)) / span : 0.0;
                pixel = pixelOf(viridis(static_cast<float>(t)));
            }
            out.pixels[static_cast<std::size_t>(y * out.width + x)] = pixel;
        }
    }
    return out;
}

}  // namespace mv
