#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "app/bench/sweep_search.h"

namespace mv {
namespace {

// A setting's cost rises and its error falls along the list; from `refusedFrom` on none runs.
struct Fake {
    std::size_t count, refusedFrom;
    std::set<std::size_t> asked;
    SearchFunction cost() {
        return [this](std::size_t i) -> std::optional<double> {
            EXPECT_LT(i, count);
            EXPECT_TRUE(asked.insert(i).second) << i << " was asked for twice";
            if (i >= refusedFrom) return std::nullopt;
            return 10.0 * static_cast<double>(i + 1);  // 10, 20, 30, ...
        };
    }
    SearchFunction error() {
        return [c = cost()](std::size_t i) -> std::optional<double> {
            const auto value = c(i);
            if (!value) return std::nullopt;
            return 10 / *value;  // 1, 1/2, 1/3, ...
        };
    }
};

TEST(SweepSearch, EqualTimeFindsTheLastWithin) {
    for (std::size_t count = 1; count <= 9; ++count) {
        for (std::size_t refused = 0; refused <= count; ++refused) {
            for (const double limit : {5.0, 10.0, 14.0, 35.0, 90.0, 1e9}) {
                Fake fake{count, refused, {}};
                const SearchResult r = searchEqualTime(count, fake.cost(), limit);
                const std::size_t within =
                    std::min(refused, static_cast<std::size_t>(std::min(limit / 10, 1e6)));
                EXPECT_EQ(r.met, within > 0) << count << " " << refused << " " << limit;
                EXPECT_EQ(r.index, within > 0 ? std::min(within, count) - 1 : 0)
                    << count << " " << refused << " " << limit;
                EXPECT_TRUE(fake.asked.contains(r.index));
                EXPECT_EQ(r.steps.size(), fake.asked.size());
            }
        }
    }
}

TEST(SweepSearch, EqualErrorFindsTheFirstThatReaches) {
    for (std::size_t count = 1; count <= 9; ++count) {
        for (std::size_t refused = 0; refused <= count; ++refused) {
            for (const double limit : {2.0, 1.0, 0.4, 0.15, 0.0}) {
                Fake fake{count, refused, {}};
                const SearchResult r = searchEqualError(count, fake.error(), limit, false);
                std::size_t first = 0;
                while (first < refused && 1.0 / static_cast<double>(first + 1) > limit) ++first;
                EXPECT_EQ(r.met, first < refused) << count << " " << refused << " " << limit;
                EXPECT_EQ(r.index, refused == 0 ? 0 : std::min(first, refused - 1))
                    << count << " " << refused << " " << limit;
                EXPECT_TRUE(fake.asked.contains(r.index));
            }
        }
    }
}

TEST(SweepSearch, HigherMayBeBetter) {
    Fake fake{9, 9, {}};
    const SearchResult r = searchEqualError(9, fake.cost(), 35, true);  // as a PSNR
    EXPECT_TRUE(r.met);
    EXPECT_EQ(r.index, 3u);
    Fake never{9, 9, {}};
    const SearchResult none = searchEqualError(9, never.cost(), 91, true);
    EXPECT_FALSE(none.met);
    EXPECT_EQ(none.index, 8u);
}

TEST(SweepSearch, NoNumberMeetsNothing) {
    const SearchFunction nothing = [](std::size_t) { return std::optional(std::nan("")); };
    EXPECT_FALSE(searchEqualTime(4, nothing, 1e9).met);
    EXPECT_FALSE(searchEqualError(4, nothing, 1e9, false).met);
    EXPECT_FALSE(searchEqualError(4, nothing, -1e9, true).met);
}

TEST(SweepSearch, AsksForFew) {
    Fake fake{1000, 1000, {}};
    EXPECT_EQ(searchEqualTime(1000, fake.cost(), 5000).index, 499u);
    EXPECT_LE(fake.asked.size(), 10u);
}

}  // namespace
}  // namespace mv
