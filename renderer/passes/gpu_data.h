#pragma once
// What passes hand each other: buffers and the few numbers the CPU knows about them.

#include <cstdint>
#include <functional>
#include <vector>

#include "megaviews/hierarchy/scene_hierarchy.h"
#include "renderer/gl/texel_buffer.h"
#include "shaders/shared/map_store.glsl"
#include "shaders/shared/types.glsl"

namespace mv {

// Views by slot, written by VplPass or an upload.
struct GpuViews {
    gl::TexelBuffer<View> views;
    std::uint32_t count = 0;  // slots in use, dead ones included
};

// What ViewHierarchyPass makes of them; the members mirror mv::ViewHierarchy.
struct GpuViewHierarchy {
    gl::TexelBuffer<View> sortedViews;          // aliveCount
    gl::TexelBuffer<std::uint32_t> mortonKeys;  // aliveCount
    gl::TexelBuffer<ViewNode> nodes;            // nodeCount
    gl::TexelBuffer<std::uint32_t> mapOfNode;   // nodeCount: leaf ordinal or kNone
    gl::TexelBuffer<std::uint32_t> leafOfView;  // aliveCount: node index
    std::uint32_t aliveCount = 0, nodeCount = 0, leafCount = 0;
    std::uint32_t slotCount = 0;            // flat: the slots of its views are below
    std::vector<std::uint32_t> levelBegin;  // read back: levels + 1 entries; flat: {0, n}
    bool flat = false;
    std::uint64_t bytes() const;
    std::uint64_t widestLevel() const;  // nodes
};

// Where only some of the views have maps: a hierarchy of these, whose maps the others
// borrow.
struct GpuMapViews {
    const GpuViewHierarchy* all = nullptr;  // the hierarchy of all views
    GpuViews views;                         // those with maps, in the order of the sorted views
    GpuViewHierarchy tree;                  // of them
    gl::TexelBuffer<std::uint32_t> places;  // of each sorted view: in the tree's sorted views
    std::uint64_t bytes() const;
};

// The scene octree on the GPU: nodes of one rule set.
struct GpuSceneHierarchy {
    gl::TexelBuffer<SceneNode> nodes;
    std::vector<std::uint32_t> levelBegin;
    std::vector<std::uint32_t> movingBegin;  // as of MovingSurface::begin; empty: nothing moves
    std::uint32_t nodeCount = 0;
    int levels = 0;
};

// Fused maps of the leaf view nodes, or, without fusion, maps of all nodes.
struct GpuViewMaps {
    gl::TexelBuffer<std::uint32_t> texels;  // of mapCount maps, where store() says
    int mapRes = 0;
    std::uint32_t mapCount = 0;
    bool fused = true;     // false: map k belongs to view node k, query walks parents
    bool inQuads = false;  // read four words a texel: more of them than a buffer texture holds
    bool packed = false;   // 16 bits a texel, two texels a word
    bool present = false;  // false for method none: everything is visible

    // Where not all maps fit at once, `texels` hold those of one slice, from firstMap on, which
    // makeSlice() makes anew. Empty: all maps are there.
    std::vector<glm::uvec2> slices;  // begin, end in the maps
    std::uint32_t firstMap = 0;
    std::function<void(std::size_t slice)> makeSlice;

    MapStore store() const { return {static_cast<uint>(mapRes)}; }
    // Texels of maps [first, first + count), slice by slice where they are not all there. Waits.
    std::vector<std::uint32_t> readTexels(std::uint32_t first, std::uint32_t count) const;
};

// Whether a frame's maps hold every pair. overflowed: they do not; good: what was counted is in the
// statistics.
enum class Proof { good, underWay, overflowed };

}  // namespace mv
