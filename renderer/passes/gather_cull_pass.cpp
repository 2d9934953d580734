#include "renderer/passes/gather_cull_pass.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <vector>

#include "renderer/gl/context.h"
#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
namespace {

// Runs of all receivers together: 64 MiB.
constexpr std::uint32_t kMaxRunsOfAll = 1u << 22;

// Every receiver costs a walk down the view tree: they are made so large that about this many
// pixels share one.
constexpr double kPixelsAReceiver = 512;

// A room shows about 4^level nodes of a level. -1: no receivers.
int receiverLevel(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                  const GatherCullOptions& options) {
    if (options.cullLevel <= 0 || scene.levels == 0) return -1;
    const double pixels =
        1.0 * gbuffer.width * gbuffer.height / (1.0 * options.scale * options.scale);
    const double nodes = std::max(1.0, pixels / kPixelsAReceiver);
    const int level = static_cast<int>(std::lround(0.5 * std::log2(nodes)));
    return std::min({options.cullLevel, scene.levels - 1, std::max(level, 1)});
}

}  // namespace

std::uint64_t GatherLists::bytes() const {
    const std::uint64_t sum = surfaces.bytes() + receivers.bytes();
    return sum + used.bytes() + firstReceiver.bytes() + lists.bytes() + runs.bytes() +
           guide.bytes();
}

GatherCullPass::GatherCullPass(gl::Results results)
    : results_(results), total_("gather receivers", results) {
    gl::Defines defines = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}};
    findReceivers_ = gl::Program("gather receivers", {"passes/gather_receivers.comp"}, defines);
    cull_ = gl::Program("gather cull", {"passes/gather_cull.comp"}, defines);
    guide_ = gl::Program("gather guide", {"passes/gather_guide.comp"}, defines);
    defines.emplace_back("PLACE", "0");
    countReceivers_ =
        gl::Program("gather receivers, count", {"passes/gather_number.comp"}, defines);
    defines.back().second = "1";
    placeReceivers_ =
        gl::Program("gather receivers, place", {"passes/gather_number.comp"}, defines);
}

void GatherCullPass::findReceivers(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                                   const GatherCullOptions& options, int level, GatherLists& out) {
    const int width = (gbuffer.width + options.scale - 1) / options.scale;
    const int height = (gbuffer.height + options.scale - 1) / options.scale;
    out.surfaces.ensure("gather surfaces", GL_TEXTURE_2D, GL_RGBA32UI, width, height);
    out.planes.ensure("gather planes", GL_TEXTURE_2D, GL_R32UI, width, height);
    out.receivers.ensure("gather receivers", GL_TEXTURE_2D, GL_R32UI, width, height);
    const std::uint64_t nodes =
        level < 0 ? 0 : scene.levelBegin[static_cast<std::size_t>(level) + 1];
    out.used.ensure("gather cones in use", std::max<std::uint64_t>(nodes, 1));
    out.used.fill(0);

    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    gbuffer.plane.bind(kUnitPlane);
    scene.nodes.bindTexels(kUnitSceneNodes);
    scene.attributes.bindTexels(kUnitSceneAttributes);
    scene.mortonKeys.bindTexels(kUnitSceneKeys);
    out.surfaces.bindImage(kImageSurfaces, GL_WRITE_ONLY, GL_RGBA32UI);
    out.planes.bindImage(kImagePlanes, GL_WRITE_ONLY, GL_R32UI);
    out.receivers.bindImage(kImageReceivers, GL_WRITE_ONLY, GL_R32UI);
    out.used.bindStorage(kBlockConesInUse);
    findReceivers_.set("size", glm::ivec2(width, height));
    findReceivers_.set("scale", options.scale);
    findReceivers_.set("receiverLevel", level);
    for (int i = 0; level >= 0 && i <= level + 1; ++i) {
        findReceivers_.set("levelBegin[" + std::to_string(i) + "]",
                           scene.levelBegin[static_cast<std::size_t>(i)]);
    }
    gl::barrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);  // used.fill
    findReceivers_.dispatch2D(width, height);

    numberReceivers(static_cast<std::uint32_t>(nodes), out);
}

std::uint32_t GatherCullPass::roomFor(std::uint32_t count) const {
    return results_ == gl::Results::waited ? count : count + count / 2 + 64;
}

