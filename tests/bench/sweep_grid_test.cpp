#include <gtest/gtest.h>

#include "app/bench/sweep_grid.h"
#include "megaviews/core/error.h"

namespace mv {
namespace {

using Values = std::vector<std::string>;

Values valuesOf(const std::string& text) { return sweepAxisFromText(text, "--sweep").values; }

std::string refusalOf(const std::string& text) {
    try {
        sweepAxisFromText(text, "--sweep");
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        return error.what();
    }
    return "";
}

std::string refusalOf(const Settings& base, const std::vector<SweepAxis>& axes) {
    try {
        sweepPoints(base, axes);
    } catch (const Error& error) {
        EXPECT_EQ(error.code, ExitCode::usage);
        return error.what();
    }
    return "";
}

TEST(SweepGrid, Lists) {
    EXPECT_EQ(valuesOf("vpls=1K,4096,1M"), (Values{"1024", "4096", "1048576"}));
    EXPECT_EQ(valuesOf("method=none"), Values{"none"});
    EXPECT_EQ(valuesOf("fusion=yes,off"), (Values{"on", "off"}));
    EXPECT_EQ(valuesOf("cutoff=0.25,1e-1"), (Values{"0.25", "0.1"}));
    EXPECT_EQ(valuesOf("resolution=64x36,128x72"), (Values{"64x36", "128x72"}));
    EXPECT_EQ(valuesOf("exposure=auto,-1"), (Values{"auto", "-1"}));
    EXPECT_EQ(valuesOf("camera-position=1,2,3;4,5,6"), (Values{"1,2,3", "4,5,6"}));
    EXPECT_EQ(valuesOf("resolution=64,36;128,72"), (Values{"64x36", "128x72"}));
}

TEST(SweepGrid, Ranges) {
    EXPECT_EQ(valuesOf("vpls=1K..8K:x2"), (Values{"1024", "2048", "4096", "8192"}));
    EXPECT_EQ(valuesOf("vpls=1K..9000:x2").back(), "8192");
    EXPECT_EQ(valuesOf("gather-samples=16..64:+16"), (Values{"16", "32", "48", "64"}));
    EXPECT_EQ(valuesOf("gather-samples=16..63:+16"), (Values{"16", "32", "48"}));
    EXPECT_EQ(valuesOf("vpls=0001..1:x2"), Values{"1"});
    EXPECT_EQ(valuesOf("seed=5..5:+1"), Values{"5"});
    // Rounding neither loses the end nor repeats a whole number.
    EXPECT_EQ(valuesOf("cutoff=0.1..0.3:+0.1"), (Values{"0.1", "0.2", "0.3"}));
    EXPECT_EQ(valuesOf("cutoff=0.001..1:x10"), (Values{"0.001", "0.01", "0.1", "1"}));
    EXPECT_EQ(valuesOf("gather-samples=1..8:x1.5"), (Values{"1", "2", "3", "5", "8"}));
    EXPECT_EQ(valuesOf("gather-samples=1,4..16:x2,100"), (Values{"1", "4", "8", "16", "100"}));
    EXPECT_EQ(valuesOf("vpls=1K..64K:x2").size(), 7u);
    EXPECT_EQ(valuesOf("exposure=-2..2:+1").size(), 5u);
}

TEST(SweepGrid, RefusesWithOneSentence) {
    for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
             {"vpls", "is not KEY=VALUES"},
             {"vpl=4", "unknown setting 'vpl'; did you mean vpls?"},
             {"distributoin=single", "did you mean distribution?"},
             {"=4", "unknown setting ''"},
             {"vpls=", "'' is not a number"},
             {"vpls=4,,8", "'' is not a number"},
             {"vpls=4x", "--sweep vpls: '4x' is not a number"},
             {"vpls=0", "is outside 1..1M"},
             {"vpls=1..2M:x2", "is outside"},
             {"vpls=1..8", "has no step"},
             {"vpls=1..8:*2", "not xFACTOR or +STEP"},
             {"vpls=1..8:", "not xFACTOR or +STEP"},
             {"vpls=1..8:x1", "never ends"},
             {"vpls=1..8:x0.5", "never ends"},
             {"vpls=1..8:+0", "never ends"},
             {"cutoff=0..1:x2", "never ends"},
             {"vpls=8..1:x2", "runs backwards"},
             {"vpls=..8:x2", "'' is not a number"},
             {"vpls=1..8:+0.5", "is not a whole number"},
             {"seed=0..1M:+1", "has more than 10000 values"},
             {"view-res=16..64:+16", "is not a power of two"},
             {"vpls=4,8,4", "'4' is there twice"},
             {"vpls=1K,1024", "'1024' is there twice"},
             {"method=ray..x:x2", "is not one of"},
             {"pick-a=1", "changes only what is shown"},
             {"compare-view-res=16", "changes only what is shown"},
             {"camera-position=1,2,3,4", "is not X,Y,Z"}}) {
        EXPECT_NE(refusalOf(text).find(part), std::string::npos) << text << ": " << refusalOf(text);
    }
}

