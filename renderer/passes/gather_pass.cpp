#include "renderer/passes/gather_pass.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/program.h"
#include "renderer/gl/vertex_array.h"
#include "renderer/gl/workarounds.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_views_pass.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

// The clamp's energy is measured on every 16th pixel each way.
constexpr int kMeasureStride = 16;

// Passes of the filter, each twice as wide as the one before: less where more samples leave less
// noise, and where upsampling smooths too. A full sum has no noise.
int filterPasses(const GatherOptions& options) {
    if (!options.filter || options.samples == 0) return 0;
    int passes = options.samples <= 16 ? 4 : options.samples <= 96 ? 3 : 2;
    if (options.samples > 512) passes = 1;
    return std::max(1, options.scale > 1 ? passes - 1 : passes);
}

// Texels of maps are fetched through a buffer texture where they fit one.
bool inStorage(const GpuViewMaps& maps) {
    if (!maps.present) return false;
    const auto bytes = static_cast<std::int64_t>(maps.texels.bytes());
    if (bytes / 4 <= gl::limits().maxTextureBufferTexels) return false;
    if (bytes > gl::limits().maxStorageBlockBytes) {
        throw Error(ExitCode::impossible,
                    "the view maps (" + std::to_string(bytes >> 20) +
                        " MiB) are larger than a storage block of this device");
    }
    return true;
}

// Where a sample's loops are long, under Workaround::loopLimit, a draw sums no more of a pixel's
// samples than its loops may take. What is left of its rounds goes to the search for samples and
// their runs.
constexpr std::uint32_t kLimitedRounds = 55000;
constexpr std::uint32_t kSearchRounds = 64;  // a sample

enum class Shader { gather, ask, measure, upsample, samples, upsampleSamples };

}  // namespace

struct GatherPass::Impl {
    GatherViewsPass viewsPass;
    GatherCullPass cullPass;
    explicit Impl(gl::Results results) : cullPass(results), asked("samples that asked", results) {}
    GatherViews views;
    GatherLists lists;
    GatherRecords records;  // of render()
    std::map<std::tuple<Shader, int, bool, std::string>, gl::Program> programs;
    std::array<gl::Program, 2> nearFieldPrograms;  // with alpha masks: the second
    gl::Program filter{"filter", {"passes/full_screen.vert", "passes/filter.frag"}};
    gl::Program accumulate{"accumulate",
                           {"passes/accumulate.comp"},
                           {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}}};
    gl::VertexArray empty{"gather: no attributes"};
    gl::Texture half, halfCandidates, ping, pong, measured, measuredCandidates;
    gl::Buffer roundsOverflow, askedCounts;
    gl::ReadBack asked;

    struct Inputs {
        const GBuffer& gbuffer;
        const RootCube& root;
        const GpuViewHierarchy& mapHierarchy;
        const GpuViewMaps& maps;
        const GatherRecords& records;
        const GatherOptions& options;
    };

    // A sample's loops are bounded, and so many samples at once as they allow.
    static bool isLimited(const Inputs& in) {
        return in.options.sample && in.options.sample->rounds > 0 &&
               (gl::isOn(gl::Workaround::loopLimit) || in.options.roundsAtOnce > 0);
    }
    gl::Program& program(Shader shader, const Inputs& in);
    gl::Program& bindSum(Shader shader, const Inputs& in);
    // That any pixel may sum, those gathered for themselves by upsample.glsl included.
    std::uint32_t mostSamples(const Inputs& in) const {
        if (in.options.samples == 0) return views.count;
        return std::min(views.count, static_cast<std::uint32_t>(std::max(in.options.samples, 16)));
    }
    void bindVisibility(gl::Program& program, const Inputs& in);
    // Calls run(k) for parts of the `most` samples that a pixel may have, from the k-th on, with
    // the uniforms that name the part. All at once where loops are short; with `draws` a part
    // after the first is added to that many of the render targets.
    template <typename Run>
    void inParts(gl::Program& program, const Inputs& in, std::uint32_t most, int draws,
                 const Run& run);
    void gather(const Inputs& in, Shader shader, int stride, gl::Texture& irradiance,
                gl::Texture& candidates);
    const gl::Texture& filtered(const Inputs& in, const gl::Texture& noisy, int passes,
                                gl::Texture* last);
    void upsample(const Inputs& in, const gl::Texture& filteredHalf, GatherResult& out);
    void measure(const Inputs& in, GatherResult& out);
    // What gather() does where samples may ask the scene.
    void ask(const Inputs& in, gl::Program& program, const gl::Texture& irradiance,
             const gl::Texture& candidates);

    void addNearField(const Inputs& in, const gl::Texture& irradiance);

    void bindGather(gl::Program& program);
    void bindUpsample(gl::Program& program, const Inputs& in);
    GatherHead recordSamples(const Inputs& in, Shader shader, glm::ivec2 pixel, float share,
                             std::vector<GatheredRecord>& out);
};

