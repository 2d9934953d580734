#include "app/viewer/instruments.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "app/viewer/legends.h"
#include "megaviews/inspect/pair_explanation.h"
#include "megaviews/views/pick_view.h"
#include "shaders/shared/pair_path.glsl"

namespace mv {
namespace {

constexpr std::size_t kMaxPixelLines = 1024;

ui::Float3 float3(glm::vec3 v) { return {v.x, v.y, v.z}; }

PickRay rayAt(const FrameCamera& camera, const Settings& settings, Instruments::Pixel pixel) {
    constexpr float kPickPixels = 24;  // a hand does not point finer
    return rayThrough(camera, settings.resolution.width, settings.resolution.height,
                      static_cast<float>(pixel.x) + 0.5f,
                      static_cast<float>(settings.resolution.height - 1 - pixel.y) + 0.5f,
                      kPickPixels);
}

}  // namespace

void Instruments::setScene(const SceneAssets& assets) {
    assets_ = &assets;
    inspector_.setScene(assets.hierarchy);
    inspector_.clearViews();
    viewsVersion_.reset();
    views_.setScene(assets);
    hover_.reset();
    picked_.reset();
}

void Instruments::readViews(const FrameRenderer& renderer) {
    if (viewsVersion_ == renderer.mapViewsVersion()) return;
    inspector_.setViews(renderer.readMapViews().views);
    viewsVersion_ = renderer.mapViewsVersion();
}

void Instruments::readFrame(const FrameRenderer& renderer, const Settings& settings,
                            ui::Model& model) {
    const bool panel = model.instrument == ui::Instrument::views ||
                       model.instrument == ui::Instrument::steps ||
                       model.picking != ui::Picking::none;
    if (panel || overlayNeedsViews(settings)) {
        readViews(renderer);
    } else if (viewsVersion_) {
        inspector_.clearViews();
        viewsVersion_.reset();
        views_.clear();
        for (auto* picked : {&model.views.a, &model.views.b}) {
            if (*picked) (*picked)->maps.clear();  // the textures are gone
        }
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
        views_.fill(renderer, settings, *viewsVersion_, model.views);
    } else {
        views_.forget();
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

void Instruments::fillLegends(const Settings& settings, const FrameStatistics& statistics,
                              ui::Model& model) {
    model.legends.clear();
    if (auto legend = debugViewLegend(settings.picture.view)) {
        model.legends.push_back(std::move(*legend));
    }
    model.difference = differenceLegend(settings.display.difference, statistics.differenceRange);
    if (!pixelLines_.empty()) model.legends.push_back(gatheredLegend());
    if (overlayWanted(settings)) {
        appendOverlayLegends(settings, inspector_.overlay(settings), model.legends);
    }
}

std::vector<std::string> Instruments::missing(const Settings& settings) {
    std::vector<std::string> out;
    const InspectSettings& asked = settings.inspect;
    if (asked.pairScene && !asked.pairView) out.emplace_back("--pair-scene: without --pair-view");
    if (asked.pairView && !asked.pairScene) out.emplace_back("--pair-view: without --pair-scene");
    if (!overlayNeedsViews(settings)) return out;
    const Overlay& overlay = inspector_.overlay(settings);
    const auto sceneNodes = inspector_.sceneNodes(settings.side[0].rules);
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    const std::string nodes = fmt::format("there are {} nodes of the scene and {} of the views",
                                          sceneNodes.size(), tree.nodes.size());
    const auto pick = [&](const char* key, auto slot, const InspectedPick& picked) {
        if (!slot || picked.sortedView) return;
        out.push_back(fmt::format("--{} {}: no view in this slot has a map", key, *slot));
    };
    pick("pick-a", asked.pickA, overlay.a);
    pick("pick-b", asked.pickB, overlay.b);
    if (asked.pairScene && asked.pairView && !pickedPair(sceneNodes, tree, settings)) {
        out.push_back(fmt::format("--pair-scene {} --pair-view {}: {}", *asked.pairScene,
                                  *asked.pairView, nodes));
    }
    if (asked.step > 0 && overlay.countsPerStep.empty()) {
        out.push_back(fmt::format("--step-scene {} --step-view {}: {}", asked.stepScene,
                                  asked.stepView, nodes));
    } else if (asked.step > overlay.step) {
        out.push_back(fmt::format("--step {}: the {} is {}, which is drawn", asked.step,
                                  overlay.stepStopped ? "last with few enough pairs" : "last step",
                                  overlay.step));
    }
    return out;
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
    const std::vector<std::size_t> along =
        pairsAlong(drawn, inspector_.sceneNodes(settings.side[0].rules),
                   inspector_.viewHierarchy(settings), rayAt(camera, settings, pixel));
    if (along.empty()) return std::nullopt;
    const auto before = std::ranges::find_if(along, [&](std::size_t i) {
        return drawn[i].scene == settings.inspect.pairScene &&
               drawn[i].view == settings.inspect.pairView;
    });
    const bool hasNext = before != along.end() && before + 1 != along.end();
    return drawn[hasNext ? *(before + 1) : along.front()];
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

void Instruments::fillSteps(const Settings& settings, ui::StepsData& data) {
    data = {};
    const InspectSettings& inspect = settings.inspect;
    data.shown = inspect.step;
    const auto nodes = inspector_.sceneNodes(settings.side[0].rules);
    const ViewHierarchy& tree = inspector_.viewHierarchy(settings);
    data.sceneNode = sceneNodeText(nodes, inspect.stepScene);
    data.viewNode = viewNodeText(tree.nodes, inspect.stepView);
    if (const auto pair = pickedPair(nodes, tree, settings)) {
        const PairExplanation why =
            explainPair(nodes, tree.nodes, settings.side[0], pair->scene, pair->view);
        const LegendEntry& outcome = decisionLegend()[pair->decision - kPairCulled];
        data.picked = {.scene = sceneNodeText(nodes, pair->scene),
                       .view = viewNodeText(tree.nodes, pair->view),
                       .decision = std::string(outcome.name),
                       .colour = displayColour(outcome.colour),
                       .reason = why.reason,
                       .comparisons = {}};
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
    const PixelValues read = renderer.readPixel(pixel.x, settings.resolution.height - 1 - pixel.y);
    const PixelSide& side = read.sides.at(static_cast<std::size_t>(sideAt(settings, pixel)));
    const RootCube& root = assets_->scene.root;
    ui::PixelValues values;
    values.x = pixel.x;
    values.y = pixel.y;
    values.radiance = float3(side.radiance);
    values.display = read.display;
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
                   pixel.x >= settings.display.split * settings.resolution.width
               ? 1
               : 0;
}

void Instruments::fillPixel(const FrameRenderer& renderer, const Settings& settings,
                            std::uint64_t picture, ui::PixelData& data) {
    const bool sameFrame = filledPixel_.picture == picture;
    const gl::Texture& shown = renderer.picture();
    data.magnified = {reinterpret_cast<void*>(static_cast<std::uintptr_t>(shown.id())),
                      shown.width(), shown.height(), true};
    if (!sameFrame || filledPixel_.hover != hover_) {
        data.hover.reset();
        if (hover_) data.hover = valuesOf(renderer, settings, *hover_);
    }
    if (!sameFrame || filledPixel_.picked != picked_) {
        data.picked.reset();
        data.gathered.clear();
        pixelLines_.clear();
        if (picked_ && picked_->x < settings.resolution.width &&
            picked_->y < settings.resolution.height) {
            data.picked = valuesOf(renderer, settings, *picked_);
            const int side = sideAt(settings, *picked_);
            const int y = settings.resolution.height - 1 - picked_->y;
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
