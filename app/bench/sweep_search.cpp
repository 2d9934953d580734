#include "app/bench/sweep_search.h"

#include <algorithm>

namespace mv {
namespace {

class Asked {
  public:
    Asked(const SearchFunction& function, SearchResult& result)
        : function_(function), result_(result) {}

    std::optional<double> operator()(std::size_t index) {
        for (const SearchStep& step : result_.steps) {
            if (step.index == index) return step.value;
        }
        result_.steps.push_back({index, function_(index)});
        return result_.steps.back().value;
    }

  private:
    const SearchFunction& function_;
    SearchResult& result_;
};

// How many of the first settings hold, if all that hold come before all that do not.
template <typename Holds>
std::size_t countHolding(std::size_t begin, std::size_t end, const Holds& holds) {
    while (begin < end) {
        const std::size_t middle = begin + (end - begin) / 2;
        if (holds(middle)) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

}  // namespace

SearchResult searchEqualTime(std::size_t count, const SearchFunction& cost, double limit) {
    SearchResult result;
    Asked ask(cost, result);
    const std::size_t within = countHolding(0, count, [&](std::size_t i) {
        const auto value = ask(i);
        return value && *value <= limit;
    });
    result.met = within > 0;
    result.index = result.met ? within - 1 : 0;
    return result;
}

SearchResult searchEqualError(std::size_t count, const SearchFunction& error, double limit,
                              bool higherIsBetter) {
    SearchResult result;
    Asked ask(error, result);
    const std::size_t usable =
        ask(count - 1) ? count
                       : countHolding(0, count - 1, [&](std::size_t i) { return bool(ask(i)); });
    if (usable == 0) return result;
    const std::size_t worse = countHolding(0, usable, [&](std::size_t i) {
        const auto value = ask(i);
        return !value || (higherIsBetter ? !(*value >= limit) : !(*value <= limit));
    });
    result.met = worse < usable;
    result.index = std::min(worse, usable - 1);
    return result;
}

}  // namespace mv
