#pragma once
// megaviews-bench sweep: its options, its files, its table.

#include <string>
#include <vector>

namespace mv {

// `arguments` without "sweep". Returns the exit code: 6 if a point could not run. Throws Error, and
// Cancelled when interrupted; the files then hold what was finished.
int sweepCommand(const std::vector<std::string>& arguments);

}  // namespace mv
