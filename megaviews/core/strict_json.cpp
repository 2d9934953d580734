#include "megaviews/core/strict_json.h"

#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace mv {

nlohmann::json parseStrictJson(std::string_view text, std::string_view where, ExitCode code) {
    const std::string place(where);
    // A key given twice is more likely a slip than an intention.
    std::vector<std::set<std::string>> seen;
    const auto onEvent = [&](int, nlohmann::json::parse_event_t event, nlohmann::json& parsed) {
        using Event = nlohmann::json::parse_event_t;
        if (event == Event::object_start) seen.emplace_back();
        if (event == Event::object_end) seen.pop_back();
        if (event == Event::key && !seen.back().insert(parsed.get<std::string>()).second) {
            throw Error(code, place + ": '" + parsed.get<std::string>() + "' is given twice");
        }
        return true;
    };
    try {
        return nlohmann::json::parse(text, onEvent, true, true);
    } catch (const nlohmann::json::exception& error) {
        throw Error(code, place + ": not valid JSON: " + std::string(withoutTag(error.what())));
    }
}

std::string_view withoutTag(std::string_view what) {
    const std::size_t end = what.find("] ");
    return end == std::string_view::npos ? what : what.substr(end + 2);
}

}  // namespace mv
