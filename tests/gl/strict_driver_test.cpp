#include "support/strict_driver.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "gl/gl_fixture.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"

namespace mv {
namespace {

// By OpenGL alone: mv::gl::Program has the barriers that are missing here.
class StrictDriver : public GlTest {
  protected:
    static GLuint compute(const char* label, const std::string& body) {
        const std::string text = "#version 450 core\nlayout(local_size_x = 1) in;\n" + body;
        const char* const source = text.c_str();
        const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
        glShaderSource(shader, 1, &source, nullptr);
        glCompileShader(shader);
        const GLuint program = glCreateProgram();
        glAttachShader(program, shader);
        glLinkProgram(program);
        glObjectLabel(GL_PROGRAM, program, -1, label);
        glDeleteShader(shader);
        return program;
    }
    static GLuint store() {
        return compute("store",
                       "layout(std430, binding = 0) writeonly buffer Out { uint stored[]; };\n"
                       "void main() { stored[0] = 7u; }\n");
    }
    static void run(GLuint program) {
        glUseProgram(program);
        glDispatchCompute(1, 1, 1);
    }
    static std::vector<std::string> missing() { return test::takeMissingBarriers(); }
};

TEST_F(StrictDriver, WhatIsStoredNeedsTheBarrierOfItsReader) {
    const GLuint stores = store();
    const GLuint fetches = compute("fetch",
                                   "layout(binding = 0) uniform usamplerBuffer texels;\n"
                                   "layout(std430, binding = 1) buffer Sum { uint sum; };\n"
                                   "void main() { sum = texelFetch(texels, 0).x; }\n");
    const gl::Buffer out("stored", 64), sum("sum", 64);
    const gl::TextureBuffer texels("stored", GL_R32UI, out);
    out.bindStorage(0);
    sum.bindStorage(1);
    texels.bind(0);

    run(stores);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    run(fetches);
    EXPECT_TRUE(missing().empty());

    run(stores);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // of another reader
    run(fetches);
    const std::vector<std::string> found = missing();
    const std::string fetched =
        "buffer \"stored\", written by program \"store\", is then read by "
        "program \"fetch\" without TEXTURE_FETCH_BARRIER";
    EXPECT_EQ(std::count(found.begin(), found.end(), fetched), 1);
    // Nor is the second store ordered after the first and its fetch, nor the second sum after the
    // first's load and store.
    EXPECT_EQ(found.size(), 5u);
    glDeleteProgram(stores);
    glDeleteProgram(fetches);
}

TEST_F(StrictDriver, ReadBacksNeedTheirs) {
    const GLuint stores = store();
    const gl::Buffer out("read back", 64);
    out.bindStorage(0);
    unsigned value = 0;
    run(stores);
    glGetNamedBufferSubData(out.id(), 0, sizeof value, &value);
    EXPECT_EQ(missing(), std::vector<std::string>{"buffer \"read back\", written by program "
                                                  "\"store\", is then used by a read-back without "
                                                  "BUFFER_UPDATE_BARRIER"});
    run(stores);
    EXPECT_EQ(out.read<unsigned>(0, 1)[0], 7u);  // has it
    missing();
    glDeleteProgram(stores);
}

TEST_F(StrictDriver, NothingMayReadWhatItDrawsTo) {
    const char* const texts[] = {
        "#version 450 core\nvoid main() { gl_Position = vec4(vec2(gl_VertexID), 0, 1); }\n",
        "#version 450 core\nlayout(binding = 0) uniform sampler2D same;\nout vec4 colour;\n"
        "void main() { colour = texelFetch(same, ivec2(0), 0); }\n"};
    const GLuint program = glCreateProgram();
    for (int i = 0; i < 2; ++i) {
        const GLuint shader = glCreateShader(i == 0 ? GL_VERTEX_SHADER : GL_FRAGMENT_SHADER);
        glShaderSource(shader, 1, &texts[i], nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    glObjectLabel(GL_PROGRAM, program, -1, "loop");
    const gl::Texture same("same", GL_TEXTURE_2D, GL_RGBA8, 1, 1);
    const gl::Framebuffer target("same", {&same});
    GLuint vertices = 0;
    glCreateVertexArrays(1, &vertices);
    glBindVertexArray(vertices);
    same.bind(0);
    target.bind();
    glUseProgram(program);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    EXPECT_EQ(missing(), std::vector<std::string>{
                             "texture \"same\" is read by program \"loop\" that draws to it"});
    glDeleteVertexArrays(1, &vertices);
    glDeleteProgram(program);
}

TEST_F(StrictDriver, WhatIsNewIsNotZero) {
    const gl::Buffer words("words", 16);
    for (const unsigned word : words.read<unsigned>(0, 4)) EXPECT_EQ(word, 0xFFC0FFEE);
    const gl::Texture radiance("radiance", GL_TEXTURE_2D, GL_RGBA32F, 2, 2);
    for (const float value : radiance.readFloats(4)) EXPECT_TRUE(std::isnan(value));
    const gl::Texture surfaces("surfaces", GL_TEXTURE_2D, GL_RGBA32UI, 1, 1);
    for (const unsigned value : surfaces.readUints(4)) EXPECT_EQ(value, 0xFFC0FFEE);
    const gl::Texture colours("colours", GL_TEXTURE_2D, GL_RGBA8, 1, 1);
    for (const int value : colours.readBytes(4)) EXPECT_NE(value, 0);
}

}  // namespace
}  // namespace mv
