#include "app/bench/stress.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "app/bench/gpu_cpu.h"
#include "app/bench/stress_truth.h"
#include "megaviews/core/error.h"
#include "megaviews/gather/gather.h"
#include "megaviews/methods/megaviews/traversal.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "renderer/passes/vpl_pass.h"
#include "shaders/shared/gather.glsl"

namespace mv::stress {
namespace {

// The GPU sums in single precision and packs normals and fluxes; the CPU takes the packed normals
// and sums in double. A shadow test at its threshold may then go the other way.
constexpr double kPictureGap = 2e-3;
// A VPL's ray that meets an edge may go to either side of it.
constexpr double kOtherViews = 0.02;

constexpr int kSkyViews = 64;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

using Picture = std::vector<glm::vec3>;  // radiance, bottom row first

Picture radianceOf(const FrameRenderer& renderer) {
    const std::vector<float> texels = renderer.radiance().readFloats(4);
    Picture out(texels.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = {texels[4 * i], texels[4 * i + 1], texels[4 * i + 2]};
    return out;
}

double sumOf(const Picture& picture) {
    double sum = 0;
    for (const glm::vec3& c : picture) sum += double{c.x} + double{c.y} + double{c.z};
    return sum;
}

// Summed absolute difference of a * gain from b as a share of `whole`; where that is nothing, any
// difference is infinitely much.
double differenceShare(const Picture& a, double gain, const Picture& b, double whole) {
    if (a.size() != b.size()) return kUnbounded;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) sum += std::abs(double{a[i][c]} * gain - double{b[i][c]});
    if (sum == 0) return 0;
    return whole > 0 ? sum / whole : kUnbounded;
}

Picture lit(const Picture& albedo, const std::vector<glm::vec3>& irradiance) {
    Picture out(albedo.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = albedo[i] * (1 / kPi) * irradiance[i];
    return out;
}

// What the GPU's gather reads: normals as the records hold them.
glm::vec3 packed(glm::vec3 n) { return n == glm::vec3(0) ? n : unpackNormal(packNormal(n)); }

std::vector<glm::vec3> gatherOnCpu(std::span<const Receiver> receivers, ViewHierarchy views,
                                   const ViewMaps& maps, const GatherReferenceOptions& options) {
    for (View& v : views.sortedViews) {
        const glm::vec3 n = packed({v.normalX, v.normalY, v.normalZ});
        v.normalX = n.x, v.normalY = n.y, v.normalZ = n.z;
    }
    std::vector<glm::vec3> irradiance(receivers.size(), glm::vec3(0));
    tbb::parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t i) {
        if (receivers[i].normal == glm::vec3(0)) return;
        const Receiver r{receivers[i].position, packed(receivers[i].normal)};
        irradiance[i] = glm::vec3(gatherAll(r, views, &maps, options));
    });
    return irradiance;
}

std::vector<ViewNode> nodesOnGpu(const std::vector<View>& views,
                                 const ViewHierarchyOptions& options) {
    GpuViews uploaded;
    upload(ViewSet{views}, uploaded);
    gl::Profiler profiler;
    ViewHierarchyPass pass;
    pass.sort(uploaded, profiler);
    GpuViewHierarchy gpu;
    pass.build(options, profiler, gpu);
    return gpu.nodes.read(0, gpu.nodeCount);
}

}  // namespace

std::string nameOf(const Setup& setup) {
    return fmt::format("{} {} {}", mv::nameOf(setup.method), nameOfRules(setup.rules),
                       setup.traversal == Traversal::queue ? "queue" : "lists");
}

const std::vector<Setup>& setups() {
    static const std::vector<Setup> all = [] {
        std::vector<Setup> s;
        for (const Method method : {Method::megaviews, Method::manylods})
            for (const uint rules : {kCorrectedRules, kPublishedRules})
                for (const Traversal traversal : {Traversal::lists, Traversal::queue})
                    s.push_back({method, rules, traversal});
        return s;
    }();
    return all;
}

// What one case gave, before it is held against others.
struct Runner::Measured {
    Result result;
    std::vector<double> errors;  // of each setup
    Picture final;               // full sum, first setup
};

