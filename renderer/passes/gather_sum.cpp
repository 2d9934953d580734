#include "renderer/passes/gather_sum.h"

#include <algorithm>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/workarounds.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/map_verdict.glsl"

namespace mv {
namespace {

// Scales up to this gather a pixel for itself where none of the gather's shares its surface; at
// larger ones there are too many, and it takes the light of what is near.
constexpr int kLargestWithAlone = 2;

// Pixels of the gather that one work group serves: a tile, or a part of one.
glm::ivec2 groupSize() {
    const int edge = static_cast<int>(kTileEdge);
    return gl::limits().workGroupSize < 64 ? glm::ivec2(4, 2) : glm::ivec2(edge, edge);
}

// So many rows of tiles are gathered at once where somebody watches.
constexpr std::uint32_t kWatchedRows = 4;

// Where a sample's loops are long, under Workaround::loopLimit, a draw sums no more of a pixel's
// samples than its loops may take. What is left of its rounds goes to the search for samples and
// their runs.
constexpr std::uint32_t kLimitedRounds = 55000;
constexpr std::uint32_t kSearchRounds = 64;  // a candidate that is not drawn yet

// Views that tiles draw are kept for so many tiles and samples at once, 128 MiB, or for a row of
// tiles and those samples that are resampled together.
constexpr std::uint64_t kMaxDraws = 1u << 24;

// Answers of slices are kept in a storage block, for each group of candidates of a sample, or for
// each view of a full sum.
std::uint32_t verdictWords(const GatherCall& in, std::uint32_t views) {
    const std::uint32_t verdicts =
        in.options.samples > 0 ? static_cast<std::uint32_t>(in.options.samples) * kCandidateGroups
                               : views;
    return (verdicts + kVerdictsInWord - 1) / kVerdictsInWord;
}

// It draws for whole tiles, a work group each.
bool isOfTiles(GatherShader shader) {
    return shader == GatherShader::gather || shader == GatherShader::samples ||
           shader == GatherShader::verdicts;
}

// Other shaders ask rays of all samples where maps are there slice by slice; further looks
// always do.
bool readsMaps(GatherShader shader, const GatherCall& in) {
    if (!in.maps.present || (in.options.sample && in.options.sampleAsked == SampleAsked::always))
        return false;
    if (shader == GatherShader::again) return false;
    return in.maps.slices.empty() || isOfTiles(shader);
}

bool mapsDecide(GatherShader shader, const GatherCall& in) {
    return in.options.sampleAsked == SampleAsked::inDoubt && readsMaps(shader, in);
}

// How the shader asks the scene; null: it does not.
const SampleVisibility* sampleOf(GatherShader shader, const GatherCall& in) {
    const bool maps = in.options.sampleAsked == SampleAsked::withoutMaps && readsMaps(shader, in);
    return in.options.sample && !maps ? &*in.options.sample : nullptr;
}

std::uint32_t tilesAcross(const GatherArea& area) {
    return area.tiles / ((static_cast<std::uint32_t>(area.size.y) + kTileEdge - 1) / kTileEdge);
}

// The same area in bands of so many rows of tiles.
std::vector<GatherArea> slicesOf(const GatherArea& area, std::uint32_t tileRows) {
    std::vector<GatherArea> slices;
    const auto height = static_cast<std::uint32_t>(area.size.y);
    for (std::uint32_t row = 0; row < height; row += tileRows * kTileEdge) {
        const std::uint32_t rows = std::min(tileRows * kTileEdge, height - row);
        slices.push_back({area.origin + glm::ivec2(0, row),
                          {area.size.x, rows},
                          area.firstTile + row / kTileEdge * tilesAcross(area),
                          (rows + kTileEdge - 1) / kTileEdge * tilesAcross(area)});
    }
    return slices;
}

// A sample's loops are bounded, and so many samples at once as they allow.
bool isLimited(GatherShader shader, const GatherCall& in) {
    const SampleVisibility* sample = sampleOf(shader, in);
    return sample && sample->rounds > 0 &&
           (gl::isOn(gl::Workaround::loopLimit) || in.options.roundsAtOnce > 0);
}

// It serves pixels of a list.
bool isListed(GatherShader shader) {
    return shader == GatherShader::alone || shader == GatherShader::again;
}

// Views that a pixel searches for itself, for each of its samples.
std::uint32_t searchesOf(GatherShader shader) {
    return isListed(shader) || shader == GatherShader::upsampleSamples ? kOwnCandidates : 1;
}

// Upper bound on the samples any pixel sums in this shader, including the extra ones of
// gather_alone.glsl.
std::uint32_t mostSamples(GatherShader shader, const GatherCall& in, std::uint32_t views) {
    if (in.options.samples == 0) return views;
    auto samples = std::max(static_cast<std::uint32_t>(in.options.samples), kAloneSamples);
    if (shader == GatherShader::again) samples *= kAllLooksSamples;
    return std::min(views, samples);
}

std::vector<std::string> filesOf(GatherShader shader) {
    if (isOfTiles(shader)) return {"passes/gather.comp"};
    if (shader == GatherShader::alone) return {"passes/gather_alone.comp"};
    if (shader == GatherShader::again) return {"passes/gather_again.comp"};
    if (shader == GatherShader::upsampleSamples) return {"passes/upsample_samples.comp"};
    return {"passes/full_screen.vert", "passes/gather_measure.frag"};
}

// Which variant of the shader answers for the method and its maps.
gl::Defines definesOf(GatherShader shader, const GatherCall& in) {
    const SampleVisibility* sample = sampleOf(shader, in);
    const bool maps = readsMaps(shader, in);
    const int kind = !maps ? 0 : in.maps.fused ? 1 : 2;
    const int verdicts = in.maps.slices.empty() || !maps    ? 0
                         : shader == GatherShader::verdicts ? 1
                                                            : 2;
    // What slices knew is all that is known where they alone answer.
    const std::string visibility = sample                     ? sample->file
                                   : kind > 0 && verdicts < 2 ? "passes/visible_maps.glsl"
                                                              : "passes/visible_all.glsl";
    gl::Defines defines = {{"MV_VISIBILITY", '"' + visibility + '"'},
                           {"MV_MAP_KIND", std::to_string(kind)}};
    if (kind > 0 && in.maps.inQuads) defines.emplace_back("MV_MAPS_IN_QUADS", "1");
    if (kind > 0 && in.maps.packed) defines.emplace_back("MV_MAPS_PACKED", "1");
    if (sample) defines.insert(defines.end(), sample->defines.begin(), sample->defines.end());
    if (isLimited(shader, in)) defines.emplace_back("MV_SAMPLE_ROUNDS", "1");
    if (mapsDecide(shader, in)) defines.emplace_back("MV_MAPS_DECIDE", "1");
    if (verdicts > 0) defines.emplace_back("MV_VERDICTS", std::to_string(verdicts));
    in.gbuffer.addGlossDefines(defines);
    if (in.options.seenShares) defines.emplace_back("MV_SEEN_SHARES", "1");
    if (shader == GatherShader::measure) defines.emplace_back("MV_MEASURES_CLAMP", "1");
    if (isOfTiles(shader)) {
        const glm::ivec2 group = groupSize();
        defines.emplace_back("MV_TILE_X", std::to_string(group.x));
        defines.emplace_back("MV_TILE_Y", std::to_string(group.y));
        if (sample && verdicts != 1) defines.emplace_back("MV_ASKS_SCENE", "1");
        if (shader == GatherShader::samples) defines.emplace_back("MV_RECORDS_SAMPLES", "1");
    }
    return defines;
}

}  // namespace

GatherSum::GatherSum() : draw_("gather draw", {"passes/gather_draw.comp"}) {}

gl::Program& GatherSum::program(GatherShader shader, const GatherCall& in) {
    const gl::Defines defines = definesOf(shader, in);
    gl::Program& program = programs_[{shader, defines}];
    if (!program) program = gl::Program("gather", filesOf(shader), defines);
    return program;
}

// What shaders/passes/gather_lists.glsl reads, and what numbers the samples.
void GatherSum::bindLists(gl::Program& p, const GatherCall& in) {
    views.prefix.bindTexels(kUnitPowerPrefix);
    views.searchTable.bindTexels(kUnitViewSearch);
    lists.lists.bindTexels(kUnitReceiverLists);
    lists.runs.bindTexels(kUnitRuns);
    lists.runWords.bind(kUnitRunWords);
    lists.searchTable.bindTexels(kUnitRunSearch);
    p.set("viewSlotShift", views.slotShift);
    p.set("capacity", lists.capacity);
    p.set("tilesAcross", lists.tilesAcross);
    p.set("tileShift", lists.tileShift);
    p.set("samples", static_cast<std::uint32_t>(in.options.samples));
    p.set("seed", in.options.seed);
    p.set("accumulationIndex", in.options.accumulationIndex);
}

// Everything that shaders/passes/gather_sum.glsl reads.
gl::Program& GatherSum::bindSum(GatherShader shader, const GatherCall& in) {
    gl::Program& p = program(shader, in);
    in.records.records.bindTexels(kUnitGatherRecords);
    bindLists(p, in);
    p.set("cutoff", static_cast<float>(in.options.cull.cutoff));
    p.set("inverseEdge2", static_cast<float>(1.0 / (in.root.edge * in.root.edge)));
    if (in.gbuffer.glossKind() > 0) in.gbuffer.bindGloss(p);
    bindVisibility(p, shader, in);
    return p;
}

void GatherSum::bindSurfaces(gl::Program& p, const GatherCall& in) {
    lists.surfaces.bind(kUnitSurfaces);
    lists.planes.bind(kUnitPlanes);
    const bool readsGBuffer = in.gbuffer.glossKind() > 0 || in.options.seenShares;
    if (readsGBuffer) p.set("scale", in.options.cull.scale);
}

void GatherSum::inParts(gl::Program& p, GatherShader shader, const GatherCall& in,
                        std::uint32_t most, std::uint32_t mostAtOnce, int targets,
                        const Part& run) {
    const bool limited = isLimited(shader, in);
    const std::uint32_t rounds =
        in.options.roundsAtOnce > 0 ? in.options.roundsAtOnce : kLimitedRounds;
    most = std::max(most, 1u);
    // Anew each time: how a sum is cut decides its last bits.
    std::uint32_t part = std::min(most, mostAtOnce);
    const std::uint32_t search = kSearchRounds * searchesOf(shader);
    if (limited) {
        const std::uint32_t each = search + std::min(in.options.sample->rounds, rounds / 8);
        part = std::min(part, std::max(rounds / each, 1u));
    }
    if (part > kBatchSamples) part -= part % kBatchSamples;
    const std::uint32_t zero = 0;
    while (true) {
        if (limited) {
            roundsOverflow_.ensure("rounds overflow", 4);
            roundsOverflow_.writeBytes(0, &zero, sizeof zero);
            roundsOverflow_.bindStorage(kBlockRoundsOverflow);
            p.set("sampleRounds", std::max(rounds / part, search + 1) - search);
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
        if (roundsOverflow_.read<std::uint32_t>(0, 1)[0] == 0) return;
        if (part == 1) throw Error(ExitCode::impossible, in.options.sample->tooLong);
        part = std::max(part / 4, 1u);
    }
}

// What the file of MV_VISIBILITY reads.
void GatherSum::bindVisibility(gl::Program& p, GatherShader shader, const GatherCall& in) {
    const SampleVisibility* sample = sampleOf(shader, in);
    if (sample) sample->bind(p);
    if (readsMaps(shader, in)) {
        if (in.maps.inQuads) {
            in.maps.texels.bindQuads(kUnitMaps);
        } else {
            in.maps.texels.bindTexels(kUnitMaps);
        }
        in.mapHierarchy.nodes.bindTexels(kUnitViewNodes);
        p.set("mapRes", static_cast<std::uint32_t>(in.maps.mapRes));
        if (!sample && (in.maps.slices.empty() || shader == GatherShader::verdicts)) {
            p.set("footprint", hasRule(in.options.rules, kRuleFootprint) ? 1 : 0);
        }
        p.set("bias", static_cast<float>(in.options.bias));
    }
}

// Everything that shaders/passes/gather.comp reads, but its draws_.
gl::Program& GatherSum::bindGather(GatherShader shader, const GatherCall& in) {
    gl::Program& p = bindSum(shader, in);
    bindSurfaces(p, in);
    in.resting.bind(p);
    if (in.options.seenShares) in.options.seenShares->bind(kUnitReflectionWeight);
    p.set("candidates", static_cast<std::uint32_t>(in.options.candidates));
    if (mapsDecide(shader, in)) p.set("mapCheck", static_cast<float>(in.options.mapCheck));
    if (!in.maps.slices.empty()) {
        p.set("verdictWords", verdictWords(in, views.count));
        verdicts_.bindStorage(kBlockVerdicts);
    }
    p.set("drawTilesAcross", drawTilesAcross());
    p.set("viewCount", std::max(views.count, 1u));
    p.set("size", glm::ivec2(lists.surfaces.width(), lists.surfaces.height()));
    return p;
}

void GatherSum::askSlices(const GatherCall& in, const GatherArea& area) {
    if (in.maps.slices.empty()) return;
    const auto pixels =
        static_cast<std::uint64_t>(lists.surfaces.width() * lists.surfaces.height());
    const std::uint64_t bytes = 4 * pixels * verdictWords(in, views.count);
    if (bytes > static_cast<std::uint64_t>(gl::limits().maxStorageBlockBytes)) {
        throw Error(
            ExitCode::impossible,
            "the maps do not fit --gpu-memory at once, and what each part of them knows of " +
                (in.options.samples > 0 ? std::to_string(in.options.samples) + " samples"
                                        : std::to_string(views.count) + " views") +
                " a pixel is too much to keep: fewer --gather-samples");
    }
    verdicts_.ensure("verdicts of maps", bytes);
    verdicts_.fill(0);
    for (std::size_t slice = 0; slice < in.maps.slices.size(); ++slice) {
        in.maps.makeSlice(slice);
        gl::Program& p = bindGather(GatherShader::verdicts, in);
        p.set("firstMap", in.maps.slices[slice].x);
        p.set("endMap", in.maps.slices[slice].y);
        runGather(p, GatherShader::verdicts, in, area);
    }
}

void GatherSum::runGather(gl::Program& p, GatherShader shader, const GatherCall& in,
                          const GatherArea& area) {
    bindLists(draw_, in);
    draw_.set("drawTilesAcross", drawTilesAcross());
    const bool watched = in.profiler && in.profiler->watched();
    const auto candidates = static_cast<std::uint32_t>(in.options.candidates);
    const std::uint32_t ofStratum = drawsOfStratum(candidates);
    const std::uint64_t ofTile = std::uint64_t{kTileParts} * ofStratum;  // draws, a sample
    draw_.set("candidates", candidates);
    const auto atOnce = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(kMaxDraws / (area.tiles * ofTile), kBatchSamples));
    const std::uint32_t ofRow = tilesAcross(area);  // tiles
    // A full sum draws nothing; its parts are views.
    const bool drawn = in.options.samples > 0;
    const auto samples = static_cast<std::uint32_t>(in.options.samples);
    const std::uint32_t most = drawn ? std::min(views.count, samples) : views.count;
    inParts(p, shader, in, most, drawn ? atOnce : kNone, 0,
            [&](std::uint32_t first, std::uint32_t count) {
                const std::uint64_t wanted = drawn ? ofTile * count : 1;  // of a tile
                const std::uint64_t mostRows = watched ? kWatchedRows : area.tiles / ofRow;
                const auto tileRows = static_cast<std::uint32_t>(
                    std::clamp<std::uint64_t>(kMaxDraws / (ofRow * wanted), 1, mostRows));
                draws_.ensure("gather draws", tileRows * ofRow * wanted);
                draws_.bindTexels(kUnitDraws);
                if (first == 0 && askedCounts) askedCounts.fill(0);
                for (const GatherArea& slice : slicesOf(area, tileRows)) {
                    if (drawn) {
                        draws_.bindStorage(kBlockDraws);
                        draw_.set("firstDrawTile", slice.firstTile);
                        draw_.set("drawTiles", slice.tiles);
                        draw_.set("firstSample", first);
                        draw_.set("sampleCount", count);
                        draw_.dispatchInvocations(wanted / ofStratum * kDrawLanes * slice.tiles);
                    }
                    p.set("firstDrawTile", slice.firstTile);
                    p.set("origin", slice.origin);
                    p.set("sampleCount", count);
                    p.dispatch2D(slice.size.x, slice.size.y);
                    if (!watched) continue;
                    const double rows = slice.origin.y + slice.size.y;
                    in.profiler->report(Stage::gather, (first + count * rows / area.size.y) / most);
                }
            });
}

gl::Program& GatherSum::bindMeasure(const GatherCall& in) {
    gl::Program& p = bindSum(GatherShader::measure, in);
    bindSurfaces(p, in);
    return p;
}

gl::Program& GatherSum::bindAlone(const GatherCall& in) {
    gl::Program& p = bindSum(GatherShader::alone, in);
    in.gbuffer.position.bind(kUnitPosition);
    in.gbuffer.normal.bind(kUnitNormal);
    return p;
}

gl::Program& GatherSum::bindAgain(const GatherCall& in, std::uint32_t samples) {
    gl::Program& p = bindSum(GatherShader::again, in);
    p.set("samples", samples);
    p.set("seed", (in.options.seed ^ kLooksSeed) + samples);
    bindSurfaces(p, in);
    return p;
}

gl::Program& GatherSum::bindUpsampleSamples(const GatherCall& in) {
    gl::Program& p = bindSum(GatherShader::upsampleSamples, in);
    setUpsample(p, in, coarse);  // filtered light is not wanted
    return p;
}

void GatherSum::setUpsample(gl::Program& p, const GatherCall& in,
                            const gl::Texture& filteredCoarse) {
    lists.surfaces.bind(kUnitSurfaces);
    in.gbuffer.position.bind(kUnitPosition);
    in.gbuffer.normal.bind(kUnitNormal);
    coarse.bind(kUnitUnfilteredCoarse);
    coarseCandidates.bind(kUnitCandidatesCoarse);
    filteredCoarse.bind(kUnitFilteredCoarse);
    p.set("scale", in.options.cull.scale);
    p.set("takesNearest", in.options.cull.scale > kLargestWithAlone ? 1 : 0);
    p.set("pixelSize", in.gbuffer.pixelSize);
}

std::uint32_t GatherSum::drawTilesAcross() const {
    return (static_cast<std::uint32_t>(lists.surfaces.width()) + kTileEdge - 1) / kTileEdge;
}

GatherArea GatherSum::wholePicture() const {
    const glm::ivec2 size(lists.surfaces.width(), lists.surfaces.height());
    const auto rows = (static_cast<std::uint32_t>(size.y) + kTileEdge - 1) / kTileEdge;
    return {{0, 0}, size, 0, rows * drawTilesAcross()};
}

GatherArea GatherSum::groupAround(glm::ivec2 pixel) const {
    const glm::ivec2 group = groupSize();
    const auto tile = glm::uvec2(pixel) / kTileEdge;
    return {pixel / group * group, group, tile.y * drawTilesAcross() + tile.x, 1};
}

void GatherSum::inParts(gl::Program& p, GatherShader shader, const GatherCall& in, int targets,
                        const std::function<void()>& run) {
    inParts(p, shader, in, mostSamples(shader, in, views.count), kNone, targets,
            [&](std::uint32_t, std::uint32_t) { run(); });
}

std::uint64_t GatherSum::bytes() const {
    return views.bytes() + lists.bytes() + draws_.bytes() + coarse.bytes() +
           coarseCandidates.bytes() + verdicts_.bytes();
}

}  // namespace mv
