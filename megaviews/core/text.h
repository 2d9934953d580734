#pragma once
// Text taken apart, and made fit for messages.

#include <string>
#include <string_view>
#include <vector>

namespace mv {

// Control characters and what is not UTF-8 are replaced by '?', and what is longer than `longest`
// bytes is cut with an ellipsis.
std::string printable(std::string_view text, std::size_t longest = 120);
// The same in double quotes.
std::string quote(std::string_view text);
std::string csvQuoted(std::string_view text);  // as it is, in quotes for a CSV file

std::string_view trimmed(std::string_view text);  // without white space around it
std::string lowered(std::string_view text);       // ASCII alone
// What stands between any of the separators; one part more than there are of those.
std::vector<std::string_view> splitAt(std::string_view text, std::string_view separators);

}  // namespace mv
