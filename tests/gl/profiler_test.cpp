// The profiler: named rows, and times that mean something on a software renderer too.

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "gl_fixture.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/pass_scope.h"
#include "renderer/gl/program.h"

namespace mv::gl {
namespace {

class ProfilerTest : public GlTest {
  protected:
    // A dispatch that takes some milliseconds on any machine.
    void busy(Program& p, std::uint32_t rounds) {
        p.set("rounds", rounds);
        out_.ensure("out", 4 * 65536);
        out_.bindStorage(0);
        p.dispatchInvocations(65536);
    }
    Program program() {
        const auto folder = std::filesystem::temp_directory_path() /
                            ("megaviews_profiler_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
        std::ofstream(folder / "busy.comp")
            << "layout(local_size_x = 8) in;\n"
               "layout(std430, binding = 0) buffer Out { uint values[]; };\n"
               "uniform uint rounds;\n"
               "void main() { uint h = gl_GlobalInvocationID.x;\n"
               "  for (uint i = 0u; i < rounds; ++i) h = h * 1664525u + 1013904223u;\n"
               "  values[gl_GlobalInvocationID.x] = h; }\n";
        setenv("MEGAVIEWS_SHADER_DIR", folder.c_str(), 1);
        Program p("busy", {"busy.comp"});
        unsetenv("MEGAVIEWS_SHADER_DIR");
        return p;
    }

  private:
    Buffer out_;
};

TEST_F(ProfilerTest, RowsAreInOrderAndEqualNamesAreAdded) {
    Profiler profiler;
    for (const Stage stage : {Stage::gather, Stage::fill, Stage::gather}) {
        PassScope scope(profiler, stage);
    }
    std::vector<StageTime> rows = profiler.take();
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].stage, Stage::gather);
    EXPECT_EQ(rows[1].stage, Stage::fill);
    EXPECT_TRUE(profiler.take().empty());
    profiler.enabled = false;
    { PassScope scope(profiler, Stage::fuse); }
    EXPECT_TRUE(profiler.take().empty());
    expectNoGlErrors();
}

TEST_F(ProfilerTest, AFrameHasTheStagesOfEachOwner) {
    Profiler profiler;
    { PassScope scope(profiler, Stage::gBuffer); }
    {
        const OwnerScope owner(profiler, 1);
        { PassScope scope(profiler, Stage::gather); }
        { PassScope scope(profiler, Stage::fill); }
    }
    try {
        const OwnerScope owner(profiler, 2);
        throw 0;
    } catch (int) {
    }
    { PassScope scope(profiler, Stage::toneMap); }
    ASSERT_TRUE(profiler.endFrame());
    ASSERT_EQ(profiler.stages(0).size(), 2u);
    EXPECT_EQ(profiler.stages(0)[0].stage, Stage::gBuffer);
    EXPECT_EQ(profiler.stages(0)[1].stage, Stage::toneMap);
    EXPECT_EQ(profiler.stages(1).size(), 2u);
    EXPECT_TRUE(profiler.stages(2).empty());
    ASSERT_TRUE(profiler.endFrame());
    EXPECT_TRUE(profiler.stages(1).empty());
    expectNoGlErrors();
}

TEST_F(ProfilerTest, LateTimesArriveWithoutAWait) {
    Profiler profiler(Results::late);
    { PassScope scope(profiler, Stage::gather); }
    forgetWaits();
    profiler.endFrame();
    EXPECT_TRUE(waits().empty());
    glFinish();
    { PassScope scope(profiler, Stage::fill); }
    if (profiler.stages(0).empty()) profiler.endFrame();
    EXPECT_EQ(profiler.stages(0).size(), 1u);
    EXPECT_TRUE(waits().empty());
    expectNoGlErrors();
}

// Wrong timers of software renderers were once off by a factor of 300: what is reported must be
// most of the wall-clock time, and no more than it.
TEST_F(ProfilerTest, TimeIsTheWorkInTheScopeAndNotWhatWasIssuedBefore) {
    Program p = program();
    Profiler profiler;
    busy(p, 10);  // compiles
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    {
        PassScope scope(profiler, Stage::gather);
        busy(p, 4000);
    }
    glFinish();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    const std::vector<StageTime> rows = profiler.take();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_GT(rows[0].ms, 0.0);
    EXPECT_LE(rows[0].ms, wall.count());
    if (limits().software) {
        EXPECT_STREQ(profiler.clock(), "wall clock, synchronised");
        EXPECT_GT(rows[0].ms, 0.1 * wall.count());
    } else {
        EXPECT_STREQ(profiler.clock(), "gpu timer");
    }
    // Work left running when a scope opens is not counted in it.
    busy(p, 4000);
    { PassScope scope(profiler, Stage::fill); }
    if (limits().software) {
        EXPECT_LT(profiler.take()[0].ms, 0.5 * rows[0].ms);
    }
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv::gl
