#pragma once
// What a linked program of shaders reads and writes: asked of the driver, but for `readonly` and
// `writeonly`, which only its text says.

#include <epoxy/gl.h>

#include <string>
#include <vector>

namespace mv::test {

struct Shader {
    GLenum stage = GL_NONE;
    std::string text;
};
// Those that are attached to a program: ask before it is linked, since some let go of them then.
std::vector<Shader> shadersOf(GLuint program);

struct Access {
    GLuint binding = 0;
    bool reads = true, writes = false;
};
struct Sampled {
    GLint location = 0;
    GLenum target = GL_TEXTURE_2D;
};
struct ProgramInterface {
    std::vector<Access> blocks, images, uniformBlocks;
    std::vector<Sampled> samplers;
};

// Of a program that has been linked of these.
ProgramInterface interfaceOf(GLuint program, const std::vector<Shader>& shaders);

}  // namespace mv::test
