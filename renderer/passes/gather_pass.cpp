#include "renderer/passes/gather_pass.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
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
#include "renderer/passes/filter_pass.h"
#include "renderer/passes/gather_cull_pass.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/near_field_pass.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

// The clamp's energy is measured on every 16th pixel each way.
constexpr int kMeasureStride = 16;

// Passes of the filter, each twice as wide as the one before: less where more samples leave less
// noise, and where upsampling smooths too; more on larger pictures, whose pixels are smaller on the
// surfaces, so that it reaches as far on them. Of sets that are averaged, one less each time their
// number has doubled: the mean has less noise with each, and would keep the first one's blur. A
// full sum has no noise.
constexpr int kFilterRows = 270;  // of a picture with no more than those of its samples
int filterPasses(const GatherOptions& options, int rows) {
    if (!options.filter || options.samples == 0) return 0;
    int passes = options.samples <= 16 ? 5 : options.samples <= 96 ? 4 : 3;
    if (options.samples > 512) passes = 2;
    passes -= std::bit_width(static_cast<unsigned>(options.set)) - 1;
    const double larger = std::log2(std::max(1.0, static_cast<double>(rows) / kFilterRows));
    return std::max(1, passes + static_cast<int>(std::lround(larger)) - (options.cull.scale > 1));
}

// Pixels of the gather that one work group serves: a tile, or a part of one.
glm::ivec2 groupSize() {
    const int edge = static_cast<int>(kTileEdge);
    return gl::limits().workGroupSize < 64 ? glm::ivec2(4, 2) : glm::ivec2(edge, edge);
}

// So many rows of pixels are gathered at once where somebody watches.
constexpr std::uint32_t kSliceRows = 4 * kTileEdge;

// Where a sample's loops are long, under Workaround::loopLimit, a draw sums no more of a pixel's
// samples than its loops may take. What is left of its rounds goes to the search for samples and
// their runs.
constexpr std::uint32_t kLimitedRounds = 55000;
constexpr std::uint32_t kSearchRounds = 64;  // a sample

// Views that the tiles draw are kept for so many tiles and samples at once: 128 MiB.
constexpr std::uint64_t kMaxDraws = 1u << 24;

enum class Shader { gather, measure, upsample, samples, upsampleSamples };

// What a dispatch of the gather covers: all pixels, or for their samples those around one.
struct Area {
    glm::ivec2 origin{0}, size{0};
    std::uint32_t firstTile = 0, tiles = 0;  // of kTileEdge pixels
};

// The same area, that of a picture, in bands of whole tiles.
std::vector<Area> slicesOf(const Area& area) {
    std::vector<Area> slices;
    const auto height = static_cast<std::uint32_t>(area.size.y);
    const std::uint32_t tilesAcross = area.tiles / ((height + kTileEdge - 1) / kTileEdge);
    for (std::uint32_t row = 0; row < height; row += kSliceRows) {
        const std::uint32_t rows = std::min(kSliceRows, height - row);
        slices.push_back({area.origin + glm::ivec2(0, row),
                          {area.size.x, rows},
                          area.firstTile + row / kTileEdge * tilesAcross,
                          (rows + kTileEdge - 1) / kTileEdge * tilesAcross});
    }
    return slices;
}

}  // namespace

