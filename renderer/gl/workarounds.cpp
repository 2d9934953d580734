#include "renderer/gl/workarounds.h"

#include <epoxy/gl.h>
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
#include "megaviews/core/text.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/vertex_array.h"

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
    {Workaround::alikeState, "alike-state",
     "Every sampler slot is filled at the start, and buffers are a little larger.",
     "llvmpipe compiles a shader again where a slot of a texel buffer holds another sampler, left "
     "there by any shader before, and where bits of the buffer's size differ."},
};
constexpr std::size_t kCount = std::size(kWorkarounds);

constexpr bool rowsStandInOrder() {
    for (std::size_t i = 0; i < kCount; ++i) {
        if (static_cast<std::size_t>(kWorkarounds[i].workaround) != i) return false;
    }
    return kCount == static_cast<std::size_t>(Workaround::alikeState) + 1;
}
static_assert(rowsStandInOrder(), "a row for each Workaround, in its order");

// Of fillSamplerSlots(). Text of its own, since the folder of shaders may be another than the
// program's.
constexpr const char* kWholeTarget = R"(
    out gl_PerVertex { vec4 gl_Position; };
    void main() {
        vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
        gl_Position = vec4(corner, 0.0, 1.0);
    })";
constexpr const char* kDrawn = R"(
    layout(location = 0) out vec4 drawn;
    void main() { drawn = allSlots(); })";
constexpr const char* kComputed = R"(
    layout(local_size_x = 1) in;
    layout(std430, binding = 0) writeonly buffer Sum { vec4 sum; };
    void main() { sum = allSlots(); })";

std::string throughSlots(GLint count) {
    return "layout(binding = 0) uniform sampler2D slots[" + std::to_string(count) + R"(];
    vec4 allSlots() {
        vec4 sum = vec4(0.0);
        for (int i = 0; i < slots.length(); ++i) sum += texelFetch(slots[i], ivec2(0), 0);
        return sum;
    })";
}

GLuint oneStage(GLenum stage, const std::string& text) {
    const std::string whole = "#version 450 core\n" + text;
    const char* const source = whole.c_str();
    return glCreateShaderProgramv(stage, 1, &source);
}

GLint integer(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

std::bitset<kCount> chosen;
std::atomic<bool> driverTakesLargePages{false};  // read in any thread

// "NAME=on" or "NAME=off".
void applySwitch(std::string_view text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string_view name = text.substr(0, equals), value = text.substr(equals);
    for (const WorkaroundInfo& info : kWorkarounds) {
        if (info.name == name && (value == "=on" || value == "=off")) {
            chosen.set(static_cast<std::size_t>(info.workaround), value == "=on");
            return;
        }
    }
    throw Error(ExitCode::usage, "MEGAVIEWS_GL_WORKAROUNDS: \"" + std::string(text) +
                                     "\" is not NAME=on or NAME=off with a NAME of " +
                                     joined(namesIn(kWorkarounds, &WorkaroundInfo::name), ", "));
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

void fillSamplerSlots() {
    if (!isOn(Workaround::alikeState)) return;
    const Texture read("sampler slots", GL_TEXTURE_2D, GL_RGBA8, 1, 1);
    const Texture drawn("sampler slots, drawn", GL_TEXTURE_2D, GL_RGBA8, 1, 1);
    const Framebuffer target("sampler slots", {&drawn});
    const Buffer sum("sampler slots", 16);
    const VertexArray none("sampler slots");
    const GLint inPixels = integer(GL_MAX_TEXTURE_IMAGE_UNITS);
    const GLint inGroups = integer(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS);
    const auto slots = static_cast<GLuint>(std::max(inPixels, inGroups));
    for (GLuint i = 0; i < slots; ++i) read.bind(i);
    target.bind();
    sum.bindStorage(0);
    const std::array<GLuint, 3> programs = {
        oneStage(GL_VERTEX_SHADER, kWholeTarget),
        oneStage(GL_FRAGMENT_SHADER, throughSlots(inPixels) + kDrawn),
        oneStage(GL_COMPUTE_SHADER, throughSlots(inGroups) + kComputed)};
    GLuint pipeline = 0;
    glCreateProgramPipelines(1, &pipeline);
    glUseProgramStages(pipeline, GL_VERTEX_SHADER_BIT, programs[0]);
    glUseProgramStages(pipeline, GL_FRAGMENT_SHADER_BIT, programs[1]);
    glUseProgramStages(pipeline, GL_COMPUTE_SHADER_BIT, programs[2]);
    glUseProgram(0);
    glBindProgramPipeline(pipeline);
    none.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDispatchCompute(1, 1, 1);
    glBindProgramPipeline(0);
    glDeleteProgramPipelines(1, &pipeline);
    for (const GLuint program : programs) glDeleteProgram(program);
    for (GLuint i = 0; i < slots; ++i) glBindTextureUnit(i, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
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
