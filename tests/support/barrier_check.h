#pragma once
// What shaders store in buffers and images, later commands see only after a barrier that names the
// way in which they read it [GL 4.5, 7.12.2]. A driver that runs one command after the other, as
// llvmpipe does, forgives a barrier that is missing; a GPU shows old data now and then. A program
// of tests that links barrier_check.cpp fails each test that sent such a command. Where
// MEGAVIEWS_SHADER_TEXTS names a folder, it leaves the text of each shader that was linked there.

#include <string>
#include <vector>

namespace mv::test {

// What was found since the last call, a sentence each, and each once in a process.
std::vector<std::string> takeMissingBarriers();

}  // namespace mv::test
