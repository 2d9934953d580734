#pragma once
// Whether large pages were asked for under an address, as Linux tells (/proc/self/smaps).

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

namespace mv::testing {

inline bool largePagesAskedFor(const void* address) {
    std::ifstream maps("/proc/self/smaps");
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    bool inside = false;
    for (std::string line; std::getline(maps, line);) {
        unsigned long long begin = 0, end = 0;
        if (std::sscanf(line.c_str(), "%llx-%llx ", &begin, &end) == 2) {
            inside = begin <= at && at < end;
        } else if (inside && line.starts_with("VmFlags:")) {
            return line.find(" hg") != std::string::npos;
        }
    }
    return false;
}

}  // namespace mv::testing
