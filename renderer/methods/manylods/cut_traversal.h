#pragma once
// Cuts of ManyLoDs that are kept on the GPU from frame to frame [HREB11 §3.2, §3.3], as a third
// traversal beside lists and queues. The same kernels make incremental and lazy
// cuts; mv::ViewCuts is their readable definition. Used by ManyViewPass only.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "megaviews/settings/statistics.h"
#include "renderer/methods/megaviews/traversal_job.h"
#include "shaders/shared/cut_data.glsl"

namespace mv {

// An entry is a node of a cut.
class CutTraversal : public PairTraversal {
  public:
    // Cuts stay where they are: all views are brought up to date at once.
    bool worksInPasses() const override { return false; }
    std::uint64_t usualEntries(uint rules) const override {
        return rules == kCorrectedRules ? 1024 : 4096;
    }
    std::array<std::uint64_t, 2> workBytes(const TraversalJob&, const PassRange&) const override {
        return {0, 0};
    }
    // What --gpu-memory leaves beside the maps, and a storage block holds.
    std::uint64_t maxEntries(const TraversalJob& job) const override;
    std::uint64_t bytesFor(const TraversalJob& job, std::uint64_t entries) const override;
    void reserve(const TraversalJob& job, std::uint64_t entries) override;
    std::uint64_t bytes() const override;
    // From the root where there are no cuts yet, or where they were made with other options.
    void run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
             ProgramCache& programs) override;
    PassOutcome outcome(std::span<const std::uint32_t> status) override;
    CutCounts counts() const override { return counts_; }

  private:
    // What cuts depend on beside views and nodes.
    struct Key {
        uint rules{};
        float pairResolution = 0;
        bool operator==(const Key&) const = default;
    };
    struct Frame;  // what all steps of a frame read
    void forget();
    void findParents(const TraversalJob& job, ProgramCache& programs);
    void beginViews(const Frame& frame);
    void testChains(const Frame& frame);
    void placeNodes(const Frame& frame);
    void placeMerged(const Frame& frame);
    void testRound(const Frame& frame, std::uint32_t round);
    void draw(const Frame& frame);
    std::uint64_t mergedCapacity() const;

    std::array<gl::TexelBuffer<CutEntry>, 2> nodes_;      // the first are those of the last frame
    std::array<gl::Buffer, 2> views_;                     // CutView by slot, in the same order
    std::array<gl::TexelBuffer<CutPending>, 2> pending_;  // by parity of the round
    gl::TexelBuffer<glm::uvec2> steps_;                   // CutStep by slot
    gl::TexelBuffer<std::uint32_t> lastMerged_;           // kCutMergedWords by slot
    gl::TexelBuffer<std::uint32_t> chains_;               // old nodes whose chains are tested
    gl::Buffer merged_;                                   // CutMerged
    gl::Buffer held_;  // kStatusCutNodes and kStatusOverflow as the last frame left them
    gl::TexelBuffer<std::uint32_t> parents_;  // of the scene nodes
    gl::TexelBuffer<glm::uvec2> large_;
    std::optional<Key> key_;
    std::uint32_t rounds_ = 0;
    CutCounts counts_;
};

}  // namespace mv
