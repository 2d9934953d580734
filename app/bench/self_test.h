#pragma once
// The GPU against its CPU twins on small built-in cases, on whatever device the program runs: what
// the test suite checks, without the test suite.

#include <string>
#include <vector>

namespace mv {

struct Check {
    std::string name;
    bool passed = false;
    std::string detail;  // the numbers the verdict rests on
};

// Needs a current context. Each check stands alone: an error in one is its failure.
std::vector<Check> runSelfTest();

}  // namespace mv
