// Views as PLY: round trips, what other tools write, and everything that can be wrong with a file.

#include "megaviews/io/ply.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>

#include "megaviews/core/error.h"
#include "views/rooms.h"

namespace mv {
namespace {

namespace fs = std::filesystem;
using testing::fluxOf;
using testing::normalOf;
using testing::positionOf;

class Ply : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("megaviews-ply-" + std::to_string(getpid()) + "-" + info->name());
        fs::create_directories(folder_);
        root_.origin = {-1, -1, -1};
        root_.edge = 4;
    }
    void TearDown() override { fs::remove_all(folder_); }

    ViewSet load(const std::string& text) {
        warnings_.clear();
        return parseViews(text, "in.ply", root_, &warnings_);
    }
    // The message that loading it ends in.
    std::string refused(const std::string& text) {
        try {
            load(text);
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::input);
            EXPECT_NE(std::string(e.what()).find("in.ply: "), std::string::npos) << e.what();
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
            return e.what();
        }
        ADD_FAILURE() << "accepted:\n" << text.substr(0, 400);
        return {};
    }
    void expectRefused(const std::string& text, const std::string& reason) {
        const std::string message = refused(text);
        EXPECT_NE(message.find(reason), std::string::npos) << message;
    }

    fs::path folder_;
    RootCube root_;
    std::vector<std::string> warnings_;
};

const std::string kSix =
    "property double x\nproperty double y\nproperty double z\n"
    "property float red\nproperty float green\nproperty float blue\n";
const std::string kNormals = "property float nx\nproperty float ny\nproperty float nz\n";

std::string ascii(std::uint64_t count, const std::string& properties, const std::string& body) {
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n" + properties +
           "end_header\n" + body;
}

