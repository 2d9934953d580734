#pragma once
// Primitives that KHR_draco_mesh_compression packs, unpacked by Google's Draco. What a stream says
// of its size is held to what the document says before anything of that size is allocated. Serves
// the first stage, file -> Scene.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mv {

// An attribute of the stream and the accessor that it is for.
struct DracoAttribute {
    std::uint32_t id = 0;   // the attribute's unique id in the stream
    int componentType = 0;  // of the accessor: GL's number, 5120 ... 5126 but 5124
    std::size_t components = 0;
};

struct DracoRequest {
    std::uint64_t mostTriangles = 0;  // the stream may hold fewer
    std::uint64_t vertices = 0;       // it must hold as many, or more where corners were split
    std::uint64_t mostBytes = 0;      // that all attributes of the stream may take together
    std::vector<DracoAttribute> attributes;
};

struct DracoMesh {
    std::uint64_t vertices = 0;
    std::vector<std::uint32_t> indices;                 // three a triangle
    std::vector<std::vector<std::uint8_t>> attributes;  // as requested, tightly packed
    std::vector<float>
        steps;          // of the grids that positions were packed on; 0: none, or no positions
    std::string error;  // why there is nothing; empty: success
};

// Safe to call from several threads.
DracoMesh decodeDraco(std::span<const std::uint8_t> compressed, const DracoRequest& request);

}  // namespace mv
