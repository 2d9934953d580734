#include "megaviews/inspect/overlay.h"

#include <array>
#include <tuple>
#include <utility>

namespace mv {
namespace {

std::optional<ViewPairs> pick(const OverlayInput& input, const Settings& settings,
                              std::optional<std::int64_t> slot, std::uint32_t colour,
                              InspectedPick& picked, std::vector<Line>& lines) {
    if (slot) picked.sortedView = sortedViewOf(*input.views, *slot);
    if (!picked.sortedView) return std::nullopt;
    appendPickedView(input.views->sortedViews[*picked.sortedView], colour, lines);
    ViewPairs pairs =
        pairsOfView(input.sceneNodes, *input.views, *picked.sortedView, settings.side[0]);
    picked.counts = pairs.counts;
    picked.chainNodes = pairs.chain.size();
    return pairs;
}

std::uint32_t nodeIndex(std::int64_t given) {
    return given < 0 || given >= std::int64_t{kNone} ? kNone : static_cast<std::uint32_t>(given);
}

}  // namespace

ViewHierarchyOptions viewHierarchyOptions(const Settings& settings) {
    const MethodSettings& side = settings.side[0];
    const uint rules = testsPairs(side.method) ? side.rules : kCorrectedRules;
    return {settings.views.octreeDepth, rules, hasFlatViews(side.method)};
}

std::optional<NodePair> pickedPair(std::span<const SceneNode> sceneNodes,
                                   const ViewHierarchy& views, const Settings& settings) {
    const std::uint32_t scene = nodeIndex(settings.inspect.pairScene.value_or(-1));
    const std::uint32_t view = nodeIndex(settings.inspect.pairView.value_or(-1));
    if (scene >= sceneNodes.size() || view >= views.nodes.size()) return std::nullopt;
    return PairTest(sceneNodes, views.nodes, settings.side[0])(scene, view);
}

bool overlayNeedsViews(const Settings& s) {
    return s.inspect.showViewOctree > 0 || s.inspect.showViews || s.inspect.pickA ||
           s.inspect.pickB || s.inspect.step > 0 || (s.inspect.pairScene && s.inspect.pairView);
}
bool overlayWanted(const Settings& s) { return s.inspect.showOctree > 0 || overlayNeedsViews(s); }

Overlay makeOverlay(const OverlayInput& input, const Settings& settings) {
    Overlay out;
    if (settings.inspect.showOctree > 0) {
        out.sceneNodes = appendSceneLevel(input.sceneNodes, input.sceneLevelBegin,
                                          settings.inspect.showOctree - 1, out.lines);
    }
    if (!overlayNeedsViews(settings) || !input.views) return out;
    const ViewHierarchy& views = *input.views;
    if (settings.inspect.showViewOctree > 0) {
        out.viewNodes = appendViewLevel(views, settings.inspect.showViewOctree - 1, out.lines);
    }
    if (settings.inspect.showViews) out.views = appendViews(views.sortedViews, out.lines);

    const auto a = pick(input, settings, settings.inspect.pickA, kPickAColour, out.a, out.lines);
    const auto b = pick(input, settings, settings.inspect.pickB, kPickBColour, out.b, out.lines);
    if (a && b) {
        const SharedPairs shared = sharedPairs(*a, *b);
        out.pairsOfBoth = shared.both.size();
        out.pairsOfAAlone = shared.aAlone.size();
        out.pairsOfBAlone = shared.bAlone.size();
        // The debug view shows the same as colours of the surfaces.
        if (settings.picture.view != DebugView::shared) {
            out.sharedBoxes = appendSharedPairs(shared, input.sceneNodes, out.lines);
        }
    }

    const std::optional<NodePair> picked = pickedPair(input.sceneNodes, views, settings);
    if (picked) {
        appendPickedPair(input.sceneNodes[picked->scene], views.nodes[picked->view], out.lines);
    }
    if (settings.inspect.step > 0) {
        const StepOptions options{.step = settings.inspect.step,
                                  .scene = nodeIndex(settings.inspect.stepScene),
                                  .view = nodeIndex(settings.inspect.stepView)};
        StepResult result = traversalStep(input.sceneNodes, views, settings.side[0], options);
        StepChoice choice{settings.inspect.stepPairs, settings.inspect.stepHidden, picked, {}};
        for (const InspectedPick& view : {out.a, out.b}) {
            if (view.sortedView) choice.viewLeaves.push_back(views.leafOfView[*view.sortedView]);
        }
        ChosenPairs chosen =
            choosePairs(result.pairs, input.sceneNodes, views, settings.side[0], choice);
        out.stepPairs = {chosen.eligible, chosen.pairs.size()};
        out.stepLinks = appendStep(chosen.pairs, input.sceneNodes, views, out.lines).drawn;
        out.stepDrawn = std::move(chosen.pairs);
        for (const NodePair& pair : result.pairs) ++out.stepDecisions.at(pair.decision);
        out.step = result.step;
        out.stepFinished = result.finished;
        out.stepStopped = result.stopped;
        out.countsPerStep = std::move(result.countsPerStep);
    }
    return out;
}

struct Inspector::Impl {
    // What an answer depends on beside scene and views.
    using TreeKey = std::tuple<int, uint, bool>;
    using MethodKey = std::pair<TreeKey, MethodSettings>;
    using OverlayKey = std::tuple<MethodKey, InspectSettings, bool>;
    using ViewKey = std::pair<MethodKey, std::int64_t>;

