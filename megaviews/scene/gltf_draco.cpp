#include "megaviews/scene/gltf_draco.h"

#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <new>

#include "megaviews/core/text.h"

namespace mv {

namespace {

// One of Draco's two mesh decoders, stopped where a stream announces more than was requested.
template <typename Decoder>
class BoundedDecoder : public Decoder {
  public:
    explicit BoundedDecoder(const DracoRequest& request) : request_(request) {}
    std::string reason;  // it was stopped for

  protected:
    // Called at the first byte of the connectivity, before anything is allocated for it.
    bool InitializeDecoder() override {
        constexpr bool kEdgebreaker = std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>;
        if (!Decoder::InitializeDecoder()) return false;
        draco::DecoderBuffer ahead = *this->buffer();
        std::uint32_t vertices = 0, triangles = 0;
        std::uint8_t seams = 0;  // attributes with a connectivity of their own
        if (kEdgebreaker && !draco::DecodeVarint(&vertices, &ahead)) return false;
        if (!draco::DecodeVarint(&triangles, &ahead)) return false;
        if (kEdgebreaker && !ahead.Decode(&seams)) return false;
        if (triangles > request_.mostTriangles) {
            reason = "its stream announces " + std::to_string(triangles) +
                     " triangles, its accessors " + std::to_string(request_.mostTriangles);
            return false;
        }
        constexpr std::uint64_t kBytesATriangle = 3 * sizeof(std::uint32_t);
        return fits(triangles * kBytesATriangle * (1 + std::uint64_t{seams}));
    }

    // Called when all attributes are announced and none is allocated.
    bool DecodeAllAttributes() override {
        const draco::PointCloud& points = *this->point_cloud();
        // Corners apart, of triangles that were held to theirs.
        const std::uint64_t most = std::max(request_.vertices, 3 * request_.mostTriangles);
        if (points.num_points() < request_.vertices || points.num_points() > most) {
            reason = "its stream holds " + std::to_string(points.num_points()) +
                     " vertices, its accessors " + std::to_string(request_.vertices);
            return false;
        }
        std::uint64_t bytes = 0;
        for (int i = 0; i < points.num_attributes(); ++i) {
            bytes += static_cast<std::uint64_t>(points.attribute(i)->byte_stride());
        }
        return fits(bytes * points.num_points()) && Decoder::DecodeAllAttributes();
    }

  private:
    bool fits(std::uint64_t bytes) {
        if (bytes <= request_.mostBytes) return true;
        reason = "its stream expands to more than is supported";
        return false;
    }

