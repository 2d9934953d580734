#include "renderer/gl/workarounds.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <cerrno>
#include <cstdlib>
#include <string>

#include "megaviews/core/error.h"
#include "megaviews/core/large_vector.h"

namespace mv::gl {
namespace {

constexpr WorkaroundInfo kWorkarounds[] = {
    {Workaround::wallClock, "wall-clock", "Stages are timed by glFinish and a steady clock.",
     "llvmpipe's timestamps are wrong by orders of magnitude."},
    {Workaround::loopLimit, "loop-limit",
     "Kernels that may loop long stop in time and are dispatched again to go on.",
     "llvmpipe ends all loops of an invocation, silently, after 65,535 iterations in all."},
    {Workaround::smallGroups, "small-groups", "Work groups have 8 invocations instead of 64.",
     "At a barrier llvmpipe spills the live variables of a whole group."},
    {Workaround::oneVector, "one-vector",
     "Work groups of the traversal that are one vector of the machine do without barriers.",
     "llvmpipe runs them in step, and an eighth of the traversal's time would go into barriers."},
    {Workaround::sparseSharing, "sparse-sharing",
     "The view \"sharing\" follows the pairs of every fourth pixel.",
     "Their paths take seconds without a GPU."},
    {Workaround::plainTextures, "plain-textures", "Textures are filtered without anisotropy.",
     "llvmpipe takes every sample of it one after the other."},
    {Workaround::keptHeap, "kept-heap", "Freed memory stays with the process.",
     "llvmpipe allocates and frees tens of MiB a frame; page faults cost a fifth of a G-buffer."},
    {Workaround::largePages, "large-pages",
     "Blocks that the driver takes by posix_memalign lie in pages of 2 MiB.",
     "llvmpipe's buffers do, and small pages cost a fault each: seconds for a large octree."},
};
constexpr std::size_t kCount = std::size(kWorkarounds);

constexpr bool rowsStandInOrder() {
    for (std::size_t i = 0; i < kCount; ++i) {
        if (static_cast<std::size_t>(kWorkarounds[i].workaround) != i) return false;
    }
    return kCount == static_cast<std::size_t>(Workaround::largePages) + 1;
}
static_assert(rowsStandInOrder(), "a row for each Workaround, in its order");

std::bitset<kCount> chosen;
std::atomic<bool> driverTakesLargePages{false};  // read in any thread

// "NAME=on" or "NAME=off".
void applySwitch(std::string_view text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string_view name = text.substr(0, equals), value = text.substr(equals);
    std::string names;
    for (const WorkaroundInfo& info : kWorkarounds) {
        if (info.name == name && (value == "=on" || value == "=off")) {
            chosen.set(static_cast<std::size_t>(info.workaround), value == "=on");
            return;
        }
        names.append(names.empty() ? "" : ", ").append(info.name);
    }
    throw Error(ExitCode::usage, "MEGAVIEWS_GL_WORKAROUNDS: \"" + std::string(text) +
                                     "\" is not NAME=on or NAME=off with a NAME of " + names);
}

}  // namespace

std::span<const WorkaroundInfo> workarounds() { return kWorkarounds; }

bool isOn(Workaround workaround) { return chosen[static_cast<std::size_t>(workaround)]; }

std::vector<std::string_view> workaroundsOn() {
    std::vector<std::string_view> names;
    for (const WorkaroundInfo& info : kWorkarounds) {
        if (isOn(info.workaround)) names.push_back(info.name);
    }
    return names;
}

void chooseWorkarounds(bool software) {
    chosen.reset();
    if (software) chosen.set();
    const char* given = std::getenv("MEGAVIEWS_GL_WORKAROUNDS");
    std::string_view rest = given ? given : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(','), rest.size());
        applySwitch(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    driverTakesLargePages = isOn(Workaround::largePages);
}

}  // namespace mv::gl

#ifndef MEGAVIEWS_SANITIZED  // sanitizers stand in for the C library here themselves
// The program's own goes before the C library's, for the driver too.
extern "C" int posix_memalign(void** out, std::size_t alignment, std::size_t bytes) noexcept {
    void* const block = memalign(alignment, bytes);
    if (!block) return ENOMEM;
    if (mv::gl::driverTakesLargePages) mv::adviseLargePages(block, bytes);
    *out = block;
    return 0;
}
#endif