GatherPass::GatherPass(gl::Results results) : impl_(std::make_unique<Impl>(results)) {}
GatherPass::~GatherPass() = default;

gl::Program& GatherPass::Impl::program(Shader shader, const Inputs& in) {
    const auto& sample = in.options.sample;
    const bool decide = in.options.mapsDecide;
    const int kind = (sample && !decide) || !in.maps.present ? 0 : in.maps.fused ? 1 : 2;
    const bool storage = kind > 0 && inStorage(in.maps);
    const std::string visibility = sample     ? sample->file
                                   : kind > 0 ? "passes/visible_maps.glsl"
                                              : "passes/visible_all.glsl";
    std::string variant = visibility;
    for (const auto& [name, value] : sample ? sample->defines : gl::Defines{}) {
        variant.append(" ").append(name).append("=").append(value);
    }
    if (isLimited(in)) variant += " limited";
    if (decide) variant += " decide";
    gl::Program& program = programs[{shader, kind, storage, variant}];
    if (!program) {
        gl::Defines defines = {{"MV_VISIBILITY", '"' + visibility + '"'},
                               {"MAPS", std::to_string(kind)}};
        if (storage) defines.emplace_back("MAPS_IN_STORAGE", "1");
        if (sample) {
            defines.insert(defines.end(), sample->defines.begin(), sample->defines.end());
        }
        if (isLimited(in)) defines.emplace_back("MV_SAMPLE_ROUNDS", "1");
        if (decide) defines.emplace_back("MV_MAPS_DECIDE", "1");
        if (shader == Shader::measure) defines.emplace_back("MEASURE", "1");
        if (shader == Shader::upsampleSamples) defines.emplace_back("UPSAMPLE", "1");
        std::vector<std::string> files = {"passes/full_screen.vert", "passes/gather.frag"};
        if (shader == Shader::upsample) files[1] = "passes/upsample.frag";
        if (shader == Shader::samples || shader == Shader::upsampleSamples) {
            files = {"passes/gather_samples.comp"};
        }
        if (shader == Shader::ask) {
            const bool small = gl::limits().workGroupSize < 64;
            defines.emplace_back("MV_TILE_X", small ? "4" : "8");
            defines.emplace_back("MV_TILE_Y", small ? "2" : "8");
            files = {"passes/gather.comp"};
        }
        program = gl::Program("gather", files, defines);
    }
    return program;
}

