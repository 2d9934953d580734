#pragma once
// Files as a whole, as every reader of the program takes them: regular files alone, so that a
// folder or a pipe is refused and never waited for.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/core/error.h"

namespace mv {

// Why a file cannot be read, in words for a message ("there is no such file"); empty if it can.
// Does not open what is no regular file.
std::string whyUnreadable(const std::filesystem::path& path);

struct Resource {
    std::vector<std::uint8_t> bytes;
    std::string error;  // why there are no bytes, in words for a message; empty = success
    std::filesystem::path file = {};  // that they are of, if any
    bool ok() const { return error.empty(); }
};

// A regular file, whole or its first `most` bytes.
Resource readRegularFile(const std::filesystem::path& path, std::uint64_t most = UINT64_MAX);

// What people write by hand: configurations, states, scripts.
constexpr std::uint64_t kLargestTextBytes = 1 << 20;
// Throws Error(code) naming path and reason for what cannot be read or is larger than `most` bytes.
std::string readTextFile(const std::filesystem::path& path, ExitCode code,
                         std::uint64_t most = kLargestTextBytes);

}  // namespace mv
