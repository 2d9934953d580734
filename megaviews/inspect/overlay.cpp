#include "megaviews/inspect/overlay.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace mv {
namespace {

bool isPicked(std::int64_t slot) { return slot >= 0; }

std::optional<ViewPairs> pick(const OverlayInput& input, const Settings& settings,
                              std::int64_t slot, std::uint32_t colour, InspectedPick& picked,
                              std::vector<Line>& lines) {
    picked.sortedView = sortedViewOf(*input.views, slot);
    if (!picked.sortedView) return std::nullopt;
    appendPickedView(input.views->sortedViews[*picked.sortedView], colour, lines);
    ViewPairs pairs =
        pairsOfView(input.sceneNodes, *input.views, *picked.sortedView, traversalOptions(settings));
    picked.counts = pairs.counts;
    picked.chainNodes = pairs.chain.size();
    return pairs;
}

std::uint32_t nodeIndex(std::int64_t given) {
    return given < 0 || given >= std::int64_t{kNone} ? kNone : static_cast<std::uint32_t>(given);
}

}  // namespace

TraversalOptions traversalOptions(const Settings& settings) {
    return {settings.rules, settings.viewRes, settings.holeFill,
            static_cast<float>(settings.pairSize)};
}

ViewHierarchyOptions viewHierarchyOptions(const Settings& settings) {
    const bool published = testsPairs(settings.method) && settings.rules == Rules::published;
    const bool flat = makesMaps(settings.method) && settings.method != Method::megaviews;
    return {settings.viewDepth, published, flat};
}

bool overlayNeedsViews(const Settings& s) {
    return s.showViewOctree > 0 || s.showViews || isPicked(s.pickA) || isPicked(s.pickB) ||
           s.step > 0;
}
bool overlayWanted(const Settings& s) { return s.showOctree > 0 || overlayNeedsViews(s); }

Overlay makeOverlay(const OverlayInput& input, const Settings& settings) {
    Overlay out;
    if (settings.showOctree > 0) {
        out.sceneNodes = appendSceneLevel(input.sceneNodes, input.sceneLevelBegin,
                                          settings.showOctree - 1, out.lines);
    }
    if (!overlayNeedsViews(settings) || !input.views) return out;
    const ViewHierarchy& views = *input.views;
    if (settings.showViewOctree > 0) {
        out.viewNodes = appendViewLevel(views, settings.showViewOctree - 1, out.lines);
    }
    if (settings.showViews) out.views = appendViews(views.sortedViews, out.lines);

    const auto a = pick(input, settings, settings.pickA, kPickAColour, out.a, out.lines);
    const auto b = pick(input, settings, settings.pickB, kPickBColour, out.b, out.lines);
    if (a && b) {
        const SharedPairs shared = sharedPairs(*a, *b);
        out.pairsOfBoth = shared.both.size();
        out.pairsOfAAlone = shared.aAlone.size();
        out.pairsOfBAlone = shared.bAlone.size();
        // The debug view shows the same as colours of the surfaces.
        if (settings.view != DebugView::shared) {
            out.sharedBoxes = appendSharedPairs(shared, input.sceneNodes, out.lines);
        }
    }

    if (settings.step > 0) {
        const StepOptions options{.step = settings.step,
                                  .scene = nodeIndex(settings.stepScene),
                                  .view = nodeIndex(settings.stepView)};
        StepResult result =
            traversalStep(input.sceneNodes, views, traversalOptions(settings), options);
        out.stepPairs = appendStep(result, input.sceneNodes, views, out.lines);
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
    using TreeKey = std::tuple<int, bool, bool>;
    using OverlayKey = std::tuple<TreeKey, Rules, int, bool, double, int, int, bool, std::int64_t,
                                  std::int64_t, int, std::int64_t, std::int64_t, bool>;
    using ViewKey = std::tuple<TreeKey, Rules, int, bool, double, std::int64_t>;

    const SceneHierarchy* scene = nullptr;
    std::optional<std::vector<SceneNode>> publishedNodes;
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
        return {o.levels, o.published, o.flat};
    }
    static OverlayKey overlayKey(const Settings& s) {
        return {treeKey(s),       s.rules,
                s.viewRes,        s.holeFill,
                s.pairSize,       s.showOctree,
                s.showViewOctree, s.showViews,
                s.pickA,          s.pickB,
                s.step,           s.stepScene,
                s.stepView,       s.view == DebugView::shared};
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
    impl_->publishedNodes.reset();
    impl_->forgetAnswers();
}

void Inspector::setViews(std::vector<View> views) {
    impl_->views = std::move(views);
    impl_->tree.reset();
    impl_->forgetAnswers();
}

bool Inspector::hasViews() const { return impl_->views.has_value(); }

void Inspector::clearViews() {
    impl_->views.reset();
    impl_->tree.reset();
    impl_->forgetAnswers();
}

std::span<const SceneNode> Inspector::sceneNodes(Rules rules) {
    Impl& m = *impl_;
    if (!m.scene) return {};
    if (rules == Rules::corrected) return m.scene->nodes;
    if (!m.publishedNodes) m.publishedNodes = m.scene->publishedNodes();
    return *m.publishedNodes;
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
        input.sceneNodes = sceneNodes(settings.rules);
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
    const Impl::ViewKey key{Impl::treeKey(settings), settings.rules,    settings.viewRes,
                            settings.holeFill,       settings.pairSize, slot};
    if (m.inspected[1] && m.inspected[1]->key == key) std::swap(m.inspected[0], m.inspected[1]);
    if (!m.inspected[0] || m.inspected[0]->key != key) {
        std::swap(m.inspected[0], m.inspected[1]);
        m.inspected[0] = Impl::Inspected{key, std::nullopt};
        const ViewHierarchy& views = viewHierarchy(settings);
        if (const auto sorted = sortedViewOf(views, slot)) {
            const std::span<const SceneNode> nodes = sceneNodes(settings.rules);
            const TraversalOptions options = traversalOptions(settings);
            ViewPairs pairs = pairsOfView(nodes, views, *sorted, options);
            ViewMapsOfView maps = mapsOfView(nodes, views, pairs, options);
            m.inspected[0]->view = InspectedView{std::move(pairs), std::move(maps)};
        }
    }
    return m.inspected[0]->view ? &*m.inspected[0]->view : nullptr;
}

}  // namespace mv