struct GatherPass::Impl {
    GatherViewsPass viewsPass;
    GatherCullPass cullPass;
    explicit Impl(gl::Results results) : asked("samples that asked", results) {
        draw = gl::Program("gather draw", {"passes/gather_draw.comp"},
                           {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}});
    }
    GatherViews views;
    GatherLists lists;
    GatherRecords records;  // of render()
    std::map<std::tuple<Shader, int, bool, std::string>, gl::Program> programs;
    NearFieldPass nearField;
    SkyPass sky;
    HistoryPass history;
    FilterPass filter;
    gl::Program draw;
    gl::Program accumulate{"accumulate",
                           {"passes/accumulate.comp"},
                           {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}}};
    gl::VertexArray empty{"gather: no attributes"};
    gl::Texture half, halfCandidates, measured;
    gl::Buffer roundsOverflow, askedCounts;
    gl::TexelBuffer<glm::uvec2> draws;  // GatherDraw
    gl::ReadBack asked;

    struct Inputs {
        const GBuffer& gbuffer;
        const RootCube& root;
        const GpuViewHierarchy& mapHierarchy;
        const GpuViewMaps& maps;
        const GatherRecords& records;
        const GatherOptions& options;
        gl::Profiler* profiler = nullptr;  // of a picture, which may be watched
    };

    // A sample's loops are bounded, and so many samples at once as they allow.
    static bool isLimited(const Inputs& in) {
        return in.options.sample && in.options.sample->rounds > 0 &&
               (gl::isOn(gl::Workaround::loopLimit) || in.options.roundsAtOnce > 0);
    }
    gl::Program& program(Shader shader, const Inputs& in);
    void bindLists(gl::Program& program, const Inputs& in);
    gl::Program& bindSum(Shader shader, const Inputs& in);
    // That any pixel may sum, those gathered for themselves by upsample.glsl included.
    std::uint32_t mostSamples(const Inputs& in) const {
        if (in.options.samples == 0) return views.count;
        return std::min(views.count, static_cast<std::uint32_t>(std::max(in.options.samples, 16)));
    }
    void bindVisibility(gl::Program& program, const Inputs& in);
    // Calls run(k, n) for parts of the `most` samples that a pixel may have, n from the k-th on,
    // with the uniforms that name the part: as many at once as mostAtOnce and the loops allow. A
    // part after the first is added to the first `targets` render targets.
    template <typename Run>
    void inParts(gl::Program& program, const Inputs& in, std::uint32_t most,
                 std::uint32_t mostAtOnce, int targets, const Run& run);
    gl::Program& bindGather(Shader shader, const Inputs& in);
    // Draws views for the area's tiles, then runs the gather's program over it.
    void runGather(gl::Program& program, const Inputs& in, const Area& area);
    std::uint32_t drawTilesAcross() const {
        return (static_cast<std::uint32_t>(lists.surfaces.width()) + kTileEdge - 1) / kTileEdge;
    }
    void gather(const Inputs& in, const gl::Texture& irradiance, const gl::Texture& candidates);
    void upsample(const Inputs& in, const gl::Texture& filteredHalf, const gl::Texture& irradiance,
                  const GatherResult& out);
    // light: of the gather's pixels -> filtered, of the picture's; and at a scale above 1 the rest
    // of `out`.
    void smooth(const Inputs& in, const gl::Texture& light, gl::Texture& filtered,
                const GatherResult& out);
    void measure(const Inputs& in, GatherResult& out);

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
    const bool quads = kind > 0 && in.maps.inQuads;
    const std::string visibility = sample     ? sample->file
                                   : kind > 0 ? "passes/visible_maps.glsl"
                                              : "passes/visible_all.glsl";
    std::string variant = visibility;
    for (const auto& [name, value] : sample ? sample->defines : gl::Defines{}) {
        variant.append(" ").append(name).append("=").append(value);
    }
    if (isLimited(in)) variant += " limited";
    if (decide) variant += " decide";
    const int gloss = in.gbuffer.glossKind();
    if (gloss > 0) variant += gloss > 1 ? " coat" : " gloss";
    if (in.options.seenShares) variant += " seen";
    gl::Program& program = programs[{shader, kind, quads, variant}];
    if (!program) {
        gl::Defines defines = {{"MV_VISIBILITY", '"' + visibility + '"'},
                               {"MAPS", std::to_string(kind)}};
        if (quads) defines.emplace_back("MAPS_IN_QUADS", "1");
        if (sample) {
            defines.insert(defines.end(), sample->defines.begin(), sample->defines.end());
        }
        if (isLimited(in)) defines.emplace_back("MV_SAMPLE_ROUNDS", "1");
        if (decide) defines.emplace_back("MV_MAPS_DECIDE", "1");
        in.gbuffer.addGlossDefines(defines);
        if (in.options.seenShares) defines.emplace_back("MV_SEEN_SHARES", "1");
        if (shader == Shader::measure) defines.emplace_back("MEASURE", "1");
        std::vector<std::string> files = {"passes/full_screen.vert", "passes/gather_measure.frag"};
        if (shader == Shader::upsample) files[1] = "passes/upsample.frag";
        if (shader == Shader::upsampleSamples) files = {"passes/upsample_samples.comp"};
        if (shader == Shader::gather || shader == Shader::samples) {
            const glm::ivec2 group = groupSize();
            defines.emplace_back("MV_TILE_X", std::to_string(group.x));
            defines.emplace_back("MV_TILE_Y", std::to_string(group.y));
            if (sample) defines.emplace_back("ASK", "1");
            if (shader == Shader::samples) defines.emplace_back("SAMPLES", "1");
            files = {"passes/gather.comp"};
        }
        program = gl::Program("gather", files, defines);
    }
    return program;
}

