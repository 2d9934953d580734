#pragma once
// Rows of a picture in parallel, and sums over them that are the same bits for any thread count:
// each row is summed from left to right in double, the rows from the top with compensation [Kahan
// 1965, Neumaier 1974].

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace mv {

template <typename Function>
void forRows(int height, const Function& row) {
    tbb::parallel_for(0, height, row);
}

inline double compensatedSum(std::span<const double> terms) {
    double sum = 0, lost = 0;
    for (const double term : terms) {
        const double next = sum + term;
        if (!std::isfinite(next)) return next;
        lost += std::abs(sum) >= std::abs(term) ? (sum - next) + term : (term - next) + sum;
        sum = next;
    }
    return sum + lost;
}

// sumOfRow(y) -> double.
template <typename Function>
double sumRows(int height, const Function& sumOfRow) {
    std::vector<double> sums(static_cast<std::size_t>(height));
    forRows(height, [&](int y) { sums[static_cast<std::size_t>(y)] = sumOfRow(y); });
    return compensatedSum(sums);
}

}  // namespace mv
