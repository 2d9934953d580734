#include "app/bench/cuts_command.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <random>

#include "app/bench/options.h"
#include "app/common/scene_assets.h"
#include "megaviews/core/error.h"
#include "megaviews/hierarchy/moving_surface.h"
#include "megaviews/measure/map_errors.h"
#include "megaviews/measure/reference_store.h"
#include "megaviews/methods/manylods/cuts.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/views/view_set.h"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

struct CutsOptions {
    std::string scene;
    std::uint64_t vpls = 1024;
    int mapRes = 16, sceneDepth = 9, frames = 8;
    uint rules = kCorrectedRules;
    std::vector<std::string> trees;
    std::vector<double> drifts, rates;
    std::vector<std::uint32_t> iterations = {0, 1, 2};
};

// One kind of cut over the frames of a motion; 0 iterations: as many as it takes, incremental.
struct Row {
    explicit Row(std::uint32_t most) : iterations(most) {}
    std::uint32_t iterations;
    std::optional<ViewCuts> cuts;
    PairCounts pairs;
    CutCounts counts;
    MapErrors errors;  // against the basic method's maps
    std::uint64_t mapsDiffering = 0;

    std::string name() const {
        return iterations == 0 ? "incremental" : fmt::format("lazy {}", iterations);
    }
};

std::vector<float> depthsOf(const ViewMaps& maps) {
    std::vector<float> depths(maps.texels.size());
    std::ranges::transform(maps.texels, depths.begin(), mapDepth);
    return depths;
}

