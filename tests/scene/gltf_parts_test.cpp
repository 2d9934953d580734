// The loader's smallest parts: hash, text, URIs.
#include <gtest/gtest.h>

#include <random>

#include "megaviews/core/sha256.h"
#include "megaviews/scene/gltf_check.h"
#include "megaviews/scene/gltf_report.h"
#include "megaviews/scene/uri.h"
#include "megaviews/scene/utf8.h"
#include "scene/gltf_builder.h"

namespace mv {
namespace {

using testing::Bytes;

TEST(Sha256Sum, StandardVectors) {
    // FIPS 180-4's examples and the empty message.
    EXPECT_EQ(Sha256().hex(), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(Sha256().add("abc").hex(),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(Sha256().add("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq").hex(),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(Sha256().add(std::string(1000000, 'a')).hex(),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256Sum, PartsDoNotMatter) {
    std::mt19937 random(5);
    for (const std::size_t length :
         {1u, 55u, 56u, 57u, 63u, 64u, 65u, 119u, 120u, 127u, 128u, 129u, 1000u}) {
        std::string text(length, ' ');
        for (char& c : text) c = static_cast<char>(random());
        const std::string whole = Sha256().add(text).hex();
        Sha256 inParts;
        for (std::size_t at = 0; at < length;) {
            const std::size_t part = std::min<std::size_t>(random() % 70, length - at);
            inParts.add(std::string_view(text).substr(at, part));
            at += part;
        }
        EXPECT_EQ(inParts.hex(), whole) << length;
    }
}

TEST(Utf8, SequencesAndTheirAbuses) {
    EXPECT_EQ(utf8SequenceLength(""), 0u);
    EXPECT_EQ(utf8SequenceLength("a"), 1u);
    EXPECT_EQ(utf8SequenceLength("é"), 2u);
    EXPECT_EQ(utf8SequenceLength("♻"), 3u);
    EXPECT_EQ(utf8SequenceLength("😀"), 4u);
    for (const char* bad : {"\x80", "\xc0\x80", "\xc1\xbf", "\xe0\x80\x80", "\xed\xa0\x80",
                            "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff",
                            "\xc3", "\xe2\x99", "\xf0\x9f\x98", "\xc3("}) {
        EXPECT_EQ(utf8SequenceLength(bad), 0u) << testing::base64(Bytes(bad, bad + strlen(bad)));
    }
    std::string text = "a\xff♻\xc3";
    EXPECT_EQ(repairUtf8(text), 2u);
    EXPECT_EQ(text, "a\xef\xbf\xbd♻\xef\xbf\xbd");
    EXPECT_EQ(repairUtf8(text), 0u);
}

TEST(Printable, ReplacesAndCuts) {
    EXPECT_EQ(printable("a\nb\x1b[31m\x7f\xff♻"), "a?b?[31m??♻");
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
    EXPECT_EQ(accessorElementBytes(5124, "VEC3"), 0u);
    EXPECT_EQ(accessorElementBytes(testing::kFloat, "VEC9"), 0u);
}

}  // namespace
}  // namespace mv
