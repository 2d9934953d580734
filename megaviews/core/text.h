#pragma once
// Text taken apart, and made fit for messages.

#include <functional>
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

// All of them with the separator between each two.
template <typename Texts>
std::string joined(const Texts& texts, std::string_view separator) {
    std::string out;
    for (const auto& text : texts) out.append(out.empty() ? "" : separator).append(text);
    return out;
}

// A member of each row, the names of a table say.
template <typename Table, typename Member>
std::vector<std::string> namesIn(const Table& table, Member member) {
    std::vector<std::string> names;
    for (const auto& row : table) names.emplace_back(std::invoke(member, row));
    return names;
}

}  // namespace mv
