// Errors of depth maps, counted by hand.

#include "megaviews/measure/map_errors.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "metrics/patterns.h"

namespace mv::test {
namespace {

TEST(MapMetricsTable, IsTheOneOfTheDocumentation) {
    std::ifstream file(MEGAVIEWS_SOURCE_DIR "/docs/metrics.md");
    const std::string page(std::istreambuf_iterator<char>(file), {});
    std::string table = "| name | share of texels, % |\n|---|---|\n";
    std::set<std::string_view> names;
    for (const MapMetricInfo& info : mapMetricsTable()) {
        names.insert(info.name);
        table.append("| `").append(info.name).append("` | ").append(info.description);
        table.append(" |\n");
    }
    EXPECT_EQ(names.size(), 7u);
    EXPECT_NE(page.find(table), std::string::npos) << "docs/metrics.md should hold\n" << table;
}

TEST(MapErrors, AreCountedByHand) {
    //                             right  +3 %   -5 %   +20 %  empty      filled     sky        NaN
    const std::vector<float> map = {1, 1.03f, 0.95f, 2.4f, kInfinity, 0.5f, kInfinity, kNaN};
    const std::vector<float> exact = {1, 1, 1, 2, 1, kInfinity, kInfinity, 1};
    const std::vector<float> nearest = {1, 0.9f, 0.97f, 1, 1, kInfinity, kInfinity, 1};
    const std::vector<float> farthest = {1, 1.05f, 1.1f, 3, 1, kInfinity, kInfinity, 1};
    const MapErrors errors = compareMaps(map, exact, nearest, farthest);
    EXPECT_EQ(errors.texels, 5u);
    EXPECT_EQ(errors.off2, 4u);
    EXPECT_EQ(errors.off10, 2u);
    EXPECT_EQ(errors.tooNear, 1u);
    EXPECT_EQ(errors.tooFar, 2u);
    EXPECT_EQ(errors.empty, 1u);
    EXPECT_EQ(errors.filled, 1u);
    EXPECT_EQ(errors.outOfRange, 2u);  // the third below its range, the empty one
    EXPECT_EQ(errors.bad, 1u);
    EXPECT_DOUBLE_EQ(errors.share(errors.off2), 0.8);
    // Off by more than 2 % is nearer, farther or empty.
    EXPECT_EQ(errors.off2, errors.tooNear + errors.tooFar + errors.empty);
    EXPECT_EQ(compareMaps(map, exact).outOfRange, 0u);
}

TEST(MapErrors, LeaveRoomForRoundingAndReferencesThatAreNoNumber) {
    // At the ends of its range up to the rounding of the ray that found them.
    const std::vector<float> map = {1, 1, 1}, exact = {1, 1, kNaN};
    const std::vector<float> nearest = {1 + 5e-6f, 0.5f, 0.5f}, farthest = {2, 1 - 5e-6f, 2};
    const MapErrors errors = compareMaps(map, exact, nearest, farthest);
    EXPECT_EQ(errors.outOfRange, 0u);
    EXPECT_EQ(errors.texels, 2u);
    EXPECT_EQ(errors.bad, 1u);
    const std::vector<float> tight = {1 + 2e-5f, 0.5f, 0.5f}, low = {2, 1 - 2e-5f, 2};
    EXPECT_EQ(compareMaps(map, exact, tight, low).outOfRange, 2u);
}

TEST(MapErrors, OfAnEmptyTexelLieInARangeThatReachesTheSky) {
    const std::vector<float> map = {kInfinity, 0.4f}, exact = {1, 1}, nearest = {0.5f, 0.5f};
    const std::vector<float> farthest = {kInfinity, kInfinity};
    EXPECT_EQ(compareMaps(map, exact, nearest, farthest).outOfRange, 1u);
}

TEST(MapErrors, OfEqualMapsAreNone) {
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{100'000}}) {
        std::vector<float> map(n);
        for (std::size_t i = 0; i < n; ++i) map[i] = i % 7 ? 0.001f * float(i) : kInfinity;
        const MapErrors errors = compareMaps(map, map, map, map);
        EXPECT_EQ(errors.texels, n - (n + 6) / 7);
        EXPECT_EQ(errors.off2 + errors.off10 + errors.tooNear + errors.tooFar + errors.empty +
                      errors.filled + errors.outOfRange + errors.bad,
                  0u);
        EXPECT_EQ(errors.share(errors.off2), 0);
    }
}

TEST(MapErrors, AddUpOverParts) {
    std::vector<float> map, exact;
    for (int i = 0; i < 50'000; ++i) {
        exact.push_back(1 + static_cast<float>(i % 13));
        map.push_back(exact.back() * (0.8f + 0.001f * static_cast<float>(i % 400)));
    }
    MapErrors parts;
    for (std::size_t begin = 0; begin < map.size(); begin += 10'000) {
        parts += compareMaps(std::span(map).subspan(begin, 10'000),
                             std::span(exact).subspan(begin, 10'000));
    }
    const MapErrors whole = compareMaps(map, exact);
    EXPECT_EQ(parts.off2, whole.off2);
    EXPECT_EQ(parts.off10, whole.off10);
    EXPECT_EQ(parts.tooNear, whole.tooNear);
    EXPECT_EQ(parts.texels, 50'000u);
    // Every depth from 0.8 to 1.199 is met 125 times.
    EXPECT_NEAR(whole.share(whole.tooNear), 180 / 400.0, 0.005);
    EXPECT_NEAR(whole.share(whole.tooFar), 179 / 400.0, 0.005);
}

TEST(MapErrors, AddUpOfEveryKind) {
    std::vector<float> map, exact, nearest, farthest;
    for (int i = 0; i < 5000; ++i) {
        exact.push_back(i % 19 ? 1.0f : kInfinity);
        map.push_back(i % 23 == 0   ? kNaN
                      : i % 17 == 0 ? kInfinity
                                    : 0.8f + 0.001f * static_cast<float>(i % 400));
        nearest.push_back(0.9f);
        farthest.push_back(1.1f);
    }
    const MapErrors whole = compareMaps(map, exact, nearest, farthest);
    MapErrors parts;
    for (std::size_t begin = 0; begin < map.size(); begin += 1000) {
        const auto part = [&](const std::vector<float>& v) {
            return std::span(v).subspan(begin, 1000);
        };
        parts += compareMaps(part(map), part(exact), part(nearest), part(farthest));
    }
    for (const MapMetricInfo& info : mapMetricsTable()) {
        EXPECT_GT(whole.*info.count, 0u) << info.name;
        EXPECT_EQ(parts.*info.count, whole.*info.count) << info.name;
    }
    EXPECT_EQ(parts.texels, whole.texels);
    EXPECT_EQ(parts.bad, whole.bad);
    EXPECT_GT(whole.bad, 0u);
}

}  // namespace
}  // namespace mv::test
