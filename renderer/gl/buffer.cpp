#include "renderer/gl/buffer.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/memory.h"
#include "renderer/gl/read_back.h"
#include "renderer/gl/workarounds.h"

namespace mv::gl {
namespace {

// Workaround::alikeState: of a texel buffer llvmpipe's compiler is told whether its size is a power
// of two, and whether some of the bits 4 to 15 are all zero. With these it never is, and they are
// not.
constexpr std::uint64_t kAlikeBits = 256 + 16;

std::uint64_t allocatedBytes(std::uint64_t bytes) {
    const std::uint64_t least = std::max<std::uint64_t>(bytes, 16);
    if (!isOn(Workaround::alikeState)) return least;
    return (least + 511) / 512 * 512 + kAlikeBits;
}

}  // namespace

Buffer::Buffer(std::string label, std::uint64_t bytes) : bytes_(bytes) {
    const ErrorsHandledHere handled;
    glCreateBuffers(1, &id_);
    glNamedBufferStorage(id_, static_cast<GLsizeiptr>(allocatedBytes(bytes)), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    if (glGetError() != GL_NO_ERROR) {
        glDeleteBuffers(1, &id_);
        throw Error(ExitCode::impossible, "the graphics memory does not hold \"" + label + "\", " +
                                              std::to_string((bytes + (1u << 20) - 1) >> 20) +
                                              " MiB");
    }
    countMemory(static_cast<std::int64_t>(bytes_));
    glObjectLabel(GL_BUFFER, id_, static_cast<GLsizei>(label.size()), label.data());
}

Buffer::~Buffer() {
    if (!id_) return;
    glDeleteBuffers(1, &id_);
    countMemory(-static_cast<std::int64_t>(bytes_));
}

Buffer::Buffer(Buffer&& other) noexcept
    : id_(std::exchange(other.id_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void Buffer::writeBytes(std::uint64_t offset, const void* data, std::uint64_t bytes) {
    assert(offset + bytes <= bytes_);
    if (bytes == 0) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::readBytes(std::uint64_t offset, void* data, std::uint64_t bytes) const {
    assert(offset + bytes <= bytes_);
    if (bytes == 0) return;
    countWait("buffer", objectLabel(GL_BUFFER, id_));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                            data);
}

void Buffer::fill(std::uint32_t value) { fill(0, bytes_ / 4, value); }

void Buffer::fill(std::uint64_t firstWord, std::uint64_t words, std::uint32_t value) {
    assert((firstWord + words) * 4 <= bytes_);
    if (words == 0) return;
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glClearNamedBufferSubData(id_, GL_R32UI, static_cast<GLintptr>(firstWord * 4),
                              static_cast<GLsizeiptr>(words * 4), GL_RED_INTEGER, GL_UNSIGNED_INT,
                              &value);
}

void Buffer::copy(const Buffer& from, std::uint64_t fromOffset, std::uint64_t offset,
                  std::uint64_t bytes) {
    assert(fromOffset + bytes <= from.bytes_ && offset + bytes <= bytes_);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glCopyNamedBufferSubData(from.id_, id_, static_cast<GLintptr>(fromOffset),
                             static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes));
}

void Buffer::bindStorage(GLuint binding) const { bindStorage(binding, 0, bytes_); }

void Buffer::bindStorage(GLuint binding, std::uint64_t offset, std::uint64_t bytes) const {
    assert(id_ && offset + bytes <= bytes_);
    const auto limit = static_cast<std::uint64_t>(limits().maxStorageBlockBytes);
    if (bytes > limit) {
        throw Error(ExitCode::impossible, "a storage block of " + std::to_string(bytes >> 20) +
                                              " MiB exceeds this driver's limit of " +
                                              std::to_string(limit >> 20) + " MiB");
    }
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, id_, static_cast<GLintptr>(offset),
                      static_cast<GLsizeiptr>(std::max<std::uint64_t>(bytes, 16)));
}

void Buffer::bindUniform(GLuint binding) const {
    assert(id_);
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

void Buffer::ensure(std::string label, std::uint64_t bytes, std::uint64_t room) {
    if (id_ && bytes_ >= bytes) return;
    const auto limit = static_cast<std::uint64_t>(limits().maxStorageBlockBytes);
    const bool withRoom = bytes_ > 0 && bytes + room <= limit;
    *this = Buffer();  // before the new one: both need not fit together
    *this = Buffer(std::move(label), withRoom ? bytes + room : bytes);
}

}  // namespace mv::gl