// Every view goes straight on in a direction of its own along its surface, and back from the
// faces of the root cube. `way`: from where it began.
void drift(ViewSet& views, float way) {
    for (View& view : views.views) {
        if (view.flags == kViewDead) continue;
        std::mt19937 random(view.slot);
        std::uniform_real_distribution<float> unit(-1, 1);
        const glm::vec3 normal = viewNormal(view);
        const glm::vec3 side = glm::cross(normal, {unit(random), unit(random), unit(random)});
        const glm::vec3 along = glm::normalize(side + glm::vec3(1e-6f, 0, 0)) * way;
        const auto inside = [](float x) { return 1 - std::abs(1 - std::abs(x)); };
        view.positionX = inside(view.positionX + along.x);
        view.positionY = inside(view.positionY + along.y);
        view.positionZ = inside(view.positionZ + along.z);
    }
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What rays through the texels' centres find from every view.
MapReferences exactMaps(const TriangleBvh& bvh, const std::vector<View>& views, int mapRes) {
    const auto res = static_cast<uint>(mapRes);
    const std::size_t texels = mapTexels(res);
    MapReferences out;
    out.mapRes = mapRes;
    for (const View& view : views) {
        if (view.flags == kViewDead) continue;
        out.slots.push_back(view.slot);
        out.positions.push_back(viewPosition(view));
    }
    out.depth.assign(out.slots.size() * texels, kInfinity);
    tbb::parallel_for(std::size_t{0}, out.slots.size(), [&](std::size_t map) {
        for (uint texel = 0; texel < texels; ++texel) {
            if (!texelReachable(texel, res)) continue;
            const auto hit =
                bvh.intersect(out.positions[map], texelDirection(texel, res), 0, kInfinity);
            if (hit) out.depth[map * texels + texel] = hit->t;
        }
    });
    return out;
}

// The maps as they are asked for; `hierarchy` is flat.
ReadMaps readMaps(const ViewMaps& maps, const ViewHierarchy& hierarchy, std::size_t slots) {
    ReadMaps out;
    out.maps = maps;
    out.mapOfSlot.assign(slots, kNone);
    for (std::uint32_t i = 0; i < hierarchy.sortedViews.size(); ++i) {
        out.mapOfSlot[hierarchy.sortedViews[i].slot] = hierarchy.mapOfNode[hierarchy.leafOfView[i]];
    }
    return out;
}

class Runner {
  public:
    Runner(const CutsOptions& options, std::string tree)
        : options_(options), tree_(std::move(tree)) {
        Settings settings;
        settings.scene.octreeDepth = options.sceneDepth;
        settings.scene.tree = tree_ == "binary" ? SceneTree::binary : SceneTree::octree;
        assets_ = loadAssetsWithoutHierarchy(options.scene, settings);
        const auto start = std::chrono::steady_clock::now();
        buildHierarchy(*assets_, settings, {});
        buildS_ = secondsSince(start);
    }

    // false: maps of incremental cuts were others.
    bool run(double driftAFrame, double framesASecond) {
        const MethodSettings method{.rules = options_.rules, .maps = {options_.mapRes}};
        std::vector<Row> rows;
        for (const std::uint32_t q : options_.iterations) rows.emplace_back(q);
        std::uint64_t basic = 0;  // pairs
        for (int frame = 0; frame <= options_.frames; ++frame) {
            const double timeS = framesASecond > 0 ? frame / framesASecond : 0;
            assets_->pose(timeS);
            refit();
            ViewSet set =
                traceVpls(assets_->bvh,
                          makeEmitters(assets_->scene, assets_->bvh, {timeS, assets_->animation}),
                          {options_.vpls});
            drift(set, static_cast<float>(driftAFrame * frame));
            const ViewHierarchy views =
                ViewHierarchy::build(set.views, {.levels = 1, .flat = true});
            const SceneNodes nodes = assets_->hierarchy.nodesUnder(options_.rules);
            const TraversalResult want = traverse(nodes, views, method);
            if (frame > 0) basic += want.counts.processed;
            const std::vector<float> depths = depthsOf(want.leafMaps);
            if (frame > 0) {
                errors_ += mapErrors(exactMaps(assets_->bvh, set.views, options_.mapRes), set.views,
                                     readMaps(want.leafMaps, views, set.views.size()));
            }
            for (Row& row : rows) {
                if (!row.cuts) {
                    const auto& moving = assets_->hierarchy.moving;
                    row.cuts.emplace(nodes, moving ? moving->begin : std::vector<std::uint32_t>());
                }
                CutOptions cut{method};
                if (row.iterations > 0) cut.iterations = row.iterations;
                const CutUpdate got = row.cuts->update(nodes, views, cut);
                if (frame == 0) continue;  // from the root
                row.pairs += got.counts;
                row.counts += got.cuts;
                row.errors += compareMaps(depthsOf(got.leafMaps), depths);
                row.mapsDiffering += got.leafMaps.texels != want.leafMaps.texels;
            }
        }
        bool same = true;
        for (const Row& row : rows) {
            print(row, driftAFrame, framesASecond, basic);
            same = same && (row.iterations > 0 || row.mapsDiffering == 0);
        }
        return same;
    }

    static void printHeader() {
        std::printf(
            "motion a frame | tree | cut | nodes | culled %% | kept %% | split %% | merged %% | "
            "pairs | basic's | fewer | rounds | coarse %% | texels off by 2 %% (%%)\n");
    }
    static void printTreeHeader() {
        std::printf(
            "\ntree | levels | leaves | nodes | MiB | built s | refitted ms | texels off exact "
            "depths by 2 %% (%%) | by 10 %% (%%) | too near (%%) | too far (%%) | empty (%%)\n");
    }
    // What the tree took, and the maps of its basic cuts beside exact ones, over all motions.
    void printTree() const {
        const SceneHierarchy& h = assets_->hierarchy;
        const auto bytes = static_cast<double>(h.nodes.size() * sizeof(SceneNode));
        const auto percent = [&](std::uint64_t n) { return 100 * errors_.share(n); };
        fmt::print(
            "{} | {} | {} | {} | {:.1f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | "
            "{:.2f}\n",
            tree_, h.levels, h.leafCount(), h.nodes.size(), bytes / (1 << 20), buildS_,
            refits_ > 0 ? 1000 * refitS_ / refits_ : 0.0, percent(errors_.off2),
            percent(errors_.off10), percent(errors_.tooNear), percent(errors_.tooFar),
            percent(errors_.empty));
    }

  private:
    // Refits once more, to take its time.
    void refit() {
        if (!assets_->hierarchy.moving) return;
        const auto start = std::chrono::steady_clock::now();
        assets_->hierarchy.refit(assets_->scene);
        refitS_ += secondsSince(start);
        ++refits_;
    }

    void print(const Row& row, double driftAFrame, double framesASecond,
               std::uint64_t basic) const {
        const auto nodes = static_cast<double>(row.counts.nodes);
        const auto percent = [&](std::uint64_t n) { return 100 * static_cast<double>(n) / nodes; };
        const std::string motion = framesASecond > 0 ? fmt::format("1/{:g} s", framesASecond)
                                                     : fmt::format("{:g} %", 100 * driftAFrame);
        const double frames = options_.frames;
        fmt::print(
            "{} | {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.2f} "
            "| "
            "{} | {:.2f} | {:.2f}\n",
            motion, tree_, row.name(), nodes / frames, percent(row.counts.culled),
            percent(row.counts.kept), percent(row.counts.split), percent(row.counts.merged),
            static_cast<double>(row.pairs.processed) / frames, static_cast<double>(basic) / frames,
            static_cast<double>(basic) / static_cast<double>(row.pairs.processed),
            row.counts.iterations, 100 * row.counts.coarseShare(),
            100 * row.errors.share(row.errors.off2 + row.errors.filled));
        std::fflush(stdout);
    }

    const CutsOptions& options_;
    std::string tree_;
    std::unique_ptr<SceneAssets> assets_;
    double buildS_ = 0, refitS_ = 0;
    int refits_ = 0;
    MapErrors errors_;  // of basic cuts' maps
};

}  // namespace

