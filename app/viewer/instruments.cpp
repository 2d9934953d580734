#include "app/viewer/instruments.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "megaviews/inspect/pair_explanation.h"
#include "megaviews/settings/debug_legends.h"
#include "megaviews/views/pick_view.h"
#include "shaders/shared/colour_map.glsl"
#include "shaders/shared/pair_path.glsl"

namespace mv {
namespace {

constexpr std::size_t kMaxRows = 20000;  // of the table of views
constexpr std::size_t kMaxPixelLines = 1024;
constexpr std::uint32_t kVisibleColour = kGreen, kOccludedColour = kVermilion;
constexpr int kScaleColours = 64;  // of a legend's bar

ui::Float3 float3(float x, float y, float z) { return {x, y, z}; }
ui::Float3 float3(glm::vec3 v) { return {v.x, v.y, v.z}; }

ui::Float3 displayColour(std::uint32_t rgba8) {
    const auto channel = [&](int shift) {
        return static_cast<float>(rgba8 >> shift & 255u) / 255.0f;
    };
    return {channel(0), channel(8), channel(16)};
}

std::vector<ui::Float3> scaleOf(ColourMap colours) {
    std::vector<ui::Float3> scale;
    for (int i = 0; i < kScaleColours; ++i) {
        const float t = static_cast<float>(i) / (kScaleColours - 1);
        scale.push_back(colours == ColourMap::grey ? float3(t, t, t) : float3(viridis(t)));
    }
    return scale;
}

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

PickRay rayAt(const FrameCamera& camera, const Settings& settings, Instruments::Pixel pixel) {
    constexpr float kPickPixels = 24;  // a hand does not point finer
    return rayThrough(
        camera, settings.picture.width, settings.picture.height, static_cast<float>(pixel.x) + 0.5f,
        static_cast<float>(settings.picture.height - 1 - pixel.y) + 0.5f, kPickPixels);
}

// Do the maps of the left side come from pairs? Without maps they are asked for all the same.
bool mapsHavePairs(const Settings& settings) {
    const Method method = settings.side[0].method;
    return !makesMaps(method) || testsPairs(method);
}

}  // namespace

void Instruments::setScene(const SceneAssets& assets) {
    assets_ = &assets;
    inspector_.setScene(assets.hierarchy);
    inspector_.clearViews();
    haveViews_ = false;
    filledViews_.reset();
    hover_.reset();
    picked_.reset();
}

void Instruments::readViews(const FrameRenderer& renderer) {
    if (haveViews_ && viewsVersion_ == renderer.viewsVersion()) return;
    inspector_.setViews(renderer.readViews().views);
    viewsVersion_ = renderer.viewsVersion();
    haveViews_ = true;
}

void Instruments::readFrame(const FrameRenderer& renderer, const Settings& settings,
                            const ui::Model& model) {
    const bool panel = model.instrument == ui::Instrument::views ||
                       model.instrument == ui::Instrument::steps ||
                       model.picking != ui::Picking::none;
    if (panel || overlayNeedsViews(settings)) {
        readViews(renderer);
    } else if (haveViews_) {
        inspector_.clearViews();
        filledViews_.reset();
        mapsA_ = {};
        mapsB_ = {};
        haveViews_ = false;
    }
}

void Instruments::drawOverlay(FrameRenderer& renderer, const Settings& settings,
                              FrameStatistics& statistics) {
    if (!pixelLines_.empty()) {
        std::vector<Line> lines = pixelLines_;
        const std::vector<Line>& others = inspector_.overlay(settings).lines;
        lines.insert(lines.end(), others.begin(), others.end());
        renderer.drawOverlay(lines, 0, statistics);
    } else {
        const Overlay& overlay = inspector_.overlay(settings);
        renderer.drawOverlay(overlay.lines, overlay.version, statistics);
    }
}

void Instruments::fill(const FrameRenderer& renderer, const Settings& settings,
                       const FrameStatistics& statistics, std::uint64_t picture, ui::Model& model) {
    fillLegends(settings, statistics, model);
    if (model.instrument == ui::Instrument::views) {
        fillViews(renderer, settings, model.views);
        fillMapTexel(settings, model.views);
    } else {
        filledViews_.reset();
    }
    if (model.instrument == ui::Instrument::steps) fillSteps(settings, model.steps);
    if (model.instrument == ui::Instrument::pixel) {
        fillPixel(renderer, settings, picture, model.pixel);
    } else {
        pixelLines_.clear();
        filledPixel_ = {};
        model.pixel = {};
    }
}

// ---- legends

void Instruments::fillLegends(const Settings& settings, const FrameStatistics& statistics,
                              ui::Model& model) {
    model.legends.clear();
    model.difference.reset();
    const DebugLegend& debug = legendOf(settings.picture.view);
    if (debug.kind != LegendKind::none) {
        ui::Legend legend;
        legend.title = debug.title;
        legend.unit = debug.unit;
        legend.low = debug.low;
        legend.high = debug.high;
        legend.logarithmic = debug.logarithmic;
        if (debug.kind == LegendKind::scale) legend.scale = scaleOf(debug.colours);
        for (const LegendClass& entry : debug.classes) {
            legend.entries.push_back({std::string(entry.name), entry.colour, std::nullopt});
        }
        model.legends.push_back(std::move(legend));
    }
    if (settings.display.difference != Difference::off) {
        ui::Legend legend;
        const bool isSigned = settings.display.difference == Difference::signedValue;
        legend.title = isSigned                                              ? "Right minus left"
                       : settings.display.difference == Difference::relative ? "Relative difference"
                       : settings.display.difference == Difference::flip
                           ? (statistics.differenceRange > 0 ? "FLIP" : "FLIP, once complete")
                           : "Absolute difference";
        const bool isFlip = settings.display.difference == Difference::flip;
        const bool hasUnit = settings.display.difference != Difference::relative && !isFlip;
        legend.unit = hasUnit ? "W/(m² sr)" : "";
        legend.high = statistics.differenceRange > 0 ? statistics.differenceRange : 1;
        legend.low = isSigned ? -legend.high : 0;
        for (int i = 0; i < kScaleColours; ++i) {
            const float t = static_cast<float>(i) / (kScaleColours - 1);
            legend.scale.push_back(float3(isSigned ? divergingColor(2 * t - 1)
                                          : settings.display.difference == Difference::relative
                                              ? cividis(t)
                                              : viridis(t)));
        }
        model.difference = std::move(legend);
    }
    if (!pixelLines_.empty()) {
        ui::Legend legend;
        legend.title = "Views gathered by the pixel";
        legend.entries = {{"visible", displayColour(kVisibleColour), std::nullopt},
                          {"occluded", displayColour(kOccludedColour), std::nullopt}};
        model.legends.push_back(std::move(legend));
    }
    if (!overlayWanted(settings)) return;
    const Overlay& overlay = inspector_.overlay(settings);
    const auto add = [&](const char* title, std::span<const LegendEntry> entries) {
        ui::Legend legend;
        legend.title = title;
        for (const LegendEntry& entry : entries) {
            legend.entries.push_back(
                {std::string(entry.name), displayColour(entry.colour), std::nullopt});
        }
        model.legends.push_back(std::move(legend));
    };
    const auto addOne = [&](const std::string& title, const char* label, std::uint32_t colour,
                            DrawnCount count) {
        ui::Legend legend;
        legend.title = title;
        legend.entries.push_back({count.drawn < count.exist
                                      ? fmt::format("{} (of {} drawn)", label, count.drawn)
                                      : std::string(label),
                                  displayColour(colour), count.exist});
        model.legends.push_back(std::move(legend));
    };
    if (settings.inspect.showOctree > 0) {
        addOne(fmt::format("Scene octree, level {}", settings.inspect.showOctree), "nodes",
               kSceneNodeColour, overlay.sceneNodes);
    }
    if (settings.inspect.showViewOctree > 0) {
        addOne(fmt::format("View octree, level {}", settings.inspect.showViewOctree), "nodes",
               kViewNodeColour, overlay.viewNodes);
    }
    if (settings.inspect.step > 0) {
        add("Traversal step", decisionLegend());
        model.legends.back().entries.push_back(
            {"view nodes", displayColour(kViewNodeColour), std::nullopt});
        if (settings.inspect.pairScene && settings.inspect.pairView) {
            model.legends.back().entries.push_back(
                {"picked pair", displayColour(kPickedPairColour), std::nullopt});
        }
    }
    if (settings.inspect.pickA && settings.inspect.pickB && overlay.a.sortedView &&
        overlay.b.sortedView) {
        add("Pairs of the picked views", sharingLegend());
        auto& entries = model.legends.back().entries;
        const std::uint64_t counts[] = {overlay.pairsOfBoth, overlay.pairsOfAAlone,
                                        overlay.pairsOfBAlone};
        for (std::size_t i = 0; i < entries.size() && i < std::size(counts); ++i) {
            entries[i].count = counts[i];
        }
    }
}

// ---- views

std::optional<ui::PickedView> Instruments::pickedView(const FrameRenderer& renderer,
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
    shown.viewRes = settings.side[0].maps.resolution;
    if (!mapsHavePairs(settings)) {
        const std::uint32_t slots[] = {static_cast<std::uint32_t>(*slot)};
        ReadMaps own = renderer.readMapsOf(slots);
        if (own.maps.viewRes != shown.viewRes) return picked;  // the maps could not be made
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

ui::Legend Instruments::colourMaps(const Settings& settings, ui::ViewsData& data) {
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
                viewMapImage(shown.maps[i], pairs, nodes, tree, shown.viewRes, quantity, scale);
            gl::Texture texture("map of a picked view", GL_TEXTURE_2D, GL_RGBA8, image.width,
                                image.height);
            std::vector<std::uint8_t> bytes(image.pixels.size() * 4);
            std::memcpy(bytes.data(), image.pixels.data(), bytes.size());
            texture.writeBytes(4, bytes);
            texture.parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
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

void Instruments::fillViews(const FrameRenderer& renderer, const Settings& settings,
                            ui::ViewsData& data) {
    ViewsKey key{viewsVersion_, settings};
    if (filledViews_ == key) return;
    const auto hovered = data.hovered;
    data = {};
    data.hovered = hovered;
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    data.total = tree.sortedViews.size();
    for (std::size_t i = 0; i < tree.sortedViews.size(); ++i) {
        const View& view = tree.sortedViews[i];
        const std::size_t bounce = view.bounce > 0 ? view.bounce - 1 : 0;
        if (data.alivePerBounce.size() <= bounce) data.alivePerBounce.resize(bounce + 1);
        ++data.alivePerBounce[bounce];
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

    if (data.a && data.b && mapsHavePairs(settings)) {
        // Copies: asking for one view may move the other.
        const Inspector::InspectedView a =
            *inspector_.inspectView(settings, *settings.inspect.pickA);
        const Inspector::InspectedView b =
            *inspector_.inspectView(settings, *settings.inspect.pickB);
        const auto renderedAt = [](const ViewPairs& pairs, std::size_t level) {
            if (level >= pairs.chain.size()) return std::uint64_t{0};
            const auto own = pairs.pairsOf(level);
            return static_cast<std::uint64_t>(std::count_if(
                own.begin(), own.end(), [](const NodePair& pair) { return isRendered(pair); }));
        };
        const auto texelsAt = [](const Inspector::InspectedView& view, std::size_t level) {
            std::uint64_t count = 0;
            if (level >= view.pairs.chain.size()) return count;
            const std::size_t begin = view.pairs.chainBegin[level];
            const std::size_t end = view.pairs.chainBegin[level + 1];
            for (const std::uint32_t pair : view.maps.fused.pair) {
                count += pair != kNone && pair >= begin && pair < end;
            }
            return count;
        };
        const std::size_t levels = std::max(a.pairs.chain.size(), b.pairs.chain.size());
        for (std::size_t level = 0; level < levels; ++level) {
            ui::SharedLevel row;
            row.level = static_cast<int>(level) + 1;
            const bool inA = level < a.pairs.chain.size(), inB = level < b.pairs.chain.size();
            row.common = inA && inB && a.pairs.chain[level] == b.pairs.chain[level];
            if (inA) row.viewsOfNode = tree.nodes[a.pairs.chain[level]].viewCount;
            row.pairsA = renderedAt(a.pairs, level);
            row.pairsB = renderedAt(b.pairs, level);
            row.texelsA = texelsAt(a, level);
            row.texelsB = texelsAt(b, level);
            data.shared.push_back(row);
        }
    }
    filledViews_ = std::move(key);
}

// What a map says in the texel under the pointer.
void Instruments::fillMapTexel(const Settings& settings, ui::ViewsData& data) {
    data.texel.reset();
    if (!data.hovered) return;
    const ui::MapPlace& place = *data.hovered;
    const std::optional<ui::PickedView>& picked = place.ofA ? data.a : data.b;
    const ShownMaps& shown = place.ofA ? mapsA_ : mapsB_;
    const auto map = static_cast<std::size_t>(place.map);
    if (!picked || map >= shown.maps.size() || place.x >= 2 * shown.viewRes ||
        place.y >= shown.viewRes) {
        return;
    }
    std::span<const NodePair> pairs;
    if (mapsHavePairs(settings)) {
        pairs = inspector_.inspectView(settings, picked->view.slot)->pairs.pairs;
    }
    const auto texel = mapTexel(shown.maps[map], texelOfPixel(place.x, place.y, shown.viewRes),
                                pairs, shown.viewRes);
    if (!texel) return;
    std::string content = "nothing is seen there";
    if (texel->depth) {
        content = fmt::format("{:.4g} world units away",
                              static_cast<double>(*texel->depth) * assets_->scene.root.edge);
    }
    if (texel->pair) {
        content += fmt::format("\nscene {}\nrendered in view {}",
                               sceneNodeText(settings, texel->pair->scene),
                               viewNodeText(settings, texel->pair->view));
    }
    data.texel = {place, texel->back ? "Back (-x)" : "Front (+x)", float3(texel->direction),
                  std::move(content)};
}

// ---- picking

std::optional<std::int64_t> Instruments::viewAt(const FrameRenderer& renderer,
                                                const FrameCamera& camera, const Settings& settings,
                                                Pixel pixel) {
    readViews(renderer);
    const PickRay ray = rayAt(camera, settings, pixel);
    const auto surface = assets_->bvh.intersect(ray.origin, ray.direction, 0, 4);
    const float distance = surface ? surface->t : std::numeric_limits<float>::infinity();
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    return pickView(tree.sortedViews, ray, distance);
}

std::optional<NodePair> Instruments::pairAt(const FrameRenderer& renderer,
                                            const FrameCamera& camera, const Settings& settings,
                                            Pixel pixel) {
    readViews(renderer);
    const std::vector<NodePair>& drawn = inspector_.overlay(settings).stepDrawn;
    const auto picked =
        pickPair(drawn, inspector_.sceneNodes(settings.side[0].rules),
                 inspector_.viewHierarchy(settings), rayAt(camera, settings, pixel));
    return picked ? std::optional(drawn[*picked]) : std::nullopt;
}

std::optional<std::int64_t> Instruments::sceneNodeAt(const FrameCamera& camera,
                                                     const Settings& settings, Pixel pixel) {
    const PickRay ray = rayAt(camera, settings, pixel);
    const auto surface = assets_->bvh.intersect(ray.origin, ray.direction, 0, 4);
    const auto nodes = inspector_.sceneNodes(settings.side[0].rules);
    if (!surface || nodes.empty()) return std::nullopt;
    const NodePath path =
        scenePathTo({nodes.data(), nullptr}, ray.origin + ray.direction * surface->t);
    const int level = settings.inspect.showOctree;  // 1 = root
    return path.nodes[std::min(path.count, level > 0 ? static_cast<uint>(level) : path.count) - 1];
}

std::optional<std::int64_t> Instruments::viewNodeOf(const Settings& settings, std::int64_t slot) {
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    const auto sorted = sortedViewOf(tree, slot);
    if (!sorted) return std::nullopt;
    std::uint32_t node = tree.leafOfView[*sorted];
    const int level = settings.inspect.showViewOctree;  // 1 = root
    while (level > 0 && tree.nodes[node].level >= static_cast<std::uint32_t>(level)) {
        node = parentOf(tree.nodes[node]);
    }
    return node;
}

// ---- steps

std::string Instruments::sceneNodeText(const Settings& settings, std::int64_t node) {
    const auto nodes = inspector_.sceneNodes(settings.side[0].rules);
    const auto i = static_cast<std::size_t>(node);
    if (i >= nodes.size()) return "no such node";
    return fmt::format("node {}, level {}{}", node, nodes[i].level + 1,
                       isLeaf(nodes[i]) ? ", a leaf" : "");
}

std::string Instruments::viewNodeText(const Settings& settings, std::int64_t node) {
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    const auto i = static_cast<std::size_t>(node);
    if (i >= tree.nodes.size()) return "no such node";
    const ViewNode& v = tree.nodes[i];
    return fmt::format("node {}, level {}, {} view{}{}", node, v.level + 1, v.viewCount,
                       v.viewCount == 1 ? "" : "s", isLeaf(v) ? ", a leaf" : "");
}

void Instruments::fillSteps(const Settings& settings, ui::StepsData& data) {
    data = {};
    const InspectSettings& inspect = settings.inspect;
    data.shown = inspect.step;
    data.sceneNode = sceneNodeText(settings, inspect.stepScene);
    data.viewNode = viewNodeText(settings, inspect.stepView);
    const auto nodes = inspector_.sceneNodes(settings.side[0].rules);
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    if (const auto pair = pickedPair(nodes, tree, settings)) {
        const PairExplanation why =
            explainPair(nodes, tree.nodes, traversalOptions(settings), pair->scene, pair->view);
        const LegendEntry& outcome = decisionLegend()[pair->decision - kPairCulled];
        data.picked = {sceneNodeText(settings, pair->scene),
                       viewNodeText(settings, pair->view),
                       std::string(outcome.name),
                       displayColour(outcome.colour),
                       why.reason,
                       {}};
        for (const PairComparison& c : why.comparisons) {
            data.picked->comparisons.push_back(
                {std::string(c.what),
                 fmt::format("{:.3g} {} {:.3g}", c.value, c.relation, c.limit)});
        }
    }
    if (inspect.step == 0) return;
    const Overlay& overlay = inspector_.overlay(settings);
    // How many steps there are is known once the last one was made.
    const bool last = overlay.stepFinished || overlay.stepStopped;
    data.steps = static_cast<int>(overlay.countsPerStep.size()) + (last ? 0 : 1);
    data.last = last;
    data.finished = overlay.stepFinished;
    data.pairs = overlay.countsPerStep.empty() ? 0 : overlay.countsPerStep.back().processed;
    data.eligible = overlay.stepPairs.exist;
    data.drawn = overlay.stepPairs.drawn;
    data.links = overlay.stepLinks;
    std::size_t decision = kPairCulled;
    for (const LegendEntry& entry : decisionLegend()) {
        data.decisions.push_back({std::string(entry.name), displayColour(entry.colour),
                                  overlay.stepDecisions.at(decision++)});
    }
}

// ---- pixel

ui::PixelValues Instruments::valuesOf(const FrameRenderer& renderer, const Settings& settings,
                                      Pixel pixel) const {
    const PixelValues read = renderer.readPixel(pixel.x, settings.picture.height - 1 - pixel.y);
    const PixelSide& side = read.sides.at(static_cast<std::size_t>(sideAt(settings, pixel)));
    const RootCube& root = assets_->scene.root;
    ui::PixelValues values;
    values.x = pixel.x;
    values.y = pixel.y;
    values.radiance = float3(side.radiance);
    if (settings.compare) {
        values.sides = {float3(read.sides[0].radiance), float3(read.sides[1].radiance)};
    }
    values.direct = float3(side.direct);
    values.indirect = float3(side.indirect);
    values.albedo = float3(read.albedo);
    values.normal = float3(read.normal);
    values.surface = read.surface;
    values.depth = static_cast<double>(read.depth) * root.edge;
    const glm::dvec3 position = root.worldFromRoot(read.position);
    values.position = {position.x, position.y, position.z};
    return values;
}

int Instruments::sideAt(const Settings& settings, Pixel pixel) {
    return settings.compare && settings.display.difference == Difference::off &&
                   pixel.x >= settings.display.split * settings.picture.width
               ? 1
               : 0;
}

void Instruments::fillPixel(const FrameRenderer& renderer, const Settings& settings,
                            std::uint64_t picture, ui::PixelData& data) {
    const bool sameFrame = filledPixel_.picture == picture;
    if (!sameFrame || filledPixel_.hover != hover_) {
        data.hover.reset();
        if (hover_) data.hover = valuesOf(renderer, settings, *hover_);
    }
    if (!sameFrame || filledPixel_.picked != picked_) {
        data.picked.reset();
        data.gathered.clear();
        pixelLines_.clear();
        if (picked_ && picked_->x < settings.picture.width &&
            picked_->y < settings.picture.height) {
            data.picked = valuesOf(renderer, settings, *picked_);
            const int side = sideAt(settings, *picked_);
            const int y = settings.picture.height - 1 - picked_->y;
            const PixelValues read = renderer.readPixel(picked_->x, y);
            const glm::vec3 reflected = read.albedo / 3.14159265f;
            const auto edge = static_cast<float>(assets_->scene.root.edge);
            for (const GatheredSample& sample : renderer.readSamples(picked_->x, y, side)) {
                ui::GatheredView view;
                view.slot = sample.slot;
                view.visible = sample.visible > 0;
                view.contribution =
                    float3(reflected * (view.visible ? sample.irradiance : sample.unoccluded));
                view.distance =
                    static_cast<double>(glm::length(sample.position - read.position) * edge);
                data.gathered.push_back(view);
                if (pixelLines_.size() < kMaxPixelLines) {
                    pixelLines_.push_back({read.position, sample.position,
                                           view.visible ? kVisibleColour : kOccludedColour});
                }
            }
        }
    }
    filledPixel_ = {picture, hover_, picked_};
}

}  // namespace mv
