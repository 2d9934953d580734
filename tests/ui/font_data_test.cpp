// The font in the program is the one in assets/fonts, and fit for columns of numbers.

#include "ui/font_data.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <fstream>
#include <iterator>
#include <memory>

namespace mv::ui {
namespace {

TEST(FontData, IsTheFileInAssets) {
    for (const auto& [name, data] :
         {std::pair{"Regular", interfaceFont()}, std::pair{"Medium", interfaceFontMedium()}}) {
        std::ifstream file(
            std::string(MEGAVIEWS_SOURCE_DIR "/assets/fonts/Roboto-") + name + ".ttf",
            std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        EXPECT_GT(bytes.size(), 100000u);
        EXPECT_EQ(bytes, std::string(data.begin(), data.end())) << name;
    }
}

TEST(FontData, DigitsAreOfOneWidthAndSignsAreThere) {
    for (const auto data : {interfaceFont(), interfaceFontMedium()}) {
        for (const float size : {13.0f, 16.0f, 32.0f}) {
            ImFontAtlas atlas;
            ImFontConfig config;
            config.FontDataOwnedByAtlas = false;
            const ImWchar ranges[] = {0x20,   0xff,   0x2010, 0x2026, 0x2190,
                                      0x21ff, 0x2212, 0x2212, 0};
            // ImGui takes data it may change, and does not.
            ImFont* font =
                atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(data.data()),
                                           static_cast<int>(data.size()), size, &config, ranges);
            ASSERT_TRUE(atlas.Build());
            const float width = font->FindGlyph('0')->AdvanceX;
            EXPECT_GT(width, size / 4);
            for (ImWchar digit = '1'; digit <= '9'; ++digit) {
                EXPECT_EQ(font->FindGlyph(digit)->AdvanceX, width) << digit;
            }
            // Degree, plus-minus, squared, micro, middle dot, times, dashes, ellipsis, minus.
            for (const ImWchar sign : std::initializer_list<ImWchar>{
                     0xb0, 0xb1, 0xb2, 0xb5, 0xb7, 0xd7, 0x2013, 0x2014, 0x2026, 0x2212}) {
                EXPECT_NE(font->FindGlyphNoFallback(sign), nullptr) << std::hex << sign;
            }
        }
    }
}

}  // namespace
}  // namespace mv::ui