    const SceneHierarchy* scene = nullptr;
    std::array<SceneNodes, kNodeTables> nodes;  // by sceneTable(); empty: not asked for
    std::optional<std::vector<View>> views;
    std::optional<std::pair<TreeKey, ViewHierarchy>> tree;
    std::optional<std::pair<OverlayKey, Overlay>> overlay;
    struct Inspected {
        ViewKey key;
        std::optional<InspectedView> view;
    };
    std::array<std::optional<Inspected>, 2> inspected;  // latest first
    ViewHierarchy noViews;
    std::uint64_t overlays = 0;

    static TreeKey treeKey(const Settings& s) {
        const ViewHierarchyOptions o = viewHierarchyOptions(s);
        return {o.levels, viewTable(o.rules), o.flat};
    }
    static MethodKey methodKey(const Settings& s) { return {treeKey(s), s.side[0]}; }
    static OverlayKey overlayKey(const Settings& s) {
        return {methodKey(s), s.inspect, s.picture.view == DebugView::shared};
    }
    void forgetAnswers() {
        overlay.reset();
        inspected = {};
    }
};

Inspector::Inspector() : impl_(std::make_unique<Impl>()) {}
Inspector::~Inspector() = default;

void Inspector::setScene(const SceneHierarchy& hierarchy) {
    impl_->scene = &hierarchy;
    impl_->nodes = {};
    impl_->forgetAnswers();
}

void Inspector::setViews(std::vector<View> views) {
    impl_->views = std::move(views);
    impl_->tree.reset();
    impl_->forgetAnswers();
}

void Inspector::clearViews() {
    impl_->views.reset();
    impl_->tree.reset();
    impl_->forgetAnswers();
}

std::span<const SceneNode> Inspector::sceneNodes(uint rules) {
    Impl& m = *impl_;
    if (!m.scene) return {};
    return m.scene->nodesUnder(rules, m.nodes[sceneTable(rules)]);
}

const ViewHierarchy& Inspector::viewHierarchy(const Settings& settings) {
    Impl& m = *impl_;
    if (!m.views) return m.noViews;
    const Impl::TreeKey key = Impl::treeKey(settings);
    if (!m.tree || m.tree->first != key) {
        m.tree = {key, ViewHierarchy::build(*m.views, viewHierarchyOptions(settings))};
    }
    return m.tree->second;
}

const Overlay& Inspector::overlay(const Settings& settings) {
    Impl& m = *impl_;
    const Impl::OverlayKey key = Impl::overlayKey(settings);
    if (m.overlay && m.overlay->first == key) return m.overlay->second;
    OverlayInput input;
    if (m.scene && overlayWanted(settings)) {
        input.sceneNodes = sceneNodes(settings.side[0].rules);
        input.sceneLevelBegin = m.scene->levelBegin;
        if (m.views && overlayNeedsViews(settings)) input.views = &viewHierarchy(settings);
    }
    m.overlay = {key, makeOverlay(input, settings)};
    m.overlay->second.version = ++m.overlays;
    return m.overlay->second;
}

const Inspector::InspectedView* Inspector::inspectView(const Settings& settings,
                                                       std::int64_t slot) {
    Impl& m = *impl_;
    const Impl::ViewKey key{Impl::methodKey(settings), slot};
    if (m.inspected[1] && m.inspected[1]->key == key) std::swap(m.inspected[0], m.inspected[1]);
    if (!m.inspected[0] || m.inspected[0]->key != key) {
        std::swap(m.inspected[0], m.inspected[1]);
        m.inspected[0] = Impl::Inspected{key, std::nullopt};
        const ViewHierarchy& views = viewHierarchy(settings);
        if (const auto sorted = sortedViewOf(views, slot)) {
            const std::span<const SceneNode> nodes = sceneNodes(settings.side[0].rules);
            ViewPairs pairs = pairsOfView(nodes, views, *sorted, settings.side[0]);
            ViewMapsOfView maps = mapsOfView(nodes, views, pairs, settings.side[0]);
            m.inspected[0]->view = InspectedView{std::move(pairs), std::move(maps)};
        }
    }
    return m.inspected[0]->view ? &*m.inspected[0]->view : nullptr;
}

}  // namespace mv
