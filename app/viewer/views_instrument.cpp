#include "app/viewer/views_instrument.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "app/viewer/legends.h"
#include "megaviews/inspect/pair_explanation.h"

namespace mv {
namespace {

constexpr std::size_t kMaxRows = 20000;  // of the table of views

ui::ViewRow rowOf(const View& view, std::uint32_t leaf) {
    ui::ViewRow row;
    row.slot = view.slot;
    row.bounce = static_cast<int>(view.bounce);
    row.leaf = leaf;
    row.position = {view.positionX, view.positionY, view.positionZ};
    row.normal = {view.normalX, view.normalY, view.normalZ};
    row.flux = {view.fluxR, view.fluxG, view.fluxB};
    return row;
}

// Do the maps of the left side come from pairs? Without maps they are asked for all the same.
bool mapsHavePairs(const Settings& settings) {
    const Method method = settings.side[0].method;
    return !makesMaps(method) || testsPairs(method);
}

std::uint64_t pairsRenderedAt(const ViewPairs& pairs, std::size_t level) {
    if (level >= pairs.chain.size()) return 0;
    const auto own = pairs.pairsOf(level);
    return static_cast<std::uint64_t>(std::count_if(
        own.begin(), own.end(), [](const NodePair& pair) { return isRendered(pair); }));
}

// Counts texels of the fused map.
std::uint64_t texelsFrom(const Inspector::InspectedView& view, std::size_t level) {
    std::uint64_t count = 0;
    if (level >= view.pairs.chain.size()) return count;
    const std::size_t begin = view.pairs.chainBegin[level];
    const std::size_t end = view.pairs.chainBegin[level + 1];
    for (const std::uint32_t pair : view.maps.fused.pair) {
        count += pair != kNone && pair >= begin && pair < end;
    }
    return count;
}

}  // namespace

void ViewsInstrument::setScene(const SceneAssets& assets) {
    assets_ = &assets;
    forget();
}

void ViewsInstrument::clear() {
    forget();
    mapsA_ = {};
    mapsB_ = {};
}

std::optional<ui::PickedView> ViewsInstrument::pickedView(const FrameRenderer& renderer,
                                                          const Settings& settings,
                                                          std::optional<std::int64_t> slot,
                                                          ShownMaps& shown) {
    shown = {};
    const Inspector::InspectedView* view = slot ? inspector_.inspectView(settings, *slot) : nullptr;
    if (!view) return std::nullopt;
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    const std::uint32_t sorted = view->pairs.sortedView;
    const std::uint32_t leaf = tree.leafOfView[sorted];
    ui::PickedView picked;
    picked.view = rowOf(tree.sortedViews[sorted], leaf);
    picked.viewsInLeaf = tree.nodes[leaf].viewCount;
    const auto add = [&](std::string name, bool fused, InspectedMap map) {
        picked.maps.push_back({std::move(name), fused, {}});
        shown.maps.push_back(std::move(map));
    };
    shown.mapRes = settings.side[0].maps.resolution;
    if (!mapsHavePairs(settings)) {
        const std::uint32_t slots[] = {static_cast<std::uint32_t>(*slot)};
        ReadMaps own = renderer.readMapsOf(slots);
        if (own.maps.mapRes != shown.mapRes) return picked;  // the maps could not be made
        add("the view's own", true, {std::move(own.maps.texels), {}});
        return picked;
    }
    add("fused", true, view->maps.fused);
    for (std::size_t i = 0; i < view->maps.own.size(); ++i) {
        const ViewNode& node = tree.nodes[view->pairs.chain[i]];
        add(fmt::format("level {}, {} views", node.level + 1, node.viewCount), false,
            view->maps.own[i]);
    }
    return picked;
}

ui::Legend ViewsInstrument::colourMaps(const Settings& settings, ui::ViewsData& data) {
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    const bool hasPairs = mapsHavePairs(settings);
    const MapQuantity quantity = hasPairs ? settings.inspect.mapColours : MapQuantity::depth;
    MapScale scale;
    ui::Legend legend;
    legend.scale = scaleOf(ColourMap::viridis);
    if (quantity == MapQuantity::level) {
        scale = {0, assets_->hierarchy.levels - 1.0};
        legend.title = "Scene level of the pair in a texel";
        legend.low = 1;
        legend.high = assets_->hierarchy.levels;
    } else if (quantity == MapQuantity::depth) {
        float farthest = 0;
        for (const ShownMaps* shown : {&mapsA_, &mapsB_}) {
            for (const InspectedMap& map : shown->maps) {
                for (const std::uint32_t depth : map.depth) {
                    if (depth != kNone) farthest = std::max(farthest, uintBitsToFloat(depth));
                }
            }
        }
        if (farthest > 0) scale.high = static_cast<double>(farthest);
        legend.title = "Depth";
        legend.unit = "world units";
        legend.high = scale.high * assets_->scene.root.edge;
    } else {
        scale = {1, std::max<double>(2, static_cast<double>(tree.sortedViews.size()))};
        legend.title = "Views that share the pair in a texel";
        legend.low = scale.low;
        legend.high = scale.high;
        legend.logarithmic = true;
    }

    const auto nodes = inspector_.sceneNodes(settings.side[0].rules);
    const auto colour = [&](std::optional<ui::PickedView>& picked, ShownMaps& shown) {
        for (std::size_t i = 0; i < shown.maps.size(); ++i) {
            const auto pairs =
                hasPairs ? std::span<const NodePair>(
                               inspector_.inspectView(settings, picked->view.slot)->pairs.pairs)
                         : std::span<const NodePair>();
            const ViewMapImage image =
                viewMapImage(shown.maps[i], pairs, nodes, tree, shown.mapRes, quantity, scale);
            gl::Texture texture("map of a picked view", GL_TEXTURE_2D, GL_RGBA8, image.width,
                                image.height);
            std::vector<std::uint8_t> bytes(image.pixels.size() * 4);
            std::memcpy(bytes.data(), image.pixels.data(), bytes.size());
            texture.writeBytes(4, bytes);
            texture.parameter(GL_TEXTURE_MIN_FILTER, GL_LINEAR);
            picked->maps[i].picture = {
                reinterpret_cast<void*>(static_cast<std::uintptr_t>(texture.id())), image.width,
                image.height, false};
            shown.textures.push_back(std::move(texture));
        }
    };
    colour(data.a, mapsA_);
    colour(data.b, mapsB_);
    return legend;
}

std::vector<ui::SharedLevel> ViewsInstrument::sharedLevels(const Settings& settings) {
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    // Copies: asking for one view may move the other.
    const Inspector::InspectedView a = *inspector_.inspectView(settings, *settings.inspect.pickA);
    const Inspector::InspectedView b = *inspector_.inspectView(settings, *settings.inspect.pickB);
    const auto &chainA = a.pairs.chain, &chainB = b.pairs.chain;
    std::vector<ui::SharedLevel> levels;
    for (std::size_t level = 0; level < std::max(chainA.size(), chainB.size()); ++level) {
        const bool inA = level < chainA.size(), inB = level < chainB.size();
        ui::SharedLevel row;
        row.level = static_cast<int>(level) + 1;
        row.common = inA && inB && chainA[level] == chainB[level];
        if (inA) row.viewsOfNode = tree.nodes[chainA[level]].viewCount;
        row.pairsA = pairsRenderedAt(a.pairs, level);
        row.pairsB = pairsRenderedAt(b.pairs, level);
        row.texelsA = texelsFrom(a, level);
        row.texelsB = texelsFrom(b, level);
        levels.push_back(row);
    }
    return levels;
}

void ViewsInstrument::fill(const FrameRenderer& renderer, const Settings& settings,
                           std::uint64_t viewsVersion, ui::ViewsData& data) {
    Key key{viewsVersion, settings};
    if (filled_ != key) {
        const auto hovered = data.hovered;
        data = {};
        data.hovered = hovered;
        const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
        data.total = tree.sortedViews.size();
        for (std::size_t i = 0; i < tree.sortedViews.size(); ++i) {
            const View& view = tree.sortedViews[i];
            const std::size_t bounce = view.bounce > 0 ? view.bounce - 1 : 0;
            if (data.perBounce.size() <= bounce) data.perBounce.resize(bounce + 1);
            ++data.perBounce[bounce];
            if (i < kMaxRows) data.rows.push_back(rowOf(view, tree.leafOfView[i]));
        }
        for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
            if (tree.mapOfNode[n] == kNone) continue;
            const std::size_t count = tree.nodes[n].viewCount;
            if (data.leavesByViews.size() <= count) data.leavesByViews.resize(count + 1);
            ++data.leavesByViews[count];
        }
        data.a = pickedView(renderer, settings, settings.inspect.pickA, mapsA_);
        data.b = pickedView(renderer, settings, settings.inspect.pickB, mapsB_);
        data.mapLegend = colourMaps(settings, data);
        if (data.a && data.b && mapsHavePairs(settings)) data.shared = sharedLevels(settings);
        filled_ = std::move(key);
    }
    data.texel = data.hovered ? texelAt(settings, data, *data.hovered) : std::nullopt;
}