// What shaders/passes/gather_lists.glsl reads, and what numbers the samples.
void GatherPass::Impl::bindLists(gl::Program& p, const Inputs& in) {
    views.prefix.bindTexels(kUnitPowerPrefix);
    views.guide.bindTexels(kUnitViewGuide);
    lists.lists.bindTexels(kUnitReceiverLists);
    lists.runs.bindTexels(kUnitRuns);
    lists.runWords.bind(kUnitRunWords);
    lists.guide.bindTexels(kUnitRunGuide);
    p.set("viewSlotShift", views.slotShift);
    p.set("capacity", lists.capacity);
    p.set("tilesAcross", lists.tilesAcross);
    p.set("tileShift", lists.tileShift);
    p.set("samples", static_cast<std::uint32_t>(in.options.samples));
    p.set("seed", in.options.seed);
    p.set("accumulationIndex", in.options.accumulationIndex);
}

// Everything that shaders/passes/gather_sum.glsl reads.
gl::Program& GatherPass::Impl::bindSum(Shader shader, const Inputs& in) {
    gl::Program& p = program(shader, in);
    in.records.records.bindTexels(kUnitGatherRecords);
    bindLists(p, in);
    p.set("cutoff", static_cast<float>(in.options.cull.cutoff));
    p.set("inverseEdge2", static_cast<float>(1.0 / (in.root.edge * in.root.edge)));
    if (in.gbuffer.glossKind() > 0) {
        in.gbuffer.bindGloss(p);
        p.set("scale", in.options.cull.scale);
    }
    bindVisibility(p, in);
    return p;
}

template <typename Run>
void GatherPass::Impl::inParts(gl::Program& p, const Inputs& in, std::uint32_t most,
                               std::uint32_t mostAtOnce, int targets, const Run& run) {
    const bool limited = isLimited(in);
    const auto& sample = in.options.sample;
    const std::uint32_t rounds =
        in.options.roundsAtOnce > 0 ? in.options.roundsAtOnce : kLimitedRounds;
    most = std::max(most, 1u);
    // Anew each time: how a sum is cut decides its last bits.
    std::uint32_t part = std::min(most, mostAtOnce);
    if (limited) {
        const std::uint32_t each = kSearchRounds + std::min(sample->rounds, rounds / 8);
        part = std::min(part, std::max(rounds / each, 1u));
    }
    const std::uint32_t zero = 0;
    while (true) {
        if (limited) {
            roundsOverflow.ensure("rounds overflow", 4);
            roundsOverflow.writeBytes(0, &zero, sizeof zero);
            roundsOverflow.bindStorage(kBlockRoundsOverflow);
            p.set("sampleRounds", std::max(rounds / part, kSearchRounds + 1) - kSearchRounds);
        }
        for (std::uint32_t first = 0; first < most; first += part) {
            p.set("firstSample", first);
            p.set("lastSample", first + part);
            for (int i = 0; i < targets && first > 0; ++i) {
                glEnablei(GL_BLEND, static_cast<GLuint>(i));
                glBlendFuncSeparatei(static_cast<GLuint>(i), GL_ONE, GL_ONE, GL_ONE, GL_ZERO);
            }
            run(first, std::min(part, most - first));
        }
        for (int i = 0; i < targets; ++i) glDisablei(GL_BLEND, static_cast<GLuint>(i));
        if (!limited) return;
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
        if (in.maps.inQuads) {
            in.maps.texels.bindQuads(kUnitMaps);
        } else {
            in.maps.texels.bindTexels(kUnitMaps);
        }
        in.mapHierarchy.nodes.bindTexels(kUnitViewNodes);
        p.set("viewRes", static_cast<std::uint32_t>(in.maps.viewRes));
        if (!in.options.sample) {
            p.set("footprint", in.options.rules == Rules::corrected ? 1 : 0);
        }
        p.set("bias", static_cast<float>(in.options.bias));
    }
}

