#include "app/bench/stress.h"

#include <spdlog/fmt/fmt.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

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
        const glm::vec3 n = packed(viewNormal(v));
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

// One case through the renderer and on the CPU, step by step; `m` gathers what they say.
class Runner::Measurement {
  public:
    Measurement(FrameRenderer& renderer, const Case& oneCase)
        : renderer_(renderer), case_(oneCase), input_(oneCase.make()), settings_(input_.settings) {
        m.result.name = oneCase.name;
        const SceneAssets& assets = *input_.assets;
        renderer_.setScene(assets.scene, assets.bvh, assets.hierarchy);
        renderer_.setViews(input_.views);
        frame_.camera = chosenCamera(settings_, assets, 0);
        settings_.side[0].method = Method::megaviews;
        // What the CPU makes as well: every point of the paths, one clamp distance, maps alone.
        settings_.views.placement = Placement::traced;
        if (!settings_.gather.clampDistance) settings_.gather.clampDistance = 0.01;
        settings_.gather.nearField = false;
        settings_.gather.undecided = Undecided::off;
    }

    void measure() {
        frame_.reuse = false;
        compareSkies();
        drawTwice();
        frame_.reuse = true;
        findTruth();
        if (!input_.views && settings_.views.particles == 0) compareViews();
        for (std::size_t i = 0; i < setups().size(); ++i) measureSetup(i);
        if (!nodesAgree(m.result.nodesDiffering, nodes_))
            fail("{} view nodes are not the CPU's", m.result.nodesDiffering);
        m.result.error = m.errors.front();
    }

    Measured m;

  private:
    template <typename... T>
    void fail(fmt::format_string<T...> text, T&&... values) {
        m.result.failures.push_back(fmt::format(text, std::forward<T>(values)...));
    }

    void render(const std::string& what) {
        renderer_.render(settings_, frame_, statistics_);
        m.result.badPixels += statistics_.badPixels;
        if (statistics_.badPixels > 0) fail("{}: {} bad pixels", what, statistics_.badPixels);
    }

    // A sky through maps of its views gives the light that it gives through rays.
    void compareSkies() {
        settings_.scene.environment.source = "sky";
        settings_.gather.skySamples = kSkyViews;
        render("under a sky");
        const double byRays = sumOf(radianceOf(renderer_));
        settings_.gather.skyViews = kSkyViews;
        render("under a sky of views");
        const double byViews = sumOf(radianceOf(renderer_));
        if (!(std::abs(byViews - byRays) <= case_.skyGap * byRays))
            fail("a sky of views gives {:.3f} of the light of rays", byViews / byRays);
        settings_.gather.skyViews = 0;
        settings_.scene.environment.source = "none";  // the sums below know views alone
    }

    // Draws the picture as a user sees it: sampled, filtered, exposure fitted.
    void drawTwice() {
        render("default picture");
        const std::vector<std::uint8_t> first = renderer_.display().readBytes(4);
        render("default picture again");
        if (renderer_.display().readBytes(4) != first) fail("two runs differ");
        if (!std::isfinite(statistics_.exposureEv)) fail("the exposure is not finite");
        m.result.views = statistics_.viewsAlive;
    }

    // Receivers, views, and what these give by rays to all triangles.
    void findTruth() {
        receivers_ = renderer_.readReceivers();
        views_ = renderer_.readViews().views;
        settings_.display.exposureEv = 0;
        settings_.gather.samples = 0;
        settings_.gather.filter = false;
        settings_.picture.view = DebugView::albedo;
        render("albedo");
        albedo_ = radianceOf(renderer_);
        const Truth truth = bruteForceGather(input_.assets->scene, views_, receivers_, clamp());
        exact_ = lit(albedo_, truth.irradiance);
        open_ = sumOf(lit(albedo_, truth.open));
    }

    // Views as the CPU traces them.
    void compareViews() {
        const SceneAssets& assets = *input_.assets;
        const Emitters emitters =
            makeEmitters(assets.scene, assets.bvh,
                         {.animation = assets.animation, .scale = settings_.scene.lightScale});
        const ViewSet cpu = traceVpls(assets.bvh, emitters,
                                      {static_cast<std::uint64_t>(settings_.views.vpls),
                                       settings_.views.bounces, settings_.seed});
        std::uint64_t& different = m.result.viewsDiffering;
        different = differingViews(views_, cpu.views);
        if (static_cast<double>(different) > kOtherViews * static_cast<double>(views_.size()))
            fail("{} of {} views are not those of the CPU", different, views_.size());
    }

