#include "scene/packed_box.h"

#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace mv::testing {

namespace {

template <typename T>
int addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type type, draco::DataType dataType,
                 int components, bool normalized, const std::vector<T>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<std::uint8_t>(components), dataType, normalized,
                   sizeof(T), 0);
    const int id = mesh.AddAttribute(attribute, true, static_cast<std::uint32_t>(values.size()));
    for (std::uint32_t i = 0; i < values.size(); ++i) {
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
    }
    return id;
}

std::string cornerText(const Scene& scene, std::uint32_t vertex) {
    const glm::dvec3 p = scene.root.worldFromRoot(scene.positions[vertex]);
    const glm::vec3 n = scene.normals[vertex];
    std::vector<double> numbers = {p.x, p.y, p.z, n.x, n.y, n.z};
    if (!scene.uvs.empty()) {
        numbers.insert(numbers.end(), {scene.uvs[vertex].x, scene.uvs[vertex].y});
    }
    if (!scene.colors.empty()) {
        for (int k = 0; k < 4; ++k) numbers.push_back(scene.colors[vertex][k]);
    }
    std::string text = "(";
    for (const double number : numbers) {
        const double rounded = std::round(number * 100) / 100;
        text += std::to_string(rounded == 0 ? 0 : rounded).substr(0, 5) + " ";
    }
    return text + ")";
}

}  // namespace

Box makeBox() {
    Box box;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2;
        const float sign = side % 2 ? 1.0f : -1.0f;
        for (int corner = 0; corner < 4; ++corner) {
            // Counter-clockwise as seen from outside.
            const float u = corner == 1 || corner == 2 ? 1.0f : -1.0f;
            const float v = corner >= 2 ? 1.0f : -1.0f;
            glm::vec3 p(0), n(0);
            p[axis] = n[axis] = sign;
            p[(axis + 1) % 3] = u * sign;
            p[(axis + 2) % 3] = v;
            box.positions.push_back(p);
            box.normals.push_back(n);
            box.uvs.emplace_back((u + 1) / 2, (v + 1) / 2);
            box.colors.emplace_back(40 * side, 51 * corner, 255, 255);
        }
        for (const int k : {0, 1, 2, 0, 2, 3}) {
            box.indices.push_back(static_cast<std::uint16_t>(4 * side + k));
        }
    }
    return box;
}

GltfBuilder plainBox() {
    const Box box = makeBox();
    GltfBuilder b;
    const int position = b.positions(box.positions), normal = b.positions(box.normals);
    const int uv = b.accessor(box.uvs, kFloat, "VEC2", 24);
    const int color = b.accessor(box.colors, kUnsignedByte, "VEC4", 24, true);
    const int index = b.accessor(box.indices, kUnsignedShort, "SCALAR", 36);
    b.primitive(
        {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}},
        index)["material"] = 0;
    const int texture = b.texture(png(1, 1, Bytes{200, 100, 50, 255}));
    b.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    return b;
}

Bytes dracoStream(const Box& box, DracoMethod method, bool quantised) {
    using draco::GeometryAttribute;
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<std::uint32_t>(box.positions.size()));
    for (std::size_t i = 0; i + 2 < box.indices.size(); i += 3) {
        mesh.AddFace({{draco::PointIndex(box.indices[i]), draco::PointIndex(box.indices[i + 1]),
                       draco::PointIndex(box.indices[i + 2])}});
    }
    addAttribute(mesh, GeometryAttribute::POSITION, draco::DT_FLOAT32, 3, false, box.positions);
    addAttribute(mesh, GeometryAttribute::NORMAL, draco::DT_FLOAT32, 3, false, box.normals);
    addAttribute(mesh, GeometryAttribute::TEX_COORD, draco::DT_FLOAT32, 2, false, box.uvs);
    addAttribute(mesh, GeometryAttribute::COLOR, draco::DT_UINT8, 4, true, box.colors);
    // Sides share the positions of their corners, hence their edges.
    if (!mesh.DeduplicateAttributeValues()) throw std::runtime_error("Draco cannot deduplicate");
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method == DracoMethod::sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                                : draco::MESH_EDGEBREAKER_ENCODING);
    if (quantised) {
        encoder.SetAttributeQuantization(kDracoPosition, 14);
        encoder.SetAttributeQuantization(kDracoNormal, 12);
        encoder.SetAttributeQuantization(kDracoUv, 14);
    }
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw std::runtime_error(status.error_msg_string());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(buffer.data());
    return {bytes, bytes + buffer.size()};
}

std::vector<glm::vec3> dracoPositions(std::span<const std::uint8_t> stream) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
    const draco::PointAttribute& attribute =
        *decoded.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    std::vector<glm::vec3> positions(attribute.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        attribute.GetValue(draco::AttributeValueIndex(i), &positions[i].x);
    }
    return positions;
}

