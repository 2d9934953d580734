#pragma once
// What a glTF file refers to: data URIs and files beside it. Nothing outside the folder of the
// glTF file is ever opened. Serves the first stage, file -> Scene.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/core/input_file.h"

namespace mv {

// Strict base64 (RFC 4648, padded or not); nothing for anything else.
std::optional<std::vector<std::uint8_t>> decodeBase64(std::string_view text);

// %41 -> A. Nothing where a '%' is not followed by two hexadecimal digits.
std::optional<std::string> percentDecode(std::string_view text);

// The bytes behind a URI: "data:...;base64,..." or a relative path. A file must hold at least
// `atLeast` bytes, and if that is positive no more are read.
Resource readUri(const std::filesystem::path& folder, const std::string& uri,
                 std::uint64_t atLeast = 0);

}  // namespace mv
