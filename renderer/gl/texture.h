#pragma once
// Textures, buffer textures, samplers' state and framebuffers: move-only owners with labels.

#include <epoxy/gl.h>

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
    void bind(GLuint unit) const;
    void bindImage(GLuint unit, GLenum access, GLenum format, int level = 0) const;
    void parameter(GLenum name, GLint value);
    std::uint64_t bytes() const { return bytes_; }

  private:
    GLuint id_ = 0;
    int width_ = 0, height_ = 0;
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
    void attachDepthLayer(const Texture& texture, int layer);  // for cube and array shadow maps

  private:
    GLuint id_ = 0;
    int width_ = 0, height_ = 0;
};

}  // namespace mv::gl
