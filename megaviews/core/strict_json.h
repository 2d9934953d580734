#pragma once
// Files that people write by hand, read strictly: comments are allowed, a key given twice is not,
// and an error says where.

#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "megaviews/core/error.h"

namespace mv {

// Throws Error(code) with one line that starts with `where`.
nlohmann::json parseStrictJson(std::string_view text, std::string_view where, ExitCode code);

}  // namespace mv