// Everything that shaders/passes/gather.comp reads, but its draws.
gl::Program& GatherPass::Impl::bindGather(Shader shader, const Inputs& in) {
    gl::Program& p = bindSum(shader, in);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    if (in.options.seenShares) in.options.seenShares->bind(kUnitReflectionWeight);
    p.set("candidates", static_cast<std::uint32_t>(in.options.candidates));
    if (in.options.mapsDecide) p.set("mapCheck", static_cast<float>(in.options.mapCheck));
    p.set("drawTilesAcross", drawTilesAcross());
    p.set("viewCount", std::max(views.count, 1u));
    p.set("size", glm::ivec2(lists.surfaces.width(), lists.surfaces.height()));
    return p;
}

void GatherPass::Impl::runGather(gl::Program& p, const Inputs& in, const Area& area) {
    bindLists(draw, in);
    draw.set("drawTilesAcross", drawTilesAcross());
    const bool watched = in.profiler && in.profiler->watched();
    const std::uint64_t each = std::uint64_t{area.tiles} * kTileParts * kDrawRanks;  // a sample
    const auto atOnce = static_cast<std::uint32_t>(std::max<std::uint64_t>(kMaxDraws / each, 1));
    // A full sum draws nothing; its parts are views.
    const bool drawn = in.options.samples > 0;
    const auto samples = static_cast<std::uint32_t>(in.options.samples);
    const std::uint32_t most = drawn ? std::min(views.count, samples) : views.count;
    inParts(p, in, most, drawn ? atOnce : kNone, 0, [&](std::uint32_t first, std::uint32_t count) {
        const std::uint64_t wanted = drawn ? each * count : 1;
        draws.ensure("gather draws", wanted);
        draws.bindTexels(kUnitDraws);
        if (first == 0 && askedCounts) askedCounts.fill(0);
        for (const Area& slice : watched ? slicesOf(area) : std::vector{area}) {
            if (drawn) {
                draws.bindStorage(kBlockDraws);
                draw.set("firstDrawTile", slice.firstTile);
                draw.set("drawTiles", slice.tiles);
                draw.set("firstSample", first);
                draw.set("sampleCount", count);
                // Producers: the lists; readers of the part or slice before.
                gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
                draw.dispatchInvocations(wanted / area.tiles * slice.tiles);
            }
            p.set("firstDrawTile", slice.firstTile);
            p.set("origin", slice.origin);
            p.set("sampleCount", count);
            // Producers: draws, records, lists and maps; surfaces; the part before.
            gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
            p.dispatch2D(slice.size.x, slice.size.y);
            if (!watched) continue;
            const double rows = slice.origin.y + slice.size.y;
            in.profiler->report(Stage::gather, (first + count * rows / area.size.y) / most);
        }
    });
}

void GatherPass::Impl::gather(const Inputs& in, const gl::Texture& irradiance,
                              const gl::Texture& candidates) {
    gl::Program& p = bindGather(Shader::gather, in);
    irradiance.bindImage(kImageIrradiance, GL_READ_WRITE, GL_RGBA32F);
    candidates.bindImage(kImageCandidates, GL_READ_WRITE, GL_RG32F);
    askedCounts.ensure("samples that asked", 8);
    askedCounts.bindStorage(kBlockAskedCounts);
    const glm::ivec2 size(lists.surfaces.width(), lists.surfaces.height());
    const auto rows = (static_cast<std::uint32_t>(size.y) + kTileEdge - 1) / kTileEdge;
    runGather(p, in, {{0, 0}, size, 0, rows * drawTilesAcross()});
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                GL_BUFFER_UPDATE_BARRIER_BIT);
    if (in.options.sample) asked.request(askedCounts, 0, 8);
}

// What shaders/passes/upsample.glsl reads beside the sum's inputs, without the filtered light.
void GatherPass::Impl::bindUpsample(gl::Program& p, const Inputs& in) {
    lists.surfaces.bind(kUnitSurfaces);
    in.gbuffer.position.bind(kUnitPosition);
    in.gbuffer.normal.bind(kUnitNormal);
    half.bind(kUnitUnfilteredHalf);
    halfCandidates.bind(kUnitCandidatesHalf);
    p.set("scale", in.options.cull.scale);
    p.set("pixelSize", in.gbuffer.pixelSize);
}

