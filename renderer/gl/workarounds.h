#pragma once
// What exists for one kind of driver only, by name. Each is on where it is needed and compiled out
// of the kernels elsewhere; MEGAVIEWS_GL_WORKAROUNDS="NAME=on,NAME=off" switches some by hand, so
// that tests see both.

#include <span>
#include <string_view>
#include <vector>

namespace mv::gl {

enum class Workaround {
    wallClock,
    loopLimit,
    smallGroups,
    oneVector,
    sparseSharing,
    plainTextures,
    keptHeap,
    largePages,
    alikeState,
};

struct WorkaroundInfo {
    Workaround workaround{};
    std::string_view name, what, why;  // what and why: a sentence each
};
std::span<const WorkaroundInfo> workarounds();

// In the current context.
bool isOn(Workaround workaround);
std::vector<std::string_view> workaroundsOn();

// Decides which are on, for gl::initialise(): all of them on a software renderer, none elsewhere,
// but for what the environment says. Throws Error(ExitCode::usage) where that names none.
void chooseWorkarounds(bool software);

// Workaround::alikeState: gives every sampler slot of the current context the state that
// gl::Texture has. Does nothing where it is off. Needs gl::limits().
void fillSamplerSlots();

}  // namespace mv::gl
