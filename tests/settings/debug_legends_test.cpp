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

}  // namespace
}  // namespace mv