    const DracoRequest& request_;
};

template <typename T>
bool convert(const draco::PointAttribute& from, std::size_t vertices, std::size_t components,
             std::vector<std::uint8_t>& out) {
    std::array<T, 4> value{};
    const std::size_t bytes = components * sizeof(T);
    out.resize(vertices * bytes);
    for (std::size_t i = 0; i < vertices; ++i) {
        const auto index = from.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
        if (index.value() >= from.size() ||
            !from.ConvertValue(index, static_cast<std::int8_t>(components), value.data())) {
            return false;
        }
        std::memcpy(out.data() + i * bytes, value.data(), bytes);
    }
    return true;
}

// Positions come as whole numbers on their grid. Places them as Draco's decoder would, and returns
// the grid's step; 0 for what was not packed on one, and stands as it is.
float leaveGrid(const draco::PointAttribute& from, std::size_t components,
                std::vector<std::uint8_t>& floats) {
    const draco::AttributeTransformData* packed = from.GetAttributeTransformData();
    draco::AttributeQuantizationTransform grid;
    if (!packed || packed->transform_type() != draco::ATTRIBUTE_QUANTIZATION_TRANSFORM ||
        !grid.InitFromAttribute(from)) {
        return 0;
    }
    const std::uint32_t most = (1u << static_cast<std::uint32_t>(grid.quantization_bits())) - 1;
    const float step = grid.range() / static_cast<float>(most);
    for (std::size_t i = 0; i < floats.size() / sizeof(float); ++i) {
        float value;
        std::memcpy(&value, floats.data() + i * sizeof(float), sizeof(float));
        value = value * step + grid.min_value(static_cast<int>(i % components));
        std::memcpy(floats.data() + i * sizeof(float), &value, sizeof(float));
    }
    return step;
}

bool convert(const draco::PointAttribute& from, const DracoAttribute& to, std::size_t vertices,
             std::vector<std::uint8_t>& out) {
    if (!from.is_mapping_identity() && from.indices_map_size() < vertices) return false;
    switch (to.componentType) {
        case 5120:
            return convert<std::int8_t>(from, vertices, to.components, out);
        case 5121:
            return convert<std::uint8_t>(from, vertices, to.components, out);
        case 5122:
            return convert<std::int16_t>(from, vertices, to.components, out);
        case 5123:
            return convert<std::uint16_t>(from, vertices, to.components, out);
        case 5125:
            return convert<std::uint32_t>(from, vertices, to.components, out);
        default:
            return convert<float>(from, vertices, to.components, out);
    }
}

// Empty on success.
template <typename Decoder>
std::string decodeInto(draco::Mesh& mesh, draco::DecoderBuffer& buffer,
                       const DracoRequest& request) {
    BoundedDecoder<Decoder> decoder(request);
    draco::DecoderOptions options;
    options.SetAttributeBool(draco::GeometryAttribute::POSITION, "skip_attribute_transform", true);
    const draco::Status status = decoder.Decode(options, &buffer, &mesh);
    if (status.ok()) return "";
    if (!decoder.reason.empty()) return decoder.reason;
    return "its stream is damaged (" + printable(status.error_msg_string()) + ")";
}

std::string decodeMesh(draco::Mesh& mesh, std::span<const std::uint8_t> compressed,
                       const DracoRequest& request) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(compressed.data()), compressed.size());
    draco::DecoderBuffer ahead = buffer;
    draco::DracoHeader header{};
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) {
        return "its data are no Draco stream";
    }
    // The extension knows no other version, and Draco's readers of older ones are not for new
    // files.
    if (header.version_major != 2 || header.version_minor != 2) {
        return "its stream is of Draco's version " + std::to_string(header.version_major) + "." +
               std::to_string(header.version_minor) + ", not 2.2";
    }
    if (header.encoder_type != draco::TRIANGULAR_MESH) return "its stream holds no triangles";
    switch (header.encoder_method) {
        case draco::MESH_EDGEBREAKER_ENCODING:
            return decodeInto<draco::MeshEdgebreakerDecoder>(mesh, buffer, request);
        case draco::MESH_SEQUENTIAL_ENCODING:
            return decodeInto<draco::MeshSequentialDecoder>(mesh, buffer, request);
        default:
            return "its stream is damaged (unknown method)";
    }
}

}  // namespace

DracoMesh decodeDraco(std::span<const std::uint8_t> compressed, const DracoRequest& request) {
    DracoMesh out;
    draco::Mesh mesh;
    try {
        out.error = decodeMesh(mesh, compressed, request);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        out.error = "its stream is damaged (" + printable(e.what()) + ")";
    }
    if (!out.error.empty()) return out;
    if (mesh.num_faces() == 0) out.error = "its stream holds no triangles";

    out.vertices = mesh.num_points();
    out.indices.reserve(3 * std::size_t{mesh.num_faces()});
    for (draco::FaceIndex face(0); face < mesh.num_faces(); ++face) {
        for (const draco::PointIndex& point : mesh.face(face)) {
            out.indices.push_back(point.value());  // in range or not: as other files' indices are
        }
    }
    for (const DracoAttribute& wanted : request.attributes) {
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
        const std::string name = "attribute " + std::to_string(wanted.id) + " of its stream";
        std::vector<std::uint8_t>& bytes = out.attributes.emplace_back();
        float& step = out.steps.emplace_back(0.0f);
        if (!attribute) {
            out.error = "there is no " + name;
        } else if (attribute->num_components() != static_cast<int>(wanted.components)) {
            out.error = name + " has " +
                        std::to_string(static_cast<std::uint64_t>(attribute->num_components())) +
                        " components, its accessor " + std::to_string(wanted.components);
        } else if (!convert(*attribute, wanted, out.vertices, bytes)) {
            out.error = "values of " + name + " do not fit its accessor";
        } else if (wanted.componentType == 5126) {
            step = leaveGrid(*attribute, wanted.components, bytes);
        }
        if (!out.error.empty()) break;
    }
    return out;
}

}  // namespace mv
