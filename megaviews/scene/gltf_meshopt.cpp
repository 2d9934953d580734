#include "megaviews/scene/gltf_meshopt.h"

#include <meshoptimizer.h>

namespace mv {

std::string meshoptViewError(const MeshoptView& view, std::uint64_t compressedBytes) {
    const std::uint64_t stride = view.byteStride;
    const std::string strideIs = "its byteStride is " + std::to_string(stride);
    std::uint64_t least = 0;  // bytes that its elements take when they are packed
    if (view.mode == "ATTRIBUTES") {
        if (stride == 0 || stride % 4 != 0 || stride > 256) {
            return strideIs + "; of attributes it must be a multiple of 4 up to 256";
        }
        // Two bits stand for no fewer than each 16 bytes of a column of bytes.
        least = view.count * stride / 64;
    } else {
        if (stride != 2 && stride != 4) return strideIs + "; of indices it must be 2 or 4";
        if (view.filter != "NONE") return "filter " + view.filter + " is for attributes only";
        const bool triangles = view.mode == "TRIANGLES";
        if (triangles && view.count % 3 != 0) {
            return "count " + std::to_string(view.count) + " of mode TRIANGLES is no multiple of 3";
        }
        least = triangles ? view.count / 3 : view.count;
    }
    if (view.filter == "OCTAHEDRAL" && stride != 4 && stride != 8) {
        return strideIs + "; for filter OCTAHEDRAL it must be 4 or 8";
    }
    if (view.filter == "QUATERNION" && stride != 8) {
        return strideIs + "; for filter QUATERNION it must be 8";
    }
    if (least > compressedBytes) {
        return std::to_string(compressedBytes) + " bytes cannot hold " +
               std::to_string(view.count) + " elements";
    }
    return "";
}

std::string decodeMeshopt(const MeshoptView& view, std::span<const std::uint8_t> compressed,
                          std::span<std::uint8_t> out) {
    // Named by their type: the header has templates of the same names.
    using Decode = int(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
    Decode* const vertices = meshopt_decodeVertexBuffer;
    Decode* const triangles = meshopt_decodeIndexBuffer;
    Decode* const indices = meshopt_decodeIndexSequence;
    Decode* const decode = view.mode == "ATTRIBUTES"  ? vertices
                           : view.mode == "TRIANGLES" ? triangles
                                                      : indices;
    const int result =
        decode(out.data(), view.count, view.byteStride, compressed.data(), compressed.size());
    constexpr int kWrongHeader = -1, kTooShort = -2, kTooLong = -3;
    switch (result) {
        case 0:
            break;
        case kWrongHeader:
            return "its data do not begin as those of mode " + view.mode +
                   " do, or in a later version";
        case kTooShort:
            return "its data are damaged: they end too early";
        case kTooLong:
            return "its data are damaged: bytes are left over";
        default:
            return "its data are damaged";
    }
    if (view.filter == "OCTAHEDRAL") {
        meshopt_decodeFilterOct(out.data(), view.count, view.byteStride);
    } else if (view.filter == "QUATERNION") {
        meshopt_decodeFilterQuat(out.data(), view.count, view.byteStride);
    } else if (view.filter == "EXPONENTIAL") {
        meshopt_decodeFilterExp(out.data(), view.count, view.byteStride);
    }
    return "";
}

}  // namespace mv
