// The Views instrument in a window: texels of maps under the pointer, in any colours.

#include <cmath>

#include "viewer/viewer_fixture.h"

namespace mv {
namespace {

class ViewsTest : public ViewerTest {};

bool says(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(ViewsTest, ATexelOfAMapSaysItsRay) {
    for (const float scale : {1.0f, 1.5f}) {
        const int height = scale > 1 ? 1000 : 700;  // maps in sight without scrolling
        Viewer viewer(900, height, Viewer::smallSettings(), "builtin:cornell", scale);
        viewer.run("views; pick-a=8; wait-still; wait 2");
        const ui::ViewsData& views = viewer.model().views;
        ASSERT_TRUE(views.a);
        const auto map = viewer.session->interface().findItem("map-a.picture");
        ASSERT_TRUE(map);
        const auto point = [&](int x, int y) {
            const auto at = [](float from, float size, int i, int n) {
                return std::to_string(std::lround(from + size * (static_cast<float>(i) + 0.5f) /
                                                             static_cast<float>(n)));
            };
            viewer.run("move " + at(map->x, map->width, x, 16) + "," +
                       at(map->y, map->height, y, 8) + "; wait 2");
        };
        int filled = 0;
        for (const auto& [x, y] : {std::pair{3, 4}, {4, 2}, {5, 5}, {11, 3}, {12, 4}, {10, 5}}) {
            point(x, y);
            ASSERT_TRUE(views.texel) << x << " " << y;
            EXPECT_EQ(views.texel->place, (ui::MapPlace{true, 0, x, y}));
            const ui::Float3 d = views.texel->direction;
            EXPECT_NEAR(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], 1, 1e-5f);
            EXPECT_EQ(d[0] > 0, x < 8);
            EXPECT_EQ(views.texel->face, x < 8 ? "Front (+x)" : "Back (-x)");
            EXPECT_EQ(d[1] > 0, x % 8 >= 4);
            EXPECT_EQ(d[2] > 0, y < 4);
            if (says(views.texel->content, "world units away")) {
                ++filled;
                EXPECT_TRUE(says(views.texel->content, "scene node "));
                EXPECT_TRUE(says(views.texel->content, "rendered in view node "));
            } else {
                EXPECT_EQ(views.texel->content, "nothing is seen there");
            }
        }
        EXPECT_GT(filled, 1);
        const std::string content = views.texel->content;
        EXPECT_EQ(views.mapLegend.unit, "");
        viewer.run("map-colours=depth; wait 2");
        EXPECT_EQ(views.mapLegend.title, "Depth");
        EXPECT_EQ(views.mapLegend.unit, "world units");
        EXPECT_GT(views.mapLegend.high, 0.1);
        point(10, 5);
        ASSERT_TRUE(views.texel);
        EXPECT_EQ(views.texel->content, content) << "whatever the colours";
        viewer.run("map-colours=views; wait 2");
        EXPECT_TRUE(views.mapLegend.logarithmic);
        viewer.run("move 90%,50%; wait 2");
        EXPECT_FALSE(views.texel);
    }
}

}  // namespace
}  // namespace mv
