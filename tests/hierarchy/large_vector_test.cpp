#include "megaviews/core/large_vector.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/large_pages.h"

namespace mv {
namespace {

TEST(LargeVector, AsksForLargePagesWhereItIsLarge) {
    if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage")) GTEST_SKIP();
    LargeVector<float> small(1000), large(8u << 20);
    EXPECT_FALSE(testing::largePagesAskedFor(&small[500]));
    EXPECT_TRUE(testing::largePagesAskedFor(&large[4u << 20]));
    EXPECT_EQ(large, LargeVector<float>(8u << 20, 0.0f));
}

}  // namespace
}  // namespace mv
