#include "megaviews/scene/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

namespace mv {

namespace {

std::optional<int> attribute(const std::map<std::string, int>& attributes,
                             const std::string& name) {
    const auto it = attributes.find(name);
    return it == attributes.end() ? std::nullopt : std::optional(it->second);
}

// Of the grid that an accessor's values lie on; 0: none. Whole numbers are one; of what was a grid
// once, such as a Draco stream's, the accessor says so.
double stepOf(const tinygltf::Accessor& accessor) {
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT) {
        if (!accessor.normalized) return 1;
        switch (accessor.componentType) {
            case TINYGLTF_COMPONENT_TYPE_BYTE:
                return 1.0 / 127;
            case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
                return 1.0 / 255;
            case TINYGLTF_COMPONENT_TYPE_SHORT:
                return 1.0 / 32767;
            default:
                return 1.0 / 65535;
        }
    }
    if (!accessor.extras.Has("megaviews")) return 0;
    const double step = accessor.extras.Get("megaviews").Get("positionStep").GetNumberAsDouble();
    return std::isfinite(step) ? step : 0;
}

std::vector<glm::vec2> readUvs(const AccessorReader& reader, const tinygltf::Primitive& in,
                               const std::optional<UvSource>& source, std::size_t vertices) {
    if (!source) return {};
    const auto accessor = attribute(in.attributes, "TEXCOORD_" + std::to_string(source->set));
    if (!accessor) return std::vector<glm::vec2>(vertices, glm::vec2(source->offset));
    std::vector<glm::vec2> result;
    result.reserve(vertices);
    for (const glm::dvec2& uv : reader.vectors2(*accessor)) {
        const glm::dvec2 moved = source->matrix * uv + source->offset;
        const bool usable = std::abs(moved.x) < 1e9 && std::abs(moved.y) < 1e9;  // false for NaN
        result.push_back(usable ? glm::vec2(moved) : glm::vec2(0));
    }
    return result;
}

template <typename T>
std::vector<T> picked(std::vector<T> values, const std::vector<std::uint32_t>& kept,
                      std::size_t vertices) {
    if (values.empty() || kept.size() == vertices) return values;
    std::vector<T> result;
    result.reserve(kept.size());
    for (const std::uint32_t i : kept) result.push_back(values[i]);
    return result;
}

}  // namespace

bool drawsTriangles(const tinygltf::Primitive& primitive) {
    return primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.attributes.contains("POSITION");
}

PrimitiveSize primitiveSize(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    const auto count = [&](int accessor) {
        return std::uint64_t{model.accessors[static_cast<std::size_t>(accessor)].count};
    };
    PrimitiveSize size;
    const std::uint64_t stored = count(primitive.attributes.at("POSITION"));
    const std::uint64_t indices = primitive.indices >= 0 ? count(primitive.indices) : stored;
    size.triangles = primitive.mode == TINYGLTF_MODE_TRIANGLES ? indices / 3
                     : indices >= 3                            ? indices - 2
                                                               : 0;
    size.vertices = std::min(stored, 3 * size.triangles);
    std::uint64_t attributes = primitive.attributes.size();
    for (const auto& target : primitive.targets) attributes += target.size();
    size.elementsKept = attributes * size.vertices;
    size.elementsRead = attributes * stored + indices;
    return size;
}

TriangleList assembleTriangles(int mode, std::span<const std::uint32_t> indices) {
    TriangleList list;
    const std::size_t n = indices.size();
    const bool separate = mode == TINYGLTF_MODE_TRIANGLES;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a != b && b != c && c != a) {
            list.triangles.emplace_back(a, b, c);
        } else if (separate) {  // strips are stitched with such triangles on purpose
            ++list.repeated;
        }
    };
    if (separate) {
        list.triangles.reserve(n / 3);
        for (std::size_t i = 0; i + 2 < n; i += 3) add(indices[i], indices[i + 1], indices[i + 2]);
        list.leftOver = n % 3;
        return list;
    }
    list.leftOver = n < 3 ? n : 0;
    for (std::size_t i = 0; i + 2 < n; ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            add(indices[i + 1], indices[i + 2], indices[0]);
        } else {
            add(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
        }
    }
    return list;
}

Primitive readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& in,
                        const std::string& place, std::span<const MaterialUvs> uvs,
                        const GltfReport& report) {
    const AccessorReader reader(model, report);
    Primitive out;
    out.place = place;
    out.positions = reader.vectors3(in.attributes.at("POSITION"));
    out.positionStep =
        stepOf(model.accessors[static_cast<std::size_t>(in.attributes.at("POSITION"))]);
    const std::size_t vertices = out.positions.size();

    // Triangles, every index checked.
    std::vector<std::uint32_t> indices;
    if (in.indices >= 0) {
        indices = reader.indices(in.indices);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (indices[i] < vertices) continue;
            report.fail(place, "index " + std::to_string(i) + " is vertex " +
                                   std::to_string(indices[i]) + ", but there are " +
                                   std::to_string(vertices) + " vertices");
        }
    } else {
        indices.resize(vertices);
        std::iota(indices.begin(), indices.end(), 0u);
    }
    TriangleList list = assembleTriangles(in.mode, indices);
    out.triangles = std::move(list.triangles);
    out.repeatedIndices = list.repeated;
    out.leftOverIndices = list.leftOver;

    const std::vector<std::uint32_t> kept = dropUnusedVertices(out.triangles, vertices);
    const auto keep = [&](auto values) { return picked(std::move(values), kept, vertices); };
    out.positions = keep(std::move(out.positions));

    // Attributes.
    if (const auto normal = attribute(in.attributes, "NORMAL")) {
        out.normals = keep(reader.vectors3(*normal, true));
    }
    if (const auto color = attribute(in.attributes, "COLOR_0")) {
        out.colors.reserve(kept.size());
        for (const glm::dvec4& c : keep(reader.vectors(*color, glm::dvec4(1), true))) {
            // Comparisons are false for NaN: such a channel is white.
            glm::vec4 clamped;
            for (int i = 0; i < 4; ++i) {
                clamped[i] = c[i] <= 0 ? 0.0f : c[i] < 1 ? static_cast<float>(c[i]) : 1.0f;
            }
            out.colors.push_back(clamped);
        }
    }
    out.material = in.material >= 0 ? static_cast<std::uint32_t>(in.material)
                                    : static_cast<std::uint32_t>(uvs.size() - 1);
    out.uvs = keep(readUvs(reader, in, uvs[out.material].base, vertices));
    out.emissiveUvs = keep(readUvs(reader, in, uvs[out.material].emissive, vertices));

    // What a pose needs.
    for (int set = 0; set < 8; ++set) {
        const auto joints = attribute(in.attributes, "JOINTS_" + std::to_string(set));
        const auto weights = attribute(in.attributes, "WEIGHTS_" + std::to_string(set));
        if (!joints || !weights) break;
        out.influences.push_back(
            {keep(reader.indices4(*joints)), keep(reader.vectors(*weights, glm::dvec4(0), true))});
    }
    for (const auto& target : in.targets) {
        Primitive::MorphTarget& morph = out.targets.emplace_back();
        if (const auto position = attribute(target, "POSITION")) {
            morph.positions = keep(reader.vectors3(*position));
        }
        if (const auto normal = attribute(target, "NORMAL")) {
            morph.normals = keep(reader.vectors3(*normal, true));
        }
    }
    return out;
}

}  // namespace mv