TEST(SweepGrid, ProductCountsTheLastAxisFastest) {
    const std::vector<SweepAxis> axes = {sweepAxisFromText("vpls=8,16", ""),
                                         sweepAxisFromText("method=none,manylods", ""),
                                         sweepAxisFromText("seed=1,2,3", "")};
    Settings base;
    base.gather.samples = 5;
    const std::vector<SweepPoint> points = sweepPoints(base, axes);
    ASSERT_EQ(points.size(), 12u);
    EXPECT_EQ(points[0].values, (Values{"8", "none", "1"}));
    EXPECT_EQ(points[1].values, (Values{"8", "none", "2"}));
    EXPECT_EQ(points[3].values, (Values{"8", "manylods", "1"}));
    EXPECT_EQ(points[11].values, (Values{"16", "manylods", "3"}));
    EXPECT_EQ(points[10].settings.views.vpls, 16);
    EXPECT_EQ(points[10].settings.side[0].method, Method::manylods);
    EXPECT_EQ(points[10].settings.seed, 2u);
    EXPECT_EQ(points[10].settings.gather.samples, 5);
    EXPECT_EQ(sweepPointName(axes, points[10].values), "vpls=16 method=manylods seed=2");
    const auto one = sweepPoints(base, {});
    ASSERT_EQ(one.size(), 1u);
    EXPECT_EQ(one[0].settings, base);
}

TEST(SweepGrid, Distributions) {
    // Before or after the count that particles copy.
    for (const bool first : {false, true}) {
        std::vector<SweepAxis> axes = {
            sweepAxisFromText("distribution=single,bounces,particles,random", ""),
            sweepAxisFromText("vpls=32", "")};
        if (!first) std::swap(axes[0], axes[1]);
        Settings base;
        base.views.particles = 7;
        base.views.bounces = 2;
        const auto points = sweepPoints(base, axes);
        ASSERT_EQ(points.size(), 4u);
        const auto expect = [&](std::size_t i, std::int64_t particles, int bounces, Placement p) {
            EXPECT_EQ(points[i].settings.views.vpls, 32);
            EXPECT_EQ(points[i].settings.views.particles, particles) << i;
            EXPECT_EQ(points[i].settings.views.bounces, bounces) << i;
            EXPECT_EQ(points[i].settings.views.placement, p) << i;
        };
        expect(0, 0, 1, Placement::traced);
        expect(1, 0, 4, Placement::traced);
        expect(2, 32, 2, Placement::traced);
        expect(3, 0, 2, Placement::random);
    }
}

TEST(SweepGrid, RefusesGridsAsAWhole) {
    const SweepAxis vpls = sweepAxisFromText("vpls=8,16", "");
    const SweepAxis distribution = sweepAxisFromText("distribution=random", "");
    EXPECT_NE(refusalOf({}, {vpls, vpls}).find("swept twice"), std::string::npos);
    for (const char* key : {"bounces=1", "particles=4", "placement=traced", "views=a.ply"}) {
        EXPECT_NE(refusalOf({}, {distribution, sweepAxisFromText(key, "")}).find("as well"),
                  std::string::npos)
            << key;
    }
    Settings fromFile;
    fromFile.views.file = "a.ply";
    EXPECT_NE(refusalOf(fromFile, {distribution}).find("from a file"), std::string::npos);
    EXPECT_EQ(refusalOf(fromFile, {vpls}), "");
    // One point of the grid is impossible: it is named.
    const std::string refusal = refusalOf({}, {sweepAxisFromText("placement=traced,random", ""),
                                               sweepAxisFromText("particles=0,4", "")});
    EXPECT_NE(refusal.find("placement=random particles=4: "), std::string::npos) << refusal;
    EXPECT_NE(refusalOf({}, {sweepAxisFromText("seed=1..1000:+1", ""),
                             sweepAxisFromText("vpls=1..11:+1", "")})
                  .find("more than 10000 points"),
              std::string::npos);
    EXPECT_EQ(sweepPoints({}, std::vector{sweepAxisFromText("seed=1..1000:+1", ""),
                                          sweepAxisFromText("vpls=1..10:+1", "")})
                  .size(),
              10000u);
}

}  // namespace
}  // namespace mv
