// Textures as they are made, before anybody sets a parameter.

#include "renderer/gl/texture.h"

#include <cstddef>
#include <vector>

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

// A read is made in bands of 64 MiB; so are layers.
TEST_F(TextureTest, WhatTakesSeveralReadsComesBackWhole) {
    for (const int layers : {1, 3}) {
        const int side = layers == 1 ? 5000 : 3000;  // of 95 and 3 x 34 MiB
        const auto texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
        gl::Texture t("large", layers == 1 ? GL_TEXTURE_2D : GL_TEXTURE_2D_ARRAY, GL_R32F, side,
                      side, layers);
        std::vector<float> all;
        for (int layer = 0; layer < layers; ++layer) {
            std::vector<float> values(texels);
            for (std::size_t i = 0; i < texels; ++i) {
                values[i] = static_cast<float>((i * 2654435761u + static_cast<std::size_t>(layer)) %
                                               1000003u);
            }
            t.writeFloats(1, values, 0, layer);
            all.insert(all.end(), values.begin(), values.end());
        }
        EXPECT_TRUE(t.readFloats(1) == all) << layers;
    }
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv
