#include "renderer/passes/gather_cull_pass.h"

#include <algorithm>
#include <bit>
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

GatherCullPass::GatherCullPass() {
    const gl::Defines defines = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}};
    findReceivers_ = gl::Program("gather receivers", {"passes/gather_receivers.comp"}, defines);
    cull_ = gl::Program("gather cull", {"passes/gather_cull.comp"}, defines);
    guide_ = gl::Program("gather guide", {"passes/gather_guide.comp"}, defines);
}

void GatherCullPass::findReceivers(const GBuffer& gbuffer, const GpuSceneHierarchy& scene,
                                   const GatherCullOptions& options, int level, GatherLists& out) {
    const int width = (gbuffer.width + options.scale - 1) / options.scale;
    const int height = (gbuffer.height + options.scale - 1) / options.scale;
    out.surfaces.ensure("gather surfaces", GL_TEXTURE_2D, GL_RGBA32UI, width, height);
    out.receivers.ensure("gather receivers", GL_TEXTURE_2D, GL_R32UI, width, height);
    const std::uint64_t nodes =
        level < 0 ? 0 : scene.levelBegin[static_cast<std::size_t>(level) + 1];
    out.used.ensure("gather cones in use", std::max<std::uint64_t>(nodes, 1));
    out.used.fill(0);

    gbuffer.position.bind(kUnitPosition);
    gbuffer.normal.bind(kUnitNormal);
    scene.nodes.bindTexels(kUnitSceneNodes);
    scene.attributes.bindTexels(kUnitSceneAttributes);
    scene.mortonKeys.bindTexels(kUnitSceneKeys);
    out.surfaces.bindImage(kImageSurfaces, GL_WRITE_ONLY, GL_RGBA32UI);
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

    // Number the receivers in use by node and cone; number 0 holds everything.
    gl::barrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // atomicOr above
    const std::vector<glm::uvec2> used = out.used.read(0, nodes);
    std::vector<std::uint32_t> first(std::max<std::uint64_t>(nodes, 1), 0);
    std::vector<std::uint32_t> keys = {kNone};
    for (std::uint32_t node = 0; node < nodes; ++node) {
        first[node] = static_cast<std::uint32_t>(keys.size());
        for (int word = 0; word < 2; ++word) {
            for (std::uint32_t bits = used[node][word]; bits != 0; bits &= bits - 1) {
                const auto bit = static_cast<std::uint32_t>(std::countr_zero(bits));
                keys.push_back(node * kReceiverCones + static_cast<std::uint32_t>(word) * 32 + bit);
            }
        }
    }
    out.receiverCount = static_cast<std::uint32_t>(keys.size());
    out.firstReceiver.ensure("gather first receivers", first.size());
    out.firstReceiver.write(0, first);
    keys_.ensure("gather receiver keys", keys.size());
    keys_.write(0, keys);
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
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // prefix of GatherViewsPass
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