bool GatherCullPass::fits(GatherLists& lists) {
    bool fit = true;
    while (const auto total = total_.take<std::uint32_t>()) {
        const std::uint32_t count = total->front() + 1;
        fit = count <= lists.receiverCount;
        if (results_ == gl::Results::waited || !fit || count < lists.receiverCount / 4) {
            lists.receiverCount = roomFor(count);
        }
    }
    return fit;
}

void GatherCullPass::numberReceivers(std::uint32_t nodes, GatherLists& out) {
    counts_.ensure("gather receiver counts", nodes + 1);
    begins_.ensure("gather receiver begins", nodes + 1);
    out.used.bindTexels(kUnitConesInUse);
    counts_.bindStorage(kBlockReceiverCounts);
    countReceivers_.set("nodeCount", nodes);
    // Producer: the receivers found above.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    countReceivers_.dispatchInvocations(nodes + 1);
    prefixSum_.exclusive(counts_, nodes + 1, begins_);

    // How many there are. Where that comes late, there is room for half as many again as before;
    // pixels of receivers beyond it take number 0, which keeps every view.
    total_.request(begins_, nodes * 4, 4);
    if (out.receiverCount == 0) {
        out.receiverCount = roomFor(total_.takeNow<std::uint32_t>()->front() + 1);
    } else {
        fits(out);
    }
    keys_.ensure("gather receiver keys", out.receiverCount);
    keys_.fill(kNone);
    out.firstReceiver.ensure("gather first receivers", std::max(nodes, 1u));
    if (nodes == 0) return;
    out.used.bindTexels(kUnitConesInUse);
    begins_.bindTexels(kUnitReceiverBegins);
    out.firstReceiver.bindStorage(kBlockReceiverCounts);
    keys_.bindStorage(kBlockReceiverKeys);
    placeReceivers_.set("nodeCount", nodes);
    placeReceivers_.set("keyCapacity", out.receiverCount);
    // Producers: the prefix sum and the fill.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                GL_SHADER_STORAGE_BARRIER_BIT);
    placeReceivers_.dispatchInvocations(nodes);
}

void GatherCullPass::render(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                            const GpuViewHierarchy& cullTree, const GatherViews& views,
                            const GatherCullOptions& options, GatherLists& out) {
    assert(!cullTree.flat && cullTree.nodeCount > 0 && options.maxRuns < 65536);
    findReceivers(gbuffer, scene, options, receiverLevel(gbuffer, scene, options), out);

    out.capacity = std::clamp(kMaxRunsOfAll / out.receiverCount, 1u, options.maxRuns);
    out.lists.ensure("gather lists", out.receiverCount);
    out.runs.ensure("gather runs", std::uint64_t{out.receiverCount} * out.capacity);
    cullTree.nodes.bindTexels(kUnitViewNodes);
    scene.nodes.bindTexels(kUnitSceneNodes);
    scene.attributes.bindTexels(kUnitSceneAttributes);
    views.prefix.bindTexels(kUnitPowerPrefix);
    keys_.bindTexels(kUnitReceiverKeys);
    out.runs.bindStorage(kBlockRuns);
    out.lists.bindStorage(kBlockReceiverLists);
    cull_.set("receiverCount", out.receiverCount);
    cull_.set("capacity", out.capacity);
    cull_.set("cullLevel", static_cast<std::uint32_t>(std::max(options.cullLevel, 0)));
    cull_.set("cutoff", options.cutoff);
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // prefix of GatherViewsPass, keys
    cull_.dispatchInvocations(out.receiverCount);

    out.runWords = gl::TextureBuffer("gather: run words", GL_R32UI, out.runs);
    const std::uint64_t slots = std::uint64_t{out.receiverCount} * kGuideSlots;
    out.guide.ensure("gather guide", slots);
    out.lists.bindTexels(kUnitReceiverLists);
    out.runWords.bind(kUnitRunWords);
    out.guide.bindStorage(kBlockRunGuide);
    guide_.set("receiverCount", out.receiverCount);
    guide_.set("capacity", out.capacity);
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // lists and runs of cull_
    guide_.dispatchInvocations(slots);
}

}  // namespace mv