void GatherPass::Impl::upsample(const Inputs& in, const gl::Texture& filteredHalf,
                                const gl::Texture& irradiance, const GatherResult& out) {
    gl::Program& p = bindSum(Shader::upsample, in);
    bindUpsample(p, in);
    filteredHalf.bind(kUnitFilteredHalf);
    const gl::Framebuffer target("upsample", {&irradiance, &out.unfiltered, &out.candidates});
    target.bind();
    inParts(p, in, mostSamples(in), kNone, 2, [&](std::uint32_t, std::uint32_t) {
        p.use();
        gl::drawFullScreen(empty);
    });
}

void GatherPass::Impl::smooth(const Inputs& in, const gl::Texture& light, gl::Texture& filtered,
                              const GatherResult& out) {
    const GBuffer& g = in.gbuffer;
    const int passes = filterPasses(in.options, g.height);
    filtered.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, g.width, g.height);
    if (in.options.cull.scale > 1) {
        const gl::Texture& small =
            filter.render(g, lists.surfaces, in.options.cull.scale, light, passes, nullptr);
        upsample(in, small, filtered, out);
        if (in.options.sky.sky) {
            sky.renderAlone(in.options.sky, g, in.options.seed, in.options.accumulationIndex,
                            *in.profiler, filtered, out.unfiltered);
        }
    } else if (passes > 0) {
        filter.render(g, lists.surfaces, 1, light, passes, &filtered);
    } else {
        glCopyImageSubData(light.id(), GL_TEXTURE_2D, 0, 0, 0, 0, filtered.id(), GL_TEXTURE_2D, 0,
                           0, 0, 0, g.width, g.height, 1);
    }
}

void GatherPass::Impl::measure(const Inputs& in, GatherResult& out) {
    gl::Program& p = bindSum(Shader::measure, in);
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    p.set("stride", kMeasureStride);
    const auto of = [](int pixels) { return (pixels + kMeasureStride - 1) / kMeasureStride; };
    measured.ensure("clamped energy", GL_TEXTURE_2D, GL_RGBA32F, of(lists.surfaces.width()),
                    of(lists.surfaces.height()));
    const gl::Framebuffer target("clamped energy", {&measured});
    target.bind();
    inParts(p, in, mostSamples(in), kNone, 1, [&](std::uint32_t, std::uint32_t) {
        p.use();
        gl::drawFullScreen(empty);
    });
    double clamped = 0, unclamped = 0;
    const std::vector<float> energy = measured.readFloats(4);
    for (std::size_t i = 0; i < energy.size(); i += 4) {
        clamped += double{energy[i]};
        unclamped += double{energy[i + 1]};
    }
    out.clampedEnergyShare = unclamped > 0 ? std::max(0.0, 1 - clamped / unclamped) : 0;

    out.keptShare = 1;
    out.receivers = 1;
    if (lists.tilesAcross == 0) return;
    const std::uint32_t tiles = lists.receiverCount - 1;
    const std::vector<GatherList> all = lists.lists.read(1, tiles);
    const std::vector<GatherTile> shown = lists.tiles.read(0, tiles);
    double kept = 0, pixels = 0;
    out.receivers = 0;
    for (std::uint32_t t = 0; t < tiles; ++t) {
        kept += 1.0 * all[t].views * shown[t].pixels;
        pixels += shown[t].pixels;
        out.receivers += shown[t].pixels > 0;
    }
    out.keptShare = pixels > 0 ? kept / (views.count * pixels) : 0;
}

