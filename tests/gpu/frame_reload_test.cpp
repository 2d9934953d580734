// Shaders edited while the program runs: a broken one is told about and the picture stays, a mended
// one is seen.

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gpu/frame_fixture.h"

namespace mv {
namespace {

class ReloadTest : public test::FrameTest {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("megaviews-reload-" + std::to_string(::getpid()));
        std::filesystem::remove_all(folder_);
        std::filesystem::copy(MEGAVIEWS_SOURCE_DIR "/shaders", folder_,
                              std::filesystem::copy_options::recursive);
        setenv("MEGAVIEWS_SHADER_DIR", folder_.c_str(), 1);
        FrameTest::SetUp();
    }
    void TearDown() override {
        FrameTest::TearDown();
        unsetenv("MEGAVIEWS_SHADER_DIR");
        std::filesystem::remove_all(folder_);
    }
    std::string read(const std::string& name) const {
        std::ifstream file(folder_ / name);
        std::ostringstream text;
        text << file.rdbuf();
        return text.str();
    }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
    }

  private:
    std::filesystem::path folder_;
};

TEST_F(ReloadTest, BrokenShadersKeepTheirLastGoodVersion) {
    render();
    const auto before = radiance();
    EXPECT_TRUE(renderer->reloadShaders().empty());  // nothing changed
    render();
    EXPECT_EQ(radiance(), before);

    const std::string good = read("passes/compose.frag");
    const auto lines = std::count(good.begin(), good.end(), '\n');
    write("passes/compose.frag", good + "nonsense;\n");
    for (int i = 0; i < 2; ++i) {  // it goes on being told
        const auto messages = renderer->reloadShaders();
        ASSERT_EQ(messages.size(), 1u);
        EXPECT_NE(messages[0].find("passes/compose.frag:" + std::to_string(lines + 1)),
                  std::string::npos)
            << messages[0];
        EXPECT_NE(messages[0].find("\"compose\""), std::string::npos) << messages[0];
        render();
        EXPECT_EQ(radiance(), before);
    }

    std::string edited = good;
    const std::string place = "color = vec4(result, 1.0);";
    ASSERT_NE(edited.find(place), std::string::npos);
    edited.replace(edited.find(place), place.size(), "color = vec4(2.0 * result, 1.0);");
    write("passes/compose.frag", edited);
    EXPECT_TRUE(renderer->reloadShaders().empty());
    render();
    const auto twice = radiance();
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (i % 4 != 3) {
            ASSERT_FLOAT_EQ(twice[i], 2 * before[i]);
        }
    }

    // A header that many programs include, missing: one message names it, all go on.
    const std::string header = read("shared/language.glsl");
    std::filesystem::remove(std::filesystem::path(std::getenv("MEGAVIEWS_SHADER_DIR")) /
                            "shared/language.glsl");
    const auto missing = renderer->reloadShaders();
    ASSERT_FALSE(missing.empty());
    for (const std::string& message : missing) {
        EXPECT_NE(message.find("shared/language.glsl"), std::string::npos) << message;
    }
    render();
    EXPECT_EQ(radiance(), twice);
    write("shared/language.glsl", header);
    write("passes/compose.frag", good);
    EXPECT_TRUE(renderer->reloadShaders().empty());
    render();
    EXPECT_EQ(radiance(), before);
}

}  // namespace
}  // namespace mv
