#pragma once
// Immutable-size GPU buffers: move-only, labelled, counted in elements, direct state access.

#include <epoxy/gl.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mv::gl {

class Buffer {
  public:
    Buffer() = default;
    // bytes may be 0 (allocates 16 so that it can be bound). Throws Error(ExitCode::impossible)
    // naming label and size if the driver is out of memory.
    Buffer(std::string label, std::uint64_t bytes);
    template <typename T>
    static Buffer of(std::string label, std::span<const T> elements) {
        Buffer b(std::move(label), elements.size_bytes());
        b.writeBytes(0, elements.data(), elements.size_bytes());
        return b;
    }
    template <typename T>
    static Buffer of(std::string label, const std::vector<T>& elements) {
        return of(std::move(label), std::span<const T>(elements));
    }
    ~Buffer();
    Buffer(Buffer&& other) noexcept;
    Buffer& operator=(Buffer&& other) noexcept;

    explicit operator bool() const { return id_ != 0; }
    GLuint id() const { return id_; }
    std::uint64_t bytes() const { return bytes_; }

    void writeBytes(std::uint64_t offset, const void* data, std::uint64_t bytes);
    void readBytes(std::uint64_t offset, void* data, std::uint64_t bytes) const;  // synchronises
    template <typename T>
    void write(std::uint64_t firstElement, std::span<const T> elements) {
        writeBytes(firstElement * sizeof(T), elements.data(), elements.size_bytes());
    }
    template <typename T>
    std::vector<T> read(std::uint64_t firstElement, std::uint64_t count) const {
        std::vector<T> out(count);
        if (count) readBytes(firstElement * sizeof(T), out.data(), count * sizeof(T));
        return out;
    }
    void fill(std::uint32_t value);  // every 32-bit word
    void fill(std::uint64_t firstWord, std::uint64_t words, std::uint32_t value);

    // On the GPU, from another buffer; offsets and size in bytes.
    void copy(const Buffer& from, std::uint64_t fromOffset, std::uint64_t offset,
              std::uint64_t bytes);

    void bindStorage(GLuint binding) const;
    void bindStorage(GLuint binding, std::uint64_t offset, std::uint64_t bytes) const;
    void bindUniform(GLuint binding) const;

    // At least `bytes` large: keeps the buffer if it is, else replaces it (contents are lost). What
    // replaces a smaller one, and so grows from frame to frame, gets `room` bytes more.
    void ensure(std::string label, std::uint64_t bytes, std::uint64_t room = 0);

  private:
    GLuint id_ = 0;
    std::uint64_t bytes_ = 0;
};

}  // namespace mv::gl