    void measureSetup(std::size_t i) {
        const Setup& setup = setups()[i];
        settings_.side[0].method = setup.method;
        settings_.side[0].rules = setup.rules;
        settings_.side[0].pairs.traversal = setup.traversal;
        if (setup.traversal == setups().front().traversal) traverseOnCpu(setup);
        if (i == 0) {
            settings_.picture.view = DebugView::final;
            render("full sum");
            m.final = radianceOf(renderer_);
        }
        settings_.picture.view = DebugView::indirect;
        const std::string name = nameOf(setup);
        render(name);
        const Picture picture = radianceOf(renderer_);
        compareWithCpu(name, picture);
        m.errors.push_back(differenceShare(picture, 1, exact_, open_));
        if (i == 0) m.result.leaked = leakedShare(picture);
    }

    // Tree, maps and picture of a method and its rules; both traversals make the same.
    void traverseOnCpu(const Setup& setup) {
        const ViewHierarchyOptions treeOptions = {settings_.views.octreeDepth, setup.rules,
                                                  setup.method == Method::manylods};
        const ViewHierarchy tree = ViewHierarchy::build(views_, treeOptions);
        nodes_ += tree.nodes.size();
        m.result.nodesDiffering += differingNodes(nodesOnGpu(views_, treeOptions), tree.nodes);
        const SceneAssets& assets = *input_.assets;
        cpu_ = traverse(assets.hierarchy.nodesUnder(setup.rules), tree, settings_.side[0]);
        GatherReferenceOptions options;
        options.clampDistance = clamp();
        options.worldEdge = static_cast<float>(assets.scene.root.edge);
        options.rules = setup.rules;
        options.bias = static_cast<float>(settings_.gather.bias);
        cpuPicture_ = lit(albedo_, gatherOnCpu(receivers_, tree, cpu_.leafMaps, options));
    }

    void compareWithCpu(const std::string& name, const Picture& picture) {
        Result& r = m.result;
        const PairCounts& pairs = statistics_.methods.front().pairs;
        r.pairsGpu += pairs.processed;
        r.pairsCpu += cpu_.counts.processed;
        if (!pairsAgree(pairs, cpu_.counts))
            fail("{}: {} pairs, CPU {}", name, pairs.processed, cpu_.counts.processed);
        const std::uint64_t texels = cpu_.leafMaps.texels.size();
        const std::uint64_t different =
            differingTexels(renderer_.readMaps().maps.texels, cpu_.leafMaps.texels);
        r.texels += texels;
        r.texelsDiffering += different;
        if (!texelsAgree(different, texels))
            fail("{}: {} of {} texels differ", name, different, texels);
        const double gap = differenceShare(picture, 1, cpuPicture_, open_);
        r.pictureGap = std::max(r.pictureGap, gap);
        if (!(gap <= kPictureGap))
            fail("{}: the GPU's picture is {:.2e} from the CPU's", name, gap);
    }

    double leakedShare(const Picture& picture) const {
        double leaked = 0;
        for (std::size_t k = 0; k < exact_.size(); ++k)
            for (int c = 0; c < 3; ++c)
                leaked += std::max(double{picture[k][c]} - double{exact_[k][c]}, 0.0);
        return leaked > 0 ? leaked / open_ : 0;
    }

    float clamp() const { return static_cast<float>(*settings_.gather.clampDistance); }

    FrameRenderer& renderer_;
    const Case& case_;
    const Input input_;
    Settings settings_;
    FrameInput frame_;
    FrameStatistics statistics_;  // of the last picture
    std::vector<Receiver> receivers_;
    std::vector<View> views_;
    Picture albedo_, exact_;
    double open_ = 0;  // light of all views if nothing stood between, summed over the picture
    std::uint64_t nodes_ = 0;
    TraversalResult cpu_;
    Picture cpuPicture_;
};

Runner::Measured Runner::measure(const Case& oneCase) {
    const auto start = std::chrono::steady_clock::now();
    Measurement measurement(renderer_, oneCase);
    measurement.measure();
    measurement.m.result.ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return std::move(measurement.m);
}

const Runner::Measured& Runner::measured(const Case& oneCase) {
    auto& kept = kept_[oneCase.name];
    if (!kept) kept = std::make_shared<const Measured>(measure(oneCase));
    return *kept;
}

Result Runner::run(const Case& oneCase) {
    const Measured& benign = measured(cases().front());
    const Measured& own = measured(oneCase);
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