int cutsCommand(const std::vector<std::string>& arguments) {
    CLI::App app(
        "Follows ManyLoDs' incremental and lazy cuts over a motion, on the CPU, beside cuts from "
        "the root. Exit code 1 if maps of incremental cuts differ.",
        "megaviews-bench cuts");
    CutsOptions options;
    std::string rules = "corrected";
    // A range does not keep NaN out.
    const auto isNumber = [](const std::string& text) {
        return std::isnan(std::strtod(text.c_str(), nullptr)) ? text + " is not a number" : "";
    };
    app.add_option("SCENE", options.scene, "A glTF file or builtin:NAME.")->required();
    app.add_option("--vpls", options.vpls, "VPL slots, of 4 bounces.")->check(CLI::Range(1, 65536));
    app.add_option("--view-res", options.mapRes, "Texels across one face of a map.")
        ->check(CLI::IsMember({8, 16, 32, 64, 128, 256}));
    app.add_option("--scene-depth", options.sceneDepth, "Levels of the scene octree.")
        ->check(CLI::Range(1, 11));
    app.add_option("--scene-tree", options.trees,
                   "octree, or binary: ManyLoDs' tree over surface samples; both may be given.")
        ->check(CLI::IsMember({"octree", "binary"}));
    app.add_option("--rules", rules, "Which tests decide on a pair.")
        ->check(CLI::IsMember({"published", "corrected"}));
    app.add_option("--frames", options.frames, "Frames of each motion, after the first.")
        ->check(CLI::Range(1, 1000));
    app.add_option("--drift", options.drifts,
                   "Motion in which each view goes this share of the root edge a frame; several "
                   "may be given.")
        ->check(CLI::Range(0.0, 1.0))
        ->check(isNumber);
    app.add_option("--frame-rate", options.rates,
                   "Motion of the scene's animation and lights, so many frames a second; several "
                   "may be given.")
        ->check(CLI::Range(0.001, 1e6))
        ->check(isNumber);
    app.add_option("--iterations", options.iterations,
                   "Kinds of cuts: 0 incremental, else lazy with so many iterations a frame.");
    if (!parseOptions(app, arguments)) return static_cast<int>(ExitCode::ok);
    options.rules = rules == "published" ? kPublishedRules : kCorrectedRules;
    if (options.drifts.empty() && options.rates.empty()) options.drifts = {0.001};
    if (options.trees.empty()) options.trees = {"octree"};

    std::vector<Runner> runners;
    for (const std::string& tree : options.trees) runners.emplace_back(options, tree);
    Runner::printHeader();
    bool same = true;
    for (const double share : options.drifts) {
        for (Runner& runner : runners) same = runner.run(share, 0) && same;
    }
    for (const double rate : options.rates) {
        for (Runner& runner : runners) same = runner.run(0, rate) && same;
    }
    Runner::printTreeHeader();
    for (const Runner& runner : runners) runner.printTree();
    return static_cast<int>(same ? ExitCode::ok : ExitCode::checkFailed);
}

}  // namespace mv