void GatherPass::prepare(const GBuffer& gbuffer, const GpuViewHierarchy& cullTree,
                         const GatherOptions& options, gl::Profiler& profiler) {
    Impl& m = *impl_;
    if (cullTree.aliveCount == 0) return;
    const gl::PassScope scope(profiler, Stage::gatherCull);
    m.viewsPass.render(cullTree, options.clampDistance, m.views);
    m.cullPass.render(gbuffer, cullTree, m.views, {options.cull}, m.lists);
}

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
    assert(options.cull.scale >= 1 && options.samples >= 0 && options.samples <= 65535);
    const int width = gbuffer.width, height = gbuffer.height;
    out.irradiance.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.unfiltered.ensure("unfiltered irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
    out.candidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RG32F, width, height);
    if (mapHierarchy.aliveCount == 0) {
        out.remembered.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        for (const gl::Texture* t : {&out.irradiance, &out.unfiltered, &out.remembered}) {
            glClearTexImage(t->id(), 0, GL_RGBA, GL_FLOAT, nullptr);
        }
        glClearTexImage(out.candidates.id(), 0, GL_RG, GL_FLOAT, nullptr);
        out.keptShare = out.clampedEnergyShare = 0;
        out.receivers = 0;
        return;
    }

    const Impl::Inputs in{gbuffer, root, mapHierarchy, maps, records, options, &profiler};
    const bool whole = options.cull.scale == 1;
    {
        const gl::PassScope scope(profiler, Stage::gather);
        if (!whole) {
            const int w = m.lists.surfaces.width(), h = m.lists.surfaces.height();
            m.half.ensure("irradiance", GL_TEXTURE_2D, GL_RGBA32F, w, h);
            m.halfCandidates.ensure("gather candidates", GL_TEXTURE_2D, GL_RG32F, w, h);
        }
        m.gather(in, whole ? out.unfiltered : m.half, whole ? out.candidates : m.halfCandidates);
        if (!options.sample) out.undecidedShare = 0;
        while (options.sample && m.asked.requested()) {
            const auto counts = m.asked.take<std::uint32_t>();
            if (!counts) break;
            const double could = counts->at(0);
            out.undecidedShare = could > 0 ? counts->at(1) / could : 0;
        }
    }
    if (options.nearFieldScene) {
        const gl::PassScope scope(profiler, Stage::nearField);
        m.nearField.render(*options.nearFieldScene, mapHierarchy, m.views, m.lists, root.edge,
                           options.seed, options.accumulationIndex,
                           whole ? out.unfiltered : m.half);
    }
    const gl::Texture& own = whole ? out.unfiltered : m.half;
    if (options.sky.sky) {
        const gl::PassScope scope(profiler, Stage::skyLight);
        m.sky.render(options.sky, gbuffer, m.lists, options.seed, options.accumulationIndex,
                     profiler, own);
    }
    const LightHistory* remembered = nullptr;
    if (options.past.history && options.samples > 0) {
        const gl::PassScope scope(profiler, Stage::history);
        m.history.render(gbuffer, m.lists.surfaces, options.cull.scale, own, options.samples,
                         options.past);
        remembered = options.past.history;
    }
    {
        const gl::PassScope scope(profiler, Stage::filter);
        if (!remembered || options.past.beside) m.smooth(in, own, out.irradiance, out);
        if (remembered) {
            m.smooth(in, remembered->light, options.past.beside ? out.remembered : out.irradiance,
                     out);
        }
    }
    if (options.measure) {
        const gl::PassScope scope(profiler, Stage::gatherMeasurements);
        m.measure(in, out);
    }
}

void GatherPass::render(const GBuffer& gbuffer, const RootCube& root,
                        const GpuViewHierarchy& cullTree, const GpuViewHierarchy& mapHierarchy,
                        const GpuViewMaps& maps, const GatherOptions& options,
                        gl::Profiler& profiler, GatherResult& out) {
    prepare(gbuffer, cullTree, options, profiler);
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
    const bool upsampled = shader == Shader::upsampleSamples;
    gl::Program& p = upsampled ? bindSum(shader, in) : bindGather(shader, in);
    const glm::ivec2 group = groupSize();
    const auto tile = glm::uvec2(pixel) / kTileEdge;
    const Area area{pixel / group * group, group, tile.y * drawTilesAcross() + tile.x, 1};
    if (upsampled) {
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
        if (upsampled) {
            inParts(p, in, mostSamples(in), kNone, 0, [&](std::uint32_t, std::uint32_t) {
                // Producers: the passes of prepare(), record() and gather(); the part before.
                gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
                p.dispatchInvocations(1);
            });
        } else {
            runGather(p, in, area);
        }
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
    if (options.cull.scale == 1) {
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
    std::uint64_t sum = m.views.bytes() + m.lists.bytes() + m.records.records.bytes() +
                        m.draws.bytes() + m.history.bytes() + m.filter.bytes();
    for (const gl::Texture* t : {&m.half, &m.halfCandidates, &m.measured}) {
        sum += t->bytes();
    }
    return sum;
}

}  // namespace mv
