#pragma once
// A buffer that one pass writes as storage and the next reads as texels, kept from frame to frame.

#include <string>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"

namespace mv {

struct TexelArray {
    gl::Buffer buffer;
    gl::TextureBuffer texels;
    // At least `bytes` large; contents are lost if it has to grow.
    void ensure(const std::string& label, GLenum internalFormat, std::uint64_t bytes) {
        if (texels && buffer.bytes() >= bytes) return;
        buffer.ensure(label, bytes);
        texels = gl::TextureBuffer(label, internalFormat, buffer);
    }
};

}  // namespace mv
