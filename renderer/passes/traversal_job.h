#pragma once
// What the two organisations of the GPU traversal share: the frame's task, the range of views one
// pass takes, and their working buffers. Used by ManyViewPass only.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "renderer/gl/program.h"
#include "renderer/passes/gpu_data.h"
#include "renderer/passes/many_view_pass.h"

namespace mv {

// A buffer that shaders also read as texels.
struct TexelBuffer {
    gl::Buffer buffer;
    gl::TextureBuffer texels;
    void ensure(const std::string& label, GLenum format, std::uint64_t bytes);
};

// Words of the status buffer: [0] something overflowed; [1 + k] entries appended to list level k
// or queue k, past the capacity too.
inline constexpr std::uint32_t kStatusWords = 64;
inline constexpr std::uint32_t kFirstStatusCounter = 1;

// Views [firstView, endView) of the sorted views, and the nodes of each level that hold any of
// them. Pairs of nodes that start before firstView are counted by an earlier pass.
struct PassRange {
    std::uint32_t firstView = 0, endView = 0;
    std::vector<glm::uvec2> levels;  // begin, end in the view nodes
};

struct PassOutcome {
    bool overflowed = false;
    std::uint64_t peakEntries = 0;
};

struct TraversalJob {
    const GpuSceneHierarchy& scene;
    const GpuViewHierarchy& views;
    const ManyViewOptions& options;
    gl::Profiler& profiler;
    GpuViewMaps& out;
    bool fuse = true;   // trees only: flat hierarchies have nothing to fuse
    bool mips = false;  // multi-pixel filling by coarser levels

    std::uint64_t mapBytes() const;
    std::uint64_t mipBytes() const;
    gl::Defines defines() const;  // of every traversal shader
};

// Buffers of both organisations that depend on the job.
struct TraversalBuffers {
    gl::Buffer counters, status, mips;
    std::array<TexelBuffer, 2> work;  // maps of internal view nodes
    std::uint64_t bytes() const;
    void bind(const TraversalJob& job) const;  // nodes, counters, status, leaf maps, coarser levels
};

// Programs by file and defines, compiled at first use.
class ProgramCache {
  public:
    gl::Program& get(const std::string& file, const gl::Defines& defines);

  private:
    std::map<std::string, gl::Program> programs_;
};

// View-major lists: traverse_lists.comp, one dispatch a view level.
class ListTraversal {
  public:
    // Bytes of working maps that a pass needs, the larger of the two buffers first.
    static std::pair<std::uint64_t, std::uint64_t> workBytes(const TraversalJob& job,
                                                             const PassRange& range);
    std::uint64_t maxEntries(const TraversalJob& job) const;  // that the memory budget allows
    void reserve(const TraversalJob& job, std::uint64_t entries);
    std::uint64_t entries() const { return entries_; }
    std::uint64_t bytes() const;
    PassOutcome run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                    ProgramCache& programs);

  private:
    std::array<TexelBuffer, 2> lists_;  // by parity of the level
    gl::Buffer heads_;
    std::uint64_t entries_ = 0;  // of each list buffer, words
};

// Breadth-first queues: traverse_queue.comp, then fuse.comp level by level.
class QueueTraversal {
  public:
    static std::pair<std::uint64_t, std::uint64_t> workBytes(const TraversalJob& job,
                                                             const PassRange& range);
    std::uint64_t maxEntries(const TraversalJob& job) const;
    void reserve(const TraversalJob& job, std::uint64_t entries);
    std::uint64_t entries() const { return entries_; }
    std::uint64_t bytes() const;
    PassOutcome run(const TraversalJob& job, const PassRange& range, TraversalBuffers& buffers,
                    ProgramCache& programs);

  private:
    void fuse(const TraversalJob& job, const PassRange& range,
              const std::vector<std::uint32_t>& offsets, TraversalBuffers& buffers,
              ProgramCache& programs);
    std::array<TexelBuffer, 2> queues_;
    gl::TextureBuffer mapOfNode_;
    gl::Buffer command_;
    std::uint64_t entries_ = 0;  // of each queue, pairs
};

}  // namespace mv