// Everything that shaders/passes/gather_sum.glsl reads.
gl::Program& GatherPass::Impl::bindSum(Shader shader, const Inputs& in) {
    gl::Program& p = program(shader, in);
    in.records.records.bindTexels(kUnitGatherRecords);
    views.prefix.bindTexels(kUnitPowerPrefix);
    lists.lists.bindTexels(kUnitReceiverLists);
    lists.runs.bindTexels(kUnitRuns);
    lists.runWords.bind(kUnitRunWords);
    lists.guide.bindTexels(kUnitRunGuide);
    views.guide.bindTexels(kUnitViewGuide);
    views.clampDistances.bindTexels(kUnitClampDistances);
    p.set("viewSlotShift", views.slotShift);
    p.set("samples", static_cast<std::uint32_t>(in.options.samples));
    p.set("capacity", lists.capacity);
    p.set("seed", in.options.seed);
    p.set("accumulationIndex", in.options.accumulationIndex);
    p.set("cutoff", in.options.cutoff);
    p.set("inverseEdge2", static_cast<float>(1.0 / (in.root.edge * in.root.edge)));
    bindVisibility(p, in);
    return p;
}

template <typename Run>
void GatherPass::Impl::inParts(gl::Program& p, const Inputs& in, std::uint32_t most, int draws,
                               const Run& run) {
    if (!isLimited(in)) {
        p.set("firstSample", 0u);
        p.set("lastSample", kNone);
        run(0u);
        return;
    }
    const auto& sample = in.options.sample;
    const std::uint32_t rounds =
        in.options.roundsAtOnce > 0 ? in.options.roundsAtOnce : kLimitedRounds;
    // Anew each time: how a sum is cut decides its last bits.
    std::uint32_t part =
        std::max(rounds / (kSearchRounds + std::min(sample->rounds, rounds / 8)), 1u);
    const std::uint32_t zero = 0;
    while (true) {
        roundsOverflow.ensure("rounds overflow", 4);
        roundsOverflow.writeBytes(0, &zero, sizeof zero);
        roundsOverflow.bindStorage(kBlockRoundsOverflow);
        p.set("sampleRounds", std::max(rounds / part, kSearchRounds + 1) - kSearchRounds);
        for (std::uint32_t first = 0; first < std::max(most, 1u); first += part) {
            p.set("firstSample", first);
            p.set("lastSample", first + part);
            for (int i = 0; i < draws && first > 0; ++i) {
                glEnablei(GL_BLEND, static_cast<GLuint>(i));
                glBlendFuncSeparatei(static_cast<GLuint>(i), GL_ONE, GL_ONE, GL_ONE, GL_ZERO);
            }
            run(first);
        }
        for (int i = 0; i < draws; ++i) glDisablei(GL_BLEND, static_cast<GLuint>(i));
        gl::barrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        if (roundsOverflow.read<std::uint32_t>(0, 1)[0] == 0) return;
        if (part == 1) throw Error(ExitCode::impossible, sample->tooLong);
        part = std::max(part / 4, 1u);
    }
}

// What the file of MV_VISIBILITY reads.
void GatherPass::Impl::bindVisibility(gl::Program& p, const Inputs& in) {
    if (in.options.sample) in.options.sample->bind(p);
    if (in.maps.present && (!in.options.sample || in.options.mapsDecide)) {
        if (inStorage(in.maps)) {
            in.maps.texels.bindStorage(kBlockMaps);
        } else {
            in.maps.texels.bindTexels(kUnitMaps);
        }
        in.mapHierarchy.nodes.bindTexels(kUnitViewNodes);
        p.set("viewRes", static_cast<std::uint32_t>(in.maps.viewRes));
        if (!in.options.sample) {
            p.set("footprint", in.options.rules == Rules::corrected ? 1 : 0);
        }
        p.set("bias", in.options.bias);
    }
}

// What shaders/passes/gather_pixel.glsl reads beside the sum's inputs.
void GatherPass::Impl::bindGather(gl::Program& p) {
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    lists.receivers.bind(kUnitReceivers);
    lists.used.bindTexels(kUnitConesInUse);
    lists.firstReceiver.bindTexels(kUnitFirstReceiver);
    p.set("receiverCount", lists.receiverCount);
}

// What shaders/passes/upsample.glsl reads beside the sum's inputs, without the filtered light.
void GatherPass::Impl::bindUpsample(gl::Program& p, const Inputs& in) {
    lists.surfaces.bind(kUnitSurfaces);
    in.gbuffer.position.bind(kUnitPosition);
    in.gbuffer.normal.bind(kUnitNormal);
    half.bind(kUnitUnfilteredHalf);
    halfCandidates.bind(kUnitCandidatesHalf);
    p.set("scale", in.options.scale);
}

