// Textures as they are made, before anybody sets a parameter.

#include "renderer/gl/texture.h"

#include "gl/gl_fixture.h"

namespace mv {
namespace {

using TextureTest = GlTest;

// With any other filter an integer texture is incomplete and reads as zero.
TEST_F(TextureTest, IntegersAreNotFiltered) {
    const auto filters = [](int format) {
        const gl::Texture t("made", GL_TEXTURE_2D, static_cast<GLenum>(format), 4, 4);
        GLint min = 0, mag = 0;
        glGetTextureParameteriv(t.id(), GL_TEXTURE_MIN_FILTER, &min);
        glGetTextureParameteriv(t.id(), GL_TEXTURE_MAG_FILTER, &mag);
        return std::pair(min, mag);
    };
    for (const int format : {GL_R8UI, GL_R16UI, GL_R32I, GL_R32UI, GL_RG32UI, GL_RGBA32I,
                             GL_RGBA32UI, GL_DEPTH_COMPONENT32F}) {
        EXPECT_EQ(filters(format), std::pair(GL_NEAREST, GL_NEAREST)) << format;
    }
    EXPECT_EQ(filters(GL_RGBA32F), std::pair(GL_LINEAR, GL_LINEAR));
    EXPECT_EQ(filters(GL_RGBA8), std::pair(GL_LINEAR, GL_LINEAR));
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