GltfBuilder dracoBox(std::span<const std::uint8_t> stream) {
    GltfBuilder b = plainBox();
    const int view = b.view(Bytes(stream.begin(), stream.end()));
    for (Json& accessor : b.json["accessors"]) accessor.erase("bufferView");
    b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view},
        {"attributes",
         {{"POSITION", kDracoPosition},
          {"NORMAL", kDracoNormal},
          {"TEXCOORD_0", kDracoUv},
          {"COLOR_0", kDracoColor}}}};
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return b;
}

int addMeshoptView(GltfBuilder& b, const Bytes& packed, std::size_t count, std::size_t byteStride,
                   const std::string& mode, const std::string& filter) {
    b.view(packed);
    const Json where = b.json["bufferViews"].back();
    const std::size_t bytes = count * byteStride;
    Json& buffers = b.json["buffers"];
    if (buffers.is_null()) {
        buffers = {{{"byteLength", 0}},
                   {{"byteLength", 0},
                    {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    }
    const auto offset = buffers[1]["byteLength"].get<std::size_t>();
    buffers[0]["byteLength"] = b.binary.size();
    buffers[1]["byteLength"] = offset + (bytes + 3) / 4 * 4;
    Json& view = b.json["bufferViews"].back();
    view = {{"buffer", 1}, {"byteOffset", offset}, {"byteLength", bytes}};
    if (mode == "ATTRIBUTES") view["byteStride"] = byteStride;
    Json& extension = view["extensions"]["EXT_meshopt_compression"];
    extension = where;
    extension["mode"] = mode;
    extension["filter"] = filter;
    extension["count"] = count;
    extension["byteStride"] = byteStride;
    return static_cast<int>(b.json["bufferViews"].size()) - 1;
}

Bytes meshoptVertices(const void* data, std::size_t count, std::size_t byteStride) {
    Bytes packed(meshopt_encodeVertexBufferBound(count, byteStride));
    packed.resize(
        meshopt_encodeVertexBuffer(packed.data(), packed.size(), data, count, byteStride));
    return packed;
}

Bytes meshoptTriangles(const std::vector<std::uint16_t>& indices) {
    Bytes packed(meshopt_encodeIndexBufferBound(indices.size(), 65536));
    packed.resize(meshopt_encodeIndexBuffer<std::uint16_t>(packed.data(), packed.size(),
                                                           indices.data(), indices.size()));
    return packed;
}

GltfBuilder meshoptBox() {
    const Box box = makeBox();
    GltfBuilder b;
    const std::size_t n = box.positions.size();
    std::vector<glm::uvec3> exponents(n);
    meshopt_encodeFilterExp(exponents.data(), n, sizeof(glm::uvec3), 15, &box.positions[0].x);
    std::vector<glm::vec4> normals;
    for (const glm::vec3& normal : box.normals) normals.emplace_back(normal, 0.0f);
    std::vector<glm::i8vec4> octahedral(n);
    meshopt_encodeFilterOct(octahedral.data(), n, sizeof(glm::i8vec4), 8, &normals[0].x);

    const auto attribute = [&](const void* data, std::size_t stride, int componentType,
                               const char* type, bool normalized, const char* filter) {
        const int view =
            addMeshoptView(b, meshoptVertices(data, n, stride), n, stride, "ATTRIBUTES", filter);
        return b.accessor(view, componentType, type, n, 0, normalized);
    };
    const int position =
        attribute(exponents.data(), sizeof exponents[0], kFloat, "VEC3", false, "EXPONENTIAL");
    const int normal =
        attribute(octahedral.data(), sizeof octahedral[0], kByte, "VEC3", true, "OCTAHEDRAL");
    const int uv = attribute(box.uvs.data(), sizeof box.uvs[0], kFloat, "VEC2", false, "NONE");
    const int color =
        attribute(box.colors.data(), sizeof box.colors[0], kUnsignedByte, "VEC4", true, "NONE");
    const int indexView =
        addMeshoptView(b, meshoptTriangles(box.indices), box.indices.size(), 2, "TRIANGLES");
    const int index = b.accessor(indexView, kUnsignedShort, "SCALAR", box.indices.size());
    b.primitive(
        {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}, {"COLOR_0", color}},
        index)["material"] = 0;
    b.json["materials"] = plainBox().json["materials"];
    b.json["textures"] = plainBox().json["textures"];
    b.json["images"] = plainBox().json["images"];
    b.json["extensionsUsed"] =
        b.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    return b;
}

Bytes webp(int width, int height, std::span<const std::uint8_t> rgba) {
    std::uint8_t* out = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), width, height, 4 * width, &out);
    const Bytes bytes(out, out + size);
    WebPFree(out);
    return bytes;
}

std::string describeTriangles(const Scene& scene) {
    std::vector<std::string> lines;
    for (const glm::uvec3& triangle : scene.triangles) {
        std::array<std::string, 3> corners;
        for (int k = 0; k < 3; ++k) {
            corners[static_cast<std::size_t>(k)] = cornerText(scene, triangle[k]);
        }
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        lines.push_back(corners[0] + corners[1] + corners[2]);
    }
    std::sort(lines.begin(), lines.end());
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
}

}  // namespace mv::testing
