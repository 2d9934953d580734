#pragma once
// What passes hand each other: buffers and the few numbers the CPU knows about them.

#include <cstdint>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "shaders/shared/types.glsl"

namespace mv {

// Views by slot, written by VplPass, ParticlePass or an upload.
struct GpuViews {
    gl::Buffer views;         // View[capacity]
    std::uint32_t count = 0;  // slots in use, dead ones included
};

// What ViewHierarchyPass makes of them; the members mirror mv::ViewHierarchy.
struct GpuViewHierarchy {
    gl::Buffer sortedViews;         // View[aliveCount]
    gl::Buffer mortonKeys;          // uint[aliveCount]
    gl::Buffer nodes;               // ViewNode[nodeCount]
    gl::TextureBuffer nodesTexels;  // the same as RGBA32UI texels, 4 a node
    gl::Buffer mapOfNode;           // uint[nodeCount]: leaf ordinal or kNone
    gl::Buffer leafOfView;          // uint[aliveCount]: node index
    std::uint32_t aliveCount = 0, nodeCount = 0, leafCount = 0;
    std::vector<std::uint32_t> levelBegin;  // read back: levels + 1 entries; flat: {0, n}
    bool flat = false;
    std::uint64_t bytes() const;
};

// The scene octree on the GPU: nodes of one rule set as texels, attributes for the gather.
struct GpuSceneHierarchy {
    gl::Buffer nodes;               // SceneNode[nodeCount]
    gl::TextureBuffer nodesTexels;  // RGBA32UI, 3 a node
    gl::Buffer attributes;          // SceneNodeAttributes[nodeCount]; rules do not change them
    gl::Buffer mortonKeys;          // uint[nodeCount]
    std::vector<std::uint32_t> levelBegin;
    std::uint32_t nodeCount = 0;
    int levels = 0;
};

// The scene octree as shaders/shared/march.glsl walks it.
struct GpuMarchTree {
    gl::Buffer nodes;               // MarchTree::nodes
    gl::TextureBuffer nodesTexels;  // RGBA32UI, one a node
    std::uint32_t nodeCount = 0;
    float leafEdge = 0;  // root-cube units
};

// Fused maps of the leaf view nodes, or, without fusion, maps of all nodes.
struct GpuViewMaps {
    gl::Buffer texels;  // uint[maps * 2 * R * R], ordered float bits, kNone = empty
    int viewRes = 0;
    std::uint32_t mapCount = 0;
    bool fused = true;     // false: map k belongs to view node k, query walks parents
    bool present = false;  // false for method none: everything is visible
};

}  // namespace mv