void GatherPass::Impl::gather(const Inputs& in, Shader shader, int stride, gl::Texture& irradiance,
                              gl::Texture& candidates) {
    const int width = (lists.surfaces.width() + stride - 1) / stride;
    const int height = (lists.surfaces.height() + stride - 1) / stride;
    irradiance.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    candidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RG32F, width, height);
    gl::Program& p = bindSum(shader, in);
    bindGather(p);
    p.set("viewCount", std::max(views.count, 1u));
    if (shader == Shader::ask) {
        ask(in, p, irradiance, candidates);
        return;
    }
    p.set("stride", stride);
    const gl::Framebuffer target("gather", {&irradiance, &candidates});
    target.bind();
    // Records, lists and maps come from compute passes, surfaces from image stores.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    inParts(p, in, mostSamples(in), 1, [&](std::uint32_t) {
        p.use();
        gl::drawFullScreen(empty);
    });
}

void GatherPass::Impl::ask(const Inputs& in, gl::Program& p, const gl::Texture& irradiance,
                           const gl::Texture& candidates) {
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    candidates.bindImage(kImageCandidates, GL_READ_WRITE, GL_RG32F);
    askedCounts.ensure("samples that asked", 8);
    askedCounts.bindStorage(kBlockAskedCounts);
    p.set("size", glm::ivec2(irradiance.width(), irradiance.height()));
    inParts(p, in, mostSamples(in), 0, [&](std::uint32_t first) {
        if (first == 0) askedCounts.fill(0);
        // Producers: records, lists and maps; surfaces; the part before.
        gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                    GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        p.dispatch2D(irradiance.width(), irradiance.height());
    });
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                GL_BUFFER_UPDATE_BARRIER_BIT);
    asked.request(askedCounts, 0, 8);
}

void GatherPass::Impl::addNearField(const Inputs& in, const gl::Texture& irradiance) {
    const BvhTables& triangles = *in.options.nearField;
    gl::Program& p = nearFieldPrograms[triangles.masks() ? 1 : 0];
    if (!p) {
        gl::Defines defines = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
                               {"MV_BVH_MASKS", triangles.masks() ? "1" : "0"}};
        if (gl::isOn(gl::Workaround::loopLimit)) {
            defines.emplace_back("MV_RAY_ROUNDS", std::to_string(kLimitedRounds / 8) + "u");
        }
        p = gl::Program("near field", {"passes/near_field.comp"}, defines);
    }
    triangles.bind(p);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    in.mapHierarchy.sortedViews.bindTexels(kUnitSortedViews);
    in.mapHierarchy.mortonKeys.bindTexels(kUnitViewKeys);
    views.clampDistances.bindTexels(kUnitClampDistances);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(irradiance.width(), irradiance.height()));
    p.set("viewCount", views.count);
    p.set("seed", in.options.seed);
    p.set("accumulationIndex", in.options.accumulationIndex);
    p.set("inverseEdge2", static_cast<float>(1.0 / (in.root.edge * in.root.edge)));
    // Producers: surfaces, views and the gather's draws or stores.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    p.dispatchInvocations(static_cast<std::uint64_t>(irradiance.width()) *
                          static_cast<std::uint64_t>(irradiance.height()));
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}

