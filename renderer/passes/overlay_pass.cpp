#include "renderer/passes/overlay_pass.h"

#include <cassert>
#include <cstddef>

#include "renderer/gl/program.h"
#include "renderer/gl/texel_buffer.h"
#include "renderer/gl/vertex_array.h"
#include "shaders/shared/bindings.glsl"

namespace mv {

struct OverlayPass::Impl {
    gl::Program lines{"overlay lines", {"passes/overlay_line.vert", "passes/overlay_line.frag"}};
    gl::Program compose{"overlay", {"passes/full_screen.vert", "passes/overlay.frag"}};
    gl::VertexArray noVertices{"overlay"};

    // What is freed when there is nothing to draw.
    gl::TexelBuffer<std::uint32_t> lineWords;
    gl::Texture layer, layerDepth;
    gl::Framebuffer layerTarget;

    void release() {
        lineWords = {};
        layerTarget = {};
        layer = {};
        layerDepth = {};
    }
    void upload(std::span<const Line> given) {
        lineWords.ensure("overlay lines", given.size_bytes() / 4);
        lineWords.writeBytes(0, given.data(), given.size_bytes());
    }
    void resize(int width, int height) {
        if (layer && layer.width() == width && layer.height() == height) return;
        layer = gl::Texture("overlay", GL_TEXTURE_2D, GL_RGBA8, width, height);
        layerDepth =
            gl::Texture("overlay depth", GL_TEXTURE_2D, GL_DEPTH_COMPONENT32F, width, height);
        layerTarget = gl::Framebuffer("overlay", {&layer}, &layerDepth);
    }
};

OverlayPass::OverlayPass() : impl_(std::make_unique<Impl>()) {}
OverlayPass::~OverlayPass() = default;

std::uint64_t OverlayPass::bytes() const {
    return impl_->lineWords.bytes() + impl_->layer.bytes() + impl_->layerDepth.bytes();
}

void OverlayPass::draw(std::span<const Line> lines, const FrameCamera& camera,
                       const gl::Texture& depth, const OverlayOptions& options,
                       gl::Profiler& profiler, const gl::Texture& display, gl::Texture& out) {
    Impl& m = *impl_;
    if (lines.empty()) {
        m.release();
        out = {};
        return;
    }
    const int width = display.width(), height = display.height();
    assert(depth.width() == width && depth.height() == height);
    const gl::PassScope scope(profiler, Stage::overlay);
    m.upload(lines);
    m.resize(width, height);

    // The lines by themselves: the nearest wins, so what is visible hides what is not.
    m.layerTarget.bind();
    const GLfloat clear[] = {0, 0, 0, 0}, farthest = 0;
    glClearNamedFramebufferfv(m.layerTarget.id(), GL_COLOR, 0, clear);
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(m.layerTarget.id(), GL_DEPTH, 0, &farthest);
    m.lineWords.bindTexels(kUnitLines);
    depth.bind(kUnitSurfaceDepth);
    gl::Program& p = m.lines;
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    p.set("clipFromWorld", camera.clipFromWorld(aspect));
    p.set("size", glm::vec2(width, height));
    p.set("widthPixels", options.widthPixels);
    p.set("hiddenAlpha", options.hiddenAlpha);
    // Lines that lie in a surface count as visible. Reversed depth falls with 1/distance in
    // perspective and linearly in orthographic pictures.
    const bool ortho = camera.orthoHalfHeight > 0;
    p.set("tolerance", ortho ? glm::vec2(0, 5e-4f) : glm::vec2(2e-3f, 0));
    p.use();
    m.noVertices.bind();
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * lines.size()));
    glDisable(GL_DEPTH_TEST);

    // Over the picture. A framebuffer is little more than a name: made anew, it cannot outlive its
    // texture.
    out.ensure("display with overlay", GL_TEXTURE_2D, GL_RGBA8, width, height);
    display.bind(kUnitDisplay);
    m.layer.bind(kUnitOverlay);
    m.compose.drawFullScreen(gl::Framebuffer("display with overlay", {&out}));
}

}  // namespace mv
