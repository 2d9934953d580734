#pragma once
// A typed array that passes write as a storage block and shaders read as texels: on software
// renderers texelFetch of read-only data is much faster than a storage block. Counted in elements.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"

namespace mv::gl {

// Format of the texels that an array of T is read as: numbers and vectors are a texel each, structs
// as many of four words as they are long.
template <typename T>
constexpr GLenum texelFormat() {
    if constexpr (std::is_same_v<T, std::uint32_t>) return GL_R32UI;
    if constexpr (std::is_same_v<T, float>) return GL_R32F;
    if constexpr (std::is_same_v<T, glm::uvec2>) return GL_RG32UI;
    if constexpr (std::is_same_v<T, glm::uvec3>) return GL_RGB32UI;
    if constexpr (std::is_same_v<T, glm::vec2>) return GL_RG32F;
    if constexpr (std::is_same_v<T, glm::vec3>) return GL_RGB32F;
    if constexpr (std::is_same_v<T, glm::vec4>) return GL_RGBA32F;
    return GL_RGBA32UI;
}

template <typename T>
class TexelBuffer : public Buffer {
  public:
    static_assert(sizeof(T) % 16 == 0 || texelFormat<T>() != GL_RGBA32UI);

    TexelBuffer() = default;
    TexelBuffer(std::string label, std::span<const T> elements)
        : Buffer(label, elements.size_bytes()), label_(std::move(label)) {
        write(0, elements);
    }

    // At least so many elements: keeps the buffer if it is large enough, else its contents are
    // lost. room: as of Buffer::ensure.
    void ensure(const std::string& label, std::uint64_t elements, std::uint64_t room = 0) {
        if (*this && size() >= elements) return;
        texels_ = TextureBuffer();
        quads_ = TextureBuffer();
        Buffer::ensure(label, elements * sizeof(T), room * sizeof(T));
        label_ = label;
    }
    std::uint64_t size() const { return bytes() / sizeof(T); }

    void write(std::uint64_t first, std::span<const T> elements) {
        writeBytes(first * sizeof(T), elements.data(), elements.size_bytes());
    }
    std::vector<T> read(std::uint64_t first, std::uint64_t count) const {
        return Buffer::read<T>(first, count);
    }

    // At most limits().maxTextureBufferTexels: throws Error(ExitCode::impossible) beyond.
    void bindTexels(GLuint unit) const {
        if (!texels_) texels_ = TextureBuffer(label_, texelFormat<T>(), *this);
        texels_.bind(unit);
    }

    // The same, four words a texel: holds four times as many words.
    void bindQuads(GLuint unit) const {
        if (!quads_) quads_ = TextureBuffer(label_, GL_RGBA32UI, *this);
        quads_.bind(unit);
    }

  private:
    std::string label_;
    mutable TextureBuffer texels_, quads_;  // made when first bound
};

}  // namespace mv::gl
