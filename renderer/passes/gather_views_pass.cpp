#include "renderer/passes/gather_views_pass.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

#include "renderer/gl/context.h"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
namespace {

constexpr std::uint64_t kBlock = 64;  // views an invocation, as the shader says

}  // namespace

GatherViewsPass::GatherViewsPass() {
    guide_ = gl::Program("gather view guide", {"passes/gather_view_guide.comp"},
                         {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}});
    for (int i = 0; i < 5; ++i) {
        stages_[i] = gl::Program("gather views " + std::to_string(i), {"passes/gather_power.comp"},
                                 {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)},
                                  {"STAGE", std::to_string(i)}});
    }
}

void GatherViewsPass::render(const GpuViewHierarchy& hierarchy, const GpuViewMaps& maps,
                             GatherViews& out) {
    const std::uint64_t n = hierarchy.aliveCount;
    const std::uint64_t blocks = (n + kBlock - 1) / kBlock;
    assert(n < (1u << 23));
    out.count = hierarchy.aliveCount;
    out.prefix.ensure("gather power", (n + 1) * 4);
    out.records.ensure("gather records", n * 48);
    blockPower_.ensure("gather block power", (blocks + 1) * 4);
    blockUnits_.ensure("gather block units", blocks * 4);

    const gl::TextureBuffer views("gather: views", GL_RGBA32UI, hierarchy.sortedViews);
    const gl::TextureBuffer leaves("gather: leaf of view", GL_R32UI, hierarchy.leafOfView);
    const gl::TextureBuffer mapOfNode("gather: map of node", GL_R32UI, hierarchy.mapOfNode);
    views.bind(0);
    leaves.bind(1);
    mapOfNode.bind(2);
    hierarchy.nodesTexels.bind(3);
    blockPower_.bindStorage(0);
    blockUnits_.bindStorage(1);
    out.prefix.bindStorage(2);
    out.records.bindStorage(3);
    // Views and hierarchy were written by compute passes.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    for (int i = 0; i < 5; ++i) {
        gl::Program& stage = stages_[i];
        stage.set("viewCount", static_cast<std::uint32_t>(n));
        stage.set("blockCount", static_cast<std::uint32_t>(blocks));
        stage.set("mapKind", maps.present ? (maps.fused ? 1u : 2u) : 0u);
        if (i == 1 || i == 3) {
            stage.dispatchGroups(1);
        } else {
            stage.dispatchInvocations(blocks);
        }
        gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT);  // each stage reads the one before
    }
    out.prefixTexels = gl::TextureBuffer("gather power", GL_R32UI, out.prefix);
    out.recordTexels = gl::TextureBuffer("gather records", GL_RGBA32UI, out.records);

    // About a view a slot, and a last slot behind all units.
    const auto slotBits = std::min<std::uint32_t>(
        static_cast<std::uint32_t>(std::bit_width(std::max<std::uint64_t>(n, 2) - 1)), 20);
    const std::uint32_t slots = (1u << slotBits) + 1;
    out.slotShift = kPowerUnitBits - slotBits;
    out.guide.ensure("gather view guide", std::uint64_t{slots} * 4);
    out.guideTexels = gl::TextureBuffer("gather view guide", GL_R32UI, out.guide);
    out.prefixTexels.bind(0);
    out.guide.bindStorage(0);
    guide_.set("viewCount", static_cast<std::uint32_t>(n));
    guide_.set("slotCount", slots);
    guide_.set("slotShift", out.slotShift);
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // the prefix
    guide_.dispatchInvocations(slots);
}

}  // namespace mv
