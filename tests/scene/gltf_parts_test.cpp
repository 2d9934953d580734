// The loader's smallest parts: hash, text, URIs.
#include <gtest/gtest.h>

#include <random>

#include "megaviews/core/hash.h"
#include "megaviews/scene/gltf_check.h"
#include "megaviews/scene/gltf_report.h"
#include "megaviews/scene/uri.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::Bytes;

TEST(HashSum, IsXxh3) {
    // XXH3's own value for the empty input.
    EXPECT_EQ(Hash().hex(), "99aa06d3014798d86001c324468d497f");
    EXPECT_NE(Hash().add("abc").hex(), Hash().add("abd").hex());
}

TEST(HashSum, PartsDoNotMatter) {
    std::mt19937 random(5);
    for (const std::size_t length :
         {1u, 55u, 56u, 57u, 63u, 64u, 65u, 119u, 120u, 127u, 128u, 129u, 1000u}) {
        std::string text(length, ' ');
        for (char& c : text) c = static_cast<char>(random());
        const std::string whole = Hash().add(text).hex();
        Hash inParts;
        for (std::size_t at = 0; at < length;) {
            const std::size_t part = std::min<std::size_t>(random() % 70, length - at);
            inParts.add(std::string_view(text).substr(at, part));
            at += part;
        }
        EXPECT_EQ(inParts.hex(), whole) << length;
    }
}

TEST(Printable, ReplacesAndCuts) {
    EXPECT_EQ(printable("a\nb\x1b[31m\x7f\xff♻"), "a?b?[31m??♻");
    EXPECT_EQ(printable("a\xc0\x80\xc3"), "a??");  // one for each broken sequence
    EXPECT_EQ(printable("♻♻", 4), "♻…");
    const std::string cut = printable(std::string(500, 'x'), 10);
    EXPECT_EQ(cut, std::string(10, 'x') + "…");
    EXPECT_EQ(printable(std::string(10, 'x'), 10), std::string(10, 'x'));
}

TEST(Report, CountsHostileWarnings) {
    GltfReport report("x.gltf");
    for (int i = 0; i < 1000; ++i) report.warn("p", "q");
    EXPECT_EQ(report.warnings.size(), 101u);
    EXPECT_EQ(report.warnings[0], "x.gltf: p: q");
}

TEST(Base64, RoundTripsAndRefuses) {
    std::mt19937 random(9);
    for (std::size_t length = 0; length < 70; ++length) {
        Bytes bytes(length);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        std::string text = testing::base64(bytes);
        EXPECT_EQ(decodeBase64(text), bytes) << length;
        while (text.ends_with('=')) text.pop_back();
        EXPECT_EQ(decodeBase64(text), bytes) << length;
    }
    for (const char* bad : {"A", "A===", "AA=A", "A\nAA", "AA-_", "====", "AAAAA", "AA==AA=="}) {
        EXPECT_FALSE(decodeBase64(bad)) << bad;
    }
}

TEST(Uri, PercentDecoding) {
    EXPECT_EQ(percentDecode("a%20b%C3%A9%2e"), "a b\xc3\xa9.");
    for (const char* bad : {"%", "%2", "a%", "%g0", "%0g"}) EXPECT_FALSE(percentDecode(bad)) << bad;
}

TEST(Uri, NothingOutsideTheFolderIsOpened) {
    const testing::TemporaryFolder folder;
    folder.write("secret.txt", std::string("secret"));
    folder.write("inside/file.txt", std::string("inside"));
    const auto inside = folder.path() / "inside";
    EXPECT_TRUE(readUri(inside, "file.txt").ok());
    EXPECT_TRUE(readUri(inside, "./sub/../file.txt").ok());
    EXPECT_EQ(readUri(inside, "file.txt", 3).bytes.size(), 3u);
    EXPECT_FALSE(readUri(inside, "file.txt", 7).ok());
    for (const std::string uri : {"../secret.txt", "..%2fsecret.txt", "%2e%2e/secret.txt",
                                  "./../secret.txt", "x/../../secret.txt", "..\\secret.txt", "",
                                  ".", "/etc/passwd", "%2Fetc/passwd", "file:///etc/passwd"}) {
        EXPECT_FALSE(readUri(inside, uri).ok()) << uri;
    }
    EXPECT_FALSE(readUri(inside, folder.path().string() + "/secret.txt").ok());
    EXPECT_FALSE(readRegularFile("/dev/null").ok());
}

TEST(AccessorElements, PadColumnsOfSmallMatrices) {
    EXPECT_EQ(accessorElementBytes(testing::kFloat, "VEC3"), 12u);
    EXPECT_EQ(accessorElementBytes(testing::kByte, "SCALAR"), 1u);
    EXPECT_EQ(accessorElementBytes(testing::kFloat, "MAT4"), 64u);
    EXPECT_EQ(accessorElementBytes(testing::kByte, "MAT2"), 8u);
    EXPECT_EQ(accessorElementBytes(testing::kByte, "MAT3"), 12u);
    EXPECT_EQ(accessorElementBytes(testing::kShort, "MAT3"), 24u);
}

}  // namespace
}  // namespace mv
