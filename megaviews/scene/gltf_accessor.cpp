#include "megaviews/scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace mv {

namespace {

template <typename Source, typename T>
T convert(const std::uint8_t* bytes, bool normalized) {
    Source value;
    std::memcpy(&value, bytes, sizeof value);
    if constexpr (std::is_integral_v<Source> && std::is_floating_point_v<T>) {
        if (normalized) {
            constexpr T kLargest = static_cast<T>(std::numeric_limits<Source>::max());
            return std::max(static_cast<T>(value) / kLargest, T(-1));
        }
    }
    if constexpr (std::is_floating_point_v<Source> && std::is_integral_v<T>) {
        return T(0);  // the check lets no float accessor be read as an integer
    } else {
        return static_cast<T>(value);
    }
}

struct Layout {
    const std::uint8_t* first;
    std::size_t stride;
    std::size_t count;
};

// Copies `width` components an element to `out`, `outStride` values apart. `target(i)` is the
// element of `out` that the i-th of the source goes to.
template <typename T, typename Target>
void copyElements(const Layout& from, int componentType, std::size_t width, bool normalized, T* out,
                  std::size_t outStride, Target target) {
    const auto run = [&]<typename Source>(Source) {
        for (std::size_t i = 0; i < from.count; ++i) {
            const std::uint8_t* element = from.first + i * from.stride;
            T* to = out + target(i) * outStride;
            for (std::size_t c = 0; c < width; ++c) {
                to[c] = convert<Source, T>(element + c * sizeof(Source), normalized);
            }
        }
    };
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return run(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return run(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return run(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return run(std::uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return run(std::uint32_t{});
        default:
            return run(float{});
    }
}

std::size_t components(const tinygltf::Accessor& accessor) {
    return static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}

std::size_t componentSize(int componentType) {
    return static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType)));
}

}  // namespace

// `out` holds count elements of `width` values each, `stride` apart, already set to what absent
// components are worth.
template <typename T>
void AccessorReader::read(int index, std::size_t width, bool normalize, T* out,
                          std::size_t stride) const {
    const tinygltf::Accessor& accessor = get(index);
    const std::size_t present = std::min(width, components(accessor));
    const std::size_t elementBytes = components(accessor) * componentSize(accessor.componentType);
    const bool normalized = normalize || accessor.normalized;
    const auto bytesAt = [&](int view, std::size_t offset) {
        const tinygltf::BufferView& v = model_->bufferViews[static_cast<std::size_t>(view)];
        const tinygltf::Buffer& buffer = model_->buffers[static_cast<std::size_t>(v.buffer)];
        return buffer.data.data() + v.byteOffset + offset;
    };
    // The last view stands for absent ones.
    if (static_cast<std::size_t>(accessor.bufferView) + 1 < model_->bufferViews.size()) {
        const std::size_t byteStride =
            model_->bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        const Layout from = {bytesAt(accessor.bufferView, accessor.byteOffset),
                             byteStride != 0 ? byteStride : elementBytes, accessor.count};
        copyElements(from, accessor.componentType, present, normalized, out, stride,
                     [](std::size_t i) { return i; });
    } else {
        for (std::size_t i = 0; i < accessor.count; ++i) {
            std::fill_n(out + i * stride, present, T(0));
        }
    }
    if (!accessor.sparse.isSparse) return;

    const auto replaced = static_cast<std::size_t>(accessor.sparse.count);
    const auto& sparseIndices = accessor.sparse.indices;
    const auto& sparseValues = accessor.sparse.values;
    std::vector<std::uint32_t> targets(replaced);
    const Layout indexLayout = {
        bytesAt(sparseIndices.bufferView, static_cast<std::size_t>(sparseIndices.byteOffset)),
        componentSize(sparseIndices.componentType), replaced};
    copyElements(indexLayout, sparseIndices.componentType, 1, false, targets.data(), 1,
                 [](std::size_t i) { return i; });
    for (const std::uint32_t target : targets) {
        if (target >= accessor.count) {
            report_->fail(
                "accessors[" + std::to_string(index) + "].sparse.indices",
                "element " + std::to_string(target) + " of " + std::to_string(accessor.count));
        }
    }
    const Layout valueLayout = {
        bytesAt(sparseValues.bufferView, static_cast<std::size_t>(sparseValues.byteOffset)),
        elementBytes, replaced};
    copyElements(valueLayout, accessor.componentType, present, normalized, out, stride,
                 [&](std::size_t i) { return targets[i]; });
}

std::vector<glm::dvec4> AccessorReader::vectors(int accessor, glm::dvec4 missing,
                                                bool normalize) const {
    std::vector<glm::dvec4> result(count(accessor), missing);
    read(accessor, 4, normalize, &result[0].x, 4);
    return result;
}

std::vector<glm::dvec3> AccessorReader::vectors3(int accessor, bool normalize) const {
    std::vector<glm::dvec3> result(count(accessor));
    read(accessor, 3, normalize, &result[0].x, 3);
    return result;
}

std::vector<glm::dvec2> AccessorReader::vectors2(int accessor, bool normalize) const {
    std::vector<glm::dvec2> result(count(accessor));
    read(accessor, 2, normalize, &result[0].x, 2);
    return result;
}

std::vector<double> AccessorReader::scalars(int accessor, bool normalize) const {
    std::vector<double> result(count(accessor));
    read(accessor, 1, normalize, result.data(), 1);
    return result;
}

std::vector<std::uint32_t> AccessorReader::indices(int accessor) const {
    std::vector<std::uint32_t> result(count(accessor));
    read(accessor, 1, false, result.data(), 1);
    return result;
}

std::vector<glm::uvec4> AccessorReader::indices4(int accessor) const {
    std::vector<glm::uvec4> result(count(accessor));
    read(accessor, 4, false, &result[0].x, 4);
    return result;
}

std::vector<glm::dmat4> AccessorReader::matrices(int accessor) const {
    std::vector<glm::dmat4> result(count(accessor));
    read(accessor, 16, false, &result[0][0].x, 16);
    return result;
}

}  // namespace mv
