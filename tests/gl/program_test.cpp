// Programs: includes, errors with file and line, dispatch folding, reload, uniforms.

#include "renderer/gl/program.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include "gl_fixture.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/texel_buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/workarounds.h"

namespace mv::gl {
namespace {

// A folder of shaders of the test's own, in place of the embedded ones.
class ProgramTest : public GlTest {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("megaviews_shaders_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder_);
        setenv("MEGAVIEWS_SHADER_DIR", folder_.c_str(), 1);
        GlTest::SetUp();
    }
    void TearDown() override {
        unsetenv("MEGAVIEWS_SHADER_DIR");
        std::filesystem::remove_all(folder_);
        GlTest::TearDown();
    }
    void file(const std::string& name, const std::string& text) {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name) << text;
    }
    std::string failure(const std::string& name) {
        try {
            const Program p("under test", {name});
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::graphics);
            return e.what();
        }
        ADD_FAILURE() << name << " compiled";
        return {};
    }

  private:
    std::filesystem::path folder_;
};

constexpr const char* kWriteSum =
    "layout(local_size_x = 8) in;\n"
    "layout(std430, binding = 0) buffer Out { uint values[]; };\n";

TEST_F(ProgramTest, IncludesAreResolvedThroughFoldersAndGuards) {
    file("shared/a.glsl", "#ifndef A\n#define A\nuint a() { return 1u; }\n#endif\n");
    file("shared/b.glsl",
         "#ifndef B\n#define B\n#ifdef __cplusplus\n#include <cmath>\n#include "
         "\"megaviews/x.h\"\n#endif\n#include \"shaders/shared/a.glsl\"\n"
         "uint b() { return a() + FACTOR; }\n#endif\n");
    file("passes/sum.comp",
         std::string(kWriteSum) +
             "#include \"shaders/shared/a.glsl\"\n"
             "  #  include \"shaders/shared/b.glsl\"\n"
             "#include \"shaders/shared/a.glsl\"\n"
             "void main() { values[0] = a() + 10u * b() + 100u * uint(__LINE__); }\n");
    Program p("sum", {"passes/sum.comp"}, {{"FACTOR", "4u"}});
    const Buffer out("out", 4);
    out.bindStorage(0);
    p.dispatchGroups(1);
    EXPECT_EQ(out.read<std::uint32_t>(0, 1)[0], 1u + 50u + 100u * 6u);
    expectNoGlErrors();
}

TEST_F(ProgramTest, AnErrorNamesTheFileAndLineItIsIn) {
    file("shared/broken.glsl",
         "#ifndef BROKEN\n#define BROKEN\n\nfloat f() { return undeclared_name; }\n#endif\n");
    file("passes/user.comp", std::string(kWriteSum) +
                                 "#include \"shaders/shared/broken.glsl\"\n"
                                 "void main() { values[0] = uint(f()); }\n");
    EXPECT_NE(failure("passes/user.comp").find("shared/broken.glsl:4"), std::string::npos)
        << failure("passes/user.comp");

    // After the include the lines are counted in the including file again.
    file("shared/broken.glsl", "#ifndef BROKEN\n#define BROKEN\n\n\n\n\n#endif\n");
    file("passes/after.comp", std::string(kWriteSum) +
                                  "#include \"shaders/shared/broken.glsl\"\n"
                                  "\nvoid main() { values[0] = other_undeclared; }\n");
    const std::string message = failure("passes/after.comp");
    EXPECT_NE(message.find("passes/after.comp:5"), std::string::npos) << message;
    EXPECT_NE(message.find("under test"), std::string::npos) << message;
}

TEST_F(ProgramTest, AMissingFileIsNamedWithWhoWantsIt) {
    file("passes/lost.comp", "#include \"shaders/shared/nowhere.glsl\"\nvoid main() {}\n");
    const std::string message = failure("passes/lost.comp");
    EXPECT_NE(message.find("shared/nowhere.glsl"), std::string::npos) << message;
    EXPECT_NE(message.find("passes/lost.comp:1"), std::string::npos) << message;
}

TEST_F(ProgramTest, FilesThatIncludeEachOtherEnd) {
    file("shared/x.glsl", "#ifndef X\n#define X\n#include \"shaders/shared/y.glsl\"\n#endif\n");
    file("shared/y.glsl", "#ifndef Y\n#define Y\n#include \"shaders/shared/x.glsl\"\n#endif\n");
    file("passes/ring.comp",
         std::string(kWriteSum) +
             "#include \"shaders/shared/x.glsl\"\nvoid main() { values[0] = 1u; }\n");
    EXPECT_NO_THROW(Program("ring", {"passes/ring.comp"}));
}

