#pragma once
// Text from a file made fit for messages.

#include <string>
#include <string_view>

namespace mv {

// Control characters and what is not UTF-8 are replaced by '?', and what is longer than `longest`
// bytes is cut with an ellipsis.
std::string printable(std::string_view text, std::size_t longest = 120);
// The same in double quotes.
std::string quote(std::string_view text);

}  // namespace mv
