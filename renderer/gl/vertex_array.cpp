#include "renderer/gl/vertex_array.h"

#include <utility>

namespace mv::gl {

VertexArray::VertexArray(std::string label) {
    glCreateVertexArrays(1, &id_);
    glObjectLabel(GL_VERTEX_ARRAY, id_, static_cast<GLsizei>(label.size()), label.data());
}

VertexArray::~VertexArray() {
    if (id_) glDeleteVertexArrays(1, &id_);
}

VertexArray::VertexArray(VertexArray&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

VertexArray& VertexArray::operator=(VertexArray&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

void VertexArray::floats(GLuint index, const Buffer& buffer, int components, std::size_t stride,
                         std::size_t offset) {
    glVertexArrayVertexBuffer(id_, index, buffer.id(), static_cast<GLintptr>(offset),
                              static_cast<GLsizei>(stride));
    glVertexArrayAttribFormat(id_, index, components, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(id_, index, index);
    glEnableVertexArrayAttrib(id_, index);
}

void VertexArray::uints(GLuint index, const Buffer& buffer, int components, std::size_t stride,
                        std::size_t offset) {
    glVertexArrayVertexBuffer(id_, index, buffer.id(), static_cast<GLintptr>(offset),
                              static_cast<GLsizei>(stride));
    glVertexArrayAttribIFormat(id_, index, components, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(id_, index, index);
    glEnableVertexArrayAttrib(id_, index);
}

void VertexArray::indices(const Buffer& buffer) { glVertexArrayElementBuffer(id_, buffer.id()); }

void VertexArray::bind() const { glBindVertexArray(id_); }

}  // namespace mv::gl
