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
    gl::Defines defines = {{"MV_WORKGROUP_SIZE", std::to_string(gl::limits().workGroupSize)}};
    guide_ = gl::Program("gather view guide", {"passes/gather_view_guide.comp"}, defines);
    records_ = gl::Program("gather records", {"passes/gather_records.comp"}, defines);
    defines.emplace_back("STAGE", "");
    for (int i = 0; i < 5; ++i) {
        defines.back().second = std::to_string(i);
        stages_[i] =
            gl::Program("gather views " + std::to_string(i), {"passes/gather_power.comp"}, defines);
    }
}

void GatherViewsPass::render(const GpuViewHierarchy& hierarchy, GatherViews& out) {
    const std::uint64_t n = hierarchy.aliveCount;
    const std::uint64_t blocks = (n + kBlock - 1) / kBlock;
    assert(n < (1u << 23));
    out.count = hierarchy.aliveCount;
    out.prefix.ensure("gather power", (n + 1) * 4);
    blockPower_.ensure("gather block power", (blocks + 1) * 4);
    blockUnits_.ensure("gather block units", blocks * 4);

    const gl::TextureBuffer views("gather: views", GL_RGBA32UI, hierarchy.sortedViews);
    views.bind(0);
    blockPower_.bindStorage(0);
    blockUnits_.bindStorage(1);
    out.prefix.bindStorage(2);
    // Views and hierarchy were written by compute passes.
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    for (int i = 0; i < 5; ++i) {
        gl::Program& stage = stages_[i];
        stage.set("viewCount", static_cast<std::uint32_t>(n));
        stage.set("blockCount", static_cast<std::uint32_t>(blocks));
        if (i == 1 || i == 3) {
            stage.dispatchGroups(1);
        } else {
            stage.dispatchInvocations(blocks);
        }
        gl::barrier(GL_SHADER_STORAGE_BARRIER_BIT);  // each stage reads the one before
    }
    out.prefixTexels = gl::TextureBuffer("gather power", GL_R32UI, out.prefix);

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

void GatherViewsPass::record(const GpuViewHierarchy& hierarchy, const GpuViewMaps& maps,
                             const GatherViews& views, GatherRecords& out) {
    assert(views.count == hierarchy.aliveCount);
    out.records.ensure("gather records", std::uint64_t{views.count} * 48);
    out.texels = gl::TextureBuffer("gather records", GL_RGBA32UI, out.records);
    const gl::TextureBuffer sorted("gather: views", GL_RGBA32UI, hierarchy.sortedViews);
    const gl::TextureBuffer leaves("gather: leaf of view", GL_R32UI, hierarchy.leafOfView);
    const gl::TextureBuffer mapOfNode("gather: map of node", GL_R32UI, hierarchy.mapOfNode);
    sorted.bind(0);
    leaves.bind(1);
    mapOfNode.bind(2);
    hierarchy.nodesTexels.bind(3);
    views.prefixTexels.bind(4);
    out.records.bindStorage(0);
    records_.set("viewCount", views.count);
    records_.set("mapKind", maps.present ? (maps.fused ? 1u : 2u) : 0u);
    gl::barrier(GL_TEXTURE_FETCH_BARRIER_BIT);  // the prefix; views and hierarchy
    records_.dispatchInvocations(views.count);
}

}  // namespace mv
