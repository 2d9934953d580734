#pragma once
// The graphics memory: what this program holds of it, and what the driver says is free.

#include <cstdint>

namespace mv::gl {

// Bytes of all buffers, textures and read-backs that are alive, without what the driver adds.
std::uint64_t heldMemory();
// For their owners: `bytes` more, or less where negative.
void countMemory(std::int64_t bytes);

// Bytes of video memory that nobody uses, by GL_NVX_gpu_memory_info or GL_ATI_meminfo; 0 where the
// driver has neither, as software renderers.
std::uint64_t freeVideoMemory();

}  // namespace mv::gl
