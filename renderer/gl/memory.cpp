#include "renderer/gl/memory.h"

#include <epoxy/gl.h>

namespace mv::gl {
namespace {

std::uint64_t held = 0;  // of the one thread that draws

}  // namespace

std::uint64_t heldMemory() { return held; }

void countMemory(std::int64_t bytes) { held += static_cast<std::uint64_t>(bytes); }

std::uint64_t freeVideoMemory() {
    GLint kibibytes[4] = {0, 0, 0,
                          0};  // ATI: total of the pool, largest block, and of auxiliary ones
    if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info")) {
        glGetIntegerv(GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX, kibibytes);
    } else if (epoxy_has_gl_extension("GL_ATI_meminfo")) {
        glGetIntegerv(GL_TEXTURE_FREE_MEMORY_ATI, kibibytes);
    }
    return kibibytes[0] > 0 ? static_cast<std::uint64_t>(kibibytes[0]) << 10 : 0;
}

}  // namespace mv::gl
