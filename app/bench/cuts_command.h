#pragma once
// megaviews-bench cuts: what ManyLoDs' incremental and lazy cuts save, and what lazy ones cost, on
// the CPU's twin.

#include <string>
#include <vector>

namespace mv {

// `arguments` without "cuts". Prints a row a motion and kind of cut; exit code 1 if maps of
// incremental cuts are not those of the basic method. Throws Error.
int cutsCommand(const std::vector<std::string>& arguments);

}  // namespace mv
