#pragma once
// Textures, buffer textures, samplers' state and framebuffers: move-only owners with labels.

#include <epoxy/gl.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "renderer/gl/buffer.h"

namespace mv::gl {

class Texture {
  public:
    Texture() = default;
    // Immutable storage. target: GL_TEXTURE_2D, _2D_ARRAY, _CUBE_MAP, _CUBE_MAP_ARRAY (depth = 6k).
    Texture(std::string label, GLenum target, GLenum internalFormat, int width, int height,
            int depth = 1, int mipLevels = 1);
    ~Texture();
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;
    explicit operator bool() const { return id_ != 0; }
    GLuint id() const { return id_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int depth() const { return depth_; }
    GLenum format() const { return format_; }
    void bind(GLuint unit) const;
    void bindImage(GLuint unit, GLenum access, GLenum format, int level = 0) const;
    void parameter(GLenum name, GLint value);
    std::uint64_t bytes() const { return bytes_; }

    // The same texture if it already has this format and size, else a new one (contents are lost).
    void ensure(std::string label, GLenum target, GLenum internalFormat, int width, int height,
                int depth = 1, int mipLevels = 1);
    // One level on the CPU, `channels` values a texel, all layers, bottom row first as OpenGL
    // counts; synchronises. Floats: any float or normalised format, channels = 1 also reads depth.
    // Bytes: 8-bit formats, sRGB as stored. Uints: integer formats.
    std::vector<float> readFloats(int channels, int level = 0) const;
    std::vector<std::uint8_t> readBytes(int channels, int level = 0) const;
    std::vector<std::uint32_t> readUints(int channels, int level = 0) const;
    // One texel of a 2-D texture that is not an integer one, (0, 0) the lower left; synchronises.
    std::array<float, 4> readTexel(int x, int y) const;
    // All texels of one layer of one level; the same conventions.
    void writeFloats(int channels, const std::vector<float>& values, int level = 0, int layer = 0);
    void writeBytes(int channels, const std::vector<std::uint8_t>& values, int level = 0,
                    int layer = 0);
    // On the GPU. Of textures that are not of integers: every texel of level 0 is 0.
    void clear();
    // The same columns of all rows of level 0 of another 2-D texture of this format and height.
    void copy(const Texture& from, int x, int width);
    void copy(const Texture& from) { copy(from, 0, width_); }

  private:
    void read(GLenum format, GLenum type, int level, std::size_t bytes, void* out) const;
    void write(GLenum format, GLenum type, int level, int layer, const void* values);
    GLuint id_ = 0;
    GLenum target_ = 0, format_ = 0;
    int width_ = 0, height_ = 0, depth_ = 1, levels_ = 1;
    std::uint64_t bytes_ = 0;
};

// A buffer seen as texels: on software renderers texelFetch of read-only data is much faster than
// a storage block. Does not own the buffer. At most limits().maxTextureBufferTexels.
class TextureBuffer {
  public:
    TextureBuffer() = default;
    TextureBuffer(std::string label, GLenum internalFormat, const Buffer& buffer);
    ~TextureBuffer();
    TextureBuffer(TextureBuffer&& other) noexcept;
    TextureBuffer& operator=(TextureBuffer&& other) noexcept;
    explicit operator bool() const { return id_ != 0; }
    GLuint id() const { return id_; }
    void bind(GLuint unit) const;

  private:
    GLuint id_ = 0;
};

class Framebuffer {
  public:
    Framebuffer() = default;
    // Colour attachments in order, and an optional depth attachment. Checked for completeness.
    Framebuffer(std::string label, const std::vector<const Texture*>& colors,
                const Texture* depth = nullptr);
    ~Framebuffer();
    Framebuffer(Framebuffer&& other) noexcept;
    Framebuffer& operator=(Framebuffer&& other) noexcept;
    explicit operator bool() const { return id_ != 0; }
    GLuint id() const { return id_; }
    void bind() const;  // also sets the viewport to the attachments' size

  private:
    GLuint id_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace mv::gl
