#pragma once
// What the traversals of the GPU share: the frame's task, the range of views one
// pass takes, and their working buffers. Used by ManyViewPass only.

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "megaviews/settings/statistics.h"
#include "renderer/gl/program.h"
#include "renderer/methods/megaviews/many_view_pass.h"
#include "renderer/methods/megaviews/pass_plan.h"
#include "renderer/passes/gpu_data.h"
#include "shaders/shared/traversal_data.glsl"

namespace mv {

// Views [firstView, endView) of the sorted views, and the nodes of each level that hold any of
// them. Pairs of nodes that start before firstView are counted by an earlier pass.
struct PassRange {
    std::uint32_t firstView = 0, endView = 0;
    std::vector<glm::uvec2> levels;  // begin, end in the view nodes
    glm::uvec2 maps{0};              // begin, end of the final maps that it writes
};

inline std::uint32_t sizeOf(glm::uvec2 range) { return range.y - range.x; }

// full: a list or a queue did not suffice; again: the traversal knows better now, same sizes.
enum class PassEnd { done, full, again };
struct PassOutcome {
    PassEnd end = PassEnd::done;
    std::vector<std::uint64_t> occupancy;  // entries appended, step by step
};

struct TraversalJob {
    const GpuSceneHierarchy& scene;
    const GpuViewHierarchy& views;
    const ManyViewOptions& options;
    gl::Profiler& profiler;
    GpuViewMaps& out;
    bool fuse = true;     // trees only: flat hierarchies have nothing to fuse
    bool mips = false;    // multi-pixel filling by coarser levels
    bool sliced = false;  // `out` has room for the final maps of one pass

    bool hasPairs() const { return views.nodeCount > 0 && scene.nodeCount > 0; }
    std::uint64_t mapBytes() const;
    std::uint64_t finalBytes() const;  // of a map in `out`
    std::uint64_t mipBytes() const;
    float pairResolution() const;  // what decidePair takes
    gl::Defines defines() const;   // of every traversal shader
};

// Buffers of every traversal that depend on the job.
struct TraversalBuffers {
    gl::Buffer counters, status, mips, command;
    gl::Buffer countersBefore;                           // of the pass under way
    std::array<gl::TexelBuffer<std::uint32_t>, 2> work;  // maps of internal view nodes
    gl::Buffer unpacked;  // final maps of the pass under way, where `out` has them packed
    std::uint64_t mapBytes() const;
    // Nodes, counters, status, coarser levels, and the pass's final maps.
    void bind(const TraversalJob& job, const PassRange& range) const;
};

// Programs by file and defines, compiled at first use.
class ProgramCache {
  public:
    gl::Program& get(const std::string& file, const gl::Defines& defines = {});

  private:
    std::map<std::string, gl::Program> programs_;
};

// Dispatches as many work groups as a status counter asks for, known to the GPU only.
void dispatchCounted(gl::Program& program, std::uint32_t statusIndex, std::uint64_t capacity,
                     int perGroup, TraversalBuffers& buffers, ProgramCache& programs);

// The leaf pairs that a traversal left over because they cover many texels.
void splatLarge(const TraversalJob& job, const PassRange& range,
                const gl::TexelBuffer<glm::uvec2>& large, TraversalBuffers& buffers,
                ProgramCache& programs);

// How the pairs of a pass are visited. ManyViewPass has one of each kind and asks that which the
// settings name; what it keeps from frame to frame is of its own kind.
class PairTraversal {
  public:
    virtual ~PairTraversal() = default;
    PairTraversal(const PairTraversal&) = delete;
    PairTraversal& operator=(const PairTraversal&) = delete;

