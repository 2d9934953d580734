#pragma once
// Shader programs from files below shaders/, with `#include "shaders/shared/x.glsl"` resolved on
// the CPU and #line kept, so that an error names the file it is in. Sources are embedded in the
// executable; if MEGAVIEWS_SHADER_DIR is set they are read from there.

#include <epoxy/gl.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace mv::gl {

using Defines = std::vector<std::pair<std::string, std::string>>;

class Program {
  public:
    Program() = default;
    // One compute shader, or a vertex and a fragment shader; paths like "passes/gather.comp".
    // `#version 450 core` and the defines are put in front, and in compute shaders that of
    // MV_WORKGROUP_SIZE, for kernels in one dimension. The same text with the same defines is
    // compiled once in a process: set every uniform before each use. Throws
    // Error(ExitCode::graphics) with the label, file, line and the driver's log.
    Program(std::string label, const std::vector<std::string>& files, const Defines& defines = {});
    ~Program();
    Program(Program&& other) noexcept;
    Program& operator=(Program&& other) noexcept;
    explicit operator bool() const { return compiled_ != nullptr; }

    // Draws that follow, and each dispatch, see what shaders stored before, and store only when
    // that was read: neither needs a barrier. Nor do reading, writing and copying buffers and
    // textures.
    void use() const;
    // Uniforms by name; a name the compiler removed is ignored.
    void set(std::string_view name, int value);
    void set(std::string_view name, std::uint32_t value);
    void set(std::string_view name, float value);
    void set(std::string_view name, glm::vec2 value);
    void set(std::string_view name, glm::vec3 value);
    void set(std::string_view name, glm::vec4 value);
    void set(std::string_view name, glm::ivec2 value);
    void set(std::string_view name, glm::uvec4 value);
    void set(std::string_view name, const glm::mat4& value);

    // At least `count` invocations of a 1-D compute program (gl_GlobalInvocationID.x may exceed
    // count in the last group: bounds-check first). Counts past the 1-D limit use a 2-D grid: the
    // shader computes its index with globalIndex() of shaders/shared/dispatch.glsl.
    void dispatchInvocations(std::uint64_t count);
    void dispatchGroups(std::uint64_t groups);  // the same for whole work groups
    void dispatch2D(int width, int height);     // invocations
    void dispatchIndirect(const class Buffer& commands, std::uint64_t byteOffset);
    glm::ivec3 groupSize() const;
    // Once for each texel of the target, of a program with "passes/full_screen.vert".
    void drawFullScreen(const class Framebuffer& target) const;

    // Compiles again from MEGAVIEWS_SHADER_DIR or the embedded text; on failure the old program
    // stays and the error is thrown. Uniforms must be set again.
    void reload();
    // Is the text of its files another than it was compiled from? Throws if a file is missing.
    bool outdated() const;
    const std::string& label() const { return label_; }

    struct Source;
    struct Compiled;  // by OpenGL: shared by all programs of the same text and defines

  private:
    void link(const std::vector<Source>& sources, Compiled& out) const;
    void enlist();  // among the live programs, or no longer
    GLint location(std::string_view name);
    std::string label_;
    std::vector<std::string> files_;
    Defines defines_;
    std::shared_ptr<Compiled> compiled_;
};

// Compiles every live program whose files changed again, from MEGAVIEWS_SHADER_DIR or, where that
// is not set, the folder the program was built from if it still exists; later programs come from
// there too. One that fails keeps its last good version. Returns what went wrong, each message
// naming program, file and line: none if all is well.
std::vector<std::string> reloadPrograms();

// Lets go of what was compiled, before its context goes.
void forgetPrograms();

// The text of an embedded (or overridden) shader file with includes resolved; for tests.
std::string shaderSource(const std::string& file);

}  // namespace mv::gl
