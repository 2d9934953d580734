#include "renderer/passes/alone_pixels.h"

#include <epoxy/gl.h>

#include <array>

#include "shaders/shared/bindings.glsl"

namespace mv {
namespace {

// Work groups of a row of the dispatch: with 65535 rows enough for any picture, and few that find
// nothing to do.
constexpr std::uint32_t kColumns = 32;

}  // namespace

void AlonePixels::clear(int width, int height) {
    const std::array<std::uint32_t, 4> none{kColumns, 0, 1, 0};
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<unsigned>(height);
    list_.ensure("pixels gathered for themselves", sizeof none + 4 * pixels);
    list_.writeBytes(0, none.data(), sizeof none);
}

void AlonePixels::bind() const { list_.bindStorage(kBlockAlonePixels); }

void AlonePixels::dispatch(gl::Program& program) const {
    bind();
    program.dispatchIndirect(list_, 0);
}

}  // namespace mv