Runner::Measured Runner::measure(const Case& oneCase) {
    Measured m;
    Result& r = m.result;
    r.name = oneCase.name;
    const auto start = std::chrono::steady_clock::now();
    const Input input = oneCase.make();
    const SceneAssets& assets = *input.assets;
    renderer_.setScene(assets.scene, assets.bvh, assets.hierarchy);
    renderer_.setViews(input.views);
    FrameInput frame;
    frame.camera = chosenCamera(input.settings, assets, 0);
    FrameStatistics statistics;
    const auto render = [&](const Settings& settings, const char* what) {
        renderer_.render(settings, frame, statistics);
        r.badPixels += statistics.badPixels;
        if (statistics.badPixels > 0)
            r.failures.push_back(fmt::format("{}: {} bad pixels", what, statistics.badPixels));
    };

    // As a user sees it: sampled, filtered, exposure fitted.
    Settings settings = input.settings;
    settings.side[0].method = Method::megaviews;
    // What the CPU makes as well: every point of the paths, one clamp distance, maps alone.
    settings.views.placement = Placement::traced;
    if (!settings.gather.clampDistance) settings.gather.clampDistance = 0.01;
    settings.gather.nearField = false;
    settings.gather.undecided = Undecided::off;
    frame.reuse = false;  // twice from the start
    settings.scene.environment.source = "sky";
    settings.gather.skySamples = kSkyViews;
    render(settings, "under a sky");
    const double byRays = sumOf(radianceOf(renderer_));
    settings.gather.skyViews = kSkyViews;
    render(settings, "under a sky of views");
    const double byViews = sumOf(radianceOf(renderer_));
    if (!(std::abs(byViews - byRays) <= oneCase.skyGap * byRays))
        r.failures.push_back(
            fmt::format("a sky of views gives {:.3f} of the light of rays", byViews / byRays));
    settings.gather.skyViews = 0;
    settings.scene.environment.source = "none";  // the sum below knows views alone
    render(settings, "default picture");
    const std::vector<std::uint8_t> first = renderer_.display().readBytes(4);
    render(settings, "default picture again");
    if (renderer_.display().readBytes(4) != first) r.failures.push_back("two runs differ");
    frame.reuse = true;
    if (!std::isfinite(statistics.exposureEv)) r.failures.push_back("the exposure is not finite");
    r.views = statistics.viewsAlive;

    // Receivers and views, and the truth for them.
    const std::vector<Receiver> receivers = renderer_.readReceivers();
    const std::vector<View> views = renderer_.readViews().views;
    settings.display.exposureEv = 0;
    settings.gather.samples = 0;
    settings.gather.filter = false;
    settings.picture.view = DebugView::albedo;
    render(settings, "albedo");
    const Picture albedo = radianceOf(renderer_);
    const auto clamp = static_cast<float>(*settings.gather.clampDistance);
    const Truth truth = bruteForceGather(assets.scene, views, receivers, clamp);
    const Picture exact = lit(albedo, truth.irradiance);
    const double open = sumOf(lit(albedo, truth.open));

    // Views as the CPU traces them.
    if (!input.views && settings.views.particles == 0) {
        const Emitters emitters =
            makeEmitters(assets.scene, assets.bvh, 0, assets.animation, settings.scene.lightScale);
        const ViewSet cpu = traceVpls(assets.bvh, emitters,
                                      {static_cast<std::uint64_t>(settings.views.vpls),
                                       settings.views.bounces, settings.seed});
        r.viewsDiffering = differingViews(views, cpu.views);
        if (static_cast<double>(r.viewsDiffering) > kOtherViews * static_cast<double>(views.size()))
            r.failures.push_back(fmt::format("{} of {} views are not those of the CPU",
                                             r.viewsDiffering, views.size()));
    }

    std::uint64_t nodes = 0;
    TraversalResult cpu;
    Picture cpuPicture;
    for (std::size_t i = 0; i < setups().size(); ++i) {
        const Setup& setup = setups()[i];
        const std::string name = nameOf(setup);
        settings.side[0].method = setup.method;
        settings.side[0].rules = setup.rules;
        settings.side[0].pairs.traversal = setup.traversal;
        if (setup.traversal == setups().front().traversal) {  // both make the same maps
            const ViewHierarchyOptions treeOptions = {settings.views.octreeDepth, setup.rules,
                                                      setup.method == Method::manylods};
            const ViewHierarchy tree = ViewHierarchy::build(views, treeOptions);
            nodes += tree.nodes.size();
            r.nodesDiffering += differingNodes(nodesOnGpu(views, treeOptions), tree.nodes);
            cpu = traverse(assets.hierarchy.nodesUnder(setup.rules), tree, settings.side[0]);
            GatherReferenceOptions options;
            options.clampDistance = clamp;
            options.worldEdge = static_cast<float>(assets.scene.root.edge);
            options.rules = setup.rules;
            options.bias = static_cast<float>(settings.gather.bias);
            cpuPicture = lit(albedo, gatherOnCpu(receivers, tree, cpu.leafMaps, options));
        }

        if (i == 0) {
            settings.picture.view = DebugView::final;
            render(settings, "full sum");
            m.final = radianceOf(renderer_);
        }
        settings.picture.view = DebugView::indirect;
        render(settings, name.c_str());
        const Picture gpuPicture = radianceOf(renderer_);

        // GPU and CPU.
        const PairCounts& pairs = statistics.methods.front().pairs;
        r.pairsGpu += pairs.processed;
        r.pairsCpu += cpu.counts.processed;
        if (!pairsAgree(pairs, cpu.counts))
            r.failures.push_back(
                fmt::format("{}: {} pairs, CPU {}", name, pairs.processed, cpu.counts.processed));
        const std::uint64_t texels = cpu.leafMaps.texels.size();
        const std::uint64_t different =
            differingTexels(renderer_.readMaps().maps.texels, cpu.leafMaps.texels);
        r.texels += texels;
        r.texelsDiffering += different;
        if (!texelsAgree(different, texels))
            r.failures.push_back(
                fmt::format("{}: {} of {} texels differ", name, different, texels));
        const double gap = differenceShare(gpuPicture, 1, cpuPicture, open);
        r.pictureGap = std::max(r.pictureGap, gap);
        if (!(gap <= kPictureGap))
            r.failures.push_back(
                fmt::format("{}: the GPU's picture is {:.2e} from the CPU's", name, gap));

        m.errors.push_back(differenceShare(gpuPicture, 1, exact, open));
        if (i == 0) {
            for (std::size_t k = 0; k < exact.size(); ++k)
                for (int c = 0; c < 3; ++c)
                    r.leaked += std::max(double{gpuPicture[k][c]} - double{exact[k][c]}, 0.0);
            r.leaked = r.leaked > 0 ? r.leaked / open : 0;
        }
    }
    if (!nodesAgree(r.nodesDiffering, nodes))
        r.failures.push_back(fmt::format("{} view nodes are not the CPU's", r.nodesDiffering));
    r.error = m.errors.front();
    r.ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return m;
}

