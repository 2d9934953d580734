#include "renderer/passes/gather_views_pass.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather_sampling.glsl"

namespace mv {
GatherViewsPass::GatherViewsPass() {
    searchTable_ = gl::Program("view search table", {"passes/view_search_table.comp"});
    spread_ = gl::Program("gather spread", {"passes/gather_clamp.comp"}, {{"MV_SPREAD", "1"}});
    clamp_ = gl::Program("gather clamp", {"passes/gather_clamp.comp"});
    records_ = gl::Program("gather records", {"passes/gather_records.comp"});
    borrowedRecords_ =
        gl::Program("gather records", {"passes/gather_records.comp"}, {{"MV_BORROWED_MAPS", "1"}});
    for (int i = 0; i < 5; ++i) {
        const std::string stage = std::to_string(i);
        stages_[i] = gl::Program("gather views " + stage, {"passes/gather_power.comp"},
                                 {{"MV_STAGE", stage}});
    }
}

void GatherViewsPass::render(const GpuViewHierarchy& hierarchy, std::optional<double> clampDistance,
                             GatherViews& out) {
    const std::uint64_t n = hierarchy.aliveCount;
    const std::uint64_t blocks = (n + kPowerBlock - 1) / kPowerBlock;
    assert(n < (1u << 23));
    out.count = hierarchy.aliveCount;
    out.prefix.ensure("gather power", n + 1);
    blockPower_.ensure("gather block power", (blocks + 1) * 4);
    blockUnits_.ensure("gather block units", blocks * 4);

    hierarchy.sortedViews.bindTexels(kUnitSortedViews);
    blockPower_.bindStorage(kBlockBlockPower);
    blockUnits_.bindStorage(kBlockBlockUnits);
    out.prefix.bindStorage(kBlockPowerPrefix);
    for (int i = 0; i < 5; ++i) {
        gl::Program& stage = stages_[i];
        stage.set("viewCount", static_cast<std::uint32_t>(n));
        stage.set("blockCount", static_cast<std::uint32_t>(blocks));
        if (i == 1 || i == 3) {
            stage.dispatchGroups(1);
        } else {
            stage.dispatchInvocations(blocks);
        }
    }

    out.clampDistances.ensure("clamp distances", n + 1);
    out.clampDistances.bindStorage(kBlockClampDistances);
    if (n > 0) {
        spread_.set("viewCount", static_cast<std::uint32_t>(n));
        spread_.dispatchGroups(1);
    }
    clamp_.set("viewCount", static_cast<std::uint32_t>(n));
    clamp_.set("fixedDistance", static_cast<float>(clampDistance.value_or(-1)));
    hierarchy.mortonKeys.bindTexels(kUnitViewKeys);
    clamp_.dispatchInvocations(n);

    // About a view a slot, and a last slot behind all units.
    const auto slotBits = std::min<std::uint32_t>(
        static_cast<std::uint32_t>(std::bit_width(std::max<std::uint64_t>(n, 2) - 1)), 20);
    const std::uint32_t slots = (1u << slotBits) + 1;
    out.slotShift = kPowerUnitBits - slotBits;
    out.searchTable.ensure("view search table", slots);
    out.prefix.bindTexels(kUnitPowerPrefix);
    out.searchTable.bindStorage(kBlockViewSearch);
    searchTable_.set("viewCount", static_cast<std::uint32_t>(n));
    searchTable_.set("slotCount", slots);
    searchTable_.set("slotShift", out.slotShift);
    searchTable_.dispatchInvocations(slots);
}

void GatherViewsPass::record(const GpuViewHierarchy& hierarchy, const GpuViewMaps& maps,
                             const GpuMapViews* mapViews, const GatherViews& views,
                             GatherRecords& out) {
    const GpuViewHierarchy& all = mapViews ? *mapViews->all : hierarchy;
    assert(views.count == all.aliveCount);
    out.records.ensure("gather records", views.count, views.count / 8);
    all.sortedViews.bindTexels(kUnitSortedViews);
    if (mapViews) mapViews->places.bindStorage(kBlockPlaces);
    hierarchy.leafOfView.bindTexels(kUnitLeafOfView);
    hierarchy.mapOfNode.bindTexels(kUnitMapOfNode);
    hierarchy.nodes.bindTexels(kUnitViewNodes);
    views.prefix.bindTexels(kUnitPowerPrefix);
    views.clampDistances.bindTexels(kUnitClampDistances);
    out.records.bindStorage(kBlockGatherRecords);
    gl::Program& p = mapViews ? borrowedRecords_ : records_;
    p.set("viewCount", views.count);
    p.set("mapKind", maps.present ? (maps.fused ? 1u : 2u) : 0u);
    p.dispatchInvocations(views.count);
}

}  // namespace mv