// Each pass across, then down: ping, pong, and the last into `last` if given. Returns what holds
// the result.
const gl::Texture& GatherPass::Impl::filtered(const Inputs& in, const gl::Texture& noisy,
                                              int passes, gl::Texture* last) {
    filter.set("scale", in.options.scale);
    const gl::Texture* source = &noisy;
    for (int i = 0; i < 2 * passes; ++i) {
        const bool across = i % 2 == 0;
        gl::Texture* target = across ? &ping : &pong;
        if (i + 1 == 2 * passes && last) target = last;
        target->ensure("filtered irradiance", GL_TEXTURE_2D, GL_RGBA32F, noisy.width(),
                       noisy.height());
        source->bind(kUnitFilterSource);
        lists.surfaces.bind(kUnitSurfaces);
        in.gbuffer.normal.bind(kUnitNormal);
        filter.set("spacing", across ? glm::ivec2(1 << i / 2, 0) : glm::ivec2(0, 1 << i / 2));
        filter.use();
        const gl::Framebuffer framebuffer("filter", {target});
        framebuffer.bind();
        gl::drawFullScreen(empty);
        source = target;
    }
    return *source;
}

void GatherPass::Impl::upsample(const Inputs& in, const gl::Texture& filteredHalf,
                                GatherResult& out) {
    gl::Program& p = bindSum(Shader::upsample, in);
    bindUpsample(p, in);
    filteredHalf.bind(kUnitFilteredHalf);
    const gl::Framebuffer target("upsample", {&out.irradiance, &out.unfiltered, &out.candidates});
    target.bind();
    inParts(p, in, mostSamples(in), 2, [&](std::uint32_t) {
        p.use();
        gl::drawFullScreen(empty);
    });
}

void GatherPass::Impl::measure(const Inputs& in, GatherResult& out) {
    gather(in, Shader::measure, kMeasureStride, measured, measuredCandidates);
    double clamped = 0, unclamped = 0;
    const std::vector<float> energy = measured.readFloats(4);
    for (std::size_t i = 0; i < energy.size(); i += 4) {
        clamped += double{energy[i]};
        unclamped += double{energy[i + 1]};
    }
    out.clampedEnergyShare = unclamped > 0 ? std::max(0.0, 1 - clamped / unclamped) : 0;

    // List 0 holds every view: it counts only where nothing else is in use.
    const std::vector<GatherList> all = lists.lists.read(0, lists.receiverCount);
    const std::uint32_t first = lists.receiverCount > 1 ? 1 : 0;
    double kept = 0;
    for (std::uint32_t r = first; r < lists.receiverCount; ++r) kept += all[r].views;
    out.receivers = lists.receiverCount - first;
    out.keptShare = kept / (static_cast<double>(views.count) * static_cast<double>(out.receivers));
}

void GatherPass::prepare(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                         const GpuViewHierarchy& cullTree, const GatherOptions& options,
                         gl::Profiler& profiler) {
    Impl& m = *impl_;
    if (cullTree.aliveCount == 0) return;
    const gl::PassScope scope(profiler, Stage::gatherCull);
    m.viewsPass.render(cullTree, options.clampDistance, m.views);
    m.cullPass.render(gbuffer, scene, cullTree, m.views,
                      {options.scale, options.cullLevel, options.cutoff}, m.lists);
}

bool GatherPass::listsFit() { return impl_->cullPass.fits(impl_->lists); }
bool GatherPass::listsUnderWay() const { return impl_->cullPass.underWay(); }

void GatherPass::record(const GpuViewHierarchy& mapHierarchy, const GpuViewMaps& maps,
                        gl::Profiler& profiler, GatherRecords& out) {
    if (mapHierarchy.aliveCount == 0) return;
    const gl::PassScope scope(profiler, Stage::gather);
    impl_->viewsPass.record(mapHierarchy, maps, impl_->views, out);
}

