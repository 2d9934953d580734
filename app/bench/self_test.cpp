#include "app/bench/self_test.h"

#include <algorithm>
#include <functional>

#include "app/bench/gpu_cpu.h"
#include "app/common/scene_assets.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/traversal/traversal.h"
#include "megaviews/views/view_set.h"
#include "renderer/frame_renderer.h"
#include "renderer/gl/context.h"
#include "renderer/passes/many_view_pass.h"
#include "renderer/passes/scene_hierarchy_upload.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"

namespace mv {
namespace {

constexpr const char* kScene = "builtin:cornell";
constexpr int kDepth = 6;
constexpr int kViewRes = 16;
constexpr std::uint64_t kLittleQueueBytes = 128 << 10;

struct Fixture {
    Settings settings;
    std::unique_ptr<SceneAssets> assets;
    Emitters emitters;
    std::vector<Check> checks;

    void check(const std::string& name, const std::function<bool(std::string& detail)>& body) {
        Check result{name, false, {}};
        try {
            result.passed = body(result.detail);
        } catch (const std::exception& error) {
            result.detail = error.what();
        }
        checks.push_back(std::move(result));
    }

    ViewSet cpuViews(std::uint64_t count) const {
        return traceVpls(assets->bvh, emitters, {count, 3, 5});
    }
};

std::string share(std::uint64_t part, std::uint64_t whole) {
    return std::to_string(part) + " of " + std::to_string(whole);
}

// A ray that grazes an edge may hit the other side of it; its path differs from there on.
void checkVpls(Fixture& f, std::uint64_t count) {
    f.check("VPLs, " + std::to_string(count) + " slots", [&](std::string& detail) {
        VplPass pass;
        pass.setScene(f.assets->scene, f.assets->bvh);
        gl::Profiler profiler;
        GpuViews gpu;
        pass.trace(f.emitters, {count, 3, 5}, profiler, gpu);
        const ViewSet cpu = f.cpuViews(count);
        const std::vector<View> views = gpu.views.read<View>(0, gpu.count);
        const std::uint64_t different = differingViews(views, cpu.views);
        detail = share(different, count) + " differ";
        return static_cast<double>(different) <= 0.01 * static_cast<double>(count);
    });
}

bool sameNode(const ViewNode& a, const ViewNode& b) {
    constexpr float kLength = 1e-6f, kCone = 1e-3f;
    return a.children == b.children && a.level == b.level && a.firstView == b.firstView &&
           a.viewCount == b.viewCount && a.flags == b.flags &&
           near(a.centerX, b.centerX, kLength) && near(a.centerY, b.centerY, kLength) &&
           near(a.centerZ, b.centerZ, kLength) && near(a.halfX, b.halfX, kLength) &&
           near(a.halfY, b.halfY, kLength) && near(a.halfZ, b.halfZ, kLength) &&
           ((a.flags & kViewNodeNoCull) != 0 || near(a.cosPsi, b.cosPsi, kCone));
}

void checkViewHierarchy(Fixture& f, std::uint64_t count, const ViewHierarchyOptions& options,
                        const std::string& name) {
    f.check("view hierarchy, " + name + ", " + std::to_string(count) + " views",
            [&](std::string& detail) {
                const ViewSet views = f.cpuViews(count);
                const ViewHierarchy cpu = ViewHierarchy::build(views.views, options);
                GpuViews uploaded;
                upload(views, uploaded);
                gl::Profiler profiler;
                ViewHierarchyPass pass;
                pass.sort(uploaded, profiler);
                GpuViewHierarchy gpu;
                pass.build(options, profiler, gpu);
                const auto nodes = gpu.nodes.read<ViewNode>(0, gpu.nodeCount);
                std::uint64_t different = 0;
                for (std::size_t i = 0; i < std::min(nodes.size(), cpu.nodes.size()); ++i) {
                    different += !sameNode(nodes[i], cpu.nodes[i]);
                }
                detail = std::to_string(gpu.nodeCount) + " nodes, CPU " +
                         std::to_string(cpu.nodes.size()) + ", " + std::to_string(different) +
                         " differ";
                return nodes.size() == cpu.nodes.size() && different == 0 &&
                       gpu.leafCount == cpu.leafCount && gpu.levelBegin == cpu.levelBegin;
            });
}

void checkTraversal(Fixture& f, std::uint64_t count, Rules rules, bool flat) {
    const std::string name = std::string(flat ? "manylods" : "megaviews") + ", " +
                             std::string(nameOf(rules)) + ", " + std::to_string(count) + " views";
    const ViewSet viewSet = f.cpuViews(count);
    const ViewHierarchy views =
        ViewHierarchy::build(viewSet.views, {kDepth, rules == Rules::published, flat});
    const auto sceneNodes = rules == Rules::published ? f.assets->hierarchy.publishedNodes()
                                                      : f.assets->hierarchy.nodes;
    const TraversalResult cpu = traverse(sceneNodes, views, {rules, kViewRes, true});
    const GpuSceneHierarchy gpuScene = uploadSceneHierarchy(f.assets->hierarchy, rules);
    const GpuViewHierarchy gpuViews = upload(views);

    const auto compare = [&](const std::string& title, Traversal traversal,
                             std::uint64_t queueBytes, bool split) {
        f.check(title, [&, traversal, queueBytes, split](std::string& detail) {
            ManyViewOptions options;
            options.traversal = traversal;
            options.rules = rules;
            options.viewRes = kViewRes;
            options.queueMemoryBytes = queueBytes;
            gl::Profiler profiler;
            ManyViewPass pass;
            GpuViewMaps maps;
            MethodStatistics statistics;
            pass.render(gpuScene, gpuViews, options, profiler, maps, statistics);
            const std::uint64_t texels = 2ull * kViewRes * kViewRes * maps.mapCount;
            const auto read = maps.texels.read<std::uint32_t>(0, texels);
            const std::uint64_t different = differingTexels(read, cpu.leafMaps.texels);
            detail = share(different, texels) + " texels differ, " +
                     std::to_string(statistics.pairs.processed) + " pairs, CPU " +
                     std::to_string(cpu.counts.processed) + ", " +
                     std::to_string(statistics.passes) + " passes";
            return pairsAgree(statistics.pairs, cpu.counts) && texelsAgree(different, texels) &&
                   (!split || statistics.passes > 1);
        });
    };
    compare("queue, " + name, Traversal::queue, 256ull << 20, false);
    compare("lists, " + name, Traversal::lists, 256ull << 20, false);
    if (count > 1) {
        // Too little for all views at once: more passes, the same pairs and maps.
        compare("queue in parts, " + name, Traversal::queue, kLittleQueueBytes, true);
    }
}

void checkPictures(Fixture& f) {
    FrameRenderer renderer;
    renderer.setScene(f.assets->scene, f.assets->bvh, f.assets->hierarchy);
    for (const Method method : {Method::megaviews, Method::manylods, Method::none}) {
        f.check("picture, " + std::string(nameOf(method)), [&](std::string& detail) {
            Settings settings = f.settings;
            settings.method = method;
            settings.vpls = 256;
            settings.width = 96;
            settings.height = 64;
            settings.gatherSamples = 16;
            FrameInput input;
            input.camera = chosenCamera(settings, *f.assets, 0);
            input.animation = f.assets->animation;
            input.reuse = false;
            FrameStatistics statistics;
            std::vector<std::uint8_t> first, second;
            renderer.render(settings, input, statistics);
            first = renderer.display().readBytes(4);
            renderer.render(settings, input, statistics);
            second = renderer.display().readBytes(4);
            const bool blank = std::all_of(
                first.begin() + 4, first.end(),
                [&, i = std::size_t{0}](std::uint8_t x) mutable { return x == first[i++ % 4]; });
            detail = std::string(first == second ? "same bytes twice" : "two runs differ") + ", " +
                     std::to_string(statistics.badPixels) + " bad pixels" +
                     (blank ? ", blank" : "");
            return first == second && statistics.badPixels == 0 && !blank;
        });
    }
}

}  // namespace

std::vector<Check> runSelfTest() {
    Fixture f;
    f.settings.sceneDepth = kDepth;
    f.settings.viewDepth = kDepth;
    f.assets = loadAssets(kScene, f.settings, {});
    f.emitters = makeEmitters(f.assets->scene, f.assets->bvh, 0, f.assets->animation, 1);

    const auto group = static_cast<std::uint64_t>(gl::limits().workGroupSize);
    for (const std::uint64_t count : {std::uint64_t{1}, group + 1, std::uint64_t{3000}}) {
        checkVpls(f, count);
    }
    for (const std::uint64_t count :
         {std::uint64_t{0}, std::uint64_t{1}, group - 1, group, group + 1, std::uint64_t{3000}}) {
        checkViewHierarchy(f, count, {kDepth, false, false}, "corrected");
    }
    checkViewHierarchy(f, 3000, {kDepth, true, false}, "published");
    checkViewHierarchy(f, 3000, {kDepth, false, true}, "flat");
    for (const Rules rules : {Rules::corrected, Rules::published}) {
        for (const bool flat : {false, true}) {
            checkTraversal(f, 1, rules, flat);
            checkTraversal(f, 200, rules, flat);
        }
    }
    checkPictures(f);
    return std::move(f.checks);
}

}  // namespace mv