const Runner::Measured& Runner::measured(const Case& oneCase) {
    auto& kept = kept_[oneCase.name];
    if (!kept) kept = std::make_shared<const Measured>(measure(oneCase));
    return *kept;
}

Result Runner::run(const Case& oneCase) {
    const Measured& benign = measured(cases().front());
    const bool isCompared = std::any_of(cases().begin(), cases().end(), [&](const Case& c) {
        return c.name == oneCase.name || (c.sameAs && c.sameAs->other == oneCase.name);
    });
    const Measured own = isCompared ? measured(oneCase) : measure(oneCase);
    Result r = own.result;

    r.allowedFactor = oneCase.factor;
    for (std::size_t i = 0; i < setups().size(); ++i) {
        const double factor = own.errors[i] == 0 ? 0 : own.errors[i] / benign.errors[i];
        if (factor > r.errorFactor || std::isnan(factor)) {
            r.errorFactor = factor;
            r.worstSetup = nameOf(setups()[i]);
        }
    }
    if (!(r.errorFactor <= oneCase.factor))
        r.failures.push_back(fmt::format("{}: {:.2f} times the benign case's error, allowed {:.2f}",
                                         r.worstSetup, r.errorFactor, oneCase.factor));

    if (oneCase.sameAs) {
        const auto other = std::find_if(cases().begin(), cases().end(), [&](const Case& c) {
            return c.name == oneCase.sameAs->other;
        });
        const Picture& expected = measured(*other).final;
        r.apart = differenceShare(own.final, 1 / oneCase.sameAs->gain, expected, sumOf(expected));
        if (!(*r.apart <= oneCase.sameAs->tolerance))
            r.failures.push_back(
                fmt::format("the picture is {:.2e} from that of {}, allowed {:.0e}", *r.apart,
                            oneCase.sameAs->other, oneCase.sameAs->tolerance));
    }
    return r;
}

std::string tableHeader() {
    return "| case                  | views | bad |   error |  leaked |    of benign | pairs GPU | "
           "pairs CPU | texels |     gap |   apart | result |\n"
           "|-----------------------|------:|----:|--------:|--------:|-------------:|----------:|"
           "----------:|-------:|--------:|--------:|--------|\n";
}

std::string tableRow(const Result& r) {
    return fmt::format(
        "| {:<21} | {:>5} | {:>3} | {:>5.2f} % | {:>5.2f} % | {:>4.2f} ({:>5.2f}) | {:>9} | {:>9} "
        "| "
        "{:>6} | {:>7.1e} | {:>7} | {:<6} |\n",
        r.name, r.views, r.badPixels, 100 * r.error, 100 * r.leaked, r.errorFactor, r.allowedFactor,
        r.pairsGpu, r.pairsCpu, r.texelsDiffering, r.pictureGap,
        r.apart ? fmt::format("{:.1e}", *r.apart) : "", r.failures.empty() ? "pass" : "FAIL");
}

}  // namespace mv::stress
