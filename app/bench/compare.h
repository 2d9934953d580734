#pragma once
// megaviews-bench compare: the metrics of two pictures kept as .npy, without a picture library.

#include <string>
#include <vector>

namespace mv {

// `arguments` without "compare". Prints one line a metric; returns the exit code, 1 if a threshold
// is missed. Throws Error(ExitCode::usage) and Error(ExitCode::input).
int compareFiles(const std::vector<std::string>& arguments);

}  // namespace mv
