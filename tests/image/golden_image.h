#pragma once
// Comparing a picture with the one that was looked at and believed. Failing leaves the picture, the
// golden one and their difference, eight times enlarged, in the build folder; a golden picture that
// is missing fails. MEGAVIEWS_BLESS=1 in the environment writes golden pictures anew.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace mv {

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  // top row first
};

struct Tolerance {
    int difference = 0;  // of a channel, of 255
    double failing = 0;  // share of the pixels that may differ by more
};

testing::AssertionResult matchesGolden(const Picture& picture, const std::string& name,
                                       Tolerance tolerance);
// Share of pixels of which a channel differs by more than `difference`; sizes must agree.
double failingShare(const Picture& a, const Picture& b, int difference);

}  // namespace mv
