// Which views have maps, and whose map another one takes.

#include "shaders/shared/map_borrowing.glsl"

#include <gtest/gtest.h>

#include <algorithm>

namespace mv {
namespace {

TEST(MapBorrowing, RunsAreEvenAndTheirMiddlesOrdered) {
    for (const uint views : {1u, 2u, 5u, 64u, 1000u, 4097u, 65536u, 1048927u, (1u << 21) - 1}) {
        for (const uint most : {1u, 3u, 64u, 1024u, views - 1, views, 2 * views}) {
            if (most == 0) continue;
            SCOPED_TRACE(::testing::Message() << views << " views, " << most << " maps");
            const uint maps = mapsOfViews(views, most);
            ASSERT_EQ(maps, std::min(views, most));
            const uint length = runLength(views, maps);
            const double even = double(views) / double(maps);
            uint before = 0;
            bool ordered = true, own = true;
            double worst = 0;
            for (uint run = 0; run < maps; ++run) {
                const uint view = viewWithMap(run, length);
                ordered &= view < views && (run == 0 || view > before);
                own &= runOfView(view, length, maps) == run;
                worst =
                    std::max(worst, std::abs((double(run) + 0.5) * even - (double(view) + 0.5)));
                before = view;
            }
            EXPECT_TRUE(ordered);
            EXPECT_TRUE(own);
            // Half a view, and what a length is rounded by.
            EXPECT_LE(worst, 1 + double(maps) / 2048);
            if (maps == views) {
                EXPECT_EQ(viewWithMap(maps - 1, length), views - 1);
            }
        }
    }
    EXPECT_EQ(runLength(0, 0), 0u);
}

TEST(MapBorrowing, WhatFacesElsewhereServesLessThanWhatIsFar) {
    const vec3 up(0, 1, 0), down(0, -1, 0), tilted = glm::normalize(vec3(0.8f, 1, 0));
    const vec3 near(0.01f, 0, 0), far(0.9f, 0.9f, 0.9f);
    EXPECT_LT(mapDistance(near, up, up), mapDistance(far, up, up));
    EXPECT_LT(mapDistance(far, up, up), mapDistance(near, up, down));  // through a floor
    EXPECT_LT(mapDistance(far, up, tilted), mapDistance(near, up, vec3(1, 0, 0)));
    EXPECT_LT(mapDistance(near, up, down), mapDistance(far, up, down));
    // Particles face everywhere.
    EXPECT_EQ(mapDistance(near, vec3(0), vec3(0)), mapDistance(near, up, up));
}

}  // namespace
}  // namespace mv
