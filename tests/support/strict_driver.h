#pragma once
// Tests meet a driver that forgives as little as a GPU does. llvmpipe runs one command after the
// other and hands out memory full of zeros. A program of tests that links strict_driver.cpp
// - fails each test that sent a command without the barrier that it needs to see what shaders
// stored in
//   buffers and images [GL 4.5, 7.12.2], or that drew to what it read;
// - gets buffers and textures full of garbage, so that what is read before it was written shows;
// - leaves the text of each shader that was linked in the folder MEGAVIEWS_SHADER_TEXTS, where that
// is set.

#include <string>
#include <vector>

namespace mv::test {

// What was found since the last call, a sentence each, and each once in a process.
std::vector<std::string> takeMissingBarriers();

}  // namespace mv::test
