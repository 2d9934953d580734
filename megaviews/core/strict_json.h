#pragma once
// Files that people write by hand, read strictly: comments are allowed, a key given twice is not,
// and an error says where.

#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/core/error.h"

namespace mv {

// Throws Error(code) with one line that starts with `where`.
nlohmann::json parseStrictJson(std::string_view text, std::string_view where, ExitCode code);

// What an exception of the JSON library says, without its "[json.exception.parse_error.101] ".
std::string_view withoutTag(std::string_view what);

}  // namespace mv
