#include "renderer/passes/gather_samples.h"

#include <algorithm>
#include <cassert>
#include <map>

#include "shaders/shared/bindings.glsl"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/gather_sampling.glsl"
#include "shaders/shared/light.glsl"

namespace mv {
namespace {

// Runs the shader for one pixel and appends what it wrote down.
GatherHead recordSamples(GatherSum& sum, const GatherCall& in, GatherShader shader,
                         glm::ivec2 pixel, float share, std::vector<GatheredRecord>& out) {
    const bool upsampled = shader == GatherShader::upsampleSamples;
    if (!upsampled) sum.askSlices(in, sum.groupAround(pixel));
    gl::Program& p = upsampled ? sum.bindUpsampleSamples(in) : sum.bindGather(shader, in);
    p.set("chosen", pixel);
    p.set("share", share / static_cast<float>(in.root.edge * in.root.edge));
    in.mapHierarchy.sortedViews.bindStorage(kBlockSortedViews);
    // As many as groups of candidates are weighed; a full sum has one for each view.
    std::uint32_t capacity =
        in.options.samples > 0
            ? std::max(static_cast<std::uint32_t>(in.options.samples), kAloneSamples) *
                  kCandidateGroups
            : in.mapHierarchy.aliveCount;
    GatherHead head{};
    while (true) {
        const gl::Buffer recorded("gathered samples",
                                  sizeof(GatherHead) + capacity * sizeof(GatheredRecord));
        recorded.bindStorage(kBlockGatheredSamples);
        p.set("recordCapacity", capacity);
        if (upsampled) {
            sum.inParts(p, shader, in, 0, [&] { p.dispatchInvocations(1); });
        } else {
            sum.runGather(p, shader, in, sum.groupAround(pixel));
        }
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

}  // namespace

std::vector<GatheredSample> readGatheredSamples(GatherSum& sum, const GatherCall& in,
                                                glm::ivec2 pixel) {
    std::vector<GatheredRecord> recorded;
    if (in.options.cull.scale == 1) {
        recordSamples(sum, in, GatherShader::samples, pixel, 1, recorded);
    } else {
        const GatherHead head =
            recordSamples(sum, in, GatherShader::upsampleSamples, pixel, 1, recorded);
        // Where no neighbour shares its surface, the pixel gathered for itself.
        const std::size_t taps = head.sampleCount > 0 ? 0 : head.tapCount;
        assert(taps <= kMaxTaps);
        for (std::size_t i = 0; i < taps; ++i) {
            const GatherTap& tap = head.taps[i];
            recordSamples(sum, in, GatherShader::samples, {tap.x, tap.y}, tap.weight / head.weight,
                          recorded);
        }
    }

    std::map<std::uint32_t, GatheredSample> bySlot;
    for (const GatheredRecord& r : recorded) {
        GatheredSample& s = bySlot[r.slot];
        s.slot = r.slot;
        s.position = {r.positionX, r.positionY, r.positionZ};
        s.unoccluded += glm::vec3(r.openR, r.openG, r.openB);
        s.irradiance += glm::vec3(r.r, r.g, r.b);
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

}  // namespace mv
