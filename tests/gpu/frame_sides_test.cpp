// Two sides of a split: each is what a frame of its own settings alone would be.

#include <algorithm>

#include "gpu/frame_fixture.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/memory.h"

namespace mv {
namespace {

using test::FrameTest;

bool has(const std::vector<StageTime>& stages, Stage wanted) {
    return std::any_of(stages.begin(), stages.end(),
                       [&](const StageTime& stage) { return stage.stage == wanted; });
}

TEST_F(FrameTest, EachSideIsWhatItsSettingsAloneGive) {
    compareWith(settings, Method::manylods);
    settings.side[1].pairs.traversal = Traversal::queue;
    settings.side[1].rules = kPublishedRules;
    settings.side[1].maps.resolution = 8;
    Settings sameMethod = settings;
    sameMethod.side[1].method = Method::megaviews;
    Settings none = settings;
    none.side[1].method = Method::none;
    Settings swapped = settings;
    std::swap(swapped.side[0], swapped.side[1]);
    for (const Settings& both : {settings, sameMethod, none, swapped}) {
        input.reuse = false;
        const Settings left = sideAlone(both, 0), right = sideAlone(both, 1);
        std::vector<std::vector<float>> alone;
        std::vector<std::vector<std::uint8_t>> aloneShown;
        std::vector<PairCounts> pairs;
        for (const Settings& side : {left, right}) {
            pairs.push_back(render(side).methods.at(0).pairs);
            alone.push_back(radiance());
            aloneShown.push_back(display());
        }
        EXPECT_NE(alone[0], alone[1]);
        for (const double split : {1.0, 0.0, 0.4}) {
            Settings shown = both;
            shown.display.split = split;
            const FrameStatistics statistics = render(shown);
            ASSERT_EQ(statistics.methods.size(), 2u);
            EXPECT_EQ(statistics.methods[0].pairs, pairs[0]);
            EXPECT_EQ(statistics.methods[1].pairs, pairs[1]);
            const auto got = radiance();
            const auto gotShown = display();
            const int x = static_cast<int>(split * settings.resolution.width + 0.5);
            for (int p = 0; p < settings.resolution.width * settings.resolution.height; ++p) {
                const std::size_t side = p % settings.resolution.width < x ? 0 : 1;
                for (std::size_t c = 4 * static_cast<std::size_t>(p);
                     c < 4 * static_cast<std::size_t>(p) + 4; ++c) {
                    ASSERT_EQ(got[c], alone[side][c]) << "split " << split << " pixel " << p;
                    ASSERT_EQ(gotShown[c], aloneShown[side][c]) << "split " << split;
                }
            }
        }
    }
}

TEST_F(FrameTest, CullsOnceForBothSides) {
    compareWith(settings, Method::manylods);
    const FrameStatistics statistics = render();
    EXPECT_TRUE(has(statistics.stagesOfBothSides, Stage::gatherCull));
    for (const MethodStatistics& method : statistics.methods) {
        EXPECT_FALSE(has(method.stages, Stage::gatherCull));
        EXPECT_TRUE(has(method.stages, Stage::gather));
        EXPECT_TRUE(has(method.stages, Stage::traverse));
    }
    // A frame that changes nothing runs nothing.
    const FrameStatistics idle = render();
    EXPECT_TRUE(idle.stagesOfBothSides.empty());
    for (const MethodStatistics& method : idle.methods) {
        EXPECT_TRUE(method.stages.empty());
        EXPECT_GT(method.pairs.processed, 0u);  // what is shown is still told
    }
    // The right side's own settings leave the left side's maps alone.
    settings.side[1].maps.resolution = 8;
    const FrameStatistics right = render();
    EXPECT_FALSE(has(right.stagesOfBothSides, Stage::gatherCull));
    EXPECT_FALSE(has(right.methods[0].stages, Stage::traverse));
    EXPECT_FALSE(has(right.methods[0].stages, Stage::gather));
    EXPECT_TRUE(has(right.methods[1].stages, Stage::traverse));
    EXPECT_TRUE(has(right.methods[1].stages, Stage::gather));
}

TEST_F(FrameTest, MapsThatDoNotFitLeaveThePictureAsItWas) {
    render();
    const auto before = display();
    Settings impossible = settings;
    compareWith(impossible, Method::raster);
    impossible.side[1].maps.resolution = 256;
    impossible.side[0].maps.memoryMiB = impossible.side[1].maps.memoryMiB = 16;
    EXPECT_THROW(render(impossible), Error);
    EXPECT_EQ(display(), before);
    render();
    EXPECT_EQ(display(), before);
}

TEST_F(FrameTest, OfAFrameThatFailedNothingIsReadAndNothingTimed) {
    render();
    const auto samples = renderer->readSamples(30, 20, 0);
    ASSERT_FALSE(samples.empty());
    Settings impossible = settings;
    setMethod(impossible, Method::raster);
    impossible.side[0].maps = {.resolution = 256, .memoryMiB = 16};
    impossible.seed = 3;
    EXPECT_THROW(render(impossible), Error);
    EXPECT_TRUE(renderer->readSamples(30, 20, 0).empty());
    EXPECT_FALSE(renderer->readGatherShares(0));
    EXPECT_FALSE(renderer->readPixel(30, 20).surface);
    EXPECT_TRUE(has(render().stagesOfBothSides, Stage::traceViews));
    EXPECT_EQ(renderer->readSamples(30, 20, 0).size(), samples.size());
    EXPECT_THROW(render(impossible), Error);
    setMethod(impossible, Method::none);
    EXPECT_FALSE(has(render(impossible).stagesOfBothSides, Stage::traceViews));  // those are there
}

// Slice by slice or at once: the same light, the same samples of a pixel, the same maps.
TEST_F(FrameTest, AnyBudgetOfMapsGivesTheSamePicture) {
    struct Case {
        Method method;
        Undecided undecided;
        uint rules;
        int samples;  // 0: all views
        int depthBits;
    };
    for (const Case& c :
         {Case{Method::megaviews, Undecided::rays, kCorrectedRules, 4, 32},
          {Method::megaviews, Undecided::rays, kCorrectedRules, 40, 16},
          {Method::megaviews, Undecided::rays, kCorrectedRules, 0, 32},
          {Method::megaviews, Undecided::off, kCorrectedRules, 40, 32},
          {Method::megaviews, Undecided::off, kCorrectedRules, 0, 16},
          {Method::manylods, Undecided::rays, kCorrectedRules, 40, 32},
          {Method::manylods, Undecided::rays, kCorrectedRules, 0, 32},
          {Method::manylods, Undecided::off, kCorrectedRules & ~kRuleFootprint, 4, 32},
          {Method::manylods, Undecided::rays, kPublishedRules, 40, 32}}) {
        setMethod(settings, c.method);
        settings.gather.undecided = c.undecided;
        settings.gather.samples = c.samples;
        settings.side[0].rules = c.rules;
        settings.side[0].maps = {.resolution = 64, .depthBits = c.depthBits};
        settings.side[0].pairs.holeFill = c.rules != kPublishedRules;
        SCOPED_TRACE(::testing::Message() << nameOf(c.method) << " rules " << c.rules << ", "
                                          << c.samples << " samples, " << c.depthBits << " bits"
                                          << (c.undecided == Undecided::rays ? ", rays" : ""));
        const FrameStatistics whole = render();
        const auto want = radiance();
        const ReadMaps maps = renderer->readMaps(0);
        const auto gathered = renderer->readSamples(30, 20, 0);
        ASSERT_FALSE(gathered.empty());
        for (const int budgetMiB : {4, 1}) {
            SCOPED_TRACE(budgetMiB);
            settings.side[0].maps.memoryMiB = budgetMiB;
            const FrameStatistics sliced = render();
            ASSERT_GT(whole.methods[0].mapBytes, std::uint64_t(budgetMiB) << 20);
            EXPECT_LE(sliced.methods[0].mapBytes, (std::uint64_t(budgetMiB) << 20) + 64);
            EXPECT_EQ(radiance(), want);
            EXPECT_EQ(sliced.methods[0].pairs, whole.methods[0].pairs);
            const ReadMaps again = renderer->readMaps(0);
            EXPECT_EQ(again.maps.texels, maps.maps.texels);
            const auto gatheredAgain = renderer->readSamples(30, 20, 0);
            ASSERT_EQ(gatheredAgain.size(), gathered.size());
            for (std::size_t i = 0; i < gathered.size(); ++i) {
                EXPECT_EQ(gatheredAgain[i].slot, gathered[i].slot);
                EXPECT_EQ(gatheredAgain[i].irradiance, gathered[i].irradiance);
            }
        }
    }
    // What is finished with all maps at hand cannot be made in slices.
    settings.side[0].pairs.holeFill = true;
    EXPECT_THROW(render(), Error);
}

TEST_F(FrameTest, TellsWhatIsOnTheGpu) {
    const auto find = [](const FrameStatistics& s, const std::string& name) {
        const auto it = std::find_if(s.memory.begin(), s.memory.end(),
                                     [&](const MemoryUse& use) { return use.name == name; });
        return it == s.memory.end() ? MemoryUse{} : *it;
    };
    const FrameStatistics one = render();
    for (const char* name : {"scene geometry", "scene octree", "views", "view octree", "lists",
                             "working maps", "final maps", "G-buffer", "gather", "picture"}) {
        EXPECT_GT(find(one, name).usedBytes, 0u) << name;
    }
    EXPECT_EQ(find(one, "final maps").usedBytes, one.methods[0].maps * 2 * 16 * 16 * 4);
    EXPECT_EQ(find(one, "final maps").predictedBytes, find(one, "final maps").usedBytes);
    // Position, normal, albedo, plane, emission, depth.
    EXPECT_EQ(find(one, "G-buffer").usedBytes, 75u * 43u * (16 + 8 + 8 + 8 + 16 + 4));
    compareWith(settings, Method::manylods);
    settings.side[1].pairs.traversal = Traversal::queue;
    const FrameStatistics two = render();
    EXPECT_EQ(find(two, "lists, left").usedBytes, find(one, "lists").usedBytes);
    EXPECT_GT(find(two, "pair queue, right").predictedBytes, 0u);
    EXPECT_EQ(find(two, "final maps, right").usedBytes, two.methods[1].maps * 2 * 16 * 16 * 4);
    EXPECT_GT(find(two, "picture").usedBytes, find(one, "picture").usedBytes);
    // What is closed is freed.
    settings.compare = false;
    EXPECT_EQ(find(render(), "lists, right").usedBytes, 0u);
}

// What no row names are counters and tables of a few KiB; what two rows name is counted once.
TEST_F(FrameTest, NamesWhatIsOnTheGpu) {
    for (const Method method : {Method::manylods, Method::none, Method::rays, Method::shadowRays,
                                Method::raster, Method::ism, Method::vir}) {
        SCOPED_TRACE(static_cast<int>(method));
        compareWith(settings, method);
        for (const bool moving : {true, false}) {
            settings.gather.history = moving ? 8 : 0;
            settings.picture.temporal = moving;
            settings.picture.accumulate = moving ? 1 : 2;
            std::uint64_t named = 0, other = 0;
            for (const MemoryUse& use : render().memory) {
                (use.name == "other" ? other : named) += use.usedBytes;
            }
            EXPECT_EQ(named + other, gl::heldMemory());
            EXPECT_LT(other, 1u << 19);
        }
    }
}

TEST_F(FrameTest, CountsByLevelWhereAsked) {
    compareWith(settings, Method::manylods);
    settings.side[1].pairs.traversal = Traversal::queue;
    settings.picture.accumulate = 3;
    EXPECT_TRUE(render().methods[0].pairsPerLevel.empty());
    input.countLevels = true;
    const FrameStatistics counted = render();
    EXPECT_EQ(counted.accumulatedFrames, 2);  // counting changes no map
    for (const MethodStatistics& method : counted.methods) {
        EXPECT_EQ(sumOf(method.pairsPerLevel), method.pairs);
        EXPECT_GT(method.occupancy.size(), 0u);
    }
    input.countLevels = false;
    const FrameStatistics kept = render();
    EXPECT_TRUE(kept.methods[0].stages.empty() || kept.methods[0].stages[0].stage == Stage::gather);
}

}  // namespace
}  // namespace mv
