#pragma once
// GBuffer x ViewHierarchy x ViewMaps -> irradiance [Kol19 §5.1]: hierarchical VPL culling, random
// subsampling of what is kept, shadow test against the maps, cross-bilateral filter.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/settings/settings.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"
#include "renderer/gl/read_back.h"
#include "renderer/passes/bvh_tables.h"
#include "renderer/passes/gather_answers.h"
#include "renderer/passes/gather_views_pass.h"
#include "renderer/passes/gbuffer_pass.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/history_pass.h"
#include "renderer/passes/near_field_pass.h"
#include "renderer/passes/sky_pass.h"

namespace mv {

// How a method answers single samples in the gather's shaders.
struct SampleVisibility {
    std::string file;  // below shaders/; defines isVisible(), see passes/gather_sum.glsl
    gl::Defines defines = {};
    std::function<void(gl::Program&)> bind;  // what the file reads
    // Where its loops are long: rounds of them that a sample is given at first, and what to say of
    // a sample that takes more than a driver allows. 0: they are short.
    std::uint32_t rounds = 0;
    std::string tooLong = {};
};

// When samples ask GatherOptions::sample beside maps that are there.
enum class SampleAsked {
    always,  // maps decide nothing
    // The light is what fused maps believe, and `sample` corrects it, most where they are not sure
    // and by `mapCheck` where they are (doubtIn()), so that the mean is that of `sample` alone.
    inDoubt,
    // Only shaders ask that read no maps, because these are there slice by slice.
    withoutMaps
};

// What is asked of the gather, and what a frame gives it. Of the settings, near field, sky, history
// and what to do in doubt are answered by the members below.
struct GatherOptions : GatherSettings {
    uint rules = kCorrectedRules;     // kRuleFootprint of them
    NearFieldScene nearFieldOf = {};  // gives back the light that the clamp takes away
    SkyRays sky = {};                 // of a set of samples; of full sums too
    int set = 1;  // of those that are averaged: the more there are, the less each is filtered
    std::uint32_t seed = 0;
    std::uint32_t accumulationIndex = 0;  // 0 while anything moves, if nothing is remembered
    // Unset: the maps answer, or where there are none, everything is visible.
    std::optional<SampleVisibility> sample = {};
    SampleAsked sampleAsked = SampleAsked::always;
    // RGB: the share that is seen of the light of each pixel of the G-buffer. Where it is small few
    // samples are taken (samplesForOne()). Null: all are.
    const gl::Texture* seenShares = nullptr;
    HistoryOptions past = {};  // not of full sums
    std::uint32_t roundsAtOnce =
        0;  // that a draw's loops may take together; 0: what the device can
};

struct GatherResult {
    // All have the G-buffer's size. Texels without a surface are 0.
    // RGBA32F, E = sum over views and the sky (everything but albedo/pi), W/m^2; w: at scale 1, the
    // variance of its luminance as its samples show it, 0 for full sums.
    gl::Texture irradiance;
    gl::Texture unfiltered;  // the same before the filter, of this frame's samples alone
    gl::Texture remembered;  // where HistoryOptions::keepsOwnLight: `irradiance` is this
                             // frame's alone, and this with the samples of those before
    // RGBA32F: share of the views kept for the pixel's receiver; of its samples, those that asked
    // GatherOptions::sample; luminance that all would have given if nothing stood between, where
    // none was seen to pass, else 0; that they gave.
    gl::Texture candidates;
    std::uint64_t bytes() const {
        return irradiance.bytes() + unfiltered.bytes() + remembered.bytes() + candidates.bytes();
    }
};

// What a set of samples is gathered from.
struct GatherInputs {
    const GBuffer& gbuffer;  // that of the last prepare(), as it was drawn then
    const RootCube& root;
    // The hierarchy the maps were rendered for, or any tree for method none (maps.present false);
    // where views borrow maps, the tree of all views.
    const GpuViewHierarchy& mapHierarchy;
    const GpuViewMaps& maps;
    const GatherRecords& records;  // of the same hierarchy and maps
    const GatherOptions& options;  // of culling, those of the last prepare()
    // Asked for two uints: samples that could ask GatherOptions::sample, and those that did. Null:
    // nobody wants to know.
    gl::ReadBack* asked = nullptr;
};

class GatherPass {
  public:
    GatherPass();
    ~GatherPass();
    // The views' power, and which views each receiver keeps: the same for all maps of the views,
    // so done once for both sides of a comparison. Flat hierarchies (ManyLoDs) are gathered through
    // `cullTree`, the MegaViews tree of the same sorted views: methods take the very same samples.
    void prepare(const GBuffer& gbuffer, const GpuViewHierarchy& cullTree,
                 const GatherOptions& options, gl::Profiler& profiler);
    // After prepare(): writes what gather() reads of the maps' views. mapHierarchy: that of the
    // maps; or any tree. mapViews: the views that it is of; null: all.
    void record(const GpuViewHierarchy& mapHierarchy, const GpuViewMaps& maps,
                const GpuMapViews* mapViews, gl::Profiler& profiler, GatherRecords& out);
    // Gathers one set of samples by the last prepare().
    void gather(const GatherInputs& in, gl::Profiler& profiler, GatherResult& out);
    // mean += (set - mean) / sets: the running mean of `sets` sets of samples.
    void accumulate(const gl::Texture& set, int sets, gl::Profiler& profiler, gl::Texture& mean);

    // After gather() of the same: the views that a pixel (bottom row first) gathered,
    // by falling unoccluded irradiance, then by slot. The very shader that gathers runs again for
    // this pixel and writes its samples down; their irradiance sums up to `unfiltered` there, less
    // near field and sky. At a scale above 1 they are those of the gather's pixels that this one is
    // brought up from, by their weights. Nothing where there is no surface. Synchronises.
    std::vector<GatheredSample> readSamples(const GatherInputs& in, glm::ivec2 pixel);

    // After gather() of the same: of pixels of a sparse grid. Synchronises.
    GatherShares readShares(const GatherInputs& in);

    std::uint64_t bytes() const;  // of what it keeps

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
