#include "renderer/methods/megaviews/pass_plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mv {

void PassPlan::begin(std::uint32_t views, double usual, double fillShare) {
    assert(views > 0 && usual > 0 && fillShare > 0 && fillShare <= 1);
    if (!parts_.empty() && parts_.back().end >= 1) before_ = std::move(parts_);
    parts_.clear();
    views_ = views;
    usual_ = usual;
    fillShare_ = fillShare;
    limit_ = 0;
    overflows_ = 0;
}

// [TSK13 eq. 3]: the largest of the means over the last pass, the last two, four, ... and all.
double PassPlan::perView() const {
    if (parts_.empty()) return std::max(usual_, atLeast_);
    double most = 0;
    for (std::size_t count = 1;; count = std::min(2 * count, parts_.size())) {
        double entries = 0, views = 0;
        for (std::size_t i = parts_.size() - count; i < parts_.size(); ++i) {
            const double share = parts_[i].end - (i > 0 ? parts_[i - 1].end : 0.0);
            views += share;
            entries += share * parts_[i].perView;
        }
        most = std::max(most, entries / views);
        if (count == parts_.size()) return most;
    }
}

double PassPlan::expected(std::uint32_t first, std::uint32_t end) const {
    if (before_.empty()) return (end - first) * perView();
    double sum = 0, begin = 0;
    for (const Part& part : before_) {
        const double from = std::max(begin * views_, double(first));
        const double to = std::min(part.end * views_, double(end));
        sum += std::max(0.0, to - from) * part.perView;
        begin = part.end;
    }
    return sum;
}

std::uint32_t PassPlan::endFrom(std::uint32_t first, std::uint64_t capacity) const {
    assert(first < views_);
    const double room = fillShare_ * double(capacity);
    std::uint32_t low = first + 1, high = views_;  // a single view is taken in any case
    while (low < high) {
        const std::uint32_t middle = high - (high - low) / 2;
        if (expected(first, middle) <= room) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    return limit_ > first ? std::min(low, limit_) : low;
}

void PassPlan::passed(std::uint32_t first, std::uint32_t end, std::uint64_t entries,
                      std::uint64_t capacity) {
    const bool known = !before_.empty() || !parts_.empty();
    parts_.push_back({.end = end == views_ ? 1.0 : double(end) / views_,
                      .perView = double(entries) / (end - first),
                      .expected = known ? expected(first, end) : 0.0,
                      .entries = double(entries),
                      .room = end == endFrom(first, capacity) ? double(capacity) : 0.0});
    limit_ = 0;
    atLeast_ = 0;
}

void PassPlan::overflowed(std::uint32_t first, std::uint32_t end, std::uint64_t capacity) {
    ++overflows_;
    before_.clear();  // it was wrong
    limit_ = first + std::max(1u, (end - first) / 2);
    if (parts_.empty()) atLeast_ = 2 * fillShare_ * double(capacity) / (end - first);
}

PassCounts PassPlan::counts() const {
    PassCounts out;
    out.made = parts_.size();
    out.overflows = overflows_;
    double errors = 0;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
        const Part& part = parts_[i];
        if (part.expected > 0 && part.entries > 0) {
            errors += std::abs(part.expected / part.entries - 1);
            ++out.predicted;
        }
        if (i > 0 && parts_[i - 1].entries + part.entries <= parts_[i - 1].room) ++out.falseAlarms;
    }
    if (out.predicted > 0) out.predictionError = errors / double(out.predicted);
    return out;
}

}  // namespace mv
