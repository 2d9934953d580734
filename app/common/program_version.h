#pragma once
// Which build this is: what --version, statistics and pictures say of it.

#include <string>

namespace mv {

// "0.1.0", "0123456789ab" (empty outside a checkout), "Release".
std::string programVersion();
std::string programCommit();
std::string programBuildType();

}  // namespace mv
