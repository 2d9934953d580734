// Textures as they are made, before anybody sets a parameter.

#include "renderer/gl/texture.h"

#include "gl/gl_fixture.h"

namespace mv {
namespace {

using TextureTest = GlTest;

// Integer textures are incomplete, and read as zero, with a filter that mixes texels.
TEST_F(TextureTest, TexelsAreNotMixedInAnyFormat) {
    for (const int format :
         {GL_R8UI, GL_R32I, GL_RGBA32UI, GL_DEPTH_COMPONENT32F, GL_RGBA32F, GL_RGBA8}) {
        const gl::Texture t("made", GL_TEXTURE_2D, static_cast<GLenum>(format), 4, 4);
        GLint min = 0, mag = 0;
        glGetTextureParameteriv(t.id(), GL_TEXTURE_MIN_FILTER, &min);
        glGetTextureParameteriv(t.id(), GL_TEXTURE_MAG_FILTER, &mag);
        EXPECT_EQ(min, GL_NEAREST_MIPMAP_NEAREST) << format;
        EXPECT_EQ(mag, GL_NEAREST) << format;
    }
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
