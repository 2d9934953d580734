#include "megaviews/settings/debug_legends.h"

#include <gtest/gtest.h>

#include <set>

namespace mv {
namespace {

constexpr DebugView kViews[] = {DebugView::final,      DebugView::direct,     DebugView::indirect,
                                DebugView::unfiltered, DebugView::normals,    DebugView::albedo,
                                DebugView::depth,      DebugView::candidates, DebugView::nan,
                                DebugView::sharing,    DebugView::shared};

TEST(DebugLegendsTest, EveryViewHasALegendThatIsWhole) {
    for (const DebugView view : kViews) {
        const DebugLegend& legend = legendOf(view);
        SCOPED_TRACE(static_cast<int>(view));
        EXPECT_EQ(legend.title.empty(), legend.kind == LegendKind::none);
        EXPECT_EQ(legend.classes.empty(), legend.kind != LegendKind::classes);
        EXPECT_LT(legend.low, legend.high);
        if (legend.logarithmic) {
            EXPECT_GT(legend.low, 0);
        }
        std::set<std::string_view> names;
        std::set<std::array<float, 3>> colours;
        for (const LegendClass& c : legend.classes) {
            EXPECT_TRUE(names.insert(c.name).second) << c.name;
            EXPECT_TRUE(colours.insert(c.colour).second) << c.name;
            EXPECT_FALSE(c.help.empty());
            for (const float x : c.colour) EXPECT_TRUE(x >= 0 && x <= 1) << c.name;
        }
    }
    EXPECT_EQ(legendOf(DebugView::final).kind, LegendKind::none);
    EXPECT_EQ(legendOf(DebugView::sharing).kind, LegendKind::scale);
    ASSERT_EQ(legendOf(DebugView::shared).kind, LegendKind::classes);
    ASSERT_EQ(legendOf(DebugView::shared).classes.size(), 5u);
    EXPECT_EQ(legendOf(DebugView::shared).classes[static_cast<int>(SharedClass::onlyB)].name,
              "B only");
}

TEST(DebugLegendsTest, PositionsGoFromEndToEnd) {
    for (const DebugView view : kViews) {
        const DebugLegend& legend = legendOf(view);
        if (legend.kind != LegendKind::scale) continue;
        EXPECT_NEAR(legendPosition(legend, legend.low), 0, 1e-12);
        EXPECT_NEAR(legendPosition(legend, legend.high), 1, 1e-12);
        EXPECT_EQ(legendPosition(legend, -1), 0);
        EXPECT_EQ(legendPosition(legend, 1e9), 1);
        EXPECT_EQ(legendPosition(legend, legend.low / 2), 0);
    }
    // 1 .. 256 by factors: 16 is half way.
    EXPECT_NEAR(legendPosition(legendOf(DebugView::sharing), 16), 0.5, 1e-12);
    EXPECT_NEAR(legendPosition(legendOf(DebugView::candidates), 0.25), 0.25, 1e-12);
}

}  // namespace
}  // namespace mv
