#pragma once
// Files that people write by hand, read strictly: comments are allowed, a key given twice is not,
// and an error says where.

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "megaviews/core/error.h"

namespace mv {

// Objects and arrays within one another: deeper ones are refused, since whatever walks a document
// recurses.
constexpr int kDeepestJson = 128;

// Throws Error(code) with one line that starts with `where`. The second keeps the order of keys.
nlohmann::json parseStrictJson(std::string_view text, std::string_view where, ExitCode code);
nlohmann::ordered_json parseOrderedJson(std::string_view text, std::string_view where,
                                        ExitCode code);

// What an exception of the JSON library says, without its "[json.exception.parse_error.101] ".
std::string_view withoutTag(std::string_view what);

}  // namespace mv
