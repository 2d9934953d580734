#pragma once
// Equal time and equal error: the place in an ordered list of settings, cheapest and worst first,
// at which a time or an error is met. By bisection: what a setting costs is assumed to rise along
// the list, and its error to fall.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace mv {

// What the i-th setting costs, or its error; nothing if it could not run. Asked once for each i.
using SearchFunction = std::function<std::optional<double>(std::size_t)>;

struct SearchStep {
    std::size_t index;
    std::optional<double> value;
};
struct SearchResult {
    std::size_t index = 0;  // that meets the limit, or comes closest to it
    bool met = false;
    std::vector<SearchStep> steps;  // in the order they were asked for
};

// The last of `count` >= 1 settings that costs at most the limit; the first if none does.
SearchResult searchEqualTime(std::size_t count, const SearchFunction& cost, double limit);
// The first setting whose error is at most the limit (at least, if higher is better); the last
// that runs if none is.
SearchResult searchEqualError(std::size_t count, const SearchFunction& error, double limit,
                              bool higherIsBetter);

}  // namespace mv