TEST_F(ProgramTest, PreciseSurvivesTheIncludes) {
    file("shared/p.glsl", "float f(float a) { precise float r = a * a + a; return r; }\n");
    file("passes/p.comp", "#include \"shaders/shared/p.glsl\"\n");
    EXPECT_NE(shaderSource("passes/p.comp").find("precise float r"), std::string::npos);
}

TEST_F(ProgramTest, AFailedReloadKeepsTheLastGoodProgram) {
    file("passes/edit.comp", std::string(kWriteSum) + "void main() { values[0] = 5u; }\n");
    Program p("edited", {"passes/edit.comp"});
    file("passes/edit.comp", "void main() { nonsense }\n");
    EXPECT_THROW(p.reload(), Error);
    const Buffer out("out", 4);
    out.bindStorage(0);
    p.dispatchGroups(1);
    EXPECT_EQ(out.read<std::uint32_t>(0, 1)[0], 5u);
    file("passes/edit.comp", std::string(kWriteSum) + "void main() { values[0] = 6u; }\n");
    p.reload();
    p.dispatchGroups(1);
    EXPECT_EQ(out.read<std::uint32_t>(0, 1)[0], 6u);
}

TEST_F(ProgramTest, UniformsReachTheShaderAndUnknownOnesAreErrors) {
    file("passes/uniforms.comp",
         std::string(kWriteSum) +
             "uniform int i; uniform uint u; uniform float f; uniform vec2 v2; uniform vec3 v3;\n"
             "uniform vec4 v4; uniform ivec2 i2; uniform uvec4 u4; uniform mat4 m;\n"
             "uniform float unused; uniform uint several[2];\n"
             "void main() { if (gl_GlobalInvocationID.x > 0u) return;\n"
             "values[0] = uint(i) + u + uint(f + v2.y + v3.z + v4.w) + uint(i2.y) + u4.w\n"
             "  + uint((m * vec4(0, 0, 0, 1)).x); }\n");
    Program p("uniforms", {"passes/uniforms.comp"});
    p.set("i", 1);
    p.set("u", 20u);
    p.set("f", 100.0f);
    p.set("v2", glm::vec2(0, 200));
    p.set("v3", glm::vec3(0, 0, 300));
    p.set("v4", glm::vec4(0, 0, 0, 400));
    p.set("i2", glm::ivec2(0, 10000));
    p.set("u4", glm::uvec4(0, 0, 0, 100000));
    glm::mat4 m(1);
    m[3].x = 5000000;  // the translation's column
    p.set("m", m);
    p.set("unused", 1.0f);
    p.set("several[1]", 1u);
    for (const char* name : {"absent", "use", "unused_", "absent[1]"})
        EXPECT_THROW(p.set(name, 1.0f), Error) << name;
    const Buffer out("out", 4);
    out.bindStorage(0);
    p.dispatchGroups(1);
    EXPECT_EQ(out.read<std::uint32_t>(0, 1)[0], 5111021u);
    expectNoGlErrors();
}

// Every index once: counted per index, with those past the end kept out.
TEST_F(ProgramTest, DispatchCoversEachIndexOnceAlsoPastTheLimitOfOneDimension) {
    std::ifstream real(MEGAVIEWS_SOURCE_DIR "/shaders/shared/dispatch.glsl");
    file("shared/dispatch.glsl", std::string(std::istreambuf_iterator<char>(real), {}));
    file("passes/count.comp",
         "layout(local_size_x = MV_WORKGROUP_SIZE) in;\n"
         "layout(std430, binding = 0) buffer Out { uint values[]; };\n"
         "#include \"shaders/shared/dispatch.glsl\"\n"
         "uniform uint count;\n"
         "void main() { uint i = globalIndex(); if (i >= count) return;\n"
         "  atomicAdd(values[i], i + 1u); }\n");
    Program p("count", {"passes/count.comp"}, {{"MV_WORKGROUP_SIZE", "8"}});
    EXPECT_EQ(p.groupSize(), glm::ivec3(8, 1, 1));
    for (std::uint32_t count : {0u, 1u, 7u, 8u, 9u, 65535u * 8u, 65535u * 8u + 1u, 700001u}) {
        Buffer out("out", (count + 1u) * 4u);
        out.fill(0);
        out.bindStorage(0);
        p.set("count", count);
        p.dispatchInvocations(count);
        std::uint64_t wrong = 0;
        const std::vector<std::uint32_t> values = out.read<std::uint32_t>(0, count + 1u);
        for (std::uint32_t i = 0; i < count; ++i) wrong += values[i] != i + 1u;
        EXPECT_EQ(wrong, 0u) << count;
        EXPECT_EQ(values[count], 0u) << count;
    }
    expectNoGlErrors();
}

