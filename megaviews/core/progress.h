#pragma once
// How long work reports itself: a stage in words and its share done. Called from any thread, at
// most some tens of times a stage. The callback may throw Cancelled.

#include <functional>
#include <string_view>

namespace mv {

using Progress = std::function<void(std::string_view stage, float fraction01)>;

inline void report(const Progress& progress, std::string_view stage, float fraction01) {
    if (progress) progress(stage, fraction01);
}

}  // namespace mv
