#pragma once
// What the driver says about the graphics memory, where it says anything.

#include <cstdint>

namespace mv::gl {

// Bytes of video memory that nobody uses, by GL_NVX_gpu_memory_info or GL_ATI_meminfo; 0 where the
// driver has neither, as software renderers.
std::uint64_t freeVideoMemory();

}  // namespace mv::gl
