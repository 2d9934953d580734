// .npy arrays, the three files of --save-maps, and files written aside.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include "megaviews/core/error.h"
#include "megaviews/io/save_maps.h"
#include "support/write_npy.h"

namespace mv {
namespace {

namespace fs = std::filesystem;

class Npy : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("megaviews-npy-" + std::to_string(getpid()) + "-" + info->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::string bytes(const fs::path& file) const {
        std::ifstream in(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }
    std::size_t filesInFolder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    template <typename T>
    void expectRefused(const std::string& text, const std::string& reason) {
        const fs::path file = folder_ / "bad.npy";
        std::ofstream(file, std::ios::binary) << text;
        try {
            readNpy<T>(file);
            ADD_FAILURE() << "accepted, though " << reason;
        } catch (const Error& e) {
            EXPECT_EQ(e.code, ExitCode::input);
            EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << e.what();
        }
    }
    fs::path folder_;
};

TEST_F(Npy, BringsBackWhatWasWritten) {
    const std::vector<std::vector<std::uint64_t>> shapes = {{0},       {1},    {7},         {2, 3},
                                                            {0, 2, 3}, {1, 1}, {4, 2, 8, 8}};
    for (const auto& shape : shapes) {
        std::uint64_t count = 1;
        for (const std::uint64_t n : shape) count *= n;
        std::vector<float> floats;
        std::vector<double> doubles;
        std::vector<std::uint32_t> uints;
        for (std::uint64_t i = 0; i < count; ++i) {
            floats.push_back(i % 5 ? static_cast<float>(i) / 3
                                   : std::numeric_limits<float>::infinity());
            doubles.push_back(static_cast<double>(i) / 3);
            uints.push_back(0xFFFFFFFFu - static_cast<std::uint32_t>(i));
        }
        const fs::path file = folder_ / "a.npy";
        writeNpy<float>(file, shape, floats);
        EXPECT_EQ(readNpy<float>(file).elements, floats);
        EXPECT_EQ(readNpy<float>(file).shape, shape);
        EXPECT_THROW(readNpy<double>(file), Error);
        writeNpy<double>(file, shape, doubles);
        EXPECT_EQ(readNpy<double>(file).elements, doubles);
        writeNpy<std::uint32_t>(file, shape, uints);
        EXPECT_EQ(readNpy<std::uint32_t>(file).elements, uints);
        EXPECT_EQ(readNpy<std::uint32_t>(file).shape, shape);
    }
}

TEST_F(Npy, HasTheHeaderThatTheFormatPrescribes) {
    writeNpy<float>(folder_ / "a.npy", {3}, std::vector<float>{1, 2, 3});
    const std::string text = bytes(folder_ / "a.npy");
    EXPECT_EQ(text.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
    const std::size_t length =
        static_cast<unsigned char>(text[8]) + 256u * static_cast<unsigned char>(text[9]);
    EXPECT_EQ((10 + length) % 64, 0u);
    EXPECT_EQ(text[10 + length - 1], '\n');
    EXPECT_EQ(text.substr(10, 59), "{'descr': '<f4', 'fortran_order': False, 'shape': (3,), }  ");
    EXPECT_EQ(text.size(), 10 + length + 12);
}

TEST_F(Npy, RefusesWhatItIsNot) {
    writeNpy<float>(folder_ / "a.npy", {2, 3}, std::vector<float>(6, 1.0f));
    const std::string good = bytes(folder_ / "a.npy");
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text = good;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    for (std::size_t n = 0; n < good.size(); ++n) expectRefused<float>(good.substr(0, n), "");
    expectRefused<float>(good + "x", "where its shape needs");
    expectRefused<float>(replaced("(2, 3)", "(2, 4)"), "where its shape needs");
    expectRefused<float>(replaced("(2, 3)", "(x, 3)"), "malformed shape");
    expectRefused<float>(replaced("(2, 3), }         ", "(4294967296, 4294967296, 6), }"),
                         "impossible shape");
    expectRefused<float>(replaced("False", "True "), "C order");
    expectRefused<float>(replaced("<f4", ">f4"), "little-endian 'f4'");
    expectRefused<float>(replaced("<f4", "<f8"), "little-endian 'f4'");
    expectRefused<float>(replaced("shape", "shame"), "no shape");
    expectRefused<float>(replaced(std::string("\x01\x00", 2), std::string("\x09\x00", 2)),
                         "version 9");
    EXPECT_THROW(readNpy<float>(folder_ / "none.npy"), Error);
    EXPECT_THROW(readNpy<float>(folder_), Error);
}

// ---------------------------------------------------------------- maps

struct Maps : ReadMaps {
    RootCube root{{100, 200, 300}, 8};
    explicit Maps(std::uint32_t count, int res = 8) {
        maps.mapRes = res;
        for (std::uint32_t m = 0; m < count; ++m) {
            maps.centers.push_back(glm::vec3(0.25f, 0.5f, 0.5f + 0.0001f * static_cast<float>(m)));
            for (int i = 0; i < 2 * res * res; ++i) {
                const float depth = 0.001f * static_cast<float>(i) + static_cast<float>(m);
                maps.texels.push_back(i % 7 == 3 ? kNone : floatBitsToUint(depth));
            }
            mapOfSlot.insert(mapOfSlot.end(), {m, kNone});
        }
    }
};

TEST_F(Npy, MapsAreDistancesInWorldUnits) {
    for (const auto& [count, res] : {std::pair{0u, 8}, {1u, 8}, {5u, 8}, {70u, 128}}) {
        const Maps made(count, res);
        saveMaps(folder_ / "maps.npy", made, made.root);
        const auto depth = readNpy<float>(folder_ / "maps.npy");
        const auto r = static_cast<std::uint64_t>(res);
        EXPECT_EQ(depth.shape, (std::vector<std::uint64_t>{count, 2, r, r}));
        for (std::size_t i = 0; i < depth.elements.size(); ++i) {
            if (made.maps.texels[i] == kNone) {
                ASSERT_EQ(depth.elements[i], std::numeric_limits<float>::infinity());
            } else {
                ASSERT_FLOAT_EQ(depth.elements[i], 8 * uintBitsToFloat(made.maps.texels[i])) << i;
            }
        }
        const auto centres = readNpy<double>(folder_ / "maps.centres.npy");
        EXPECT_EQ(centres.shape, (std::vector<std::uint64_t>{count, 3}));
        for (std::size_t m = 0; m < count; ++m) {
            EXPECT_EQ(centres.elements[3 * m], 102.0);
            EXPECT_EQ(centres.elements[3 * m + 1], 204.0);
        }
        const auto views = readNpy<std::uint32_t>(folder_ / "maps.views.npy");
        EXPECT_EQ(views.elements, made.mapOfSlot);
    }
    EXPECT_EQ(filesInFolder(), 3u);
}

TEST_F(Npy, NumPyReadsThem) {
    if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) {
        GTEST_SKIP() << "no NumPy for /usr/bin/python3";
    }
    const Maps made(3);
    saveMaps(folder_ / "m.npy", made, made.root);
    const std::string f = folder_.string();
    const std::string script =
        "import numpy as n\n"
        "d=n.load('" +
        f + "/m.npy'); c=n.load('" + f + "/m.centres.npy'); v=n.load('" + f +
        "/m.views.npy')\n"
        "assert d.dtype==n.float32 and d.shape==(3,2,8,8), (d.dtype,d.shape)\n"
        "assert n.isinf(d[1,0,0,3]) and abs(d[2,1,7,7]-8*(2+0.127))<1e-5, d[2,1,7,7]\n"
        "assert c.dtype==n.float64 and c.shape==(3,3) and c[2,0]==102\n"
        "assert v.dtype==n.uint32 and v.tolist()==[0,2**32-1,1,2**32-1,2,2**32-1]\n";
    std::ofstream(folder_ / "check.py") << script;
    EXPECT_EQ(std::system(("/usr/bin/python3 " + f + "/check.py").c_str()), 0);
}

TEST_F(Npy, ArraysOfOneSetLieBesideEachOther) {
    EXPECT_EQ(besideNpy("a/b.npy", "views"), fs::path("a/b.views.npy"));
    EXPECT_EQ(besideNpy("a.b/c", "views"), fs::path("a.b/c.views.npy"));
}

// ---------------------------------------------------------------- files written aside

TEST_F(Npy, NothingIsLeftOfAFileThatWasNotCommitted) {
    std::ofstream(folder_ / "old") << "old";
    {
        OutputFile file(folder_ / "old");
        file.write("new");
        EXPECT_EQ(bytes(folder_ / "old"), "old");
    }
    EXPECT_EQ(bytes(folder_ / "old"), "old");
    EXPECT_EQ(filesInFolder(), 1u);
    OutputFile file(folder_ / "old");
    file.write("new");
    file.commit();
    EXPECT_EQ(bytes(folder_ / "old"), "new");
    EXPECT_EQ(filesInFolder(), 1u);
}

TEST_F(Npy, LinksAndDevicesStayWhatTheyAre) {
    std::ofstream(folder_ / "target") << "old";
    fs::create_symlink("target", folder_ / "link");
    OutputFile linked(folder_ / "link");
    linked.write("new");
    linked.commit();
    EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
    EXPECT_EQ(bytes(folder_ / "target"), "new");
    OutputFile sink("/dev/null");
    sink.write("nothing");
    sink.commit();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(Npy, AFullDiskIsAnErrorThatNamesTheFile) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
    try {
        writeNpy<float>("/dev/full", {100000}, std::vector<float>(100000));
        ADD_FAILURE() << "written";
    } catch (const Error& e) {
        EXPECT_EQ(e.code, ExitCode::output);
        EXPECT_NE(std::string(e.what()).find("/dev/full"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace mv