void GatherPass::gather(const GBuffer& gbuffer, const RootCube& root,
                        const GpuViewHierarchy& mapHierarchy, const GpuViewMaps& maps,
                        const GatherRecords& records, const GatherOptions& options,
                        gl::Profiler& profiler, GatherResult& out) {
    Impl& m = *impl_;
    assert(options.scale >= 1 && options.samples >= 0 && options.samples <= 65535);
    const int width = gbuffer.width, height = gbuffer.height;
    out.irradiance.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.unfiltered.ensure("unfiltered irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.candidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RG32F, width, height);
    if (mapHierarchy.aliveCount == 0) {
        for (const gl::Texture* t : {&out.irradiance, &out.unfiltered}) {
            glClearTexImage(t->id(), 0, GL_RGBA, GL_FLOAT, nullptr);
        }
        glClearTexImage(out.candidates.id(), 0, GL_RG, GL_FLOAT, nullptr);
        out.keptShare = out.clampedEnergyShare = 0;
        out.receivers = 0;
        return;
    }

    const Impl::Inputs in{gbuffer, root, mapHierarchy, maps, records, options};
    const bool whole = options.scale == 1;
    {
        const gl::PassScope scope(profiler, Stage::gather);
        m.gather(in, options.sample ? Shader::ask : Shader::gather, 1,
                 whole ? out.unfiltered : m.half, whole ? out.candidates : m.halfCandidates);
        if (!options.sample) out.undecidedShare = 0;
        while (options.sample && m.asked.requested()) {
            const auto counts = m.asked.take<std::uint32_t>();
            if (!counts) break;
            const double could = counts->at(0);
            out.undecidedShare = could > 0 ? counts->at(1) / could : 0;
        }
    }
    if (options.nearField) {
        const gl::PassScope scope(profiler, Stage::nearField);
        m.addNearField(in, whole ? out.unfiltered : m.half);
    }
    {
        const gl::PassScope scope(profiler, Stage::filter);
        const int passes = filterPasses(options);
        if (!whole) {
            m.upsample(in, m.filtered(in, m.half, passes, nullptr), out);
        } else if (passes > 0) {
            m.filtered(in, out.unfiltered, passes, &out.irradiance);
        } else {
            glCopyImageSubData(out.unfiltered.id(), GL_TEXTURE_2D, 0, 0, 0, 0, out.irradiance.id(),
                               GL_TEXTURE_2D, 0, 0, 0, 0, width, height, 1);
        }
    }
    if (options.measure) {
        const gl::PassScope scope(profiler, Stage::gatherMeasurements);
        m.measure(in, out);
    }
}

void GatherPass::render(const GBuffer& gbuffer, const RootCube& root,
                        const GpuSceneHierarchy& scene, const GpuViewHierarchy& cullTree,
                        const GpuViewHierarchy& mapHierarchy, const GpuViewMaps& maps,
                        const GatherOptions& options, gl::Profiler& profiler, GatherResult& out) {
    prepare(gbuffer, scene, cullTree, options, profiler);
    record(mapHierarchy, maps, profiler, impl_->records);
    gather(gbuffer, root, mapHierarchy, maps, impl_->records, options, profiler, out);
}

void GatherPass::accumulate(const gl::Texture& set, int sets, gl::Profiler& profiler,
                            gl::Texture& mean) {
    assert(sets >= 2 && mean.width() == set.width() && mean.height() == set.height());
    const gl::PassScope scope(profiler, Stage::accumulate);
    gl::Program& p = impl_->accumulate;
    set.bind(kUnitSampleSet);
    mean.bindImage(kImageMean, GL_READ_WRITE, GL_RGBA32F);
    p.set("size", glm::ivec2(mean.width(), mean.height()));
    p.set("sets", static_cast<float>(sets));
    // Producers: the accumulation before; draws into `set` are ordered without.
    gl::barrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
    p.dispatch2D(mean.width(), mean.height());
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // whoever composes reads it
}

// Runs the shader for one pixel and appends what it wrote down.
GatherHead GatherPass::Impl::recordSamples(const Inputs& in, Shader shader, glm::ivec2 pixel,
                                           float share, std::vector<GatheredRecord>& out) {
    gl::Program& p = bindSum(shader, in);
    if (shader == Shader::samples) {
        bindGather(p);
    } else {
        bindUpsample(p, in);
        half.bind(kUnitFilteredHalf);  // filtered light is not wanted
    }
    p.set("chosen", pixel);
    p.set("share", share / static_cast<float>(in.root.edge * in.root.edge));
    in.mapHierarchy.sortedViews.bindStorage(kBlockSortedViews);
    // As many as samples are asked for; a full sum has one for each view.
    std::uint32_t capacity = in.options.samples > 0
                                 ? static_cast<std::uint32_t>(std::max(in.options.samples, 64))
                                 : in.mapHierarchy.aliveCount;
    GatherHead head{};
    while (true) {
        const gl::Buffer recorded("gathered samples",
                                  sizeof(GatherHead) + capacity * sizeof(GatheredRecord));
        recorded.bindStorage(kBlockGatheredSamples);
        p.set("recordCapacity", capacity);
        inParts(p, in, mostSamples(in), 0, [&](std::uint32_t) {
            // Producers: the passes of prepare(), record() and gather(); the part before.
            gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
            p.dispatchInvocations(1);
        });
        gl::barrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        recorded.readBytes(0, &head, sizeof head);
        if (head.sampleCount > capacity) {  // runs may hold dark views beside those that count
            capacity = head.sampleCount;
            continue;
        }
        const std::size_t before = out.size();
        out.resize(before + head.sampleCount);
        if (head.sampleCount > 0) {
            recorded.readBytes(sizeof(GatherHead), out.data() + before,
                               head.sampleCount * sizeof(GatheredRecord));
        }
        return head;
    }
}

std::vector<GatheredSample> GatherPass::readSamples(const GBuffer& gbuffer, const RootCube& root,
                                                    const GpuViewHierarchy& mapHierarchy,
                                                    const GpuViewMaps& maps,
                                                    const GatherRecords& records,
                                                    const GatherOptions& options,
                                                    glm::ivec2 pixel) {
    Impl& m = *impl_;
    if (mapHierarchy.aliveCount == 0 || pixel.x < 0 || pixel.y < 0 || pixel.x >= gbuffer.width ||
        pixel.y >= gbuffer.height) {
        return {};
    }
    const Impl::Inputs in{gbuffer, root, mapHierarchy, maps, records, options};
    std::vector<GatheredRecord> recorded;
    if (options.scale == 1) {
        m.recordSamples(in, Shader::samples, pixel, 1, recorded);
    } else {
        const GatherHead head = m.recordSamples(in, Shader::upsampleSamples, pixel, 1, recorded);
        // Where no neighbour shares its surface, the pixel gathered for itself.
        const std::size_t taps = head.sampleCount > 0 ? 0 : head.tapCount;
        assert(taps <= kMaxTaps);
        for (std::size_t i = 0; i < taps; ++i) {
            const GatherTap& tap = head.taps[i];
            m.recordSamples(in, Shader::samples, {tap.x, tap.y}, tap.weight / head.weight,
                            recorded);
        }
    }

    std::map<std::uint32_t, GatheredSample> bySlot;
    for (const GatheredRecord& r : recorded) {
        GatheredSample& s = bySlot[r.slot];
        s.slot = r.slot;
        s.position = {r.positionX, r.positionY, r.positionZ};
        s.unoccluded += glm::vec3(r.r, r.g, r.b);
        if (r.visible) s.irradiance += glm::vec3(r.r, r.g, r.b);
        ++s.samples;
        s.visible += r.visible;
    }
    std::vector<GatheredSample> out;
    for (const auto& [slot, sample] : bySlot) out.push_back(sample);
    std::stable_sort(out.begin(), out.end(), [](const GatheredSample& a, const GatheredSample& b) {
        return luminance(a.unoccluded) > luminance(b.unoccluded);
    });
    return out;
}

std::uint64_t GatherPass::bytes() const {
    const Impl& m = *impl_;
    std::uint64_t sum = m.views.bytes() + m.lists.bytes() + m.records.records.bytes();
    for (const gl::Texture* t :
         {&m.half, &m.halfCandidates, &m.ping, &m.pong, &m.measured, &m.measuredCandidates}) {
        sum += t->bytes();
    }
    return sum;
}

}  // namespace mv