// Appends a number as it lies in a file.
template <typename T>
void append(std::string& out, T value) {
    out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// ---------------------------------------------------------------- round trips

TEST_F(Ply, BringsBackWhatWasSaved) {
    const testing::Lit lit(testing::furnishedRoom(1, testing::everything));
    const ViewSet set = lit.trace(1000, 4);
    const fs::path file = folder_ / "views.ply";
    saveViews(file, set, lit.scene.root);
    const ViewSet back = loadViews(file, lit.scene.root);
    ASSERT_EQ(back.views.size(), set.alive());
    std::size_t at = 0;
    for (const View& v : set.views) {
        if (v.flags == kViewDead) continue;
        const View& w = back.views[at];
        EXPECT_LT(glm::length(positionOf(w) - positionOf(v)), 1e-7);
        EXPECT_LT(glm::length(normalOf(w) - normalOf(v)), 1e-6);
        EXPECT_EQ(fluxOf(w), fluxOf(v));
        EXPECT_EQ(w.flags, kViewHemisphere);
        EXPECT_EQ(w.slot, at);
        ++at;
    }
    // What was read is written again with the same bytes.
    const fs::path again = folder_ / "again.ply";
    saveViews(again, back, lit.scene.root);
    const auto bytes = [](const fs::path& p) {
        std::ifstream in(p, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(fs::file_size(file), fs::file_size(again));
    EXPECT_EQ(bytes(again).substr(0, 300), bytes(file).substr(0, 300));
    EXPECT_NE(bytes(file).find("property double z\nproperty float nx\n"), std::string::npos);
    for (const auto& entry : fs::directory_iterator(folder_)) {
        EXPECT_EQ(entry.path().extension(), ".ply") << "left behind";
    }
}

TEST_F(Ply, KeepsDoublePositionsFarFromTheOrigin) {
    root_.origin = {1e6, -2e6, 3e6};
    root_.edge = 2;
    ViewSet set = makeParticles(SceneBounds{}, 100, 1, 0, 5);
    saveViews(folder_ / "far.ply", set, root_);
    const ViewSet back = loadViews(folder_ / "far.ply", root_);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_LT(glm::length(positionOf(back.views[i]) - positionOf(set.views[i])), 1e-7);
        EXPECT_EQ(back.views[i].flags, kViewOmnidirectional);
        EXPECT_EQ(back.views[i].bounce, 0u);
    }
}

TEST_F(Ply, WritesNoNormalsForParticlesAloneAndZeroOnesAmongVpls) {
    ViewSet set = makeParticles(SceneBounds{}, 3, 1, 0, 5);
    const auto header = [&] {
        saveViews(folder_ / "p.ply", set, root_);
        std::ifstream in(folder_ / "p.ply", std::ios::binary);
        const std::string text(std::istreambuf_iterator<char>(in), {});
        return text.substr(0, text.find("end_header"));
    };
    EXPECT_EQ(header().find("nx"), std::string::npos);
    View vpl = set.views[0];
    vpl.flags = kViewHemisphere;
    vpl.normalY = 1;
    set.views.push_back(vpl);
    EXPECT_NE(header().find("nx"), std::string::npos);
    const ViewSet back = loadViews(folder_ / "p.ply", root_);
    ASSERT_EQ(back.views.size(), 4u);
    EXPECT_EQ(back.views[0].flags, kViewOmnidirectional);
    EXPECT_EQ(back.views[3].flags, kViewHemisphere);
    EXPECT_EQ(back.views[3].normalY, 1.0f);
}

TEST_F(Ply, HoldsNoViews) {
    saveViews(folder_ / "none.ply", ViewSet{{View{}, View{}}}, root_);
    EXPECT_TRUE(loadViews(folder_ / "none.ply", root_).views.empty());
    EXPECT_TRUE(load(ascii(0, kSix, "")).views.empty());
}

// ---------------------------------------------------------------- what others write

TEST_F(Ply, ReadsAsciiInAnyOrderWithCommentsAndWhatFollows) {
    const std::string text =
        "ply\nformat ascii 1.0\ncomment from elsewhere\nobj_info 7\n"
        "element vertex 2\nproperty float confidence\nproperty float32 blue\nproperty float green\n"
        "property float red\nproperty float z\nproperty float64 y\nproperty float x\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0.5 3 2 1 0.25 1.5 -0.5\n"
        "\n0.5 +3e0 2 1 1 1 1\n"
        "3 0 1 2\n";
    for (const bool crlf : {false, true}) {
        std::string input;
        for (const char c : text) input += crlf && c == '\n' ? "\r\n" : std::string(1, c);
        const ViewSet set = load(input);
        ASSERT_EQ(set.views.size(), 2u);
        const glm::dvec3 world = root_.worldFromRoot(glm::vec3(positionOf(set.views[0])));
        EXPECT_LT(glm::length(world - glm::dvec3(-0.5, 1.5, 0.25)), 1e-6);
        EXPECT_EQ(fluxOf(set.views[0]), glm::dvec3(1, 2, 3));
        EXPECT_EQ(fluxOf(set.views[1]), glm::dvec3(1, 2, 3));
        EXPECT_EQ(set.views[0].flags, kViewOmnidirectional);
    }
    // A last line without its end.
    EXPECT_EQ(load(text.substr(0, text.size() - 1)).views.size(), 2u);
    EXPECT_EQ(load(ascii(1, kSix, "0 0 0 1 1 1")).views.size(), 1u);
}

TEST_F(Ply, ReadsBinaryOfEveryType) {
    for (const char* end : {"\n", "\r\n"}) {
        std::string text;
        for (const char* line :
             {"ply", "format binary_little_endian 1.0", "element vertex 2", "property uchar a",
              "property uchar red", "property double x", "property float green", "property uint8 y",
              "property float z", "property double blue", "property float nx", "property double ny",
              "property float nz", "element junk 2", "property list ushort double values",
              "end_header"}) {
            text += std::string(line) + end;
        }
        for (int i = 0; i < 2; ++i) {
            append<std::uint8_t>(text, 250);
            append<std::uint8_t>(text, 51);
            append<double>(text, -1);
            append<float>(text, 1);
            append<std::uint8_t>(text, 2);
            append<float>(text, 0.5f);
            append<double>(text, 7.25);
            append<float>(text, 0);
            append<double>(text, -4);
            append<float>(text, 3);
        }
        const ViewSet set = load(text + "whatever follows");
        ASSERT_EQ(set.views.size(), 2u);
        const View& v = set.views[1];
        EXPECT_EQ(positionOf(v), glm::dvec3(0, 0.75, 0.375));
        EXPECT_FLOAT_EQ(v.fluxR, 0.2f);  // 8 bits mean colours
        EXPECT_EQ(v.fluxG, 1.0f);
        EXPECT_EQ(v.fluxB, 7.25f);
        EXPECT_LT(glm::length(normalOf(v) - glm::dvec3(0, -0.8, 0.6)), 1e-7);
        EXPECT_EQ(v.flags, kViewHemisphere);
        EXPECT_EQ(v.bounce, 1u);
    }
}

TEST_F(Ply, ClampsWhatLiesJustOutsideAndSaysSo) {
    const ViewSet set = load(ascii(2, kSix, "-1.003 0 0 1 1 1\n0 0 3 1 1 1\n"));
    EXPECT_EQ(set.views[0].positionX, 0.0f);
    EXPECT_LT(set.views[1].positionZ, 1.0f);
    EXPECT_GT(set.views[1].positionZ, 0.999999f);
    ASSERT_EQ(warnings_.size(), 1u);
    EXPECT_NE(warnings_[0].find("2 views"), std::string::npos) << warnings_[0];
}

// ---------------------------------------------------------------- what is wrong with files

TEST_F(Ply, RefusesMalformedHeaders) {
    expectRefused("", "not a PLY file");
    expectRefused("plyx\n", "not a PLY file");
    expectRefused("ply", "ends where the rest of its header");
    expectRefused("ply\nformat ascii 1.0\n", "ends where the rest of its header");
    expectRefused(std::string("\0\0\0\0", 4), "not a PLY file");
    expectRefused("ply\nformat ascii 2.0\nend_header\n", "line 2");
    expectRefused("ply\nformat binary 1.0\nend_header\n", "unknown format 'binary'");
    expectRefused("ply\nend_header\n", "no format line");
    expectRefused("ply\nformat ascii 1.0\nend_header\n", "no vertex element");
    expectRefused("ply\nformat ascii 1.0\nwhat is this\nend_header\n",
                  "unknown header keyword 'what'");
    expectRefused("ply\nformat ascii 1.0\nproperty float x\n", "before any element");
    expectRefused("ply\nformat ascii 1.0\nelement vertex\nend_header\n", "line 3");
    expectRefused("ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", "is '-1'");
    expectRefused("ply\nformat ascii 1.0\nelement vertex 1e3\nend_header\n", "is '1e3'");
    expectRefused("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n",
                  "line 3");
    expectRefused("ply\nformat binary_big_endian 1.0\nend_header\n", "unknown format");
    expectRefused("ply\nformat ascii 1.0\nelement face 0\nelement vertex 0\nend_header\n",
                  "the first element must be vertex");
    expectRefused(ascii(0, kSix + "property float x\n", ""), "a second property 'x'");
    expectRefused(ascii(0, "property half x\n", ""), "unknown type 'half'");
    expectRefused(ascii(0, "property float\n", ""), "expected 'property <type> <name>'");
    expectRefused(ascii(0, "property short x\n", ""), "unknown type 'short'");
    expectRefused(ascii(0, kSix + "property list uchar int a\n", ""),
                  "expected 'property <type> <name>'");
    expectRefused(ascii(0, "property float x\nproperty float y\n", ""), "no property 'z'");
    expectRefused(ascii(0, kSix.substr(0, kSix.rfind("property")), ""), "no property 'blue'");
    expectRefused(ascii(0, kSix + "property float nx\n", ""), "no property 'ny'");
}

TEST_F(Ply, RefusesWhatDoesNotFitItsHeader) {
    const std::string line = "0 0 0 1 1 1\n";
    expectRefused(ascii(2, kSix, "0.000000000000000 0 0 1 1 1\n"), "ends where vertex 1");
    expectRefused(ascii(1, kSix, "0 0 0 1 100\n"), "line 11: vertex 0: 5 numbers, but 6");
    expectRefused(ascii(1, kSix, "0 0 0 1 1 1 1\n"), "7 numbers, but 6");
    expectRefused(ascii(1, kSix, "0 0 zero 1 1 1\n"), "'zero' is not a number");
    expectRefused(ascii(1, kSix, "0 0 0x1 1 1 1\n"), "is not a number");
    expectRefused(ascii(1, kSix, "0 0 1e999 1 1 1\n"), "vertex 0");
    expectRefused(ascii(1, kSix, std::string("\x01\x02\xff\0 0 0 0 0 0\n", 16)), "is not a number");

    // Counts that the file's size does not bear out: refused before anything is allocated.
    for (const std::string format : {"ascii", "binary_little_endian"}) {
        for (const std::string count : {"1000", "8388607"}) {
            expectRefused("ply\nformat " + format + " 1.0\nelement vertex " + count + "\n" + kSix +
                              "end_header\n" + line,
                          "bytes are left");
        }
        for (const std::string count : {"8388608", "18446744073709551615"}) {
            expectRefused("ply\nformat " + format + " 1.0\nelement vertex " + count + "\n" + kSix +
                              "end_header\n" + line,
                          "at most");
        }
    }
}

TEST_F(Ply, RefusesWhatIsNoView) {
    expectRefused(ascii(1, kSix, "nan 0 0 1 1 1\n"), "vertex 0: x is not finite");
    expectRefused(ascii(1, kSix, "0 inf 0 1 1 1\n"), "vertex 0: y is not finite");
    expectRefused(ascii(1, kSix, "0 0 0 1 -1 1\n"), "green = -1");
    expectRefused(ascii(1, kSix, "0 0 0 1e39 1 1\n"), "is not a flux");
    expectRefused(ascii(1, kSix + kNormals, "0 0 0 1 1 1 0 nan 0\n"), "ny is not finite");
    expectRefused(ascii(2, kSix, "0 0 0 1 1 1\n0 4 0 1 1 1\n"),
                  "vertex 1 lies outside the scene's root cube: y = 4");
    expectRefused(ascii(1, kSix, "0 0 1e300 1 1 1\n"), "outside the scene's root cube");
    // Tiny and huge normals are directions all the same.
    const ViewSet set =
        load(ascii(2, kSix + kNormals, "0 0 0 1 1 1 0 1e-30 0\n0 0 0 1 1 1 0 0 1e30\n"));
    EXPECT_EQ(normalOf(set.views[0]), glm::dvec3(0, 1, 0));
    EXPECT_EQ(normalOf(set.views[1]), glm::dvec3(0, 0, 1));
}

TEST_F(Ply, EveryTruncationAndManyFlippedBytesAreRefusedOrReadNeverCrash) {
    ViewSet set = makeParticles(SceneBounds{}, 4, 1, 0, 5);
    set.views[1].flags = kViewHemisphere;
    set.views[1].normalX = 1;
    saveViews(folder_ / "good.ply", set, root_);
    std::ifstream in(folder_ / "good.ply", std::ios::binary);
    const std::string good(std::istreambuf_iterator<char>(in), {});
    for (std::size_t n = 0; n < good.size(); ++n) refused(good.substr(0, n));
    int accepted = 0;
    for (uint i = 0; i < 3000; ++i) {
        const uvec4 h = pcg4d({i, 1, 2, 3});
        std::string bad = good;
        bad[h.x % bad.size()] = static_cast<char>(h.y);
        if (h.z % 2) bad[h.w % bad.size()] = static_cast<char>(h.z >> 8);
        try {
            const ViewSet read = load(bad);
            EXPECT_LE(read.views.size(), 9u);
            ++accepted;
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::input);
        }
    }
    EXPECT_GT(accepted, 100);
    EXPECT_LT(accepted, 2900);
}

TEST_F(Ply, NamesFilesThatCannotBeReadOrWritten) {
    const auto inputError = [&](const fs::path& file) {
        try {
            loadViews(file, root_);
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::input);
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    EXPECT_NE(inputError(folder_ / "none.ply").find("none.ply: there is no such file"),
              std::string::npos);
    EXPECT_NE(inputError(folder_).find("is a folder"), std::string::npos);
    for (const fs::path& file : {folder_ / "no" / "such" / "folder.ply", folder_}) {
        try {
            saveViews(file, ViewSet{}, root_);
            ADD_FAILURE() << "written: " << file;
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::output);
            EXPECT_NE(std::string(e.what()).find(file.string()), std::string::npos) << e.what();
        }
    }
}

}  // namespace
}  // namespace mv