TEST_F(ProgramTest, Dispatch2DAndIndirectCoverWhatTheyShould) {
    file("passes/grid.comp",
         "layout(local_size_x = 4, local_size_y = 2) in;\n"
         "layout(std430, binding = 0) buffer Out { uint values[]; };\n"
         "uniform ivec2 size;\n"
         "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
         "  if (any(greaterThanEqual(p, size))) return;\n"
         "  atomicAdd(values[p.y * size.x + p.x], 1u); }\n");
    Program p("grid", {"passes/grid.comp"});
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(5, 3), glm::ivec2(8, 4)}) {
        const auto texels = static_cast<std::uint64_t>(size.x * size.y);
        Buffer out("out", texels * 4);
        out.fill(0);
        out.bindStorage(0);
        p.set("size", size);
        p.dispatch2D(size.x, size.y);
        EXPECT_EQ(out.read<std::uint32_t>(0, texels), std::vector<std::uint32_t>(texels, 1u));
    }
    Buffer out("out", 32 * 4);
    out.fill(0);
    out.bindStorage(0);
    p.set("size", glm::ivec2(8, 4));
    const Buffer commands = Buffer::of("commands", std::vector<std::uint32_t>{9, 9, 2, 2, 1});
    p.dispatchIndirect(commands, 8);
    EXPECT_EQ(out.read<std::uint32_t>(0, 32), std::vector<std::uint32_t>(32, 1u));
    expectNoGlErrors();
}

// The driver keeps what it has compiled in files, which it writes from a thread of its own.
class DriverCacheTest : public ProgramTest {
  protected:
    void SetUp() override {
        kept_ = std::filesystem::temp_directory_path() /
                ("megaviews_driver_" + std::to_string(getpid()));
        std::filesystem::create_directories(kept_);
        setenv("MESA_SHADER_CACHE_DIR", kept_.c_str(), 1);  // read with the process's first context
        ProgramTest::SetUp();
    }
    void TearDown() override {
        ProgramTest::TearDown();
        unsetenv("MESA_SHADER_CACHE_DIR");
        std::filesystem::remove_all(kept_);
    }
    int filesKept() const {
        int files = -1;
        for (int waits = 0; waits < 5; ++waits) {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            int now = 0;
            for (const auto& e : std::filesystem::recursive_directory_iterator(kept_)) {
                if (e.is_regular_file() && e.path().filename() != "index") ++now;
            }
            if (std::exchange(files, now) != now) waits = 0;
        }
        return files;
    }

  private:
    std::filesystem::path kept_;
};

TEST_F(DriverCacheTest, AKernelIsCompiledOnceWhateverItReads) {
    if (!isOn(Workaround::alikeState)) GTEST_SKIP();
    file("passes/texels.comp", std::string(kWriteSum) +
                                   "layout(binding = 0) uniform usamplerBuffer texels;\n"
                                   "layout(binding = 1) uniform usamplerBuffer others;\n"
                                   "void main() { values[0] = texelFetch(texels, 0).x +\n"
                                   "    texelFetch(others, 0).x; }\n");
    file("passes/images.comp", std::string(kWriteSum) +
                                   "layout(binding = 0) uniform usampler2D whole;\n"
                                   "layout(binding = 1) uniform sampler2D real;\n"
                                   "void main() { values[0] = texelFetch(whole, ivec2(0), 0).x +\n"
                                   "    uint(texelFetch(real, ivec2(0), 0).x); }\n");
    const Buffer out("out", 4);
    Program texels("texels", {"passes/texels.comp"}), images("images", {"passes/images.comp"});
    const Texture whole("whole", GL_TEXTURE_2D, GL_R32UI, 3, 3);
    const Texture real("real", GL_TEXTURE_2D, GL_RGBA32F, 3, 3);
    const auto readBuffers = [&](std::uint64_t one, std::uint64_t other) {
        TexelBuffer<std::uint32_t> first, second;
        first.ensure("first", one);
        second.ensure("second", other);
        first.bindTexels(0);
        second.bindTexels(1);
        out.bindStorage(0);
        texels.dispatchGroups(1);
        glFinish();
    };
    readBuffers(1000, 1000);
    whole.bind(0);
    real.bind(1);
    out.bindStorage(0);
    images.dispatchGroups(1);
    const int files = filesKept();
    if (files == 0) GTEST_SKIP() << "the driver keeps nothing, or has another folder by now";
    readBuffers(1000, 1000);
    readBuffers(1, 70000);
    readBuffers(4096, 16384);
    readBuffers(100003, 64);
    EXPECT_EQ(filesKept(), files);
    expectNoGlErrors();
}

}  // namespace
}  // namespace mv::gl
