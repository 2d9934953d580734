#pragma once
// Vertex arrays: which buffers a draw reads.

#include <epoxy/gl.h>

#include <cstddef>
#include <string>

#include "renderer/gl/buffer.h"

namespace mv::gl {

class VertexArray {
  public:
    VertexArray() = default;
    explicit VertexArray(std::string label);
    ~VertexArray();
    VertexArray(VertexArray&& other) noexcept;
    VertexArray& operator=(VertexArray&& other) noexcept;
    explicit operator bool() const { return id_ != 0; }

    // Attribute `index` = `components` floats (or uints) every `stride` bytes of buffer. The buffer
    // must outlive the draws.
    void floats(GLuint index, const Buffer& buffer, int components, std::size_t stride,
                std::size_t offset = 0);
    void uints(GLuint index, const Buffer& buffer, int components, std::size_t stride,
               std::size_t offset = 0);
    void indices(const Buffer& buffer);  // 32 bit
    void bind() const;

  private:
    GLuint id_ = 0;
};

}  // namespace mv::gl