// What a map says in a texel.
std::optional<ui::MapTexel> ViewsInstrument::texelAt(const Settings& settings,
                                                     const ui::ViewsData& data,
                                                     const ui::MapPlace& place) {
    const std::optional<ui::PickedView>& picked = place.ofA ? data.a : data.b;
    const ShownMaps& shown = place.ofA ? mapsA_ : mapsB_;
    const auto map = static_cast<std::size_t>(place.map);
    if (!picked || map >= shown.maps.size() || place.x >= 2 * shown.mapRes ||
        place.y >= shown.mapRes) {
        return std::nullopt;
    }
    std::span<const NodePair> pairs;
    if (mapsHavePairs(settings)) {
        pairs = inspector_.inspectView(settings, picked->view.slot)->pairs.pairs;
    }
    const auto texel = mapTexel(shown.maps[map], texelOfPixel(place.x, place.y, shown.mapRes),
                                pairs, shown.mapRes);
    if (!texel) return std::nullopt;
    std::string content = "nothing is seen there";
    if (texel->depth) {
        content = fmt::format("{:.4g} world units away",
                              static_cast<double>(*texel->depth) * assets_->scene.root.edge);
    }
    if (texel->pair) {
        content += fmt::format(
            "\nscene {}\nrendered in view {}",
            sceneNodeText(inspector_.sceneNodes(settings.side[0].rules), texel->pair->scene),
            viewNodeText(inspector_.viewHierarchy(settings).nodes, texel->pair->view));
    }
    const glm::vec3 d = texel->direction;
    return ui::MapTexel{
        place, texel->back ? "Back (-x)" : "Front (+x)", {d.x, d.y, d.z}, std::move(content)};
}

}  // namespace mv