    // Whether it can visit the views in several passes.
    virtual bool worksInPasses() const { return true; }
    // Whether it writes every texel of the final maps. If not, it only takes minima.
    virtual bool writesEveryTexel() const { return false; }
    // Entries of a view node, as long as nothing is known.
    virtual std::uint64_t usualEntries(uint rules) const {
        return rules == kCorrectedRules ? 64 : 512;
    }
    // Bytes that a pass needs of each buffer of working maps.
    virtual std::array<std::uint64_t, 2> workBytes(const TraversalJob& job,
                                                   const PassRange& range) const = 0;
    // Entries that the memory budget and the device's limits allow.
    virtual std::uint64_t maxEntries(const TraversalJob& job) const = 0;
    virtual std::uint64_t bytesFor(const TraversalJob& job, std::uint64_t entries) const = 0;
    virtual void reserve(const TraversalJob& job, std::uint64_t entries) = 0;
    std::uint64_t entries() const { return entries_; }
    virtual std::uint64_t bytes() const = 0;
    virtual void run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                     ProgramCache& programs) = 0;
    // How the last run ended, by the status that it left.
    virtual PassOutcome outcome(std::span<const std::uint32_t> status) = 0;
    // What outcome() was told of cuts; zeros where none are kept.
    virtual CutCounts counts() const { return {}; }
    // How many views its passes take.
    PassPlan& plan() { return plan_; }

  protected:
    PairTraversal() = default;
    std::uint64_t entries_ = 0;  // that there is room for

  private:
    PassPlan plan_;
};

// View-major lists: traverse_lists.comp, one dispatch a view level. An entry is a word of the list
// buffers.
class ListTraversal : public PairTraversal {
  public:
    bool writesEveryTexel() const override { return true; }
    std::array<std::uint64_t, 2> workBytes(const TraversalJob& job,
                                           const PassRange& range) const override;
    std::uint64_t maxEntries(const TraversalJob& job) const override;
    std::uint64_t bytesFor(const TraversalJob& job, std::uint64_t entries) const override;
    void reserve(const TraversalJob& job, std::uint64_t entries) override;
    std::uint64_t bytes() const override;
    void run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
             ProgramCache& programs) override;
    PassOutcome outcome(std::span<const std::uint32_t> status) override;

  private:
    void bindLevel(const TraversalJob& job, const PassRange& range, std::size_t level,
                   TraversalBuffers& buffers, gl::Program& program);
    void resumeSuspended(TraversalBuffers& buffers, gl::Program& program);
    std::array<gl::TexelBuffer<std::uint32_t>, 2> lists_;  // by parity of the level
    gl::Buffer heads_;
    std::array<gl::Buffer, 2> suspended_;  // Suspended
    bool careful_ = false;    // work groups were suspended before: look after every level
    std::size_t levels_ = 0;  // of the last run
};

// Breadth-first queues: traverse_queue.comp, then fuse.comp level by level. An entry is a pair.
class QueueTraversal : public PairTraversal {
  public:
    std::array<std::uint64_t, 2> workBytes(const TraversalJob& job,
                                           const PassRange& range) const override;
    std::uint64_t maxEntries(const TraversalJob& job) const override;
    std::uint64_t bytesFor(const TraversalJob& job, std::uint64_t entries) const override;
    void reserve(const TraversalJob& job, std::uint64_t entries) override;
    std::uint64_t bytes() const override;
    void run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
             ProgramCache& programs) override;
    PassOutcome outcome(std::span<const std::uint32_t> status) override;

  private:
    // offsets: from each level's nodes to their working maps.
    void traverse(const TraversalJob& job, const PassRange& range,
                  const std::vector<std::uint32_t>& offsets, TraversalBuffers& buffers,
                  ProgramCache& programs);
    void fuse(const TraversalJob& job, const PassRange& range,
              const std::vector<std::uint32_t>& offsets, TraversalBuffers& buffers,
              ProgramCache& programs);
    std::array<gl::TexelBuffer<glm::uvec2>, 2> queues_;
    gl::TexelBuffer<glm::uvec2> large_;
    std::size_t steps_ = 0;  // of the last run
};

}  // namespace mv
