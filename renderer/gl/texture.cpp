#include "renderer/gl/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <utility>

#include "megaviews/core/error.h"
#include "renderer/gl/context.h"
#include "renderer/gl/memory.h"
#include "renderer/gl/read_back.h"

namespace mv::gl {
namespace {

constexpr std::size_t kMostBytesOfRead = std::size_t{64} << 20;

std::uint64_t bytesPerTexel(GLenum format) {
    switch (format) {
        case GL_R8:
        case GL_R8UI:
            return 1;
        case GL_RG8:
        case GL_R16F:
        case GL_R16:
        case GL_R16UI:
        case GL_DEPTH_COMPONENT16:
            return 2;
        case GL_RGBA8:
        case GL_SRGB8_ALPHA8:
        case GL_RGB10_A2:
        case GL_R11F_G11F_B10F:
        case GL_RGB9_E5:
        case GL_RG16F:
        case GL_RG16:
        case GL_RG16_SNORM:
        case GL_R32F:
        case GL_R32I:
        case GL_R32UI:
        case GL_DEPTH_COMPONENT24:
        case GL_DEPTH24_STENCIL8:
        case GL_DEPTH_COMPONENT32F:
            return 4;
        case GL_RGBA16F:
        case GL_RGBA16:
        case GL_RG32F:
        case GL_RG32UI:
            return 8;
        case GL_RGB32F:
        case GL_RGB32UI:
            return 12;
        case GL_RGBA32F:
        case GL_RGBA32I:
        case GL_RGBA32UI:
            return 16;
        default:
            assert(false && "texture format without a size");
            return 16;
    }
}

bool isDepth(GLenum format) {
    return format == GL_DEPTH_COMPONENT16 || format == GL_DEPTH_COMPONENT24 ||
           format == GL_DEPTH_COMPONENT32F || format == GL_DEPTH24_STENCIL8;
}

std::uint64_t imageBytes(GLenum format, int width, int height, int depth, int levels) {
    std::uint64_t texels = 0;
    for (int level = 0; level < levels; ++level) {
        texels += static_cast<std::uint64_t>(std::max(width >> level, 1)) *
                  static_cast<std::uint64_t>(std::max(height >> level, 1));
    }
    return texels * static_cast<std::uint64_t>(depth) * bytesPerTexel(format);
}

constexpr std::array<GLenum, 4> kFormats = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
constexpr std::array<GLenum, 4> kIntegerFormats = {GL_RED_INTEGER, GL_RG_INTEGER, GL_RGB_INTEGER,
                                                   GL_RGBA_INTEGER};

}  // namespace

// ---------------------------------------------------------------- Texture

Texture::Texture(std::string label, GLenum target, GLenum internalFormat, int width, int height,
                 int depth, int mipLevels)
    : target_(target),
      format_(internalFormat),
      width_(width),
      height_(height),
      depth_(target == GL_TEXTURE_CUBE_MAP ? 6 : depth),
      levels_(mipLevels) {
    assert(width > 0 && height > 0 && depth > 0 && mipLevels > 0);
    bytes_ = imageBytes(format_, width_, height_, depth_, levels_);
    const Limits& limit = limits();
    if (width > limit.maxTextureSize || height > limit.maxTextureSize ||
        depth_ > limit.maxArrayLayers) {
        throw Error(ExitCode::impossible, "\"" + label + "\" of " + std::to_string(width) + " x " +
                                              std::to_string(height) + " x " +
                                              std::to_string(depth_) +
                                              " texels exceeds this driver's limit of " +
                                              std::to_string(limit.maxTextureSize) + " a side, " +
                                              std::to_string(limit.maxArrayLayers) + " layers");
    }
    const ErrorsHandledHere handled;
    glCreateTextures(target, 1, &id_);
    if (target == GL_TEXTURE_2D || target == GL_TEXTURE_CUBE_MAP) {
        glTextureStorage2D(id_, levels_, format_, width, height);
    } else {
        glTextureStorage3D(id_, levels_, format_, width, height, depth_);
    }
    if (glGetError() != GL_NO_ERROR) {
        glDeleteTextures(1, &id_);
        throw Error(ExitCode::impossible, "the graphics memory does not hold \"" + label + "\", " +
                                              std::to_string((bytes_ + (1u << 20) - 1) >> 20) +
                                              " MiB");
    }
    countMemory(static_cast<std::int64_t>(bytes_));
    glObjectLabel(GL_TEXTURE, id_, static_cast<GLsizei>(label.size()), label.data());
    // One state for all: shaders fetch texels, but for those that bring samplers of their own.
    parameter(GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
    parameter(GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    parameter(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    parameter(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    parameter(GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

Texture::~Texture() {
    if (!id_) return;
    glDeleteTextures(1, &id_);
    countMemory(-static_cast<std::int64_t>(bytes_));
}

Texture::Texture(Texture&& other) noexcept { *this = std::move(other); }

Texture& Texture::operator=(Texture&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(target_, other.target_);
    std::swap(format_, other.format_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    std::swap(depth_, other.depth_);
    std::swap(levels_, other.levels_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void Texture::bind(GLuint unit) const { glBindTextureUnit(unit, id_); }

void Texture::bindImage(GLuint unit, GLenum access, GLenum format, int level) const {
    const GLboolean layered = target_ == GL_TEXTURE_2D ? GL_FALSE : GL_TRUE;
    glBindImageTexture(unit, id_, level, layered, 0, access, format);
}

void Texture::parameter(GLenum name, GLint value) { glTextureParameteri(id_, name, value); }

void Texture::ensure(std::string label, GLenum target, GLenum internalFormat, int width, int height,
                     int depth, int mipLevels) {
    const int layers = target == GL_TEXTURE_CUBE_MAP ? 6 : depth;
    if (id_ && target_ == target && format_ == internalFormat && width_ == width &&
        height_ == height && depth_ == layers && levels_ == mipLevels) {
        return;
    }
    *this = Texture();
    *this = Texture(std::move(label), target, internalFormat, width, height, depth, mipLevels);
}

void Texture::read(GLenum format, GLenum type, int level, std::size_t bytes, void* out) const {
    assert(id_ && level < levels_);
    countWait("texture", objectLabel(GL_TEXTURE, id_));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    const int width = std::max(width_ >> level, 1), height = std::max(height_ >> level, 1);
    // In bands of rows, or of layers: one call cannot name 2 GiB.
    const bool flat = depth_ == 1;
    const int slices = flat ? height : depth_;
    const std::size_t slice = bytes / static_cast<std::size_t>(slices);
    const int most = static_cast<int>(
        std::clamp<std::size_t>(kMostBytesOfRead / std::max<std::size_t>(slice, 1), 1, 1u << 30));
    for (int at = 0; at < slices; at += most) {
        const int count = std::min(most, slices - at);
        glGetTextureSubImage(id_, level, 0, flat ? at : 0, flat ? 0 : at, width,
                             flat ? count : height, flat ? 1 : count, format, type,
                             static_cast<GLsizei>(slice * static_cast<std::size_t>(count)),
                             static_cast<std::byte*>(out) + slice * static_cast<std::size_t>(at));
    }
}

void Texture::write(GLenum format, GLenum type, int level, int layer, const void* values) {
    assert(id_ && level < levels_ && layer < depth_);
    const int width = std::max(width_ >> level, 1), height = std::max(height_ >> level, 1);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    if (target_ == GL_TEXTURE_2D) {
        glTextureSubImage2D(id_, level, 0, 0, width, height, format, type, values);
    } else {
        glTextureSubImage3D(id_, level, 0, 0, layer, width, height, 1, format, type, values);
    }
}

void Texture::clear() {
    assert(id_);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glClearTexImage(id_, 0, GL_RGBA, GL_FLOAT, nullptr);
}

void Texture::copy(const Texture& from, int x, int width) {
    assert(from.target_ == GL_TEXTURE_2D && target_ == GL_TEXTURE_2D && from.format_ == format_);
    assert(from.height_ == height_ && x >= 0 && x + width <= std::min(width_, from.width_));
    if (width <= 0) return;
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glCopyImageSubData(from.id_, GL_TEXTURE_2D, 0, x, 0, 0, id_, GL_TEXTURE_2D, 0, x, 0, 0, width,
                       height_, 1);
}

namespace {
std::size_t levelValues(const Texture& texture, int channels, int level) {
    return static_cast<std::size_t>(std::max(texture.width() >> level, 1)) *
           static_cast<std::size_t>(std::max(texture.height() >> level, 1)) *
           static_cast<std::size_t>(texture.depth()) * static_cast<std::size_t>(channels);
}
std::size_t formatIndex(int channels) {
    assert(channels >= 1 && channels <= 4);
    return static_cast<std::size_t>(channels - 1);
}
}  // namespace

std::vector<float> Texture::readFloats(int channels, int level) const {
    std::vector<float> out(levelValues(*this, channels, level));
    const GLenum format = isDepth(format_) ? GL_DEPTH_COMPONENT : kFormats[formatIndex(channels)];
    read(format, GL_FLOAT, level, out.size() * sizeof(float), out.data());
    return out;
}

std::array<float, 4> Texture::readTexel(int x, int y) const {
    assert(id_ && target_ == GL_TEXTURE_2D && x >= 0 && y >= 0 && x < width_ && y < height_);
    std::array<float, 4> out{};
    countWait("texture", objectLabel(GL_TEXTURE, id_));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glGetTextureSubImage(id_, 0, x, y, 0, 1, 1, 1, GL_RGBA, GL_FLOAT, sizeof out, out.data());
    return out;
}

std::vector<std::uint8_t> Texture::readBytes(int channels, int level) const {
    std::vector<std::uint8_t> out(levelValues(*this, channels, level));
    read(kFormats[formatIndex(channels)], GL_UNSIGNED_BYTE, level, out.size(), out.data());
    return out;
}

std::vector<std::uint32_t> Texture::readUints(int channels, int level) const {
    std::vector<std::uint32_t> out(levelValues(*this, channels, level));
    read(kIntegerFormats[formatIndex(channels)], GL_UNSIGNED_INT, level,
         out.size() * sizeof(std::uint32_t), out.data());
    return out;
}

void Texture::writeFloats(int channels, const std::vector<float>& values, int level, int layer) {
    assert(values.size() * static_cast<std::size_t>(depth_) == levelValues(*this, channels, level));
    write(kFormats[formatIndex(channels)], GL_FLOAT, level, layer, values.data());
}

void Texture::writeBytes(int channels, const std::vector<std::uint8_t>& values, int level,
                         int layer) {
    assert(values.size() * static_cast<std::size_t>(depth_) == levelValues(*this, channels, level));
    write(kFormats[formatIndex(channels)], GL_UNSIGNED_BYTE, level, layer, values.data());
}

// ---------------------------------------------------------------- TextureBuffer

TextureBuffer::TextureBuffer(std::string label, GLenum internalFormat, const Buffer& buffer) {
    assert(buffer);
    const std::uint64_t texels = buffer.bytes() / bytesPerTexel(internalFormat);
    const auto limit = static_cast<std::uint64_t>(limits().maxTextureBufferTexels);
    if (texels > limit) {
        throw Error(ExitCode::impossible, "\"" + label + "\" of " + std::to_string(texels) +
                                              " texels exceeds this driver's limit of " +
                                              std::to_string(limit));
    }
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &id_);
    glTextureBuffer(id_, internalFormat, buffer.id());
    glObjectLabel(GL_TEXTURE, id_, static_cast<GLsizei>(label.size()), label.data());
}

TextureBuffer::~TextureBuffer() {
    if (id_) glDeleteTextures(1, &id_);
}

TextureBuffer::TextureBuffer(TextureBuffer&& other) noexcept : id_(std::exchange(other.id_, 0)) {}

TextureBuffer& TextureBuffer::operator=(TextureBuffer&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

void TextureBuffer::bind(GLuint unit) const { glBindTextureUnit(unit, id_); }

// ---------------------------------------------------------------- Framebuffer

Framebuffer::Framebuffer(std::string label, const std::vector<const Texture*>& colors,
                         const Texture* depth) {
    assert(!colors.empty() || depth);
    const Texture* first = colors.empty() ? depth : colors.front();
    width_ = first->width();
    height_ = first->height();
    glCreateFramebuffers(1, &id_);
    std::vector<GLenum> drawBuffers;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i);
        glNamedFramebufferTexture(id_, attachment, colors[i]->id(), 0);
        drawBuffers.push_back(attachment);
    }
    if (drawBuffers.empty()) {
        glNamedFramebufferDrawBuffer(id_, GL_NONE);
        glNamedFramebufferReadBuffer(id_, GL_NONE);
    } else {
        glNamedFramebufferDrawBuffers(id_, static_cast<GLsizei>(drawBuffers.size()),
                                      drawBuffers.data());
    }
    if (depth) glNamedFramebufferTexture(id_, GL_DEPTH_ATTACHMENT, depth->id(), 0);
    const GLenum status = glCheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        glDeleteFramebuffers(1, &id_);
        throw Error(ExitCode::graphics, "the driver refuses the framebuffer \"" + label +
                                            "\" (status " + std::to_string(status) + ")");
    }
    glObjectLabel(GL_FRAMEBUFFER, id_, static_cast<GLsizei>(label.size()), label.data());
}

Framebuffer::~Framebuffer() {
    if (id_) glDeleteFramebuffers(1, &id_);
}

Framebuffer::Framebuffer(Framebuffer&& other) noexcept { *this = std::move(other); }

Framebuffer& Framebuffer::operator=(Framebuffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(width_, other.width_);
    std::swap(height_, other.height_);
    return *this;
}

void Framebuffer::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, id_);
    glViewport(0, 0, width_, height_);
}

}  // namespace mv::gl
